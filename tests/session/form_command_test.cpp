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
  return *std::get<BodyShapes<1>>(session.state().bodies.front().shapes).current;
}
const Volume& volume(const Session& session) {
  return *std::get<BodyShapes<3>>(session.state().bodies.front().shapes).current;
}

/// A rod 10 long on [0, 1], clamped at one end, of bending stiffness E I = 2 w2/L = 200, which hardly stretches.
Session rod(const std::vector<std::string>& more) {
  Session session = fresh();
  run(session, {R"({"do":"new","shape":"curve","size":10,"degree":3,"net":30})",
                R"({"do":"edge","which":"u0","hold":"clamped"})",
                R"({"do":"material","model":"fundamental","w1":100,"w2":1000})", R"({"do":"evolve","mode":"static"})"});
  run(session, more);
  return session;
}

Point tip(const Session& session) { return *evaluate_point<1>(curve(session), {1.0}); }

TEST(FormCommand, ARodBendsAsABeamUnderASmallForce) {
  Session session = rod({R"({"do":"force","kind":"dead","at":[1],"vector":[0,0,1e-4]})", R"({"do":"step"})"});
  const double exact = 1e-4 * 1000 / (3 * 200.0);
  EXPECT_NEAR(tip(session)[2], exact, 1e-6 * exact);
  EXPECT_TRUE(session.state().steps.back().converged);
  EXPECT_EQ(*session.energy(), session.state().steps.back().energy);
}

TEST(FormCommand, ARodBendsFarAsTheElasticaDoes) {
  // P L²/(E I) = 4: by elliptic integrals the tip moves by 0.66996 L across and 0.32894 L back (K. Mattiasson, Int. J.
  // Numer. Meth. Engng. 17 (1981)).
  const Session session = rod({R"({"do":"force","kind":"dead","at":[1],"vector":[0,0,8]})", R"({"do":"step"})"});
  EXPECT_TRUE(session.state().steps.back().converged) << session.state().steps.back().note;
  EXPECT_NEAR(tip(session)[2], 6.6996, 2e-3);
  EXPECT_NEAR(10 - tip(session)[0], 3.2894, 2e-3);
  const Points& now = curve(session).control_points();
  EXPECT_EQ(now.row(0), Eigen::RowVector3d(0, 0, 0));  // clamped, to the bit
}

TEST(FormCommand, ABlockIsPulledAsItsMetricHasIt) {
  // Held at u = 0 alone along u, otherwise free to slide, under a force f per measure along u: 4 w1 (x'² − L²) x' is
  // all the force beyond, f (1 − u). The metric couples no two directions.
  Session session = fresh();
  run(session, {R"({"do":"new","shape":"volume","size":[2,1,1],"degree":[3,2,2],"net":[10,3,3]})",
                R"({"do":"edge","which":"u0","components":"x"})", R"({"do":"edge","which":"v0","components":"y"})",
                R"({"do":"edge","which":"w0","components":"z"})", R"({"do":"material","model":"fundamental","w1":0.5})",
                R"({"do":"evolve","mode":"static"})", R"({"do":"load","vector":[10,0,0]})", R"({"do":"step"})"});
  EXPECT_TRUE(session.state().steps.back().converged) << session.state().steps.back().note;
  for (const double u : {0.1, 0.45, 0.8}) {
    const auto at = *evaluate<3>(volume(session), Parameters<3>{{u, 0.3, 0.6}}, 1);
    const double x = at.at({1, 0, 0})(0, 0);
    EXPECT_GT(x, 2.01);
    EXPECT_NEAR(4 * 0.5 * (x * x - 4) * x, 10 * (1 - u), 1e-3 * 10);
    EXPECT_NEAR(at.at({0, 1, 0})(0, 1), 1, 1e-9);  // no Poisson's effect
  }
}

TEST(FormCommand, IsUndoneAndInSnapshots) {
  Session session = rod({});
  const SessionState before = session.state();
  run(session, {R"({"do":"force","kind":"dead","at":[1],"vector":[0,0,1]})", R"({"do":"step"})"});
  const auto restored = Session::restore(session.document(), session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_TRUE(same_state(session.state(), restored->state()));
  EXPECT_EQ(restored->state().bodies.front().fundamental, session.state().bodies.front().fundamental);
  run(session, {R"({"do":"undo"})"});
  run(session, {R"({"do":"undo"})"});
  EXPECT_TRUE(same_state(session.state(), before));
}

TEST(FormCommand, NamesWhatIsWrong) {
  Session session = rod({R"({"do":"evolve","mode":"acm"})"});
  EXPECT_EQ(refusal(session, R"({"do":"step"})").where, "mode");
  EXPECT_EQ(refusal(session, R"({"do":"material","model":"shell"})").where, "model");
  EXPECT_EQ(refusal(session, R"({"do":"material","w1":[1,2,3]})").where, "w1");
  EXPECT_EQ(refusal(session, R"({"do":"material","w2":-1})").where, "w2");
  run(session, {R"({"do":"force","kind":"spring","at":[1],"to":[1,1,1]})"});
  EXPECT_EQ(refusal(session, R"({"do":"evolve","mode":"static"})").where, "force");
  run(session, {R"({"do":"remove","tool":"force"})", R"({"do":"tool","name":"ball","radius":1,"position":[0,0,50]})"});
  EXPECT_EQ(refusal(session, R"({"do":"evolve","mode":"static"})").where, "tool");
  run(session, {R"({"do":"remove","tool":"ball"})", R"({"do":"material","model":"linear"})", R"({"do":"step"})"});
  EXPECT_EQ(refusal(session, R"({"do":"material","w1":1})").where, "model");
  run(session, {R"({"do":"new","shape":"volume"})"});
  EXPECT_EQ(refusal(session, R"({"do":"material","model":"fundamental","w2":1})").where, "w2");
  run(session, {R"({"do":"material","model":"fundamental"})", R"({"do":"load","vector":[0,0,1]})"});
  EXPECT_EQ(refusal(session, R"({"do":"evolve","mode":"static"})").kind, ErrorKind::numerical);  // nothing holds it
}

}  // namespace
}  // namespace knead
