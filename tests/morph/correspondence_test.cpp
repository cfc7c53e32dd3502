// The nearest visible points of surfaces beside those among many thousands of samples.
#include "morph/correspondence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "knead/spline/evaluate.hpp"
#include "support/thread_counts.hpp"

namespace knead {
namespace {

using Eigen::Vector2d;
using morph::Correspondences;
using morph::FitSurface;
using morph::VisibleFoot;
using morph::VisibleSearch;

constexpr double pi = std::numbers::pi;

/// A bicubic net over x and y, with heights.
template <class Place>
std::shared_ptr<const Surface> sheet(int rows, int columns, const Place& place, int degree = 3) {
  const auto u = KnotVector::clamped_uniform(degree, rows).value(),
             v = KnotVector::clamped_uniform(degree, columns).value();
  Points net(rows * columns, 3);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j)
      net.row(i * columns + j) = Point(place(i / (rows - 1.0), j / (columns - 1.0))).transpose();
  }
  return std::make_shared<const Surface>(*Surface::create({u, v}, net));
}

/// What polygons in fractions enclose, with the polygons as edges.
VisibleRegion region_of(const Surface& surface, std::vector<std::vector<Vector2d>> loops) {
  VisibleRegion region;
  for (auto& loop : loops) {
    // As finely as edges of files are followed, so that chords are beside the edge in space too.
    TrimEdge edge;
    constexpr int parts = 64;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vector2d &a = loop[k], &b = loop[(k + 1) % loop.size()];
      for (int part = 0; part < (loop.size() > 8 ? 1 : parts); ++part)
        edge.course.emplace_back(a + (b - a) * part / parts);
    }
    edge.course.push_back(loop.front());
    for (const Vector2d& at : edge.course)
      edge.points.push_back(*evaluate_point<2>(surface, parameters_of(surface, at)));
    region.edges.push_back(std::move(edge));
  }
  region.faces.push_back(std::move(loops));
  return region;
}

std::vector<Vector2d> circle(const Vector2d& centre, double radius, int corners) {
  std::vector<Vector2d> loop;
  for (int k = 0; k < corners; ++k)
    loop.emplace_back(
        centre + radius * Vector2d(std::cos(2 * pi * k / corners), std::sin(2 * pi * k / corners)));
  return loop;
}

/// Two wavy sheets across each other, one of which has a hole and one of which shows a disc, and a
/// whole plane of one span.
std::vector<FitSurface> model() {
  std::vector<FitSurface> result;
  const auto wavy = sheet(9, 7, [](double s, double t) {
    return Point(4 * s, 3 * t, 0.5 * std::sin(6 * s) * std::cos(5 * t));
  });
  result.push_back({wavy, region_of(*wavy, {{{0.1, 0.1}, {0.9, 0.15}, {0.8, 0.9}, {0.2, 0.8}},
                                            circle({0.5, 0.5}, 0.2, 300)})});
  const auto upright = sheet(6, 6, [](double s, double t) {
    return Point(2 + 0.3 * std::sin(5 * t), 3 * s, 3 * t - 1.5);
  });
  result.push_back({upright, region_of(*upright, {circle({0.5, 0.4}, 0.35, 400)})});
  const auto plane = sheet(
      2, 2, [](double s, double t) { return Point(5 * s - 0.5, 4 * t - 0.5, -2); }, 1);
  result.push_back({plane, {}});
  return result;
}

/// All visible points of a grid, as brute force.
std::vector<Point> samples_of(const std::vector<FitSurface>& surfaces, int parts) {
  std::vector<Point> result;
  for (const FitSurface& s : surfaces) {
    for (int i = 0; i <= parts; ++i) {
      for (int j = 0; j <= parts; ++j) {
        const Vector2d at(i / double(parts), j / double(parts));
        if (!s.region.contains(at)) continue;
        result.push_back(*evaluate_point<2>(*s.surface, parameters_of(*s.surface, at)));
      }
    }
  }
  return result;
}

double nearest_sample(const std::vector<Point>& samples, const Point& x) {
  double least = std::numeric_limits<double>::infinity();
  for (const Point& p : samples) least = std::min(least, (p - x).squaredNorm());
  return std::sqrt(least);
}

std::vector<Point> random_points(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Point> result;
  for (int k = 0; k < count; ++k)
    result.emplace_back(-0.5 + 5 * unit(random), -0.5 + 4 * unit(random), -2.2 + 4 * unit(random));
  return result;
}

TEST(VisibleSearch, NoVisibleSampleIsNearer) {
  const auto surfaces = model();
  const auto search = VisibleSearch::create(surfaces);
  ASSERT_TRUE(search) << search.error().message();
  // Samples are 5 / 300 apart at most in each direction; speeds are up to twice the mean.
  constexpr int parts = 300;
  const double spacing = 2 * 5.0 / parts;
  const auto samples = samples_of(surfaces, parts);
  for (const Point& x : random_points(1500, 3)) {
    const VisibleFoot foot = search->nearest(x, 100);
    ASSERT_GE(foot.surface, 0);
    const FitSurface& on = surfaces[static_cast<std::size_t>(foot.surface)];
    EXPECT_NEAR((*evaluate_point<2>(*on.surface, foot.parameters) - foot.point).norm(), 0, 1e-13);
    EXPECT_NEAR((foot.point - x).norm(), foot.distance, 1e-13);
    const double sampled = nearest_sample(samples, x);
    // Between its ends a chord of an edge is off the edge by about 1e-3 at most.
    EXPECT_LE(foot.distance, sampled + 2e-3) << x.transpose();
    // A sample lies beside every visible point, at an edge perhaps one step farther inside.
    EXPECT_LE(sampled, std::hypot(foot.distance, 2 * spacing) + 2 * spacing * 0.5);
  }
}

TEST(VisibleSearch, PartnersAreVisible) {
  const auto surfaces = model();
  const auto search = VisibleSearch::create(surfaces);
  ASSERT_TRUE(search);
  for (const Point& x : random_points(2000, 4)) {
    const VisibleFoot foot = search->nearest(x, 100);
    const FitSurface& on = surfaces[static_cast<std::size_t>(foot.surface)];
    Vector2d f(foot.parameters[0], foot.parameters[1]);  // domains are from 0 to 1
    // Inside, or on a chord of an edge up to rounding.
    double off = on.region.contains(f) ? 0 : 1;
    for (const TrimEdge& edge : on.region.edges) {
      for (std::size_t k = 0; k + 1 < edge.course.size() && off > 0; ++k) {
        const Vector2d a = edge.course[k], way = edge.course[k + 1] - a;
        const double t = std::clamp((f - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
        off = std::min(off, (f - a - t * way).norm());
      }
    }
    EXPECT_LE(off, 1e-12) << x.transpose();
  }
}

TEST(VisibleSearch, PointsOnTheFacesAreTheirOwnPartners) {
  const auto surfaces = model();
  const auto search = VisibleSearch::create(surfaces);
  ASSERT_TRUE(search);
  const auto samples = samples_of(surfaces, 40);
  for (const VisibleFoot& foot : search->nearest(samples, 1)) EXPECT_LE(foot.distance, 1e-9);
}

TEST(VisibleSearch, SurfacesThatAreNotShownDoNotCount) {
  const auto surfaces = model();
  const auto search = VisibleSearch::create(surfaces, {true, true, false});
  ASSERT_TRUE(search);
  for (const Point& x : random_points(200, 5)) EXPECT_NE(search->nearest(x, 100).surface, 2);
  EXPECT_EQ(search->nearest({0, 0, -2}, 0.1).surface, -1);
}

// A closed cylinder, half of which is visible across its seam.
TEST(VisibleSearch, ClosedSurfacesAcrossTheirSeam) {
  const double w = std::sqrt(0.5);
  const double x[] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, y[] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
  Points net(18, 3);
  std::vector<double> weights;
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 2; ++j) {
      net.row(2 * i + j) << x[i], y[i], 2.0 * j;
      weights.push_back(i % 2 == 1 ? w : 1);
    }
  }
  const auto round = KnotVector::create(2, {0, 0, 0, .25, .25, .5, .5, .75, .75, 1, 1, 1}).value();
  const auto surface = std::make_shared<const Surface>(
      *Surface::create({round, KnotVector::clamped_uniform(1, 2).value()}, net, weights));
  FitSurface cylinder{surface, {}};
  cylinder.region.closed = {true, false};
  for (const double turn : {0.0, 1.0}) {
    cylinder.region.faces.push_back(
        {{{turn - 0.25, 0}, {turn + 0.25, 0}, {turn + 0.25, 1}, {turn - 0.25, 1}}});
  }
  for (const double s : {-0.25, 0.25}) {
    TrimEdge edge;
    for (const double t : {0.0, 1.0}) {
      edge.course.emplace_back(s, t);
      edge.points.emplace_back(0, s < 0 ? -1 : 1, 2 * t);
    }
    cylinder.region.edges.push_back(edge);
  }
  const auto search = VisibleSearch::create(std::span(&cylinder, 1));
  ASSERT_TRUE(search);
  for (int k = 0; k < 200; ++k) {
    const double angle = 2 * pi * (k + 0.37) / 200;
    for (const double r : {0.4, 1.0, 3.0}) {
      const Point p(r * std::cos(angle), r * std::sin(angle), 0.7);
      // The visible half is x >= 0; from the other side the nearer of its edges is nearest.
      const double truth = p.x() >= 0 ? std::abs(r - 1) : std::hypot(p.x(), std::abs(p.y()) - 1);
      EXPECT_NEAR(search->nearest(p, 10).distance, truth, 1e-9) << angle << " " << r;
    }
  }
}

TEST(Correspondence, FarPointsAreLeftOutAndListed) {
  const auto surfaces = model();
  const auto search = VisibleSearch::create(surfaces);
  ASSERT_TRUE(search);
  std::vector<Point> points, displacements;
  for (int k = 0; k < 100; ++k) {
    points.emplace_back(0.04 * k, 1, k % 2 == 0 ? -2.25 : -2.0625);
    displacements.emplace_back(1, 2, 3);
  }
  const auto found = correspond(*search, surfaces, points, displacements, {.reach = 0.125});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->data.size(), 50U);
  EXPECT_EQ(found->left_out, 50U);
  ASSERT_EQ(found->listed.size(), Correspondences::most_listed);
  for (std::size_t k = 0; k < found->listed.size(); ++k) {
    EXPECT_EQ(found->listed[k].number, 2 * k);
    EXPECT_NEAR(found->listed[k].distance, 0.25, 1e-12);
  }
  EXPECT_NEAR(found->largest_distance, 0.0625, 1e-12);
  EXPECT_NEAR(found->rms_distance, 0.0625, 1e-12);
  EXPECT_EQ(found->data[3].displacement, Point(1, 2, 3));
  EXPECT_EQ(found->numbers[3], 7U);
  const auto normal =
      correspond(*search, surfaces, points, displacements, {.reach = 0.125, .along_normal = true});
  ASSERT_TRUE(normal);
  EXPECT_NEAR((normal->data[3].displacement - Point(0, 0, 3)).norm(), 0, 1e-12);
}

TEST(Correspondence, IsTheSameWithAnyNumberOfThreads) {
  const auto surfaces = model();
  const auto points = random_points(3000, 6);
  std::vector<VisibleFoot> first;
  for (const int threads : testing::thread_counts) {
    const auto feet = testing::with_threads(threads, [&] {
      const auto search = VisibleSearch::create(surfaces);
      return search ? search->nearest(points, 2) : std::vector<VisibleFoot>();
    });
    ASSERT_EQ(feet.size(), points.size());
    if (first.empty()) first = feet;
    for (std::size_t k = 0; k < feet.size(); ++k) {
      EXPECT_EQ(feet[k].surface, first[k].surface);
      EXPECT_EQ(feet[k].parameters, first[k].parameters);
      EXPECT_EQ(feet[k].distance, first[k].distance);
    }
  }
}

}  // namespace
}  // namespace knead
