#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "sheet.hpp"

namespace knead {
namespace {

using testing::at;
using testing::first;
using testing::fresh;
using testing::refusal;
using testing::run;
using testing::same_bits;
using testing::same_state;

const ShellMaterial& shell_of(const Session& session) {
  return std::get<ShellMaterial>(first(session).elasticity);
}

// A cantilever 10 long, 1 wide and 0.1 thick, E = 1.2e6, ν = 0, clamped at u = 0.

const std::vector<std::string> cantilever_commands = {
    R"({"do":"new","size":[10,1],"net":[19,4]})", R"({"do":"edge","which":"u0","hold":"tangent"})",
    R"({"do":"material","model":"shell","young":1.2e6,"poisson":0,"thickness":0.1})",
    R"({"do":"evolve","mode":"static"})"};

Session bent_cantilever(const std::vector<std::string>& load) {
  Session session = fresh();
  run(session, cantilever_commands);
  run(session, load);
  return session;
}

Point tip_displacement(const Session& session) {
  return at(*first(session).current, 1, 0.5) - at(*first(session).opened, 1, 0.5);
}

TEST(ShellCommand, ASmallLineForceBendsAsABeamDoes) {
  // w = F L³ / (3 E I), I = b t³/12 = 1/12000: the cubic is in the space; turns are of the order of
  // w / L = 3e-6, what they change of the order of their square, and the tolerance of Newton's
  // method is 1e-8.
  const Session session = bent_cantilever(
      {R"({"do":"force","kind":"line","edge":"u1","vector":[0,0,1e-5]})", R"({"do":"step"})"});
  const double exact = 1e-5 * 1000 / (3 * 1.2e6 / 12000);
  EXPECT_NEAR(tip_displacement(session)[2], exact, 1e-6 * exact);
}

TEST(ShellCommand, AnAreaLoadBendsAsABeamDoes) {
  // w = q L⁴ / (8 E I): the quartic is approximated by cubics on 16 spans, whose tip is exact.
  const Session session =
      bent_cantilever({R"({"do":"load","vector":[0,0,1e-6]})", R"({"do":"step"})"});
  const double exact = 1e-6 * 10000 / (8 * 1.2e6 / 12000);
  EXPECT_NEAR(tip_displacement(session)[2], exact, 1e-6 * exact);
}

TEST(ShellCommand, ALoadThatGrowsAlongABeamIsGivenBySamplesOrAFormula) {
  // q = q₀ x / L: w = 11 q₀ L⁴ / (120 E I) at the tip, which cubics give exactly.
  const double exact = 11 * 1e-6 * 10000 / (120 * 1.2e6 / 12000);
  for (const char* load :
       {R"({"do":"load","counts":[2,2],"samples":[[0,0,0],[0,0,0],[0,0,1e-6],[0,0,1e-6]]})",
        R"({"do":"load","formula":["0","0","1e-6*s"]})",
        R"({"do":"load","formula":["0","0","1e-7*x"]})",
        // The sheet of 10 × 1 is on [0, 1]².
        R"({"do":"load","formula":["0","0","1e-5*s"],"per":"parameters"})"}) {
    const Session session = bent_cantilever({load, R"({"do":"step"})"});
    EXPECT_NEAR(tip_displacement(session)[2], exact, 1e-6 * exact) << load;
  }
}

TEST(ShellCommand, ATaperedBeamBendsAsBeamTheoryHasIt) {
  // t = t₀ (1 − x/2L), P at the tip: w = ∫ P (L − x)² / (E I) dx = 96 P L³/(E t₀³) [ln y + 1/y −
  // 1/(8 y²)] from 1/2 to 1.
  const double exact = 96 * 1e-5 * 1000 / (1.2e6 * 1e-3) * (0.875 - 1.5 + std::log(2.0));
  for (const char* taper :
       {R"({"do":"material","coefficient":"thickness","formula":"0.1 - 0.05*s"})",
        R"({"do":"material","coefficient":"thickness","counts":[2,2],)"
        R"("samples":[0.1,0.1,0.05,0.05]})"}) {
    const Session session =
        bent_cantilever({taper, R"({"do":"force","kind":"line","edge":"u1","vector":[0,0,1e-5]})",
                         R"({"do":"step"})"});
    EXPECT_NEAR(tip_displacement(session)[2], exact, 1e-5 * exact) << taper;
    EXPECT_NEAR(shell_of(session).thickness, 0.075, 1e-15);
  }
  // A modulus that varies as t³ would does the same to bending.
  const Session soft = bent_cantilever(
      {R"({"do":"material","coefficient":"young","formula":"1.2e6*(1 - s/2)^3"})",
       R"({"do":"force","kind":"line","edge":"u1","vector":[0,0,1e-5]})", R"({"do":"step"})"});
  EXPECT_NEAR(tip_displacement(soft)[2], exact, 1e-5 * exact);
}

TEST(ShellCommand, CoefficientsThatVaryAreUndoneReplacedAndInSnapshots) {
  const char* const taper =
      R"({"do":"material","coefficient":"thickness","formula":"0.1 - 0.05*s"})";
  Session session = bent_cantilever({taper});
  ASSERT_TRUE(shell_of(session).thickness_field);
  const auto restored = Session::restore(session.document(), session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_EQ(first(*restored).elasticity, first(session).elasticity);
  run(session, {R"({"do":"undo"})"});
  EXPECT_FALSE(shell_of(session).thickness_field);
  run(session, {taper, R"({"do":"material","density":2})"});
  EXPECT_TRUE(shell_of(session).thickness_field);
  run(session, {R"({"do":"material","thickness":0.2})"});
  EXPECT_FALSE(shell_of(session).thickness_field);
}

TEST(ShellCommand, NamesWhatIsWrongWithCoefficientsThatVary) {
  Session session = fresh();
  run(session, {R"({"do":"new","size":[10,1],"net":[8,4]})"});
  EXPECT_EQ(refusal(session, R"({"do":"material","coefficient":"thickness","formula":"1"})").where,
            "model");
  EXPECT_EQ(refusal(session,
                    R"({"do":"material","model":"shell","coefficient":"thickness","formula":"1"})")
                .where,
            "young");
  run(session,
      {R"({"do":"material","model":"shell","young":1,"coefficient":"thickness","formula":"1 + )"
       R"(s"})"});
  EXPECT_EQ(
      refusal(session,
              R"({"do":"material","coefficient":"thickness","counts":[2,2],"samples":[1,0,1,1]})")
          .where,
      "thickness: coefficient (0, 1)");
  EXPECT_EQ(
      refusal(session, R"({"do":"material","coefficient":"thickness","formula":"s - 0.5"})").where,
      "formula");
  EXPECT_EQ(
      refusal(session, R"({"do":"material","coefficient":"young","formula":"1","young":2})").where,
      "young");
  EXPECT_EQ(refusal(session, R"({"do":"material","coefficient":"poisson","formula":"0"})").where,
            "coefficient");
  EXPECT_EQ(refusal(session, R"({"do":"material","thickness":2,"region":[[0,1],[0,0.5]]})").where,
            "region");
}

TEST(ShellCommand, WeightsOfTheFormsAreOneNumberOrThree) {
  Session session = fresh();
  run(session, {R"({"do":"new","size":[10,1],"net":[8,4]})",
                R"({"do":"material","model":"fundamental","w1":2.5,"w2":[1,0.5,0.25]})"});
  EXPECT_EQ(std::get<FundamentalMaterial>(first(session).elasticity).w1,
            (std::array{2.5, 2.5, 2.5}));
  EXPECT_EQ(std::get<FundamentalMaterial>(first(session).elasticity).w2,
            (std::array{1.0, 0.5, 0.25}));
}

TEST(ShellCommand, GravityIsDensityTimesThickness) {
  const Session weight =
      bent_cantilever({R"({"do":"material","density":2})", R"({"do":"load","gravity":[0,0,-5e-6]})",
                       R"({"do":"step"})"});
  const Session load =
      bent_cantilever({R"({"do":"load","vector":[0,0,-1e-6]})", R"({"do":"step"})"});
  EXPECT_NEAR(tip_displacement(weight)[2], tip_displacement(load)[2], 1e-12);
}

TEST(ShellCommand, WithoutMassThereIsNoWeight) {
  Session session = bent_cantilever({});
  run(session, {R"({"do":"load","gravity":[0,0,-1]})"});
  EXPECT_EQ(refusal(session, R"({"do":"step"})").where, "gravity");
  run(session, {R"({"do":"material","model":"fundamental"})"});
  EXPECT_EQ(refusal(session, R"({"do":"step"})").where, "gravity");
}

TEST(ShellCommand, FormsSwingWithoutGainingEnergy) {
  Session session = fresh();
  run(session, {R"({"do":"new","size":[10,1],"net":[19,4]})",
                R"({"do":"edge","which":"u0","hold":"tangent"})",
                R"({"do":"material","model":"fundamental","w1":1,"w2":10,"mass":1,"damping":0})",
                R"({"do":"evolve","mode":"static"})",
                R"({"do":"force","name":"pull","kind":"line","edge":"u1","vector":[0,0,0.5]})",
                R"({"do":"step"})", R"({"do":"remove","tool":"pull"})",
                R"({"do":"evolve","mode":"dynamic","time_step":1})"});
  const double at_first = *session.energy();
  double before = at_first, fastest = 0;
  for (int k = 0; k < 60; ++k) {
    run(session, {R"({"do":"step"})"});
    const StepRecord& step = session.state().steps.back();
    EXPECT_TRUE(step.converged) << step.note;
    EXPECT_LE(step.energy + step.kinetic, before * (1 + 1e-9));
    before = step.energy + step.kinetic;
    fastest = std::max(fastest, step.kinetic);
  }
  EXPECT_GT(fastest, 0.3 * at_first);
  run(session, {R"({"do":"material","mass":0})"});
  EXPECT_EQ(refusal(session, R"({"do":"step"})").where, "density");
}

TEST(ShellCommand, BendsFarAsInTheLiterature) {
  // Sze, Liu and Lo (2004): under P = 4 the tip moves by 6.698 along z and −3.286 along x.
  const Session session =
      bent_cantilever({R"({"do":"force","kind":"line","edge":"u1","vector":[0,0,4]})",
                       R"({"do":"step","increments":4})"});
  EXPECT_NEAR(tip_displacement(session)[2], 6.698, 0.002 * 6.698);
  EXPECT_NEAR(tip_displacement(session)[0], -3.286, 0.002 * 3.286);
  const StepRecord& last = session.state().steps.back();
  EXPECT_EQ(last.load_factor, 1);
  EXPECT_TRUE(last.converged);
  EXPECT_EQ(last.increments.size(), 4U);
  EXPECT_EQ(std::accumulate(last.increments.begin(), last.increments.end(), 0), last.iterations);
  EXPECT_LT(last.residual, 1e-8);
  const Points now = first(session).current->control_points(),
               then = first(session).opened->control_points();
  EXPECT_TRUE(same_bits(now.topRows(8), then.topRows(8)));  // the clamped rows
}

TEST(ShellCommand, HoldsSingleCoordinates) {
  const Session session =
      bent_cantilever({R"({"do":"edge","which":"u1","components":"z"})",
                       R"({"do":"force","kind":"dead","at":[0.5,0.5],"vector":[0,0,-1]})",
                       R"({"do":"step","increments":2})"});
  EXPECT_EQ(tip_displacement(session)[2], 0);
  EXPECT_LT(tip_displacement(session)[0], -1e-3);  // it slides in
  EXPECT_LT((at(*first(session).current, 0.5, 0.5))[2], -1e-2);
}

TEST(ShellCommand, IsUndoneAndInSnapshots) {
  Session session = bent_cantilever({});
  const SessionState before = session.state();
  run(session, {R"({"do":"force","kind":"line","edge":"u1","vector":[0,0,1]})",
                R"({"do":"step","increments":2})"});
  const auto restored = Session::restore(session.document(), session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_TRUE(same_state(session.state(), restored->state()));
  EXPECT_EQ(restored->state().steps, session.state().steps);
  EXPECT_EQ(first(*restored).elasticity, first(session).elasticity);
  run(session, {R"({"do":"undo"})"});
  run(session, {R"({"do":"undo"})"});
  EXPECT_TRUE(same_state(session.state(), before));
}

TEST(ShellCommand, RefusesMomentsWhereTheyHaveNoMeaning) {
  Session session = bent_cantilever(
      {R"({"do":"force","name":"turn","kind":"moment","edge":"u1","moment":1e-3})"});
  EXPECT_EQ(
      refusal(session, R"({"do":"force","kind":"moment","edge":"u1","moment":1,"vector":[0,0,1]})")
          .where,
      "vector");
  EXPECT_EQ(refusal(session, R"({"do":"force","kind":"moment","moment":1})").where, "edge");
  run(session, {R"({"do":"step"})", R"({"do":"symmetry","mirror":"v"})"});
  EXPECT_EQ(refusal(session, R"({"do":"step"})").where, "turn");
  run(session, {R"({"do":"undo"})", R"({"do":"material","model":"linear"})"});
  EXPECT_EQ(refusal(session, R"({"do":"step"})").where, "turn");
}

TEST(ShellCommand, NamesWhatIsWrong) {
  Session session = fresh();
  run(session, {R"({"do":"new","size":[10,1],"net":[8,4]})"});
  EXPECT_EQ(refusal(session, R"({"do":"material","young":1})").where, "model");
  EXPECT_EQ(refusal(session, R"({"do":"material","model":"shell","young":1})").where, "thickness");
  EXPECT_FALSE(refusal(session, R"({"do":"material","model":"shell","young":-1,"thickness":1})")
                   .what.empty());
  EXPECT_EQ(refusal(session, R"({"do":"step","increments":2})").where, "increments");
  run(session, {R"({"do":"material","model":"shell","young":1,"thickness":1})"});
  run(session, {R"({"do":"load","vector":[0,0,1]})"});
  EXPECT_EQ(refusal(session, R"({"do":"evolve","mode":"static"})").kind,
            ErrorKind::numerical);  // nothing holds it
  run(session, {R"({"do":"load"})", R"({"do":"edge","hold":"tangent"})",
                R"({"do":"evolve","mode":"static"})"});
  EXPECT_EQ(refusal(session, R"({"do":"step","increments":0})").where, "increments");
  run(session, {R"({"do":"evolve","mode":"dynamic"})"});
  EXPECT_EQ(refusal(session, R"({"do":"step"})").where, "density");
  run(session,
      {R"({"do":"new","size":[10,1],"net":[8,4]})", R"({"do":"select","surfaces":["#1","#2"]})"});
  EXPECT_EQ(refusal(session, R"({"do":"step"})").where, "#2");  // which is no shell
  run(session, {R"({"do":"select","surface":"#1"})", R"({"do":"evolve","mode":"acm"})"});
  run(session, {R"({"do":"material","model":"linear"})", R"({"do":"step"})"});
}

}  // namespace
}  // namespace knead
