// Commands that place control points obey what holds the surfaces, whichever command it is.
#include "knead/hold/seams.hpp"
#include "knead/spline/extremum.hpp"
#include "session/fixes.hpp"
#include "sheet.hpp"
#include "support/error_codes.hpp"

namespace knead {
namespace {

using testing::at;
using testing::code_of;
using testing::first;
using testing::on_sheet;
using testing::refusal;
using testing::run;
using testing::same_bits;

// On sheets of size 10 by 10 with nets of 10 by 10: a pull of the middle of a block of 4 × 4 × 4
// moves all of it, and one of a corner of a fine linear block only what is near.
const std::string pull_all =
    R"({"do":"lattice","net":[4,4,4],"which":[21,22,25,26,37,38,41,42],"by":[0,0,1]})";
const std::string pull_corner =
    R"({"do":"lattice","net":[9,9,2],"degree":[1,1,1],"which":[0,1],"by":[0,0,1]})";
const std::string freeze_middle = R"({"do":"freeze","region":[[0.4,0.6],[0.4,0.6]]})";

TEST(PlacedPoints, FrozenRegionsStayUnderALattice) {
  Session session = on_sheet({freeze_middle});
  const Error error = refusal(session, pull_all);
  EXPECT_EQ(code_of(error), ErrorCode::point_frozen) << error.message();
  EXPECT_EQ(error.where, "lattice");
  EXPECT_EQ(session.moved_control_points(0), 0);
  run(session, {pull_corner});
  EXPECT_GT(session.moved_control_points(0), 0);
}

TEST(PlacedPoints, FrozenRegionsStayWhereWeightsAndKnotsChange) {
  for (const char* json :
       {R"({"do":"weights","which":[44],"weight":2})",
        R"({"do":"knots","direction":"u","knots":[0,0,0,0,0.1,0.3,0.35,0.4,0.7,0.75,1,1,1,1]})"}) {
    Session session = on_sheet({R"({"do":"points","which":[44],"by":[0,0,3]})"});
    const Surface before = *first(session).current;
    Session frozen = on_sheet({R"({"do":"points","which":[44],"by":[0,0,3]})", freeze_middle});
    run(session, {json});
    EXPECT_GT(largest_distance(*first(session).current, before), 1e-3) << json;
    const ErrorCode code = code_of(refusal(frozen, json));
    EXPECT_TRUE(code == ErrorCode::point_frozen || code == ErrorCode::region_frozen) << json;
    EXPECT_TRUE(same_bits(*first(frozen).current, before)) << json;
    // What leaves the shape as it is may change the net.
    run(frozen, {R"({"do":"refine","region":[[0,1],[0,1]]})", R"({"do":"elevate","by":[1,0]})"});
  }
}

TEST(PlacedPoints, CoarseningAFrozenRegionIsRefusedWhereItWouldMoveIt) {
  const std::string bump = R"({"do":"points","which":[44],"by":[0,0,0.01]})",
                    coarse = R"({"do":"coarsen","tolerance":0.1})";
  Session session = on_sheet({bump}), frozen = on_sheet({bump, freeze_middle});
  const Surface before = *first(session).current;
  run(session, {coarse});
  ASSERT_GT(largest_distance(*first(session).current, before), 1e-4);
  const Error error = refusal(frozen, coarse);
  EXPECT_EQ(code_of(error), ErrorCode::region_frozen) << error.message();
}

TEST(PlacedPoints, TheLimitStandsUnderALattice) {
  Session session = on_sheet({R"({"do":"limit","distance":0.1})"});
  EXPECT_EQ(code_of(refusal(session, pull_all)), ErrorCode::beyond_limit);
  EXPECT_EQ(session.largest_displacement(0), 0);
  // What is beyond it may come nearer.
  Session beyond = on_sheet({pull_all, R"({"do":"limit","distance":0.1})"});
  run(beyond,
      {R"({"do":"lattice","net":[4,4,4],"which":[21,22,25,26,37,38,41,42],"by":[0,0,-0.2]})"});
  EXPECT_EQ(code_of(refusal(beyond, pull_all)), ErrorCode::beyond_limit);
}

TEST(PlacedPoints, SymmetriesStandUnderALattice) {
  Session session = on_sheet({R"({"do":"symmetry","mirror":"u"})"});
  EXPECT_NE(refusal(session, pull_corner).message().find("symmetry would be lost"),
            std::string::npos);
  run(session, {pull_all});
}

TEST(PlacedPoints, WhatALatticeMovesIsHeldInItsNewPlace) {
  Session session = on_sheet({R"({"do":"edge","hold":"tangent"})", R"({"do":"hold","rows":1})",
                              R"({"do":"pin","control_points":[[4,4]]})",
                              R"({"do":"pin","at":[0.3,0.6]})", pull_all});
  EXPECT_GT(at(*first(session).current, 0.5, 0.5)[2], 0.1);
  const Surface before = *first(session).current;
  run(session, {R"({"do":"step","count":3})"});
  EXPECT_LT(largest_distance(*first(session).current, before), 1e-12);
}

/// Two sheets side by side along x = 5, whose nets along it differ.
const std::vector<std::string> two_sheets = {
    R"({"do":"new","net":[6,6],"size":[5,5]})",
    R"({"do":"new","net":[6,9],"size":[5,5],"position":[5,0,0]})",
    R"({"do":"select","surfaces":["#1","#2"]})"};

double gap_between(const Session& session) {
  const auto& surfaces = session.state().surfaces;
  const Surface* const sheets[] = {surfaces[0].current.get(), surfaces[1].current.get()};
  const auto seams = find_seams(sheets, 0.1);
  return seams && seams->seams.size() == 1 ? seams->seams[0].gap : INFINITY;
}

TEST(PlacedPoints, SeamsStayClosedUnderALattice) {
  Session session = testing::fresh();
  run(session, two_sheets);
  ASSERT_LT(gap_between(session), 1e-14);
  const std::string pull =
      R"({"do":"lattice","net":[4,7,4],"which":[37,38,65,66],"by":[0.2,0.1,2]})";
  Session never = testing::fresh();
  run(never, two_sheets);
  run(never, {R"({"do":"refine","permission":"never"})"});
  const Error error = refusal(never, pull);
  EXPECT_EQ(code_of(error), ErrorCode::seam_would_open) << error.message();
  EXPECT_EQ(never.largest_displacement(0), 0);
  for (const Fix& fix : fixes_for(*error.diagnostic)) ASSERT_TRUE(never.act(fix.commands));
  run(never, {pull});
  EXPECT_GT(gap_between(never), 1e-4);

  run(session, {pull});
  EXPECT_GT(session.largest_displacement(0), 0.1);
  EXPECT_LT(gap_between(session), 1e-14);
}

TEST(PlacedPoints, SymmetriesStandWhereALatticeUnitesTheKnotsOfSeams) {
  Session session = testing::fresh();
  run(session, two_sheets);
  run(session, {R"({"do":"select","surface":"#1"})", R"({"do":"symmetry","mirror":"v"})",
                R"({"do":"select","surfaces":["#1","#2"]})"});
  const Error error =
      refusal(session, R"({"do":"lattice","net":[4,7,4],"which":[37,38,65,66],"by":[0.2,0.1,2]})");
  EXPECT_NE(error.message().find("symmetry would be lost"), std::string::npos) << error.message();
}

}  // namespace
}  // namespace knead
