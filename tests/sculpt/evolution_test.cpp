// Static balance, dynamics, loads, friction, rigid tools and limits, on curves, surfaces and volumes.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "knead/sculpt/active_spline.hpp"
#include "knead/spline/extremum.hpp"
#include "support/surfaces.hpp"
#include "support/tools.hpp"

namespace knead {
namespace {

std::vector<bool> rim(const Surface& s, int rows) {
  const auto [m, n] = s.net();
  std::vector<bool> fixed;
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) fixed.push_back(i < rows || j < rows || i >= m - rows || j >= n - rows);
  }
  return fixed;
}

template <int D>
Spline<D> box(int degree, int net) {
  std::vector<KnotVector> knots(D, *KnotVector::clamped_uniform(degree, net));
  int size = 1;
  for (int d = 0; d < D; ++d) size *= net;
  Points points = Points::Zero(size, 3);
  for (int i = 0; i < size; ++i) {
    for (int d = D, rest = i; d-- > 0; rest /= net) points(i, d) = knots[0].greville(rest % net);
  }
  if constexpr (D == 1) return *Curve::create({knots[0]}, points);
  if constexpr (D == 2) return *Surface::create({knots[0], knots[1]}, points);
  if constexpr (D == 3) return *Volume::create({knots[0], knots[1], knots[2]}, points);
}

/// Both ends of the first direction.
template <int D>
std::vector<bool> ends(const Spline<D>& s, int rows) {
  std::vector<bool> fixed(static_cast<std::size_t>(s.size()));
  const int slab = s.size() / s.net()[0];
  for (int i = 0; i < s.size(); ++i) {
    const int row = i / slab;
    fixed[static_cast<std::size_t>(i)] = row < rows || row >= s.net()[0] - rows;
  }
  return fixed;
}

template <int D>
ActiveSpline<D> active(const Spline<D>& s, const ActiveSettings<D>& settings) {
  auto made = ActiveSpline<D>::create(s, settings);
  if (!made) ADD_FAILURE() << made.error().message();
  return std::move(*made);
}

/// Largest deflection of a unit plate under unit load, K of β = 1 alone on the raw equations.
double plate(int net, int rows) {
  const Surface s = box<2>(3, net);
  ActiveSettings<2> settings;
  settings.raw = true;
  settings.material = {{0, 0, 0}, {1, 1, 1}};
  settings.evolution = Evolution::stationary;
  settings.fixed = rim(s, rows);
  ActiveLoads load;
  load.force = Point(0, 0, 1);
  const auto step = active<2>(s, settings).step({s.control_points()}, {}, load);
  if (!step) ADD_FAILURE() << step.error().message();
  return largest_norm(*s.with_control_points(step->control_points - s.control_points())).value;
}

TEST(Stationary, PlatesBendAsTheirSeriesSay) {
  // Thin plate, w = q L⁴ / D · coefficient (Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells): simply
  // supported by Navier's double series, clamped from the literature to nine digits.
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
  settings.material = {{0, 0, 0}, {1, 1, 1}};  // bending alone: one held corner leaves it free to tilt
  settings.fixed = std::vector<bool>(64);
  settings.fixed[0] = true;
  EXPECT_EQ(ActiveSpline<2>::create(s, settings).error().kind, ErrorKind::numerical);
}

template <int D>
void swings() {
  const Spline<D> s = box<D>(3, D == 3 ? 5 : 9);
  ActiveSettings<D> settings;
  settings.evolution = Evolution::dynamic;
  settings.fixed = ends<D>(s, 1);
  settings.damping = 0;
  settings.time_step = 0.05;
  Points start = s.control_points() + 0.05 * testing::random_points(s.size(), 3);
  for (int i = 0; i < s.size(); ++i) {
    if (settings.fixed[static_cast<std::size_t>(i)]) start.row(i) = s.control_points().row(i);
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

/// A string fixed at its ends, plucked into its lowest mode: X = sin(πu) cos(πt/√μ) z, α = 1. With the mass as a
/// constant, or as a field.
double string_error(double h, double mass = 1, bool field = false) {
  const Curve s = box<1>(5, 24);
  ActiveSettings<1> settings;
  settings.raw = true;
  settings.material = {{1}, {0}};
  settings.evolution = Evolution::dynamic;
  settings.fixed = ends<1>(s, 1);
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
  // The stationary shape under the load π² sin(πu) is sin(πu): it gives the control points of the mode.
  ActiveSettings<1> still = settings;
  still.evolution = Evolution::stationary;
  ActiveLoads load;
  load.nodal = Points::Zero(s.size(), 3);
  const BasisQuadrature q = gauss_basis(s.knots(0), 12, 0);
  for (int k = 0; k < q.basis.size(); ++k) {
    const double f =
        std::numbers::pi * std::numbers::pi * std::sin(std::numbers::pi * q.parameters[static_cast<std::size_t>(k)]);
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
  return std::abs(evaluate_point<1>(*s.with_control_points(state.control_points), {0.5})->z());  // cos(π/2) = 0
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

template <int D>
void sinks_and_settles() {
  const Spline<D> s = box<D>(2, D == 3 ? 6 : 10);
  ActiveSettings<D> settings;
  settings.fixed = ends<D>(s, 1);
  settings.detail = 0.2;
  const Tool ball = {"ball", testing::sphere_at(Point(0.5, D > 1 ? 0.5 : 0.03, D > 2 ? 0.5 : 0.17), 0.2),
                     ToolMode::collision, 1e4, 1};
  const ActiveSpline<D> model = active<D>(s, settings);
  EXPECT_EQ(model.step({s.control_points()}, {})->control_points, s.control_points());  // at rest nothing moves
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
    if (settings.fixed[static_cast<std::size_t>(i)]) {
      EXPECT_EQ(last.control_points.row(i), s.control_points().row(i));
    }
  }
  // Rigid motion and scale are followed.
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.8, Point(1, -2, 0.5).normalized()).toRotationMatrix();
  const auto moved = [&](const Points& p) {
    return Points((7.0 * p * turn.transpose()).rowwise() + Eigen::RowVector3d(3, 4, -5));
  };
  settings.detail *= 7;
  Tool other = ball;
  other.shape = testing::sphere_at(7 * turn * ball.shape.placement().position + Point(3, 4, -5), 1.4);
  const ActiveSpline<D> turned = active<D>(*s.with_control_points(moved(s.control_points())), settings);
  ActiveState t{moved(s.control_points())};
  for (int k = 0; k < 25; ++k) t.control_points = turned.step(t, {&other, 1})->control_points;
  EXPECT_LT((t.control_points - moved(state.control_points)).cwiseAbs().maxCoeff(), 7e-8);
  // Taken away, the tool leaves nothing behind.
  for (int k = 0; k < 60; ++k) state.control_points = model.step(state, {})->control_points;
  EXPECT_LT((state.control_points - s.control_points()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(ActiveSpline, SettlesUnderAToolInEveryDimension) {
  sinks_and_settles<1>();
  sinks_and_settles<2>();
  sinks_and_settles<3>();
}

TEST(RigidTool, IsEnteredByLessThanAFractionOfItsSize) {
  const Surface s = box<2>(3, 20);
  ActiveSettings<2> settings;
  settings.fixed = rim(s, 2);
  settings.detail = 0.2;
  Tool ball = {"ball", testing::sphere_at(Point(0.5, 0.47, 0.15), 0.2), ToolMode::collision, 100, 1};
  ball.rigid = true;
  const auto step = active<2>(s, settings).step({s.control_points()}, {&ball, 1});
  ASSERT_TRUE(step);
  EXPECT_TRUE(step->converged) << step->note;
  EXPECT_LE(step->gap, rigid_gap);
  EXPECT_GT(step->gap, 0);
  EXPECT_EQ(step->gap_tool, "ball");
}

TEST(RigidTool, SaysWhyWhatIsHeldInsideItStaysThere) {
  const Surface s = box<2>(3, 10);
  ActiveSettings<2> settings;
  settings.fixed = rim(s, 2);
  settings.detail = 0.2;
  Tool ball = {"ball", testing::sphere_at(Point(0.5, 0, 0.1), 0.2), ToolMode::collision, 1e4, 1};
  ball.rigid = true;
  const auto step = active<2>(s, settings).step({s.control_points()}, {&ball, 1});
  ASSERT_TRUE(step);
  EXPECT_FALSE(step->converged);
  EXPECT_NE(step->note.find("ball"), std::string::npos);
}

TEST(Limit, HoldsToAMillionth) {
  const Surface s = box<2>(3, 16);
  ActiveSettings<2> settings;
  settings.fixed = rim(s, 1);
  settings.detail = 0.2;
  const Tool ball = {"ball", testing::sphere_at(Point(0.5, 0.47, 0.1), 0.2), ToolMode::collision, 1e4, 1};
  const ActiveSpline<2> model = active<2>(s, settings);
  ActiveState state{s.control_points()};
  ActiveLoads loads;
  for (double limit : {1.0, 0.03, 0.01}) {
    loads.limit = limit;
    auto step = model.step(state, {&ball, 1}, loads);
    ASSERT_TRUE(step);
    const double way = largest_norm(*s.with_control_points(step->control_points - s.control_points())).value;
    if (limit == 1.0) {
      EXPECT_GT(way, 0.05);
      EXPECT_FALSE(step->limited);
    } else {
      EXPECT_LE(way, limit * (1 + 1e-6));
      EXPECT_GT(way, limit * (1 - 1e-4));
      EXPECT_TRUE(step->limited);
    }
  }
}

TEST(Loads, PressureOnAFlatSheetIsALoadAlongItsNormal) {
  const Surface s = box<2>(3, 9);
  ActiveSettings<2> settings;
  settings.evolution = Evolution::stationary;
  settings.fixed = rim(s, 1);
  const ActiveSpline<2> model = active<2>(s, settings);
  ActiveLoads pressure, force;
  pressure.pressure = 0.01;
  force.force = Point(0, 0, 0.01);
  const Points a = model.step({s.control_points()}, {}, pressure)->control_points;
  const Points b = model.step({s.control_points()}, {}, force)->control_points;
  EXPECT_GT((b - s.control_points()).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(Friction, AHeavySheetOnASlantStaysOrSlides) {
  // A sheet lying on a ball so large that it is a slant of slope 0.5.
  const Surface s = box<2>(2, 4);
  const double radius = 1e4;
  const Point up = Point(-0.5, 0, 1).normalized();
  ActiveSettings<2> settings;
  settings.evolution = Evolution::dynamic;
  settings.time_step = 0.06;
  settings.damping = 0;
  settings.detail = 10;
  ActiveLoads loads;
  loads.gravity = Point(0, 0, -1);
  Points start = s.control_points();
  for (int i = 0; i < start.rows(); ++i) start(i, 2) = 0.5 * start(i, 0);  // in the slant
  const auto way = [&](double friction) {
    Tool ground = {"ground", testing::sphere_at(Point(0.5, 0.5, 0.25) - radius * up, radius), ToolMode::collision, 1e4,
                   1};
    ground.friction = friction;
    const Surface tilted = *s.with_control_points(start);
    const ActiveSpline<2> model = active<2>(tilted, settings);
    ActiveState state{start};
    for (int k = 0; k < 20; ++k) {
      auto step = model.step(state, {&ground, 1}, loads);
      if (!step) {
        ADD_FAILURE() << step.error().message();
        break;
      }
      state.control_points = step->control_points;
      state.velocity = step->velocity;
    }
    return (state.control_points - start).rowwise().norm().maxCoeff();
  };
  const double slides = way(0.1), stays = way(1.0), without = way(0);
  EXPECT_LT(stays, 0.02);  // the ground is a spring that gives a little, and the ball is round
  EXPECT_GT(slides, 0.2);
  EXPECT_GT(without, slides);
  // Without friction: g sin(slope) t²/2, with 0.1: (sin − 0.1 cos) g t²/2.
  // Gravity is in units of the model: its length is the root of its area.
  const double length = std::pow(1.25, 0.25), t = 20 * 0.06, sine = 0.5 / std::sqrt(1.25), cosine = 1 / std::sqrt(1.25);
  EXPECT_NEAR(without, 0.5 * sine * t * t * length, 0.01 * without);
  EXPECT_NEAR(slides, 0.5 * (sine - 0.1 * cosine) * t * t * length, 0.03 * slides);
}

TEST(Step, ThatRunsAwayIsRefused) {
  const Surface s = box<2>(3, 8);
  ActiveSettings<2> settings;
  settings.lambda = 1e-9;
  const ActiveSpline<2> model = active<2>(s, settings);
  ActiveLoads load;
  load.force = Point(0, 0, 1);
  const auto refused = model.step({s.control_points()}, {}, load);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::numerical);
  EXPECT_NE(refused.error().remedy.find("lambda"), std::string::npos);
}

TEST(SeveralPatches, CoupledMoveTogetherAndUncoupledTear) {
  const Surface s = box<2>(3, 8);
  Points right = s.control_points();
  right.col(0).array() += 1;
  const Surface t = *s.with_control_points(right);
  ActiveSettings<2> settings;
  settings.detail = 0.2;
  const Tool ball = {"ball", testing::sphere_at(Point(0.9, 0.5, 0.15), 0.2), ToolMode::collision, 1e4, 1};
  const auto gap = [&](bool coupled) {
    settings.constraints.clear();
    for (int j = 0; coupled && j < 8; ++j) settings.constraints.push_back({"seam", {{56 + j, 1}, {64 + j, -1}}});
    const auto model = ActiveSpline<2>::create({s, t}, settings);
    EXPECT_TRUE(model) << model.error().message();
    ActiveState state{Points(128, 3)};
    state.control_points << s.control_points(), right;
    for (int k = 0; k < 10; ++k) {
      auto step = model->step(state, {&ball, 1});
      if (!step) {
        ADD_FAILURE() << step.error().message();
        return 0.0;
      }
      state.control_points = step->control_points;
    }
    return (state.control_points.middleRows(56, 8) - state.control_points.middleRows(64, 8))
        .rowwise()
        .norm()
        .maxCoeff();
  };
  EXPECT_GT(gap(false), 0.01);
  EXPECT_LT(gap(true), 1e-12);
}

TEST(Constraints, APulledPointArrivesAndTheRestFollows) {
  const Surface s = box<2>(3, 10);
  ActiveSettings<2> settings;
  settings.fixed = rim(s, 1);
  const auto table_u = tabulate_basis(s.knots(0), std::vector{0.4}, 0),
             table_v = tabulate_basis(s.knots(1), std::vector{0.55}, 0);
  LinearConstraint pin{"pin", {}, Point(0, 0, 0.1)};
  for (int r = 0; r <= 3; ++r) {
    for (int c = 0; c <= 3; ++c) {
      pin.terms.emplace_back((table_u->first[0] + r) * 10 + table_v->first[0] + c,
                             table_u->row(0, 0)[r] * table_v->row(0, 0)[c]);
    }
  }
  settings.constraints = {pin};
  for (RestMode mode : {RestMode::shape, RestMode::none}) {
    settings.rest = mode;
    settings.evolution = Evolution::stationary;
    const auto step = active<2>(s, settings).step({s.control_points()}, {});
    ASSERT_TRUE(step);
    const Point at = *evaluate_point<2>(*s.with_control_points(step->control_points), {0.4, 0.55});
    EXPECT_LT((at - Point(0.4, 0.55, 0.1)).norm(), 1e-12);
    EXPECT_LT(step->violation, 1e-12);
    EXPECT_LT(step->residual, 1e-10);
  }
}

}  // namespace
}  // namespace knead
