#include <gtest/gtest.h>

#include <numbers>

#include "sheet.hpp"

namespace knead {
namespace {

using testing::at;
using testing::first;
using testing::fresh;
using testing::new_sheet;
using testing::refusal;
using testing::run;
using testing::same_bits;

// Loads that keep their direction, in raw units on sheets held at one edge: what they do is
// compared where it must agree.

Points displaced_by(const std::vector<std::string>& commands) {
  Session session = fresh();
  run(session, {new_sheet, R"({"do":"scaling","mode":"raw"})", R"({"do":"edge","which":"u0"})"});
  run(session, commands);
  run(session, {R"({"do":"evolve","mode":"static"})"});
  return first(session).current->control_points() - first(session).opened->control_points();
}

double relative_difference(const Points& a, const Points& b) {
  return (a - b).cwiseAbs().maxCoeff() / std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
}

TEST(DeadLoads, OnASquareSheetAreaIsTheParameterMeasureTimesItsSpeed) {
  // 10 by 10 on [0, 1]²: dA = 100 du dv.
  const Points area = displaced_by({R"({"do":"load","vector":[0,0,1],"per":"area"})"});
  const Points parameters = displaced_by({R"({"do":"load","vector":[0,0,100]})"});
  EXPECT_GT(area.cwiseAbs().maxCoeff(), 1);
  EXPECT_LT(relative_difference(area, parameters),
            1e-11);  // condition of a 10 × 10 plate times rounding
}

TEST(DeadLoads, SamplesPerAreaAreThoseOfTheParametersTimesTheSpeed) {
  const Points area = displaced_by(
      {R"({"do":"load","counts":[2,2],"samples":[[0,0,0],[0,0,0],[0,0,1],[0,0,1]],"per":"area"})"});
  const Points parameters = displaced_by({R"({"do":"load","formula":["0","0","100*s"]})"});
  EXPECT_GT(area.cwiseAbs().maxCoeff(), 1);
  EXPECT_LT(relative_difference(area, parameters), 1e-9);
}

TEST(DeadLoads, ALineOfForceBalancesThePointForceOfItsResultantInSymmetricSheets) {
  // Under a load along x, y or z the mean displacement of the loaded edge by a line force p and
  // that of the whole force at its middle follow Betti's theorem: the work of each in the other's
  // displacement is the same.
  const Points line =
      displaced_by({R"({"do":"force","kind":"line","edge":"u1","vector":[0,0,2]})"});
  const Points point =
      displaced_by({R"({"do":"force","kind":"dead","at":[0.7,0.3],"vector":[0,0,3]})"});
  Session a = fresh();
  run(a, {new_sheet});
  const auto spline = [&](const Points& d) { return *first(a).current->with_control_points(d); };
  const double work_of_point = 3 * at(spline(line), 0.7, 0.3)[2];
  // The line force is 2 per length, 10 long: 20 times the mean along u = 1, of a cubic on 7 equal
  // spans: by Simpson.
  double mean = 0;
  const Surface d = spline(point);
  for (int k = 0; k < 7; ++k) {
    mean +=
        (at(d, 1, k / 7.0)[2] + 4 * at(d, 1, (k + 0.5) / 7)[2] + at(d, 1, (k + 1) / 7.0)[2]) / 42;
  }
  EXPECT_GT(std::abs(work_of_point), 1e-3);
  EXPECT_NEAR(20 * mean, work_of_point, 1e-9 * std::abs(work_of_point));
}

TEST(DeadLoads, AMirrorReflectsForces) {
  const std::string
      point = R"({"do":"force","name":"a","kind":"dead","at":[0.7,0.2],"vector":[1,2,3]})",
      line = R"({"do":"force","name":"b","kind":"line","edge":"v0","vector":[0.1,0.2,0.3]})";
  const Points mirrored = displaced_by({R"({"do":"symmetry","mirror":"v"})", point, line});
  const Points both = displaced_by(
      {point, R"({"do":"force","name":"c","kind":"dead","at":[0.7,0.8],"vector":[1,-2,3]})", line,
       R"({"do":"force","name":"d","kind":"line","edge":"v1","vector":[0.1,-0.2,0.3]})"});
  EXPECT_GT(both.col(1).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT(relative_difference(mirrored, both), 1e-9);
}

TEST(DeadLoads, AForceKeepsItsDirectionAndGoesWithRemove) {
  Session session = fresh();
  run(session, {new_sheet, R"({"do":"edge","which":"u0"})",
                R"({"do":"force","name":"weight","kind":"dead","at":[1,0.5],"vector":[0,0,-0.01]})",
                R"({"do":"evolve","mode":"static"})"});
  const Points once = first(session).current->control_points();
  run(session, {R"({"do":"step","count":2})"});
  EXPECT_LT((first(session).current->control_points() - once).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT(at(*first(session).current, 1, 0.5)[2], -1e-4);
  run(session, {R"({"do":"remove","tool":"weight"})", R"({"do":"step"})"});
  EXPECT_LT(std::abs(at(*first(session).current, 1, 0.5)[2]), 1e-11);
}

TEST(DeadLoads, AreInSnapshots) {
  Session session = fresh();
  run(session,
      {new_sheet, R"({"do":"force","name":"a","kind":"dead","at":[1,0.5],"vector":[0,0,-1]})",
       R"({"do":"force","name":"b","kind":"line","edge":"v1","vector":[0,1,0]})",
       R"({"do":"load","vector":[0,0,1],"per":"area"})"});
  const auto restored = Session::restore(session.document(), session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_EQ(restored->state().forces, session.state().forces);
  EXPECT_EQ(restored->state().load, session.state().load);
}

TEST(DeadLoads, NameWhatIsMissingOrTooMuch) {
  Session session = fresh();
  run(session, {new_sheet});
  const std::pair<const char*, const char*> wrong[] = {
      {R"({"do":"force","at":[0.5,0.5]})", "to"},
      {R"({"do":"force","to":[0,0,1]})", "at"},
      {R"({"do":"force","kind":"dead","at":[0.5,0.5]})", "vector"},
      {R"({"do":"force","kind":"dead","at":[0.5,0.5],"vector":[0,0,1],"to":[0,0,1]})", "to"},
      {R"({"do":"force","kind":"line","vector":[0,0,1]})", "edge"},
      {R"({"do":"force","kind":"line","edge":"u1","vector":[0,0,1],"at":[0.5,0.5]})", "at"},
      {R"({"do":"load","per":"length"})", "per"}};
  for (const auto& [json, where] : wrong) EXPECT_EQ(refusal(session, json).where, where) << json;
}

}  // namespace
}  // namespace knead
