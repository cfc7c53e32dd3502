// Surfaces that follow data, against maps of space that are known everywhere.

#include "morph/surface_fit.hpp"

#include <gtest/gtest.h>

#include "base/interruption.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "morph/fit_models.hpp"
#include "support/thread_counts.hpp"

namespace knead::morph::testing {
namespace {

using knead::testing::clamped_knots;
using knead::testing::with_threads;

/// Two sheets side by side in one plane, with equal nets or with nets that have nothing in common.
Model sheets(bool equal) {
  const auto cubic = *KnotVector::clamped_uniform(3, 6);
  const auto other = clamped_knots(4, {0, 0.3, 0.55, 1}, {5, 1, 2, 5});
  return model_of({wave(cubic, cubic, -1, 0),
                   equal ? wave(cubic, cubic, 0, 1)
                         : wave(clamped_knots(2, {0, 0.4, 1}, {3, 1, 3}), other, 0, 1)},
                  {edge_between(0, 1, true)});
}

/// An upright cylinder, a sphere and a patch with weights from 1 to 4, apart from each other.
Model closed_shapes() {
  const auto knots = *KnotVector::clamped_uniform(3, 6);
  const Surface flat = wave(knots, knots, -1, 1);
  Points points = flat.control_points();
  std::vector<double> weights;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      points(6 * i + j, 2) = 0.1 * (i - 2) * (j - 3);
      weights.push_back(1 + 3 * knots.greville(i) * (1 - knots.greville(j)));
    }
  }
  return model_of({knead::testing::cylinder(1.5), knead::testing::sphere(),
                   make_surface(knots, knots, points, weights)});
}

double largest_change(const Surface& a, const Surface& b) {
  return (a.control_points() - b.control_points()).cwiseAbs().maxCoeff();
}

TEST(SurfaceFit, ReproducesAffineMapsOnTheNetsAsTheyAre) {
  Eigen::Matrix3d linear;
  linear << 0.1, 0.02, -0.3, 0.05, -0.2, 0.01, 0.3, 0.1, 0.15;
  const Map map = [&](const Point& x) { return Point(linear * x + Point(3, -2, 1)); };
  for (const Model& model : {sheets(true), sheets(false), closed_shapes()}) {
    const FitResult result = fit(model, data_on(model, map, 6));
    for (std::size_t s = 0; s < model.surfaces.size(); ++s)
      EXPECT_EQ(result.surfaces[s].size(), model.surfaces[s].surface->size());
    // Moments of the data are sums of some hundred products of numbers below 4.
    EXPECT_LT(errors_of(model, result, map).largest, 1e-12 * model.size);
    EXPECT_TRUE(result.above.empty());
  }
}

TEST(SurfaceFit, GivesTheSameSurfacesForZeroData) {
  const Model model = closed_shapes();
  const FitResult result = fit(model, data_on(model, [](const Point&) { return Point(0, 0, 0); }));
  for (std::size_t s = 0; s < model.surfaces.size(); ++s) {
    EXPECT_EQ(result.surfaces[s].control_points(), model.surfaces[s].surface->control_points());
    EXPECT_EQ(result.surfaces[s].knots(), model.surfaces[s].surface->knots());
  }
}

TEST(SurfaceFit, IsLinearInTheDataOnTheSameNets) {
  const Model model = sheets(false);
  std::vector<Datum> data = data_on(model, bulge(0.05));
  const FitSettings settings{.refinement = 1, .rounds = 4};
  const FitResult once = fit(model, data, settings);
  for (Datum& datum : data) datum.displacement *= 2;
  const FitResult twice = fit(model, data, settings);
  for (std::size_t s = 0; s < 2; ++s) {
    for (int k = 0; k <= 50; ++k) {
      const Point x = at(*model.surfaces[s].surface, k / 50.0, 0.3);
      const Point a = at(once.surfaces[s], k / 50.0, 0.3) - x,
                  b = at(twice.surfaces[s], k / 50.0, 0.3) - x;
      EXPECT_LT((b - 2 * a).norm(), 1e-12 * model.size);
    }
  }
}

TEST(SurfaceFit, FollowsSmoothMapsBetweenTheDataAndKeepsEdgesTogether) {
  for (const bool equal : {true, false}) {
    const Model model = sheets(equal);
    for (const double amplitude : {0.02, 0.2}) {
      for (const Map& map : {bend(amplitude * model.size), twist(amplitude * model.size),
                             bulge(amplitude * model.size)}) {
        const FitResult result = fit(model, data_on(model, map));
        const double wanted = amplitude < 0.1 ? 1e-5 : 2e-5;
        EXPECT_LT(errors_of(model, result, map).largest, 2 * wanted * model.size);
        EXPECT_LT(errors_of(model, result, map).rms, wanted * model.size);
        const AtEdge edge = at_edge(result.surfaces[0], result.surfaces[1]);
        EXPECT_LT(edge.parting, 1.5e-6 * model.size);
        EXPECT_LT(edge.degrees, 0.03);
        EXPECT_TRUE(result.above.empty());
      }
    }
  }
}

TEST(SurfaceFit, KeepsClosedSurfacesClosedAndPolesPoints) {
  const Model model = closed_shapes();
  for (const double amplitude : {0.02, 0.2}) {
    const Map map = bulge(amplitude * model.size);
    const FitResult result = fit(model, data_on(model, map, 48));
    EXPECT_LT(errors_of(model, result, map).largest, 5e-5 * model.size);
    for (std::size_t s = 0; s < 2; ++s) {  // the cylinder, and the sphere
      const Surface& moved = result.surfaces[s];
      const auto [m, n] = moved.net();
      const Points& p = moved.control_points();
      const Points change = p.topRows(n) - p.bottomRows(n);
      EXPECT_LT(change.cwiseAbs().maxCoeff(), 1e-14) << m;
      for (int k = 0; k < 97; ++k) {
        const double t = (k + 0.37) / 97;
        const auto low = normal_at_foot(moved, {0, t}), high = normal_at_foot(moved, {1, t});
        ASSERT_TRUE(low && high);
        if (low->isZero() || t < 0.05 || t > 0.95) continue;
        EXPECT_LT(angle_between_planes(*low, *high) * 180 / std::numbers::pi, 0.05);
      }
    }
    // The tangent plane at the pole is one: normals at 3e-5 of a meridian turn by 0.005° at most.
    const auto beside = normal_at_foot(result.surfaces[1], {0.1, 3e-5});
    for (const double u : {0.3, 0.45, 0.6, 0.95}) {
      const auto other = normal_at_foot(result.surfaces[1], {u, 3e-5});
      ASSERT_TRUE(beside && other && !beside->isZero() && !other->isZero());
      EXPECT_LT(angle_between_planes(*beside, *other) * 180 / std::numbers::pi, 0.05);
    }
    const Surface& ball = result.surfaces[1];
    const int n = ball.net()[1];
    for (int i = 1; i < ball.net()[0]; ++i) {
      EXPECT_LT((ball.control_points().row(i * n) - ball.control_points().row(0)).norm(), 1e-14);
      EXPECT_LT(
          (ball.control_points().row(i * n + n - 1) - ball.control_points().row(n - 1)).norm(),
          1e-14);
    }
  }
}

TEST(SurfaceFit, SmoothsNoise) {
  Model model = sheets(false);
  constexpr double noise = 0.05;
  for (FitSurface& s : model.surfaces) {  // a metre long, in millimetres
    s.surface = std::make_shared<const Surface>(
        *s.surface->with_control_points(500 * s.surface->control_points()));
  }
  model.size *= 500;
  const Map map = [](const Point& x) { return Point(500 * bulge(0.02)(x / 500)); };
  const FitResult result = fit(model, data_on(model, map, 40, noise), {.noise = noise});
  EXPECT_LT(errors_of(model, result, map).rms, 0.3 * noise * std::sqrt(3.0));
  const AtEdge edge = at_edge(result.surfaces[0], result.surfaces[1]);
  EXPECT_LT(edge.parting, 2e-6 * model.size);
  EXPECT_LT(edge.degrees, 0.05);
}

TEST(SurfaceFit, GoesOnFromTheNetsOfAFitOfSimilarData) {
  const Model model = sheets(false);
  const Map map = bulge(0.2 * model.size);
  const FitResult first = fit(model, data_on(model, map));
  ASSERT_GT(first.refinements, 1);
  const FitResult second = fit(model, data_on(model, map), {.begin_with = first.surfaces});
  EXPECT_LT(second.refinements, first.refinements);
  EXPECT_GE(second.control_points, first.control_points);
  EXPECT_LT(errors_of(model, second, map).rms, 2e-5 * model.size);
  const auto fewer = fit_surfaces(model.surfaces, model.edges, data_on(model, map),
                                  {.begin_with = std::span(first.surfaces).first(1)});
  ASSERT_FALSE(fewer);
  EXPECT_NE(fewer.error().message().find("not one of each surface"), std::string::npos);
}

TEST(SurfaceFit, HoldsAtAFixedNeighbour) {
  Model model = sheets(true);
  model.surfaces[0].fixed = true;
  // The displacement and its slope vanish at the edge, x = 0.
  const Map map = [](const Point& x) {
    return Point(0, 0, x.x() > 0 ? 0.05 * x.x() * x.x() * std::cos(x.y()) : 0);
  };
  std::vector<Datum> data;
  for (const Datum& datum : data_on(model, map)) {
    if (datum.surface == 1) data.push_back(datum);
  }
  const FitResult result = fit(model, data);
  EXPECT_EQ(largest_change(result.surfaces[0], *model.surfaces[0].surface), 0);
  EXPECT_LT(errors_of(model, result, map).largest, 3e-5 * model.size);
  EXPECT_LT(at_edge(result.surfaces[0], result.surfaces[1]).parting, 1e-6 * model.size);
  EXPECT_TRUE(result.above.empty());
}

TEST(SurfaceFit, NamesDataThatContradictAFixedSurface) {
  Model model = sheets(true);
  model.surfaces[0].fixed = true;
  std::vector<Datum> data = data_on(
      model, [](const Point& x) { return Point(0, 0, x.x() > 0 ? 0.05 * x.x() * x.x() : 0); });
  data.push_back({0, {0.5, 0.25}, Point(0, 0, 0.125)});
  const FitResult result = fit(model, data);
  ASSERT_EQ(result.above.size(), 1U);
  EXPECT_EQ(result.above[0].measure, FitExcess::Measure::contradiction);
  EXPECT_EQ(result.above[0].surface, 0);
  EXPECT_EQ(result.above[0].found, 0.125);
  EXPECT_DOUBLE_EQ(result.above[0].wanted, 1e-5 * result.size);
  EXPECT_LT((result.above[0].place - Point(-0.5, -0.25, 0)).norm(), 1e-12);
}

TEST(SurfaceFit, NamesWhatNetsTooCoarseCannotReach) {
  const Model model = sheets(true);
  const Map ripple = [](const Point& x) { return Point(0, 0, 0.02 * std::sin(10 * x.x())); };
  const FitResult result = fit(model, data_on(model, ripple, 40), {.refinement = 1.5});
  ASSERT_FALSE(result.above.empty());
  const FitExcess& worst = result.above[0];
  EXPECT_EQ(worst.measure, FitExcess::Measure::residual);
  EXPECT_GT(worst.found, worst.wanted);
  EXPECT_DOUBLE_EQ(worst.wanted, 1e-5 * result.size);
  const auto place = evaluate_point<2>(
      *model.surfaces[static_cast<std::size_t>(worst.surface)].surface, worst.parameters);
  EXPECT_LT((*place - worst.place).norm(), 1e-12);
  EXPECT_LE(result.control_points, 1.5 * 72);
  EXPECT_TRUE(fit(model, data_on(model, ripple, 40), {.refinement = 40}).above.empty());
}

TEST(SurfaceFit, DoesNotLetControlPointsFlyOfWhichAlmostNothingIsVisible) {
  const auto knots = *KnotVector::clamped_uniform(3, 13);
  for (const double until : {0.701, 0.5}) {
    Model model = model_of({wave(knots, knots, -1, 1)});
    const Map map = bulge(0.05);
    const FitResult result = fit(model, data_on(model, map, 40, 0, until));
    EXPECT_LT(errors_of(model, result, map, until).largest, 3e-5 * model.size);
    double largest = 0;
    for (int i = 0; i <= 100; ++i) {
      for (int j = 0; j <= 100; ++j)
        largest = std::max(largest,
                           map(at(*model.surfaces[0].surface, until * i / 100, j / 100.0)).norm());
    }
    const Surface& moved = result.surfaces[0];
    Surface before = *model.surfaces[0].surface;
    for (int d = 0; d < 2; ++d) {
      const auto finer = Refinement::create(before.knots(d), moved.knots(d));
      ASSERT_TRUE(finer);
      before = *refined<2>(before, d, *finer);
    }
    EXPECT_LT((moved.control_points() - before.control_points()).rowwise().norm().maxCoeff(),
              1.5 * largest)
        << until;
  }
}

TEST(SurfaceFit, DoesNotDependOnTheNumberOfThreads) {
  const Model model = sheets(false);
  const std::vector<Datum> data = data_on(model, twist(0.1), 60);
  const FitResult one = with_threads(1, [&] { return fit(model, data); });
  for (const int threads : knead::testing::thread_counts) {
    const FitResult more = with_threads(threads, [&] { return fit(model, data); });
    for (std::size_t s = 0; s < 2; ++s)
      EXPECT_EQ(more.surfaces[s].control_points(), one.surfaces[s].control_points());
  }
}

TEST(SurfaceFit, TakesOneDatumForATranslation) {
  const Model model = sheets(true);
  const Datum datum{1, {0.3, 0.4}, Point(1, -2, 0.5)};
  const FitResult result = fit(model, std::span(&datum, 1));
  for (std::size_t s = 0; s < 2; ++s) {
    const Points moved =
        model.surfaces[s].surface->control_points().rowwise() + datum.displacement.transpose();
    EXPECT_LT((result.surfaces[s].control_points() - moved).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(SurfaceFit, EndsWhenItIsInterrupted) {
  const Model model = sheets(true);
  const std::vector<Datum> data = data_on(model, bend(0.1));
  Interruption interruption([] { return false; });
  const auto result = fit_surfaces(model.surfaces, model.edges, data);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message(), interrupted_error().error().message());
}

TEST(SurfaceFit, RefusesWhatIsNoInput) {
  const Model model = sheets(true);
  const std::vector<Datum> data = data_on(model, bend(0.1), 4);
  const auto message = [&](std::vector<Datum> changed, FitSettings settings = {}) {
    const auto result = fit_surfaces(model.surfaces, model.edges, changed, settings);
    return result ? std::string("accepted") : result.error().message();
  };
  std::vector<Datum> bad = data;
  bad[3].displacement.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(message(bad).starts_with("datum 3: its displacement")) << message(bad);
  bad = data;
  bad[5].parameters[1] = 1.5;
  EXPECT_TRUE(message(bad).starts_with("datum 5")) << message(bad);
  bad = data;
  bad[1].surface = 2;
  EXPECT_TRUE(message(bad).starts_with("datum 1: it names a surface")) << message(bad);
  EXPECT_TRUE(message({}).starts_with("data: no datum")) << message({});
  EXPECT_TRUE(message(data, {.tolerance = 0.0}).starts_with("settings: "))
      << message(data, {.tolerance = 0.0});
}

}  // namespace
}  // namespace knead::morph::testing
