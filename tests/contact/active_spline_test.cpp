#include "knead/contact/active_spline.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "contact/active.hpp"
#include "knead/spline/extremum.hpp"
#include "support/surfaces.hpp"
#include "support/tools.hpp"

namespace knead {
namespace {

using testing::rim;

ActiveSurface active(const Surface& s, const ActiveSettings<2>& settings) {
  auto made = ActiveSurface::create(s, settings);
  if (!made) ADD_FAILURE() << made.error().message();
  return std::move(*made);
}

Points run(const ActiveSurface& model, Points x, const std::vector<Tool>& tools, int steps) {
  for (int k = 0; k < steps; ++k) {
    auto step = model.step(x, tools);
    if (!step) {
      ADD_FAILURE() << step.error().message();
      break;
    }
    EXPECT_TRUE(step->converged);
    x = std::move(step->control_points);
  }
  return x;
}

/// A scene in which both modes are in contact: a relief, its rim held, a ball pressed in and a ball
/// that attracts.
struct Scene {
  Surface surface;
  ActiveSettings<2> settings;
  std::vector<Tool> tools;

  explicit Scene(Surface s) : surface(std::move(s)) {
    settings.held = rim(surface, 1);
    settings.detail = 0.1;
    settings.lambda = 5;
    tools = {
        {"press", testing::sphere_at(Point(0.55, 0.4, 0.27), 0.3), ToolMode::collision, 500, 1},
        {"draw", testing::sphere_at(Point(1.0, 0.6, -0.35), 0.2), ToolMode::proximity, 200, 0.3}};
  }
  [[nodiscard]] Points sculpted(int steps = 8) const {
    return run(active(surface, settings), surface.control_points(), tools, steps);
  }
};

std::vector<Surface> scene_surfaces() {
  return {
      testing::relief(testing::uniform_clamped(3, 6), testing::uniform_clamped(3, 5), 1, 0.04),
      testing::relief(testing::uniform_clamped(2, 6),
                      testing::clamped_knots(3, {0, 1, 1.5, 4, 5}, {4, 1, 3, 1, 4}), 2, 0.04),
      testing::relief(testing::uniform_clamped(3, 5), testing::uniform_clamped(2, 6), 3, 0.04, 2)};
}

double relative_difference(const Points& a, const Points& b, const Surface& s) {
  return (a - b).cwiseAbs().maxCoeff() / bounding_box(s).diagonal();
}

TEST(ActiveSurface, AtRestNothingMovesToTheLastBit) {
  for (const Surface& s : scene_surfaces()) {
    const ActiveSurface model = active(s, {});
    EXPECT_EQ(run(model, s.control_points(), {}, 5), s.control_points());
    EXPECT_EQ(model.energy(s.control_points()), 0);
  }
}

TEST(ActiveSurface, FixedControlPointsKeepTheirBits) {
  for (const Surface& s : scene_surfaces()) {
    const Scene scene(s);
    const Points after = scene.sculpted();
    int moved = 0;
    for (int i = 0; i < s.size(); ++i) {
      if (scene.settings.held[static_cast<std::size_t>(i)]) {
        EXPECT_EQ(after.row(i), s.control_points().row(i));
      } else {
        moved += after.row(i) != s.control_points().row(i);
      }
    }
    EXPECT_GT(moved, 5);
  }
}

TEST(ActiveSurface, WithoutForcesIsExactlyTheImplicitEulerStep) {
  const Surface s =
      testing::relief(testing::uniform_clamped(3, 5), testing::uniform_clamped(3, 4), 4);
  for (RestMode rest : {RestMode::shape, RestMode::none}) {
    for (StepWeight weight : {StepWeight::mass, StepWeight::identity}) {
      ActiveSettings<2> settings;
      settings.rest = rest;
      settings.weight = weight;
      settings.lambda = 3;
      const ActiveSurface model = active(s, settings);
      Points x = s.control_points() + 0.1 * testing::random_points(s.size(), 5);
      double energy = model.energy(x);
      for (int k = 0; k < 10; ++k) {
        auto step = model.step(x, {});
        ASSERT_TRUE(step);
        EXPECT_LE(step->iterations, 2);
        EXPECT_LE(step->energy, energy * (1 + 1e-12));
        energy = step->energy;
        x = step->control_points;
      }
    }
  }
}

TEST(ActiveSurface, SettlesWhereInternalAndToolForcesBalance) {
  for (const Surface& s : scene_surfaces()) {
    const Scene scene(s);
    const ActiveSurface model = active(s, scene.settings);
    const Points x = run(model, s.control_points(), scene.tools, 60);
    const auto last = model.step(x, scene.tools);
    EXPECT_LT(last->residual, 1e-8);
    EXPECT_LT(relative_difference(last->control_points, x, s), 1e-8);
  }
}

TEST(ActiveSurface, IsStableAndTightAtAnyStiffness) {
  const Surface s = testing::uniform_sheet(3, 20, 20);
  double before = 1;
  for (double k : {1e0, 1e2, 1e4, 1e6, 1e8, max_tool_stiffness}) {
    ActiveSettings<2> settings;
    settings.held = rim(s, 2);
    settings.detail = 0.2;
    const std::vector<Tool> tools = {
        {"ball", testing::sphere_at(Point(0.5, 0.47, 0.15), 0.2), ToolMode::collision, k, 1}};
    const Points x = run(active(s, settings), s.control_points(), tools, 6);
    const double depth = -x.col(2).minCoeff();
    EXPECT_LT(depth, 0.06);
    // Deepest entry of any surface point into the ball: it shrinks as the stiffness grows.
    const std::vector<double> samples = testing::breaks_of(std::vector<double>(100, 0.01));
    std::vector<double> inside(samples.begin(), samples.end() - 1);
    const auto grid =
        evaluate_grid<2>(*s.with_control_points(x),
                         {std::span<const double>(inside), std::span<const double>(inside)});
    double entry = 0;
    for (Eigen::Index i = 0; i < grid->points().rows(); ++i) {
      entry = std::max(
          entry,
          0.2 - (grid->points().row(i).transpose() - tools[0].shape.placement().position).norm());
    }
    EXPECT_LT(entry, before);
    before = entry + 1e-4;
    if (k >= 1e6) {
      EXPECT_LT(entry, 2e-3);
    }
  }
}

TEST(ActiveSurface, ReleasesWithoutSticking) {
  const Surface s = testing::uniform_sheet(3, 14, 14);
  ActiveSettings<2> settings;
  settings.held = rim(s, 2);
  settings.detail = 0.2;
  const ActiveSurface model = active(s, settings);
  std::vector<Tool> tools = {
      {"ball", testing::sphere_at(Point(0.5, 0.5, 0.15), 0.2), ToolMode::collision, 1e5, 1}};
  Points x = run(model, s.control_points(), tools, 5);
  EXPECT_LT(x.col(2).minCoeff(), -0.03);
  testing::move_to(tools[0], Point(0.5, 0.5, 5));
  x = run(model, x, tools, 30);
  EXPECT_LT(relative_difference(x, s.control_points(), s), 1e-12);
}

TEST(ActiveSurface, ProximityDrawsTheSurfaceToTheTool) {
  const Surface s = testing::uniform_sheet(3, 16, 16);
  ActiveSettings<2> settings;
  settings.held = rim(s, 2);
  settings.detail = 0.1;
  const std::vector<Tool> tools = {
      {"magnet", testing::sphere_at(Point(0.5, 0.5, 0.25), 0.2), ToolMode::proximity, 100, 0.1}};
  const Points x = run(active(s, settings), s.control_points(), tools, 10);
  const double top = largest_norm(*s.with_control_points(x - s.control_points())).value;
  EXPECT_GT(top, 0.001);
  EXPECT_LT(top, 0.0501);
}

TEST(ActiveSurface, FollowsRigidMotionAndChangeOfUnits) {
  for (const Surface& s : scene_surfaces()) {
    const Scene scene(s);
    const Points expected = scene.sculpted();
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(1.1, Point(3, -1, 2).normalized()).toRotationMatrix();
    const Eigen::RowVector3d shift(0.3, -7, 2);
    for (double scale : {1.0, 1 / 25.4, 1000.0}) {
      const auto map = [&](const Points& p) {
        return Points((scale * p * turn.transpose()).rowwise() + shift);
      };
      Scene moved(*s.with_control_points(map(s.control_points())));
      moved.settings = scene.settings;
      moved.settings.detail *= scale;
      moved.tools = scene.tools;
      for (Tool& tool : moved.tools) {
        const Placement& at = tool.shape.placement();
        tool.shape = *PlacedShape::create(tool.shape.shape(),
                                          {Eigen::Quaterniond(turn),
                                           scale * turn * at.position + shift.transpose(),
                                           {scale, scale, scale}});
        tool.range *= scale;
      }
      EXPECT_LT(relative_difference(moved.sculpted(), map(expected), moved.surface), 1e-9);
    }
  }
}

KnotVector mapped(const KnotVector& k, double scale, double shift) {
  std::vector<double> knots(k.knots().begin(), k.knots().end());
  for (double& x : knots) x = scale * x + shift;
  if (scale < 0) std::reverse(knots.begin(), knots.end());
  return *KnotVector::create(k.degree(), knots);
}

TEST(ActiveSurface, DoesNotFeelAffineMapsOfTheKnots) {
  for (const Surface& s : scene_surfaces()) {
    const Scene scene(s);
    Scene other(testing::make_surface(mapped(s.knots(0), 37.3, -5), mapped(s.knots(1), 0.011, 2),
                                      s.control_points(),
                                      {s.weights().begin(), s.weights().end()}));
    EXPECT_LT(relative_difference(other.sculpted(), scene.sculpted(), s), 1e-9);
  }
}

TEST(ActiveSurface, DoesNotFeelReversalOrExchangeOfTheDirections) {
  for (const Surface& s : scene_surfaces()) {
    const auto [m, n] = s.net();
    const Points expected = Scene(s).sculpted();
    // permutation[k] = row of the original net that stands at row k of the new one
    std::vector<int> reversed, exchanged;
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j < n; ++j) reversed.push_back((m - 1 - i) * n + j);
    }
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < m; ++i) exchanged.push_back(i * n + j);
    }
    const auto permuted = [&](const std::vector<int>& permutation, KnotVector u, KnotVector v) {
      Points points(s.size(), 3);
      std::vector<double> weights;
      for (int k = 0; k < s.size(); ++k) {
        points.row(k) = s.control_points().row(permutation[static_cast<std::size_t>(k)]);
        if (s.rational())
          weights.push_back(
              s.weights()[static_cast<std::size_t>(permutation[static_cast<std::size_t>(k)])]);
      }
      const Points sculpted =
          Scene(testing::make_surface(std::move(u), std::move(v), points, weights)).sculpted();
      Points back(s.size(), 3);
      for (int k = 0; k < s.size(); ++k)
        back.row(permutation[static_cast<std::size_t>(k)]) = sculpted.row(k);
      return back;
    };
    EXPECT_LT(
        relative_difference(permuted(reversed, mapped(s.knots(0), -1, 0), s.knots(1)), expected, s),
        1e-9);
    EXPECT_LT(relative_difference(permuted(exchanged, s.knots(1), s.knots(0)), expected, s), 1e-9);
  }
}

/// Largest displacement after ten steps on a sheet of the given net.
double dent(int net, StepWeight weight, double lambda) {
  const Surface s = testing::uniform_sheet(3, net, net);
  ActiveSettings<2> settings;
  settings.detail = 0.3;
  settings.weight = weight;
  settings.lambda = lambda;
  settings.rest = RestMode::shape;
  const std::vector<Tool> tools = {
      {"ball", testing::sphere_at(Point(0.5, 0.5, 0.25), 0.3), ToolMode::collision, 10, 1}};
  const Points x = run(active(s, settings), s.control_points(), tools, 10);
  return largest_norm(*s.with_control_points(x - s.control_points())).value;
}

TEST(ActiveSurface, FeelsTheSameOnEveryNetWithTheMassMatrixAndNotWithTheIdentity) {
  const double mass16 = dent(16, StepWeight::mass, 30), mass32 = dent(32, StepWeight::mass, 30);
  EXPECT_NEAR(mass32 / mass16, 1, 0.01);
  const double identity16 = dent(16, StepWeight::identity, 0.1),
               identity32 = dent(32, StepWeight::identity, 0.1);
  EXPECT_LT(identity32 / identity16, 0.9);
}

TEST(ActiveSurface, RefusesWhatCannotBeComputed) {
  const Surface s = testing::uniform_sheet(3, 6, 6);
  ActiveSettings<2> settings;
  settings.material.beta[0] = -1;
  EXPECT_EQ(ActiveSurface::create(s, settings).error().where, "beta11");
  settings = {};
  settings.lambda = -1;
  EXPECT_EQ(ActiveSurface::create(s, settings).error().where, "lambda");
  settings = {};
  settings.lambda = 0;  // nothing is held: K alone is singular
  EXPECT_EQ(ActiveSurface::create(s, settings).error().kind, ErrorKind::numerical);
}

}  // namespace
}  // namespace knead
