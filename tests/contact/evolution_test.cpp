// Static balance and dynamics, on curves, surfaces and volumes.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "active.hpp"
#include "knead/spline/extremum.hpp"

namespace knead {
namespace {

using testing::active;
using testing::box;
using testing::ends;
using testing::rim;

/// Largest deflection of a unit plate under unit load, K of β = 1 alone on the raw equations.
double plate(int net, int rows) {
  const Surface s = box<2>(3, net);
  ActiveSettings<2> settings;
  settings.raw = true;
  settings.material = {{0, 0, 0}, {1, 1, 1}};
  settings.evolution = Evolution::stationary;
  settings.held = rim(s, rows);
  ActiveLoads load;
  load.force = Point(0, 0, 1);
  const auto step = active<2>(s, settings).step({s.control_points()}, {}, load);
  if (!step) ADD_FAILURE() << step.error().message();
  return largest_norm(*s.with_control_points(step->control_points - s.control_points())).value;
}

TEST(Stationary, PlatesBendAsTheirSeriesSay) {
  // Thin plate, w = q L⁴ / D · coefficient (Timoshenko and Woinowsky-Krieger, Theory of Plates and
  // Shells): simply supported by Navier's double series, clamped from the literature to nine
  // digits.
  double navier = 0;
  for (int m = 1; m < 400; m += 2) {
    for (int n = 1; n < 400; n += 2) {
      const double q = m * m + n * n;
      navier += ((m + n) / 2 % 2 == 1 ? 1.0 : -1.0) / (m * n * q * q);
    }
  }
  navier *= 16 / std::pow(std::numbers::pi, 6);
  constexpr double clamped = 0.001265319087;
  EXPECT_NEAR(plate(34, 1) / navier, 1, 1e-5);
  EXPECT_NEAR(plate(34, 2) / clamped, 1, 1e-5);
  EXPECT_NEAR(plate(66, 1) / navier, 1, 1e-6);
  EXPECT_NEAR(plate(66, 2) / clamped, 1, 1e-6);
}

TEST(Stationary, ConvergesWithTheFourthPowerOfTheSpans) {
  const double a = plate(11, 1), b = plate(19, 1), c = plate(35, 1);  // 8, 16, 32 spans
  EXPECT_NEAR(std::log2((b - a) / (c - b)), 4, 0.3);
}

TEST(Stationary, WithoutAHoldIsRefused) {
  const Surface s = box<2>(3, 8);
  ActiveSettings<2> settings;
  settings.evolution = Evolution::stationary;
  const auto free = ActiveSpline<2>::create(s, settings);
  ASSERT_FALSE(free);
  EXPECT_EQ(free.error().kind, ErrorKind::numerical);
  EXPECT_NE(free.error().remedy.find("hold an edge"), std::string::npos);
  settings.material = {{0, 0, 0},
                       {1, 1, 1}};  // bending alone: one held corner leaves it free to tilt
  settings.held = std::vector<bool>(64);
  settings.held[0] = true;
  EXPECT_EQ(ActiveSpline<2>::create(s, settings).error().kind, ErrorKind::numerical);
}

template <int D>
void swings() {
  const Spline<D> s = box<D>(3, D == 3 ? 5 : 9);
  ActiveSettings<D> settings;
  settings.evolution = Evolution::dynamic;
  settings.held = ends<D>(s, 1);
  settings.damping = 0;
  settings.time_step = 0.05;
  Points start = s.control_points() + 0.05 * testing::random_points(s.size(), 3);
  for (int i = 0; i < s.size(); ++i) {
    if (settings.held[static_cast<std::size_t>(i)]) start.row(i) = s.control_points().row(i);
  }
  for (double damping : {0.0, 0.7}) {
    settings.damping = damping;
    const ActiveSpline<D> model = active<D>(s, settings);
    ActiveState state{start};
    const double first = 0.5 * model.energy(state);
    double before = first;
    for (int k = 0; k < 200; ++k) {
      auto step = model.step(state, {});
      ASSERT_TRUE(step) << step.error().message();
      const double total = 0.5 * step->energy + step->kinetic;
      EXPECT_LE(total, before * (1 + 1e-13));
      before = total;
      state.control_points = std::move(step->control_points);
      state.velocity = std::move(step->velocity);
    }
    if (damping > 0) {
      EXPECT_LT(before, 0.01 * first);
    }
  }
}

TEST(Dynamic, NeverGainsEnergyAndComesToRestWithDamping) {
  swings<1>();
  swings<2>();
  swings<3>();
}

/// A string held at its ends, plucked into its lowest mode: X = sin(πu) cos(πt/√μ) z, α = 1. With
/// the mass as a constant, or as a field.
double string_error(double h, double mass = 1, bool field = false) {
  const Curve s = box<1>(5, 24);
  ActiveSettings<1> settings;
  settings.raw = true;
  settings.material = {{1}, {0}};
  settings.evolution = Evolution::dynamic;
  settings.held = ends<1>(s, 1);
  settings.damping = 0;
  settings.time_step = h;
  settings.mass = mass;
  if (field) {
    MaterialFieldOf<1> varying;
    varying.alpha = {1.0};
    varying.beta = {0.0};
    varying.mass = mass;
    varying.damping = 0.0;
    settings.fields = {varying};
    settings.mass = 77;  // the field counts
    settings.damping = 77;
  }
  const ActiveSpline<1> model = active<1>(s, settings);
  // The stationary shape under the load π² sin(πu) is sin(πu): it gives the control points of the
  // mode.
  ActiveSettings<1> still = settings;
  still.evolution = Evolution::stationary;
  ActiveLoads load;
  load.nodal = Points::Zero(s.size(), 3);
  const BasisQuadrature q = gauss_basis(s.knots(0), 12, 0);
  for (int k = 0; k < q.basis.size(); ++k) {
    const double f = std::numbers::pi * std::numbers::pi *
                     std::sin(std::numbers::pi * q.parameters[static_cast<std::size_t>(k)]);
    for (int r = 0; r <= 5; ++r) {
      load.nodal(q.basis.first[static_cast<std::size_t>(k)] + r, 2) +=
          q.weights[static_cast<std::size_t>(k)] * f * q.basis.row(k, 0)[r];
    }
  }
  const auto mode = active<1>(s, still).step({s.control_points()}, {}, load);
  ActiveState state{mode->control_points};
  const int steps = static_cast<int>(std::round(0.5 * std::sqrt(mass) / h));
  for (int k = 0; k < steps; ++k) {
    auto step = model.step(state, {});
    state.control_points = std::move(step->control_points);
    state.velocity = std::move(step->velocity);
  }
  return std::abs(
      evaluate_point<1>(*s.with_control_points(state.control_points), {0.5})->z());  // cos(π/2) = 0
}

TEST(Dynamic, IsOfSecondOrder) {
  const double a = string_error(0.1), b = string_error(0.05), c = string_error(0.025);
  EXPECT_NEAR(std::log2(a / b), 2, 0.1);
  EXPECT_NEAR(std::log2(b / c), 2, 0.05);
}

TEST(Dynamic, FourTimesTheMassSwingsHalfAsFast) {
  // In units of the period nothing changes, the error of a step included.
  const double expected = string_error(0.05);
  EXPECT_NEAR(string_error(0.1, 4), expected, 1e-9);
  EXPECT_NEAR(string_error(0.1, 4, true), expected, 1e-9);
}

TEST(Dynamic, AFreeSheetFallsAsMassDampingAndGravitySay) {
  // μ ẍ = μ g − γ ẋ: x = g/c (t − (1 − exp(−c t))/c), c = γ/μ, the same everywhere on the sheet.
  const Surface s = box<2>(3, 6);
  ActiveSettings<2> settings;
  settings.evolution = Evolution::dynamic;
  settings.raw = true;
  settings.time_step = 0.01;
  ActiveLoads loads;
  loads.gravity = Point(0, 0, -3);
  for (const double mass : {0.5, 2.0}) {
    for (const bool field : {false, true}) {
      settings.mass = mass;
      settings.damping = 0.8;
      settings.fields.clear();
      if (field) settings.fields.emplace_back(settings.material, mass, 0.8);
      const ActiveSpline<2> model = active<2>(s, settings);
      ActiveState state{s.control_points()};
      for (int k = 0; k < 100; ++k) {
        auto step = model.step(state, {}, loads);
        ASSERT_TRUE(step);
        state.control_points = std::move(step->control_points);
        state.velocity = std::move(step->velocity);
      }
      const double c = 0.8 / mass, expected = -3 / c * (1 - (1 - std::exp(-c)) / c);
      const Points way = state.control_points - s.control_points();
      EXPECT_NEAR(way.col(2).minCoeff(), expected, 2e-5);  // second order in the step
      EXPECT_NEAR(way.col(2).maxCoeff(), expected, 2e-5);
    }
  }
}

template <int D>
void sinks_and_settles() {
  const Spline<D> s = box<D>(2, D == 3 ? 6 : 10);
  ActiveSettings<D> settings;
  settings.held = ends<D>(s, 1);
  settings.detail = 0.2;
  const Tool ball = {"ball",
                     testing::sphere_at(Point(0.5, D > 1 ? 0.5 : 0.03, D > 2 ? 0.5 : 0.17), 0.2),
                     ToolMode::collision, 1e4, 1};
  const ActiveSpline<D> model = active<D>(s, settings);
  EXPECT_EQ(model.step({s.control_points()}, {})->control_points,
            s.control_points());  // at rest nothing moves
  ActiveState state{s.control_points()};
  ActiveStep last;
  for (int k = 0; k < 25; ++k) {
    auto step = model.step(state, {&ball, 1});
    ASSERT_TRUE(step);
    EXPECT_TRUE(step->converged);
    last = *step;
    state.control_points = step->control_points;
  }
  EXPECT_LT(last.residual, 1e-7);
  EXPECT_GT(last.energy, 1e-4);
  EXPECT_GT(last.gap, 0);
  for (int i = 0; i < s.size(); ++i) {
    if (settings.held[static_cast<std::size_t>(i)]) {
      EXPECT_EQ(last.control_points.row(i), s.control_points().row(i));
    }
  }
  // Rigid motion and scale are followed.
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.8, Point(1, -2, 0.5).normalized()).toRotationMatrix();
  const auto moved = [&](const Points& p) {
    return Points((7.0 * p * turn.transpose()).rowwise() + Eigen::RowVector3d(3, 4, -5));
  };
  settings.detail *= 7;
  Tool other = ball;
  other.shape =
      testing::sphere_at(7 * turn * ball.shape.placement().position + Point(3, 4, -5), 1.4);
  const ActiveSpline<D> turned =
      active<D>(*s.with_control_points(moved(s.control_points())), settings);
  ActiveState t{moved(s.control_points())};
  for (int k = 0; k < 25; ++k) t.control_points = turned.step(t, {&other, 1})->control_points;
  EXPECT_LT((t.control_points - moved(state.control_points)).cwiseAbs().maxCoeff(), 7e-8);
  // Taken away, the tool leaves nothing behind.
  for (int k = 0; k < 60; ++k) state.control_points = model.step(state, {})->control_points;
  EXPECT_LT((state.control_points - s.control_points()).cwiseAbs().maxCoeff(), 1e-9);
}

/// Random starts under random constraints: energy falls, constraints hold, held points stay, all
/// within rounding.
template <int D>
void sinks_under_constraints() {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const Spline<D> s = box<D>(D == 3 ? 2 : 3, D == 3 ? 5 : 9);
    const int n = s.size();
    ActiveSettings<D> settings;
    settings.lambda = 3;
    settings.held = std::vector<bool>(static_cast<std::size_t>(n), false);
    settings.held[seed] = true;
    const int a = static_cast<int>(7 * seed) % n, b = (a + 1) % n, c = (a + n / 2) % n;
    if (a == static_cast<int>(seed) || b == static_cast<int>(seed) || c == static_cast<int>(seed))
      continue;
    settings.constraints = {{"pair", {{a, 1}, {b, -1}}},
                            {"plane", {{c, 1}}, Point(0, 0, 0.01), Point(1, 2, -1)}};
    const ActiveSpline<D> model = active<D>(s, settings);
    ActiveState state{s.control_points() + 0.03 * testing::random_points(n, seed)};
    const Points start = state.control_points;
    state.control_points =
        model.step(state, {})->control_points;  // now the constraints are satisfied
    ActiveLoads none;
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 12; ++k) {
      const auto step = model.step(state, {}, none);
      ASSERT_TRUE(step);
      EXPECT_LE(step->energy, before * (1 + 1e-12));
      EXPECT_LT(step->violation, 1e-10);
      EXPECT_EQ(step->control_points.row(seed), start.row(seed));
      before = step->energy;
      state.control_points = step->control_points;
    }
  }
}

TEST(ActiveSpline, SinksUnderConstraintsInEveryDimension) {
  sinks_under_constraints<1>();
  sinks_under_constraints<2>();
  sinks_under_constraints<3>();
}

TEST(ActiveSpline, SettlesUnderAToolInEveryDimension) {
  sinks_and_settles<1>();
  sinks_and_settles<2>();
  sinks_and_settles<3>();
}

}  // namespace
}  // namespace knead
