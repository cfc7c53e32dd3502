#include <gtest/gtest.h>

#include <cmath>

#include "knead/spline/evaluate.hpp"
#include "support.hpp"

// Curves and volumes that keep their fundamental forms.

namespace knead {
namespace {

using testing::fresh;
using testing::refusal;
using testing::run;
using testing::same_state;

const Curve& curve(const Session& session) {
  return *std::get<SceneCurve>(session.state().bodies.front()).current;
}
const Volume& volume(const Session& session) {
  return *std::get<SceneVolume>(session.state().bodies.front()).current;
}

/// A rod 10 long on [0, 1], clamped at one end, of bending stiffness E I = 2 w2/L = 200, which
/// hardly stretches.
Session rod(const std::vector<std::string>& more) {
  Session session = fresh();
  run(session, {R"({"do":"new","shape":"curve","size":10,"degree":3,"net":30})",
                R"({"do":"edge","which":"u0","hold":"tangent"})",
                R"({"do":"material","model":"fundamental","w1":100,"w2":1000})",
                R"({"do":"evolve","mode":"static"})"});
  run(session, more);
  return session;
}

Point tip(const Session& session) { return *evaluate_point<1>(curve(session), {1.0}); }

TEST(FormCommand, ARodBendsAsABeamUnderASmallForce) {
  Session session =
      rod({R"({"do":"force","kind":"dead","at":[1],"vector":[0,0,1e-4]})", R"({"do":"step"})"});
  const double exact = 1e-4 * 1000 / (3 * 200.0);
  EXPECT_NEAR(tip(session)[2], exact, 1e-6 * exact);
  EXPECT_TRUE(session.state().steps.back().converged);
  EXPECT_EQ(*session.energy(), session.state().steps.back().energy);
}

TEST(FormCommand, ARodBendsFarAsTheElasticaDoes) {
  // P L²/(E I) = 4: by elliptic integrals the tip moves by 0.66996 L across and 0.32894 L back (K.
  // Mattiasson, Int. J. Numer. Meth. Engng. 17 (1981)).
  const Session session =
      rod({R"({"do":"force","kind":"dead","at":[1],"vector":[0,0,8]})", R"({"do":"step"})"});
  EXPECT_TRUE(session.state().steps.back().converged) << session.state().steps.back().note;
  EXPECT_NEAR(tip(session)[2], 6.6996, 2e-3);
  EXPECT_NEAR(10 - tip(session)[0], 3.2894, 2e-3);
  const Points& now = curve(session).control_points();
  EXPECT_EQ(now.row(0), Eigen::RowVector3d(0, 0, 0));  // clamped, to the bit
}

TEST(FormCommand, ABlockIsPulledAsItsMetricHasIt) {
  // Held at u = 0 alone along u, otherwise free to slide, under a force f per measure along u: 4 w1
  // (x'² − L²) x' is all the force beyond, f (1 − u). The metric couples no two directions.
  Session session = fresh();
  run(session,
      {R"({"do":"new","shape":"volume","size":[2,1,1],"degree":[3,2,2],"net":[10,3,3]})",
       R"({"do":"edge","which":"u0","components":"x"})",
       R"({"do":"edge","which":"v0","components":"y"})",
       R"({"do":"edge","which":"w0","components":"z"})",
       R"({"do":"material","model":"fundamental","w1":0.5})", R"({"do":"evolve","mode":"static"})",
       R"({"do":"load","vector":[10,0,0]})", R"({"do":"step"})"});
  EXPECT_TRUE(session.state().steps.back().converged) << session.state().steps.back().note;
  for (const double u : {0.1, 0.45, 0.8}) {
    const auto at = *evaluate<3>(volume(session), Parameters<3>{{u, 0.3, 0.6}}, 1);
    const double x = at.at({1, 0, 0})(0, 0);
    EXPECT_GT(x, 2.01);
    EXPECT_NEAR(4 * 0.5 * (x * x - 4) * x, 10 * (1 - u), 1e-3 * 10);
    EXPECT_NEAR(at.at({0, 1, 0})(0, 1), 1, 1e-9);  // no Poisson's effect
  }
}

/// A rod 10 long between two clamped ends, and a ball above its middle.
Session clamped_rod(const std::string& more = "") {
  Session session = rod(
      {R"({"do":"edge","which":"u1","hold":"tangent"})",
       R"({"do":"tool","name":"ball","radius":1,"position":[5,0,1],"stiffness":1e5)" + more + "}"});
  return session;
}

TEST(FormCommand, ABallDentsARod) {
  Session session = clamped_rod();
  for (int k = 0; k < 5; ++k) {
    run(session, {R"({"do":"move","tool":"ball","by":[0,0,-0.2]})", R"({"do":"step"})"});
    EXPECT_TRUE(session.state().steps.back().converged) << session.state().steps.back().note;
    EXPECT_LE(session.state().steps.back().residual, 1e-9);
  }
  const Point middle = *evaluate_point<1>(curve(session), {0.5});
  EXPECT_NEAR(middle[2], -1, 0.02);  // the ball's lowest point, less what its stiffness gives way
  EXPECT_NEAR(middle[0], 5, 1e-6);
  const double at_quarter = (*evaluate_point<1>(curve(session), {0.25}))[2];
  EXPECT_LT(at_quarter, -0.3);
  EXPECT_GT(at_quarter, -0.8);
  run(session, {R"({"do":"remove","tool":"ball"})", R"({"do":"step"})"});
  EXPECT_NEAR((*evaluate_point<1>(curve(session), {0.5}))[2], 0, 1e-6);  // elastic
}

TEST(FormCommand, ARigidBallStaysOutsideOfARod) {
  Session session = clamped_rod(R"(,"rigid":true)");
  for (int k = 0; k < 5; ++k)
    run(session, {R"({"do":"move","tool":"ball","by":[0.1,0,-0.2]})", R"({"do":"step"})"});
  EXPECT_TRUE(session.state().steps.back().converged) << session.state().steps.back().note;
  double nearest = 10;
  for (int k = 0; k <= 1000; ++k) {
    nearest = std::min(
        nearest, (*evaluate_point<1>(curve(session), {k / 1000.0}) - Point(5.5, 0, 0)).norm());
  }
  EXPECT_GE(nearest, 1 - 1e-4);
  EXPECT_LE(nearest, 1 + 1e-2);
}

TEST(FormCommand, RelaxesInStepsThatLowerItsEnergy) {
  Session session =
      rod({R"({"do":"force","kind":"dead","at":[1],"vector":[0,0,8]})", R"({"do":"step"})",
           R"({"do":"remove","tool":"force"})", R"({"do":"evolve","mode":"acm","lambda":1e-3})"});
  double before = *session.energy();
  for (int k = 0; k < 20; ++k) {
    run(session, {R"({"do":"step"})"});
    EXPECT_TRUE(session.state().steps.back().converged);
    EXPECT_LT(*session.energy(), before);
    before = *session.energy();
  }
}

TEST(FormCommand, SwingsWithoutGainingEnergy) {
  Session session =
      rod({R"({"do":"force","kind":"dead","at":[1],"vector":[0,0,2]})", R"({"do":"step"})",
           R"({"do":"remove","tool":"force"})", R"({"do":"material","mass":1,"damping":0})",
           R"({"do":"evolve","mode":"dynamic","time_step":5})"});
  double before = *session.energy(), fastest = 0;
  const double at_first = before;
  for (int k = 0; k < 60; ++k) {
    run(session, {R"({"do":"step"})"});
    const StepRecord& step = session.state().steps.back();
    EXPECT_TRUE(step.converged) << step.note;
    const double sum = step.energy + step.kinetic;
    EXPECT_LE(sum, before * (1 + 1e-9));
    before = sum;
    fastest = std::max(fastest, step.kinetic);
  }
  EXPECT_GT(fastest, 0.5 * at_first);
}

/// A block that stands on a plate, and a ball above its middle.
Session block(const std::string& more = "") {
  Session session = fresh();
  run(session,
      {R"({"do":"new","shape":"volume","size":[2,2,1],"degree":2,"net":[8,8,5]})",
       R"({"do":"edge","which":"w0"})", R"({"do":"material","model":"fundamental","w1":1})",
       R"({"do":"evolve","mode":"static"})",
       R"({"do":"tool","name":"ball","radius":0.5,"position":[1,1,1.5],"stiffness":100)" + more +
           "}"});
  for (int k = 0; k < 3; ++k) {
    run(session, {R"({"do":"move","tool":"ball","by":[0,0,-0.1]})", R"({"do":"step"})"});
    EXPECT_TRUE(session.state().steps.back().converged) << session.state().steps.back().note;
  }
  return session;
}

TEST(FormCommand, ABallDentsABlock) {
  const Session session = block();
  const double top = (*evaluate_point<3>(volume(session), {0.5, 0.5, 1}))[2];
  EXPECT_LT(top, 0.8);
  EXPECT_GT(top, 0.65);
  EXPECT_EQ((*evaluate_point<3>(volume(session), {0.5, 0.5, 0}))[2], 0);
}

TEST(FormCommand, FrictionHoldsARod) {
  const auto pulled = [](const std::string& friction) {  // along the rod, under the ball
    Session session = clamped_rod();
    for (int k = 0; k < 3; ++k)
      run(session, {R"({"do":"move","tool":"ball","by":[0,0,-0.2]})", R"({"do":"step"})"});
    run(session,
        {R"({"do":"tool","name":"ball","radius":1,"position":[5,0,0.4],"stiffness":1e5,)"
         R"("friction":)" +
             friction + "}",
         R"({"do":"force","kind":"dead","at":[0.5],"vector":[300,0,0]})", R"({"do":"step"})"});
    EXPECT_TRUE(session.state().steps.back().converged) << session.state().steps.back().note;
    return (*evaluate_point<1>(curve(session), {0.5}))[0] - 5;
  };
  const double free = pulled("0");
  EXPECT_NEAR(free, 300 * 0.25 / 8e4,
              2e-4);  // of N = 4 w1 (|S'|² - 100) |S'|, ∂N/∂|S'| = 8e4 at rest
  EXPECT_LT(pulled("0.5"), 0.6 * free);
}

TEST(FormCommand, SpringsAndLimitsActOnIt) {
  Session session = rod({R"({"do":"force","kind":"spring","at":[1],"to":[9,0,4],"strength":1e4})",
                         R"({"do":"step"})"});
  EXPECT_NEAR((tip(session) - Point(9, 0, 4)).norm(), 0, 0.2);
  Session limited =
      rod({R"({"do":"limit","distance":0.5})",
           R"({"do":"force","kind":"dead","at":[1],"vector":[0,0,8]})", R"({"do":"step"})"});
  EXPECT_LE((tip(limited) - Point(10, 0, 0)).norm(), 0.5 * (1 + 1e-6));
  EXPECT_GT((tip(limited) - Point(10, 0, 0)).norm(), 0.45);
}

TEST(FormCommand, IsUndoneAndInSnapshots) {
  Session session = rod({});
  const SessionState before = session.state();
  run(session, {R"({"do":"force","kind":"dead","at":[1],"vector":[0,0,1]})", R"({"do":"step"})"});
  const auto restored = Session::restore(session.document(), session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_TRUE(same_state(session.state(), restored->state()));
  const auto forms = [](const Session& s) {
    return std::visit([](const auto& shapes) { return std::get<FormWeights>(shapes.elasticity); },
                      s.state().bodies.front());
  };
  EXPECT_EQ(forms(*restored), forms(session));
  run(session, {R"({"do":"undo"})"});
  run(session, {R"({"do":"undo"})"});
  EXPECT_TRUE(same_state(session.state(), before));
}

TEST(FormCommand, NamesWhatIsWrong) {
  Session session = rod({});
  EXPECT_EQ(refusal(session, R"({"do":"material","model":"shell"})").where, "model");
  EXPECT_EQ(refusal(session, R"({"do":"material","w1":[1,2,3]})").where, "w1");
  EXPECT_EQ(refusal(session, R"({"do":"material","w2":-1})").where, "w2");
  run(session, {R"({"do":"load","gravity":[0,0,-1]})"});
  EXPECT_EQ(refusal(session, R"({"do":"step"})").where, "gravity");
  run(session,
      {R"({"do":"load"})", R"({"do":"material","mass":0})", R"({"do":"evolve","mode":"dynamic"})"});
  EXPECT_EQ(refusal(session, R"({"do":"step"})").where, "mass");
  run(session, {R"({"do":"material","model":"linear","mass":1})", R"({"do":"step"})"});
  EXPECT_EQ(refusal(session, R"({"do":"material","w1":1})").where, "model");
  run(session, {R"({"do":"new","shape":"volume"})"});
  EXPECT_EQ(refusal(session, R"({"do":"material","model":"fundamental","w2":1})").where, "w2");
  run(session, {R"({"do":"material","model":"fundamental"})", R"({"do":"load","vector":[0,0,1]})"});
  EXPECT_EQ(refusal(session, R"({"do":"evolve","mode":"static"})").kind,
            ErrorKind::numerical);  // nothing holds it
}

}  // namespace
}  // namespace knead
