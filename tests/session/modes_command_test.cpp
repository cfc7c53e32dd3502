#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sheet.hpp"

// Natural frequencies and buckling loads against exact and published ones (docs/shell.md has their
// table).

namespace knead {
namespace {

using std::numbers::pi;
using testing::fresh;
using testing::refusal;
using testing::run;
using testing::same_state;

const char* const square = R"({"do":"new","size":[1,1],"degree":[4,4],"net":[12,12]})";
const char* const steel =
    R"({"do":"material","model":"shell","young":1e6,"poisson":0.3,"thickness":0.01,"density":2})";

std::vector<double> values(const std::vector<ModeRecord>& modes) {
  std::vector<double> result;
  for (const ModeRecord& mode : modes) result.push_back(mode.value);
  return result;
}

TEST(ModesCommand, OfAFreeSquarePlateAreThoseOfLeissa) {
  Session session = fresh();
  run(session, {square, steel, R"({"do":"modes","count":12})"});
  const auto& modes = session.state().modes;
  ASSERT_EQ(modes.size(), 12U);
  // Sqrt(D / (ρ t)) / (2π), side 1.
  const double unit = std::sqrt(1e6 * 1e-4 / (12 * (1 - 0.09)) / 2) / (2 * pi);
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_LT(std::abs(modes[k].value), 1e-3 * 13.468 * unit) << k;
  // Leissa, J. Sound Vib. 31 (1973), by nine-term Ritz series, which are upper bounds; Liew, Xiang
  // and Kitipornchai (1993) have 13.468, 19.596, 24.270, 34.801.
  const std::vector<double> liew = {13.468, 19.596, 24.270, 34.801, 34.801};
  for (std::size_t k = 0; k < liew.size(); ++k)
    EXPECT_NEAR(modes[k + 6].value / unit, liew[k], 1e-3 * liew[k]) << k;
  for (const ModeRecord& mode : modes) EXPECT_LT(mode.residual, 1e-4);
}

TEST(ModesCommand, OfALinearPlateAreThoseOfLeissaInEachCoordinate) {
  // The active model with the energy of a thin plate, twice its strain energy as μ X² is twice its
  // kinetic one.
  Session session = fresh();
  run(session, {square, R"({"do":"material","model":"plate","rigidity":3,"poisson":0.3,"mass":2})",
                R"({"do":"modes","count":24})"});
  const auto found = values(session.state().modes);
  ASSERT_EQ(found.size(), 24U);
  const double unit = std::sqrt(3.0 / 2) / (2 * pi);
  for (std::size_t k = 0; k < 9; ++k) EXPECT_LT(std::abs(found[k]), 1e-3 * 13.468 * unit) << k;
  const std::vector<double> liew = {13.468, 19.596, 24.270, 34.801, 34.801};
  for (std::size_t k = 0; k < liew.size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(found[9 + 3 * k + c] / unit, liew[k], 1e-4 * liew[k]) << k;
  }
}

TEST(ModesCommand, OfACantileveredPanelAreThoseMeasured) {
  // A fan blade: 304.8 mm long and along the arc, radius 609.6, thickness 3.048; measured by M. D.
  // Olson and G. M. Lindberg, J. Sound Vib. 19 (1971), to a few percent. N, mm, t: an arc of 1/2
  // radian, clamped at v = 0.
  const double r = 609.6, half = 0.25, s = std::sin(half), c = std::cos(half);
  const auto point = [](double x, double y, double z) {
    return fmt::format("[{},{},{}]", x, y, z);
  };
  Session session = fresh();
  run(session,
      {fmt::format(R"({{"do":"new","degree":[2,1],"net":[3,2],"points":[{},{},{},{},{},{}],)"
                   R"("weights":[1,1,{},{},1,1]}})",
                   point(-r * s, 0, r * c), point(-r * s, 304.8, r * c), point(0, 0, r / c),
                   point(0, 304.8, r / c), point(r * s, 0, r * c), point(r * s, 304.8, r * c), c,
                   c),
       R"({"do":"elevate","by":[1,2]})", R"({"do":"refine","region":[[0,1],[0,1]]})",
       R"({"do":"refine","region":[[0,1],[0,1]]})", R"({"do":"refine","region":[[0,1],[0,1]]})",
       R"({"do":"edge","which":"v0","hold":"tangent"})",
       R"({"do":"material","model":"shell","young":206800,"poisson":0.3,"thickness":3.048,)"
       R"("density":7.86e-9})",
       R"({"do":"modes","count":5})"});
  const std::vector<double> measured = {86.6, 135.5, 258.9, 350.6, 395.2};
  const auto found = values(session.state().modes);
  ASSERT_EQ(found.size(), measured.size());
  for (std::size_t k = 0; k < measured.size(); ++k)
    EXPECT_NEAR(found[k], measured[k], 0.05 * measured[k]) << k;
}

TEST(ModesCommand, OfALinearMembraneAreExact) {
  // K = α ∫ |∇X|², M = μ ∫ X²: ω² = 2π² α/μ, thrice, as each coordinate vibrates alone; then 5π²
  // six times.
  Session session = fresh();
  run(session, {square, R"({"do":"edge","hold":"position"})",
                R"({"do":"material","alpha":[3,0,3],"beta":[0,0,0],"mass":2})",
                R"({"do":"modes","count":6})"});
  const auto found = values(session.state().modes);
  ASSERT_EQ(found.size(), 6U);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], std::sqrt(2 * 1.5) / 2, 1e-6) << k;
  for (std::size_t k = 3; k < 6; ++k) EXPECT_NEAR(found[k], std::sqrt(5 * 1.5) / 2, 1e-5) << k;
}

TEST(ModesCommand, ChangesNothingThatUndoSees) {
  Session session = fresh();
  run(session, {square, steel, R"({"do":"limit","distance":1})", R"({"do":"undo"})"});
  const SessionState before = session.state();
  const std::size_t commands = session.journal().size();
  run(session, {R"({"do":"modes","count":7})"});
  EXPECT_EQ(session.journal().size(), commands);
  EXPECT_TRUE(session.can_redo());
  const auto restored = Session::restore(session.document(), session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_TRUE(same_state(restored->state(), session.state()));
  SessionState after = session.state();
  after.modes.clear();
  EXPECT_TRUE(same_state(before, after));
}

TEST(BucklingCommand, OfAStrutIsThatOfEuler) {
  // Clamped at one end: P = π² E I / (4 L²), here per width; ν = 0.
  Session session = fresh();
  run(session, {R"({"do":"new","size":[10,1],"degree":[4,2],"net":[12,3]})",
                R"({"do":"edge","which":"u0","hold":"tangent"})",
                R"({"do":"material","model":"shell","young":1.2e6,"thickness":0.1})",
                R"({"do":"force","kind":"line","edge":"u1","vector":[-0.5,0,0]})",
                R"({"do":"buckling","count":2})"});
  const double euler = pi * pi * 1.2e6 * 1e-3 / 12 / 400 / 0.5;
  const auto found = values(session.state().buckling);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0], euler, 1e-5 * euler);
  EXPECT_NEAR(found[1], 9 * euler, 1e-3 * 9 * euler);
}

TEST(BucklingCommand, OfASupportedPlateIsThatOfTimoshenko) {
  // A square, simply supported, compressed along x: n = 4π² D / b² per length.
  Session session = fresh();
  run(session, {square, steel, R"({"do":"edge","which":"u0","components":"xz"})",
                R"({"do":"edge","which":"u1","components":"z"})",
                R"({"do":"edge","which":"v0","components":"z"})",
                R"({"do":"edge","which":"v1","components":"z"})",
                R"({"do":"pin","at":[0,0.5],"components":"y"})",
                R"({"do":"force","kind":"line","edge":"u1","vector":[-1,0,0]})",
                R"({"do":"buckling","count":1})"});
  const double exact = 4 * pi * pi * 1e6 * 1e-6 / (12 * 0.91);
  ASSERT_EQ(session.state().buckling.size(), 1U);
  EXPECT_NEAR(session.state().buckling[0].value, exact, 1e-4 * exact);
}

TEST(BucklingCommand, NamesWhatIsWrong) {
  Session session = fresh();
  run(session, {square});
  EXPECT_EQ(refusal(session, R"({"do":"buckling"})").where, "model");
  EXPECT_EQ(refusal(session, R"({"do":"modes","count":0})").where, "count");
  run(session, {R"({"do":"material","model":"shell","young":1,"thickness":0.1})"});
  EXPECT_EQ(refusal(session, R"({"do":"modes"})").where, "density");
  run(session, {R"({"do":"edge","which":"u0","hold":"tangent"})"});
  EXPECT_EQ(refusal(session, R"({"do":"buckling"})").where, "load");
  run(session, {R"({"do":"force","kind":"line","edge":"u1","vector":[1,0,0]})"});
  EXPECT_EQ(refusal(session, R"({"do":"buckling"})").where, "load");  // it pulls
}

}  // namespace
}  // namespace knead
