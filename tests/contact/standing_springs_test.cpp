// Springs on many points, which stand in the matrix of a step.
#include "contact/standing_springs.hpp"

#include <gtest/gtest.h>

#include "active.hpp"
#include "spline/basis_terms.hpp"

namespace knead {
namespace {

using testing::active;
using testing::ball_above_sheet;
using testing::box;
using testing::sheet_settings;

constexpr int places = 40;  // too few springs for the matrix

double fraction(int k, double of) { return 0.15 + 0.7 * (k * of - std::floor(k * of)); }

/// Springs all over the sheet; each is `parts` springs of one strength in all.
std::vector<PointForce> springs(const Surface& s, double strength, int parts, double height = 0.1) {
  std::vector<PointForce> result;
  for (int k = 0; k < places; ++k) {
    const double u = fraction(k, 0.618034), v = fraction(k, 0.754878);
    PointForce force;
    force.terms = basis_terms<2>(s, {u, v}, 0);
    force.to = Point(u, v, height * fraction(k, 0.41));
    force.strength = strength / parts;
    result.insert(result.end(), static_cast<std::size_t>(parts), force);
  }
  return result;
}

struct Pair {
  ActiveStep apart, together;
};

/// Two steps with springs too few for the matrix, and with the same springs each in three.
template <class Change>
Pair pair_of_steps(const ActiveSettings<2>& settings, const Surface& s, double strength,
                   std::span<const Tool> tools, const Change& change) {
  const ActiveSpline<2> model = active<2>(s, settings);
  Pair pair;
  for (const bool apart : {true, false}) {
    ActiveLoads loads;
    loads.points = springs(s, strength, apart ? 1 : 3);
    change(loads);
    EXPECT_EQ(standing_springs<2>(loads.points, std::span(&s, 1)).empty(), apart);
    auto first = model.step({s.control_points()}, tools, loads);
    EXPECT_TRUE(first && first->converged);
    auto second = model.step({first->control_points, {}, first->velocity}, tools, loads);
    EXPECT_TRUE(second && second->converged) << second->note;
    (apart ? pair.apart : pair.together) = std::move(*second);
  }
  return pair;
}

void expect_same(const Pair& pair) {
  const auto& [apart, together] = pair;
  EXPECT_LE((apart.control_points - together.control_points).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_NEAR(apart.energy, together.energy, 1e-9 * apart.energy);
  EXPECT_NEAR(apart.contact, together.contact, 1e-9 * apart.contact);
  EXPECT_NEAR(apart.residual, together.residual, 1e-7);
}

const auto unchanged = [](ActiveLoads&) {};

TEST(StandingSprings, MoveAsTheSameSpringsDoOneByOne) {
  const Surface s = box<2>(3, 16);
  for (const double strength : {1.0, 100.0, 1e4}) {
    for (const Evolution evolution : {Evolution::acm, Evolution::stationary, Evolution::dynamic}) {
      ActiveSettings<2> settings = sheet_settings(s);
      settings.evolution = evolution;
      expect_same(pair_of_steps(settings, s, strength, {}, unchanged));
    }
  }
}

TEST(StandingSprings, StandBesideToolsLimitsAndOtherForces) {
  const Surface s = box<2>(3, 16);
  const std::vector<Tool> tools = {ball_above_sheet(500)};
  expect_same(pair_of_steps(sheet_settings(s), s, 100, tools, unchanged));
  expect_same(pair_of_steps(sheet_settings(s), s, 100, tools, [&](ActiveLoads& loads) {
    PointForce volcano;
    volcano.kind = PointForce::Kind::volcano;
    volcano.terms = basis_terms<2>(s, {0.3, 0.6}, 0);
    volcano.to = Point(0.3, 0.6, -0.1);
    volcano.strength = 1e-3;
    PointForce mean;
    for (int k = 0; k < s.size(); ++k) mean.terms.emplace_back(k, 1.0 / s.size());
    mean.to = Point(0.5, 0.5, 0.02);
    loads.points.insert(loads.points.begin(), {volcano, mean});
    loads.pressure = 0.1;
  }));
}

TEST(StandingSprings, StandWherePointsSlideInAPlane) {
  const Surface s = box<2>(3, 16);
  ActiveSettings<2> settings = sheet_settings(s);
  for (int k = 0; k < 4; ++k) settings.held[static_cast<std::size_t>(k)] = false;
  settings.constraints.push_back(
      {"plane", {{1, 1.0}}, Point::Zero(), Point(2, 1, 0.5).normalized()});
  expect_same(pair_of_steps(settings, s, 100, {}, unchanged));
}

TEST(StandingSprings, StandInNestedNets) {
  const Surface s = box<2>(3, 24);
  ActiveSettings<2> settings = sheet_settings(s);
  settings.solver = StepSolver::iterative;
  expect_same(pair_of_steps(settings, s, 100, {}, unchanged));
}

TEST(StandingSprings, TakeOneFactorWhereverTheyDrawTo) {
  const Surface s = box<2>(3, 40);
  const ActiveSpline<2> model = active<2>(s, sheet_settings(s));
  Points at = s.control_points();
  for (const double height : {0.1, 0.2, -0.1}) {
    ActiveLoads loads;
    loads.points = springs(s, 1e3, 20, height);
    const auto step = model.step({at}, {}, loads);
    ASSERT_TRUE(step);
    EXPECT_TRUE(step->converged);
    EXPECT_LE(step->solves, 10);  // one by one, forty springs take 140
    at = step->control_points;
  }
}

TEST(StandingSprings, AreNoneOfManyControlPoints) {
  const Surface s = box<2>(3, 16);
  std::vector<PointForce> forces = springs(s, 1, 2);
  EXPECT_EQ(standing_springs<2>(forces, std::span(&s, 1)).size(), forces.size());
  PointForce mean;
  for (int k = 0; k < s.size(); ++k) mean.terms.emplace_back(k, 1.0 / s.size());
  EXPECT_TRUE(standing_springs<2>(std::vector<PointForce>(100, mean), std::span(&s, 1)).empty());
  forces.push_back(mean);
  EXPECT_EQ(standing_springs<2>(forces, std::span(&s, 1)).size(), forces.size() - 1);
}

}  // namespace
}  // namespace knead
