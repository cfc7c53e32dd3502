// Surfaces that are locked.
#include "sheet.hpp"

namespace knead {
namespace {

using testing::fresh;
using testing::refusal;
using testing::run;

const char* const press = R"({"do":"tool","radius":2,"position":[2,5,1]})";

/// Three sheets side by side, each of which seams connect with the next.
Session three_sheets() {
  Session session = fresh();
  run(session,
      {R"({"do":"new","size":[10,10]})", R"({"do":"new","size":[10,10],"position":[10,0,0]})",
       R"({"do":"new","size":[10,10],"position":[20,0,0]})"});
  return session;
}

const Points& points_of(const Session& session, std::size_t surface) {
  return session.state().surfaces[surface].current->control_points();
}

TEST(LockCommand, WhatIsLockedCannotBeSelectedAndIsSelectedNoLonger) {
  Session session = three_sheets();
  run(session, {R"({"do":"select","surfaces":["#1","#2"]})", R"({"do":"lock","surfaces":["#1"]})"});
  EXPECT_EQ(session.state().selection(), std::vector<int>{1});
  EXPECT_EQ(refusal(session, R"({"do":"select","surface":"#1"})").where, "surface");
  EXPECT_EQ(refusal(session, R"({"do":"select","surfaces":["#2","#1"]})").where, "surfaces");
  run(session, {R"({"do":"lock"})"});
  EXPECT_FALSE(session.state().selected);
  EXPECT_NE(refusal(session, R"({"do":"step"})").what.find("none of the 3"), std::string::npos);
  EXPECT_NE(refusal(session, R"({"do":"lock"})").what.find("none of the 3"), std::string::npos);
  run(session,
      {R"({"do":"lock","surfaces":["#1"],"locked":false})", R"({"do":"select","surface":"#1"})"});
  EXPECT_EQ(refusal(session, R"({"do":"lock","surfaces":["#9"]})").where, "surfaces");
}

TEST(LockCommand, NothingMovesWhatIsLocked) {
  Session session = three_sheets();
  const Points second = points_of(session, 1);
  run(session,
      {R"({"do":"lock","surfaces":["#2"]})", R"({"do":"select","surface":"#1","connected":true})"});
  EXPECT_EQ(session.state().selection(), std::vector<int>{0}) << "#3 is connected through #2";
  ASSERT_EQ(session.state().notes.size(), 1U);
  EXPECT_NE(std::string(session.state().notes[0]).find("#2"), std::string::npos);
  run(session, {R"({"do":"hold","rows":1})", press, R"({"do":"step","count":3})"});
  EXPECT_GT(session.largest_displacement(0), 0.1);
  EXPECT_TRUE(points_of(session, 1) == second);
}

TEST(LockCommand, IsKeptBySnapshotsAndUndone) {
  Session session = three_sheets();
  run(session, {R"({"do":"lock","surfaces":["#2"]})"});
  const auto again = Session::restore(session.document(), session.snapshot());
  ASSERT_TRUE(again) << again.error().message();
  EXPECT_TRUE(again->state().surfaces[1].locked);
  run(session, {R"({"do":"undo"})"});
  EXPECT_FALSE(session.state().surfaces[1].locked);
}

}  // namespace
}  // namespace knead
