#include <gtest/gtest.h>

#include <cmath>

#include "scene/shell_fields.hpp"
#include "sheet.hpp"

namespace knead {
namespace {

using testing::fresh;
using testing::run;

// A strip 10 long and 1 wide, t = 0.1, E = 1.2e6, ν = 0, clamped at u = 0, under small loads.

Session strip(const std::vector<std::string>& load,
              const std::vector<std::string>& holds = {
                  R"({"do":"edge","which":"u0","hold":"tangent"})"}) {
  Session session = fresh();
  run(session, {R"({"do":"new","size":[10,1],"net":[12,4]})"});
  run(session, holds);
  run(session, {R"({"do":"material","model":"shell","young":1.2e6,"thickness":0.1})",
                R"({"do":"evolve","mode":"static"})"});
  run(session, load);
  run(session, {R"({"do":"step"})"});
  return session;
}

ShellPointResults results_at(const Session& session, double s, double t) {
  const auto read = read_shell(session.state(), 0, {s, t});
  if (read && *read) return **read;
  ADD_FAILURE() << "there are no results";
  return {};
}

TEST(ShellResults, OfAStretchedStripAreUniform) {
  // n = 1e-3 per length: the strain is n / (E t) = 8.3e-9, and what is not linear in it of that
  // share. Nothing is clamped, which would keep the strain at the edge from being that.
  const Session session = strip({R"({"do":"force","kind":"line","edge":"u1","vector":[1e-3,0,0]})"},
                                {R"({"do":"edge","which":"u0","hold":"position"})",
                                 R"({"do":"edge","which":"u1","components":"z"})"});
  for (const double s : {0.1, 0.5, 0.95}) {
    const ShellPointResults r = results_at(session, s, 0.3);
    EXPECT_NEAR(r.membrane[0], 1e-3, 1e-9);
    EXPECT_NEAR(r.membrane[1], 0, 1e-9);
    EXPECT_NEAR(r.von_mises[0], 1e-2, 1e-8);
    EXPECT_NEAR(r.von_mises[1], 1e-2, 1e-8);
    EXPECT_NEAR(r.bending_strain, 0, 1e-9);
  }
}

TEST(ShellResults, OfABentStripAreThoseOfABeam) {
  // A moment m on its end: the bending moment is m everywhere, σ = 6 m / t², t/2 κ = 6 m / (E t²).
  const Session session = strip({R"({"do":"force","kind":"moment","edge":"u1","moment":1e-3})"});
  const ShellPointResults r = results_at(session, 0.4, 0.5);
  EXPECT_NEAR(std::max(std::abs(r.moment[0]), std::abs(r.moment[1])), 1e-3, 1e-8);
  EXPECT_NEAR(r.von_mises[0], 0.6, 1e-5);
  EXPECT_NEAR(r.von_mises[1], 0.6, 1e-5);
  EXPECT_NEAR(r.bending_strain, 0.6 / 1.2e6, 1e-11);
}

TEST(ShellResults, ReactionsBalanceTheLoad) {
  const Session session =
      strip({R"({"do":"force","kind":"line","edge":"u1","vector":[1e-3,0,2e-4]})",
             R"({"do":"load","vector":[0,1e-4,0]})"});
  const auto reactions = hold_reactions(session.state());
  ASSERT_TRUE(reactions) << reactions.error().message();
  ASSERT_EQ(reactions->size(), 1U);
  EXPECT_EQ(reactions->front().hold, "edge u0");
  EXPECT_LT((reactions->front().force - Point(-1e-3, -1e-3, -2e-4)).norm(), 1e-9);
}

TEST(ShellResults, AreThoseOfShellsAlone) {
  Session session = fresh();
  run(session, {R"({"do":"new","size":[1,1]})"});
  const auto read = read_shell(session.state(), 0, {0.5, 0.5});
  ASSERT_TRUE(read);
  EXPECT_FALSE(*read);
  const auto grid = result_grid(session.state().surfaces.front(), 3);
  ASSERT_TRUE(grid);
  ASSERT_EQ(grid->fields.size(), 1U);
  EXPECT_EQ(grid->fields.front().name, "displacement");
  EXPECT_FALSE(result_grid(session.state().surfaces.front(), 1));
}

TEST(ShellResults, AreWrittenForParaView) {
  const Session session =
      strip({R"({"do":"force","kind":"line","edge":"u1","vector":[1e-3,0,0]})"});
  const auto grid = result_grid(session.state().surfaces.front(), 3);
  ASSERT_TRUE(grid) << grid.error().message();
  const std::string text = vtu_text({&*grid, 1});
  for (const char* part :
       {"NumberOfPoints=\"9\" NumberOfCells=\"4\"", "Name=\"von_mises\" NumberOfComponents=\"2\"",
        "Name=\"displacement\" NumberOfComponents=\"3\"", "0 3 4 1\n", "</VTKFile>"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  }
}

}  // namespace
}  // namespace knead
