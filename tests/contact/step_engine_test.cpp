// Steps by iteration over nested nets, beside the same steps by a factor.
#include <gtest/gtest.h>

#include "active.hpp"
#include "base/interruption.hpp"
#include "contact/step_engine.hpp"
#include "knead/base/threads.hpp"

namespace knead {
namespace {

using testing::active;
using testing::ball_above_sheet;
using testing::box;
using testing::sheet_settings;

/// The largest difference of control points after some steps by either solver, as a share of the
/// largest displacement.
template <int D>
double difference(std::vector<Spline<D>> patches, ActiveSettings<D> settings, Tool tool,
                  const ActiveLoads& loads = {}) {
  settings.solver = StepSolver::direct;
  const auto direct = ActiveSpline<D>::create(patches, settings);
  settings.solver = StepSolver::iterative;
  const auto iterative = ActiveSpline<D>::create(patches, settings);
  if (!direct || !iterative) {
    ADD_FAILURE() << (direct ? iterative : direct).error().message();
    return 1;
  }
  EXPECT_FALSE(direct->engine().iterative);
  EXPECT_TRUE(iterative->engine().iterative);
  int rows = 0;
  for (const Spline<D>& patch : patches) rows += patch.size();
  Points start(rows, 3);
  for (int first = 0; const Spline<D>& patch : patches) {
    start.middleRows(first, patch.size()) = patch.control_points();
    first += patch.size();
  }
  ActiveState a{start}, b{start};
  for (int k = 0; k < 4; ++k) {
    testing::move_to(tool, tool.shape.placement().position + Point(0.02, 0.01, -0.02));
    const auto on_a = direct->step(a, {&tool, 1}, loads),
               on_b = iterative->step(b, {&tool, 1}, loads);
    if (!on_a || !on_b) {
      ADD_FAILURE() << (on_a ? on_b : on_a).error().message();
      return 1;
    }
    EXPECT_EQ(on_a->converged, on_b->converged) << k << ' ' << on_b->note;
    a = {on_a->control_points, {}, on_a->velocity};
    b = {on_b->control_points, {}, on_b->velocity};
  }
  const double moved = (a.control_points - start).cwiseAbs().maxCoeff();
  EXPECT_GT(moved, 0);
  return (a.control_points - b.control_points).cwiseAbs().maxCoeff() / moved;
}

/// The same of a spline with its ends held and the tool at a place.
template <int D>
double held_difference(const Spline<D>& s, int rows, double detail, Tool tool, const Point& at) {
  ActiveSettings<D> settings;
  settings.held = testing::ends<D>(s, rows);
  settings.detail = detail;
  testing::move_to(tool, at);
  return difference<D>({s}, settings, tool);
}

TEST(IterativeSteps, AreThoseOfAFactorUnderSoftStiffAndRigidTools) {
  const Surface s = box<2>(3, 40);
  for (const double stiffness : {1e2, 1e4, 1e7})
    EXPECT_LE(difference<2>({s}, sheet_settings(s), ball_above_sheet(stiffness)), 1e-7);
  Tool rigid = ball_above_sheet(1e3);
  rigid.rigid = true;
  EXPECT_LE(difference<2>({s}, sheet_settings(s), rigid), 1e-6);
  Tool rough = ball_above_sheet(1e4);
  rough.friction = 0.3;
  ActiveLoads loads;
  loads.force = Point(0.1, 0, -0.2);
  EXPECT_LE(difference<2>({s}, sheet_settings(s), rough, loads), 1e-7);
}

TEST(IterativeSteps, AreThoseOfAFactorInEveryEvolution) {
  const Surface s = box<2>(3, 40);
  ActiveSettings<2> settings = sheet_settings(s);
  settings.evolution = Evolution::stationary;
  EXPECT_LE(difference<2>({s}, settings, ball_above_sheet(1e3)), 1e-7);
  settings.evolution = Evolution::dynamic;
  EXPECT_LE(difference<2>({s}, settings, ball_above_sheet(1e3)), 1e-7);
  settings.evolution = Evolution::acm;
  settings.weight = StepWeight::identity;
  EXPECT_LE(difference<2>({s}, settings, ball_above_sheet(1e3)), 1e-7);
}

TEST(IterativeSteps, AreThoseOfAFactorForCurvesVolumesAndSeveralDegrees) {
  for (const int degree : {2, 4, 5}) {
    const Surface s = box<2>(degree, 36);
    EXPECT_LE(difference<2>({s}, sheet_settings(s), ball_above_sheet(1e3)), 1e-7) << degree;
  }
  EXPECT_LE(
      held_difference<1>(box<1>(3, 60), 2, 0.15, ball_above_sheet(1e3), Point(0.42, 0.1, 0.1)),
      1e-7);
  EXPECT_LE(held_difference<3>(box<3>(2, 9), 1, 0.3, ball_above_sheet(1e2), Point(0.5, 0.5, 1.1)),
            1e-7);
}

TEST(IterativeSteps, AreThoseOfAFactorWhereMaterialJumpsAndWeightsVary) {
  const Surface s = box<2>(3, 40);
  ActiveSettings<2> settings = sheet_settings(s);
  const auto jump = SplineField<2>::create(
      {*KnotVector::create(1, {0, 0, 0.5, 0.5, 1, 1}), *KnotVector::create(1, {0, 0, 1, 1})},
      {1, 1, 1, 1, 100, 100, 100, 100});
  ASSERT_TRUE(jump);
  MaterialFieldOf<2> field;
  field.alpha[0] = field.alpha[2] = *jump;
  field.beta[0] = field.beta[1] = field.beta[2] = *jump;
  settings.fields = {field};
  EXPECT_LE(difference<2>({s}, settings, ball_above_sheet(1e3)), 1e-7);

  std::vector<double> weights;
  for (int i = 0; i < s.size(); ++i) weights.push_back(1 + 3 * (i % 40) / 39.0);
  const auto rational = Surface::create({s.knots(0), s.knots(1)}, s.control_points(), weights);
  ASSERT_TRUE(rational);
  EXPECT_LE(difference<2>({*rational}, sheet_settings(s), ball_above_sheet(1e3)), 1e-7);
}

TEST(IterativeSteps, AreThoseOfAFactorAcrossASeam) {
  const Surface left = box<2>(3, 28);
  Points moved = left.control_points();
  moved.col(0).array() += 1;
  const Surface right = *left.with_control_points(moved);
  ActiveSettings<2> settings = sheet_settings(left);
  settings.held = testing::ends<2>(left, 1);
  std::vector<bool> beyond = settings.held;
  for (std::size_t j = 0; j < 28; ++j) settings.held[27 * 28 + j] = beyond[j] = false;
  settings.held.insert(settings.held.end(), beyond.begin(), beyond.end());
  for (int j = 0; j < 28; ++j) {
    settings.constraints.push_back({"seam", {{27 * 28 + j, 1.0}, {28 * 28 + j, -1.0}}});
    // and the tangents across it
    settings.constraints.push_back(
        {"smooth seam", {{26 * 28 + j, 1.0}, {27 * 28 + j, -2.0}, {29 * 28 + j, 1.0}}});
  }
  Tool tool = ball_above_sheet(1e3);
  testing::move_to(tool, Point(0.95, 0.5, 0.14));
  EXPECT_LE(difference<2>({left, right}, settings, tool), 1e-7);
}

TEST(IterativeSteps, RepeatBitForBitWithAnyNumberOfThreads) {
  const Surface s = box<2>(3, 70);
  ActiveSettings<2> settings = sheet_settings(s);
  settings.solver = StepSolver::iterative;
  Tool tool = ball_above_sheet(1e3);
  testing::move_to(tool, Point(0.45, 0.52, 0.1));
  std::vector<Points> results;
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    results.push_back(active<2>(s, settings).step(s.control_points(), {&tool, 1})->control_points);
  }
  set_thread_count(0);
  EXPECT_TRUE(results[0] == results[1]);
  EXPECT_TRUE(results[0] == results[2]);
}

TEST(StepEngine, FactorsWhereCyclesTakeMoreIterationsThanAFactorIsWorth) {
  // Just above the number of points that are factored unasked, only with the usual 12; a factor's
  // cost per point grows as the root of their number.
  EXPECT_EQ(most_iterations<2>(direct_points<2> + 1, 3), 12);
  EXPECT_EQ(most_iterations<2>(2 * direct_points<2>, 3), 24);
  EXPECT_EQ(most_iterations<1>(2 * direct_points<1>, 2), 24);
  EXPECT_EQ(most_iterations<2>(10 * direct_points<2>, 3), 40);
  EXPECT_EQ(most_iterations<2>(400, 3),
            12);  // below it, where iteration is not tried unless asked for
  // Denser factors: of degree 4 and more, and of volumes.
  EXPECT_EQ(most_iterations<2>(direct_points<2> + 1, 4), 40);
  EXPECT_EQ(most_iterations<3>(direct_points<3> + 1, 2), 40);
}

TEST(StepEngine, SaysThatItWasStoppedInsteadOfThatItDoesNotConverge) {
  const Surface s = box<2>(3, 40);
  ActiveSettings<2> settings = sheet_settings(s);
  settings.solver = StepSolver::iterative;
  const Interruption stop([] { return false; });
  const auto made = ActiveSurface::create(s, settings);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().what, interrupted_error().error().what);
}

TEST(StepEngine, IsChosenByCountsAndStructure) {
  const Surface small = box<2>(3, 20);
  ActiveSettings<2> settings = sheet_settings(small);
  EXPECT_EQ(active<2>(small, settings).engine().reason, "400 control points, at most 90000");
  EXPECT_TRUE(active<2>(small, settings).engine().usual);
  settings.solver = StepSolver::iterative;
  settings.constraints = {{"plane", {{210, 1.0}}, Point::Zero(), Point(1, 1, 0)}};
  const auto refused = ActiveSurface::create(small, settings);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().where, "solver");
  EXPECT_NE(refused.error().message().find("automatic"), std::string::npos);

  const Surface large = box<2>(2, 301);
  const auto chosen = active<2>(large, sheet_settings(large));
  EXPECT_TRUE(chosen.engine().iterative);
  EXPECT_EQ(chosen.engine().reason.substr(0, 22), "90601 control points, ");
}

}  // namespace
}  // namespace knead
