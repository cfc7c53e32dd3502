#include <gtest/gtest.h>

#include "sheet.hpp"

namespace knead {
namespace {

using testing::at;
using testing::first;
using testing::fresh;
using testing::new_sheet;
using testing::refusal;
using testing::run;
using testing::same_state;

// Constraints on single coordinates, on sheets of size 10 by 10 with nets of 10 by 10. Edge v0 has
// the control points 10 i.

constexpr const char* pull_load = R"({"do":"load","vector":[1,2,3]})";

Session dragged_sheet(const std::vector<std::string>& constraints) {
  Session session = fresh();
  run(session, {new_sheet});
  run(session, constraints);
  run(session, {pull_load, R"({"do":"step","count":3})"});
  return session;
}

/// Of control point k: which coordinates kept their bits.
Components kept_components(const Session& session, int k) {
  const auto now = first(session).current->control_points().row(k),
             then = first(session).opened->control_points().row(k);
  return {now[0] == then[0], now[1] == then[1], now[2] == then[2]};
}

TEST(Components, OfAnEdgeKeepTheirBitsAndTheOthersMove) {
  const Session session = dragged_sheet({R"({"do":"edge","which":"v0","components":"xz"})"});
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(kept_components(session, 10 * i), (Components{true, false, true})) << i;
    EXPECT_EQ(kept_components(session, 10 * i + 1), (Components{})) << i;
  }
}

TEST(Components, OfAClampedEdgeHoldItsSlopeToo) {
  const Session session =
      dragged_sheet({R"({"do":"edge","which":"v0","hold":"tangent","components":"zy"})"});
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(kept_components(session, 10 * i), (Components{false, true, true})) << i;
    EXPECT_EQ(kept_components(session, 10 * i + 1), (Components{false, true, true})) << i;
    EXPECT_EQ(kept_components(session, 10 * i + 2), (Components{})) << i;
  }
}

TEST(Components, OfOneLoadMoveAsInTheModelWithoutTheOthers) {
  // Coordinates of the linear model are independent: x and z move as with the whole edge held, y as
  // with a free one.
  const Session some = dragged_sheet(
      {R"({"do":"edge","which":"u0"})", R"({"do":"edge","which":"v0","components":"xz"})"});
  const Session all =
      dragged_sheet({R"({"do":"edge","which":"u0"})", R"({"do":"edge","which":"v0"})"});
  const Session none = dragged_sheet({R"({"do":"edge","which":"u0"})"});
  const auto column = [](const Session& s, int c) {
    return first(s).current->control_points().col(c).eval();
  };
  // 1e-12 of lengths up to 10: the condition of the factored matrix with lambda 1 is below 1e4.
  EXPECT_LT((column(some, 0) - column(all, 0)).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_LT((column(some, 1) - column(none, 1)).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_LT((column(some, 2) - column(all, 2)).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_GT((column(all, 1) - column(none, 1)).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Components, OfAPinHoldThePointInThemAlone) {
  const Session session = dragged_sheet({R"({"do":"pin","at":[0.4,0.3],"components":"z"})"});
  const Point now = at(*first(session).current, 0.4, 0.3),
              then = at(*first(session).opened, 0.4, 0.3);
  EXPECT_NEAR(now[2], then[2], 1e-13);
  EXPECT_GT(now[0] - then[0], 1e-3);
  EXPECT_GT(now[1] - then[1], 1e-3);
}

TEST(Components, OfAPinThatMovesGoThereAlone) {
  const Session session =
      dragged_sheet({R"({"do":"edge","which":"u0"})",
                     R"({"do":"pin","at":[0.6,0.3],"to":[99,99,0.5],"components":"z"})"});
  const Point now = at(*first(session).current, 0.6, 0.3);
  EXPECT_NEAR(now[2], 0.5, 1e-12);
  EXPECT_LT(now[0], 20);
}

TEST(Components, OfAnEdgeAreHeldAndFreedOneByOne) {
  Session session = fresh();
  run(session, {new_sheet, R"({"do":"edge","which":"v0"})",
                R"({"do":"edge","which":"v0","hold":"open","components":"x"})",
                R"({"do":"edge","which":"v0","hold":"tangent","components":"z"})", pull_load,
                R"({"do":"step"})"});
  EXPECT_EQ(kept_components(session, 30), (Components{false, true, true}));
  EXPECT_EQ(kept_components(session, 31), (Components{false, false, true}));
  run(session, {R"({"do":"edge","which":"v0","hold":"open"})"});
  EXPECT_TRUE(first(session).constraints.empty());
}

TEST(Components, WhatNothingHoldsHasNoEquilibrium) {
  Session session = fresh();
  run(session, {new_sheet, R"({"do":"edge","which":"u0","components":"xz"})"});
  const std::string to_equilibrium = R"({"do":"evolve","mode":"static"})";
  EXPECT_NE(refusal(session, to_equilibrium).message().find("nothing holds the model in place"),
            std::string::npos);
  run(session, {R"({"do":"edge","which":"v0","components":"y"})", to_equilibrium});
}

TEST(Components, AreUndoneAndInSnapshots) {
  Session session = fresh();
  run(session, {new_sheet, R"({"do":"edge","which":"v1"})"});
  const SessionState before = session.state();
  run(session, {R"({"do":"edge","which":"v1","hold":"tangent","components":"xz"})",
                R"({"do":"pin","at":[0.5,0.5],"components":"y"})"});
  const auto restored = Session::restore(session.document(), session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_TRUE(same_state(session.state(), restored->state()));
  EXPECT_EQ(first(session).constraints.size(), 3U);
  run(session, {R"({"do":"undo"})"});
  run(session, {R"({"do":"undo"})"});
  EXPECT_TRUE(same_state(session.state(), before));
}

TEST(Components, NamesWhatIsWrong) {
  Session session = fresh();
  run(session, {new_sheet});
  for (const char* text : {"", "w", "xx", "xyzx", "x z"}) {
    const Error error = refusal(
        session, std::string(R"({"do":"edge","which":"v0","components":")") + text + R"("})");
    EXPECT_EQ(error.where, "components") << text;
  }
  EXPECT_EQ(refusal(session, R"({"do":"edge","edge":"#4","components":"x"})").where, "components");
  EXPECT_EQ(refusal(session, R"({"do":"pin","control_points":[[0,0]],"components":"x"})").where,
            "components");
}

}  // namespace
}  // namespace knead
