// Scans with truths known in advance: their noise, where they lie, and the shape they were taken
// of.
#include "morph/scan.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "knead/spline/evaluate.hpp"
#include "morph/align.hpp"
#include "morph/scan_fit.hpp"
#include "support/thread_counts.hpp"

namespace knead {
namespace {

using morph::FitSurface;
using morph::Scan;
using morph::VisibleSearch;

/// A bicubic sheet 4 by 3, unlike any turned image of itself, and of no kind of surface that slides
/// in itself.
std::shared_ptr<const Surface> sheet(double lift = 0) {
  constexpr int rows = 9, columns = 8;
  const auto u = KnotVector::clamped_uniform(3, rows).value(),
             v = KnotVector::clamped_uniform(3, columns).value();
  Points net(rows * columns, 3);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const double s = i / (rows - 1.0), t = j / (columns - 1.0);
      const double height = 0.6 * std::sin(3 * s) - 0.4 * std::sin(4 * t) + 0.4 * s * t;
      net.row(i * columns + j) << 4 * s, 3 * t, height + lift * std::sin(2 * s + t);
    }
  }
  return std::make_shared<const Surface>(*Surface::create({u, v}, net));
}

/// Random points of a surface, where `shown` says so of fractions, each coordinate with noise.
template <class Shown>
std::vector<Point> points_of(const Surface& surface, int count, double noise, const Shown& shown) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> error(0, 1);
  std::vector<Point> result;
  while (result.size() < static_cast<std::size_t>(count)) {
    const Eigen::Vector2d at(unit(random), unit(random));
    if (!shown(at)) continue;
    Point p = *evaluate_point<2>(surface, parameters_of(surface, at));
    for (int c = 0; c < 3; ++c) p[c] += noise * error(random);
    result.push_back(p);
  }
  return result;
}
std::vector<Point> points_of(const Surface& surface, int count, double noise) {
  return points_of(surface, count, noise, [](const Eigen::Vector2d&) { return true; });
}

TEST(EstimatedNoise, IsThatWhichWasAdded) {
  for (const double noise : {1e-4, 1e-3, 1e-2}) {
    EXPECT_NEAR(morph::estimated_noise(points_of(*sheet(), 20'000, noise)), noise, 0.05 * noise);
  }
  // Of exact points what a cubic cannot follow is left, of any spacing.
  EXPECT_LT(morph::estimated_noise(points_of(*sheet(), 20'000, 0)), 1e-6);
  EXPECT_LT(morph::estimated_noise(points_of(*sheet(), 2'000, 0)), 1e-4);
  EXPECT_EQ(morph::estimated_noise(points_of(*sheet(), 39, 0)), 0);
}

TEST(Align, FindsMotionsOfAnySize) {
  const std::vector<FitSurface> model = {{sheet(), {}}};
  const auto search = VisibleSearch::create(model);
  ASSERT_TRUE(search) << search.error().message();
  const double size = search->box().diagonal().norm();
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 1);
  for (int trial = 0; trial < 12; ++trial) {
    const Point axis = Point(normal(random), normal(random), normal(random)).normalized();
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd((trial + 1) * EIGEN_PI / 12, axis).toRotationMatrix();
    const Point shift =
        3 * size * Point(normal(random), normal(random), normal(random)).normalized();
    std::vector<Point> points = points_of(*model[0].surface, 3000, 0);
    std::vector<Point> moved;
    for (const Point& p : points) moved.push_back(turn * p + shift);
    const auto found = morph::align(morph::scan_of(moved, {}, {}), *search, model, {});
    ASSERT_TRUE(found) << found.error().message();
    double largest = 0;
    for (std::size_t k = 0; k < points.size(); ++k)
      largest = std::max(largest, (found->motion.at(moved[k]) - points[k]).norm());
    EXPECT_LT(largest, 1e-7 * size) << "turned by " << 15 * (trial + 1) << " degrees";
    EXPECT_NEAR(found->motion.rotation.determinant(), 1, 1e-12);
    EXPECT_GT(found->rms_before, size);
  }
}

TEST(Align, ScansWithNoiseThatShowAPart) {
  const std::vector<FitSurface> model = {{sheet(), {}}};
  const auto search = VisibleSearch::create(model);
  ASSERT_TRUE(search) << search.error().message();
  const double size = search->box().diagonal().norm(), noise = 1e-4 * size;
  const auto shown = [](const Eigen::Vector2d& at) {
    return at.x() < 0.8 && (at.y() > 0.2 || at.x() < 0.4);
  };
  const auto rough = points_of(*model[0].surface, 5000, noise, shown);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2, Point(1, 2, 3).normalized()).toRotationMatrix();
  std::vector<Point> moved;
  for (const Point& p : rough) moved.push_back(turn * p + Point(5, -9, 2));
  const auto found = morph::align(morph::scan_of(moved, {}, {}), *search, model, {});
  ASSERT_TRUE(found) << found.error().message();
  double largest = 0;
  for (std::size_t k = 0; k < moved.size(); ++k)
    largest = std::max(largest, (found->motion.at(moved[k]) - rough[k]).norm());
  EXPECT_LT(largest, noise);
}

/// Fits a sheet to a scan of one that is lifted, and gives the largest and rms distance of the
/// result from the truth, at points that were no data.
struct Followed {
  morph::ScanFit fit;
  double rms = 0, largest = 0, farthest = 0;  ///< of the result; how far a point moved
};
template <class Shown>
Followed followed(const Scan& scan, const Shown& judged, morph::ScanSettings settings) {
  const std::vector<FitSurface> model = {{sheet(), {}}};
  settings.reach = 0.5;
  auto fit = morph::fit_scan(scan, model, {}, {}, settings);
  EXPECT_TRUE(fit) << fit.error().message();
  if (!fit) return {};
  Followed result{*std::move(fit)};
  const std::vector<FitSurface> truth = {{sheet(0.1), {}}};
  const auto search = VisibleSearch::create(truth);
  const Surface& moved = result.fit.fit.surfaces[0];
  int count = 0;
  for (int i = 1; i < 60; ++i) {
    for (int j = 1; j < 60; ++j) {
      const Eigen::Vector2d at(i / 60.0, j / 60.0);
      if (!judged(at)) continue;
      const double off =
          search->nearest(*evaluate_point<2>(moved, parameters_of(moved, at)), 1).distance;
      result.rms += off * off;
      result.largest = std::max(result.largest, off);
      ++count;
    }
  }
  result.rms = std::sqrt(result.rms / count);
  for (int i = 0; i <= 100; ++i) {
    for (int j = 0; j <= 100; ++j) {
      const Eigen::Vector2d at(i / 100.0, j / 100.0);
      const Point before =
          *evaluate_point<2>(*model[0].surface, parameters_of(*model[0].surface, at));
      const Point after = *evaluate_point<2>(moved, parameters_of(moved, at));
      result.farthest = std::max(result.farthest, (after - before).norm());
    }
  }
  return result;
}

TEST(FitScan, FollowsExactPoints) {
  const auto everywhere = [](const Eigen::Vector2d&) { return true; };
  const Scan scan = morph::scan_of(points_of(*sheet(0.1), 20'000, 0), {}, {});
  const auto found = followed(scan, everywhere, {.tolerance = 1e-5});
  EXPECT_LT(found.rms, 2e-5);
  EXPECT_LT(found.largest, 2e-4);
  EXPECT_EQ(found.fit.noise, 0);
}

// Exact points ask for no more than the default tolerance, and feet that are still wrong for less.
TEST(FitScan, GivesExactPointsNoMoreControlPointsThanTheyNeed) {
  const auto everywhere = [](const Eigen::Vector2d&) { return true; };
  const Scan scan = morph::scan_of(points_of(*sheet(0.1), 20'000, 0), {}, {});
  const auto found = followed(scan, everywhere, {});
  EXPECT_LT(found.rms, found.fit.noise);
  EXPECT_LE(found.fit.fit.control_points, 120);
}

TEST(FitScan, LeavesNoiseBehind) {
  const auto everywhere = [](const Eigen::Vector2d&) { return true; };
  constexpr double noise = 2e-3;
  const Scan scan = morph::scan_of(points_of(*sheet(0.1), 20'000, noise), {}, {});
  const auto found = followed(scan, everywhere, {});
  EXPECT_NEAR(found.fit.noise, noise, 0.1 * noise);
  EXPECT_LT(found.rms, 0.3 * std::sqrt(3.0) * noise);
}

TEST(FitScan, GoesNowhereBeyondTheBorderOfAScan) {
  const auto part = [](const Eigen::Vector2d& at) {
    return at.x() < 0.6 && (at - Eigen::Vector2d(0.3, 0.5)).norm() > 0.1;
  };
  const Scan scan = morph::scan_of(points_of(*sheet(0.1), 15'000, 1e-3, part), {}, {});
  const auto found = followed(scan, part, {});
  EXPECT_LT(found.rms, 0.3 * std::sqrt(3.0) * 1e-3);
  EXPECT_LT(found.farthest, 1.5 * 0.1);  // the sheet is lifted by 0.1 at most
}

/// A roof over x from 0 to 1 and a wall below its edge x = 1, both flat, moved.
std::vector<FitSurface> angle(const Point& by) {
  const auto knots = *KnotVector::clamped_uniform(1, 2);
  const auto sheet = [&](const Point& a, const Point& b, const Point& along) {
    Points net(4, 3);
    net << a.transpose(), (a + along).transpose(), b.transpose(), (b + along).transpose();
    net.rowwise() += by.transpose();
    return std::make_shared<const Surface>(*Surface::create({knots, knots}, net));
  };
  const Point y(0, 1, 0);
  return {{sheet({0, 0, 0}, {1, 0, 0}, y), {}}, {sheet({1, 0, 0}, {1, 0, -1}, y), {}}};
}

// Each of both faces says nothing of how the other moves along it, and the edge of them all.
TEST(FitScan, FacesSlideAlongBesideASharpEdge) {
  const Point by(0.02, 0, 0.05);
  const auto model = angle(Point::Zero()), truth = angle(by);
  morph::FitEdge edge{.course = nullptr, .surfaces = {0, 1}, .name = "edge"};
  for (const double t : {0.0, 0.5, 1.0})
    edge.samples.push_back({t, Point(1, t, 0), {Eigen::Vector2d(1, t), Eigen::Vector2d(0, t)}});
  constexpr double noise = 1e-3;
  std::vector<Point> points = points_of(*truth[0].surface, 5000, noise);
  const auto below = points_of(*truth[1].surface, 5000, noise);
  points.insert(points.end(), below.begin(), below.end());
  const auto fit = morph::fit_scan(morph::scan_of(points, {}, {}), model, {{edge}}, {},
                                   {.reach = 0.2, .noise = noise});
  ASSERT_TRUE(fit) << fit.error().message();
  const Surface &roof = fit->fit.surfaces[0], &wall = fit->fit.surfaces[1];
  for (int i = 0; i <= 20; ++i) {
    for (int j = 0; j <= 20; ++j) {
      const Eigen::Vector2d at(i / 20.0, j / 20.0);
      EXPECT_NEAR(evaluate_point<2>(roof, parameters_of(roof, at))->z(), by.z(), noise);
      EXPECT_NEAR(evaluate_point<2>(wall, parameters_of(wall, at))->x(), 1 + by.x(), noise);
    }
  }
  EXPECT_NEAR(evaluate_point<2>(roof, std::array{1.0, 0.5})->x(), 1 + by.x(), noise)
      << "the edge itself";
}

TEST(FitScan, OutliersDoNotPull) {
  const auto everywhere = [](const Eigen::Vector2d&) { return true; };
  auto points = points_of(*sheet(0.1), 20'000, 1e-3);
  for (std::size_t k = 0; k < points.size(); k += 20) points[k].z() += 0.2;
  const auto found = followed(morph::scan_of(points, {}, {}), everywhere, {.noise = 1e-3});
  // Some have neighbours from which no normal is like that of the sheet.
  EXPECT_GT(found.fit.last.outliers + found.fit.last.turned_away, 990U);
  EXPECT_LT(found.rms, 0.3 * std::sqrt(3.0) * 1e-3);
}

TEST(FitScan, DoesNotDependOnThreads) {
  const Scan scan = morph::scan_of(points_of(*sheet(0.1), 3000, 1e-3), {}, {});
  const std::vector<FitSurface> model = {{sheet(), {}}};
  std::optional<Points> first;
  for (const int threads : testing::thread_counts) {
    const auto fit = testing::with_threads(
        threads, [&] { return morph::fit_scan(scan, model, {}, {}, {.reach = 0.5}); });
    ASSERT_TRUE(fit) << fit.error().message();
    const Points& net = fit->fit.surfaces[0].control_points();
    if (!first) first = net;
    EXPECT_EQ(net, *first);
  }
}

}  // namespace
}  // namespace knead
