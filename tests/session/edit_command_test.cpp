#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "knead/spline/extremum.hpp"
#include "sheet.hpp"

namespace knead {
namespace {

using testing::at;
using testing::first;
using testing::fresh;
using testing::on_sheet;
using testing::open_sample;
using testing::refusal;
using testing::run;
using testing::same_bits;
using testing::same_state;

// Editing control points, weights and knots by hand, on sheets of size 10 by 10 with nets of 10
// by 10.

/// Nothing is left to do: what was made by hand stays under steps, to rounding.
void expect_at_rest(Session& session) {
  const Surface before = *first(session).current;
  run(session, {R"({"do":"step","count":3})"});
  EXPECT_LT(largest_distance(*first(session).current, before), 1e-12);
}

TEST(PointsCommand, OnlyNamedPointsChangeABitAndTheShapeStays) {
  Session session = on_sheet();
  const Points before = first(session).current->control_points();
  run(session, {R"({"do":"points","which":[44,45],"by":[0.1,0,1.7]})"});
  const SceneSurface& s = first(session);
  for (Eigen::Index k = 0; k < before.rows(); ++k) {
    const Eigen::RowVector3d expected =
        before.row(k) +
        (k == 44 || k == 45 ? Eigen::RowVector3d(0.1, 0, 1.7) : Eigen::RowVector3d(0, 0, 0));
    EXPECT_EQ(s.current->control_points().row(k), expected) << k;
  }
  EXPECT_EQ(s.rest, s.current);
  EXPECT_NE(s.opened, s.current);
  EXPECT_EQ(session.moved_control_points(0), 2);
  EXPECT_EQ(*session.energy(), 0);
  expect_at_rest(session);
}

TEST(PointsCommand, RowsAndPlacesAreTakenInOrderEachOnce) {
  Session session = fresh();
  run(session, {R"({"do":"new","net":[4,5]})",
                R"({"do":"points","which":[7],"rows_u":[1],)"
                R"("to":[[7,0,0],[5,0,0],[6,0,0],[8,0,0],[9,0,-0.0]]})",
                R"({"do":"points","rows_v":[4],"rows_u":[3],"by":[0,0,2],"relative":true})"});
  const Points& p = first(session).current->control_points();
  for (int k = 5; k < 9; ++k) EXPECT_EQ(p.row(k)[0], k);
  const double diagonal = bounding_box(*first(session).reference).diagonal();
  for (int k = 0; k < 20; ++k)
    EXPECT_EQ(p.row(k)[2], k % 5 == 4 || k >= 15 ? 2 * diagonal : 0) << k;
  run(session, {R"({"do":"points","which":[0],"to":[[-0.0,0.1,3]]})"});
  EXPECT_TRUE(std::signbit(first(session).current->control_points()(0, 0)));
}

TEST(PointsCommand, WhatIsDisplacedStaysDisplacedByAsMuch) {
  Session session = on_sheet({testing::ball, R"({"do":"step","count":5})"});
  const Points displaced =
      first(session).current->control_points() - first(session).rest->control_points();
  const double energy = *session.energy();
  ASSERT_GT(energy, 0);
  run(session, {R"({"do":"points","rows_u":[2,3],"by":[0,0.5,-1]})"});
  const Points after =
      first(session).current->control_points() - first(session).rest->control_points();
  EXPECT_LT((after - displaced).cwiseAbs().maxCoeff(),
            16 * std::numeric_limits<double>::epsilon() * 10);
  EXPECT_NEAR(*session.energy(), energy, 1e-12 * energy);
}

TEST(PointsCommand, HandsMoveWhatIsHeldAndItIsHeldThere) {
  Session session =
      on_sheet({R"({"do":"edge","hold":"tangent"})", R"({"do":"hold","rows":1})",
                R"({"do":"pin","control_points":[[4,4]]})", R"({"do":"pin","at":[0.3,0.6]})",
                R"({"do":"points","which":[5,44,26,36],"by":[0,0,1]})"});
  expect_at_rest(session);
  EXPECT_GT(at(*first(session).current, 0, 0.55)[2], 0.1);
}

TEST(PointsCommand, FrozenRegionsSymmetriesAndLimitsStand) {
  Session session = on_sheet({R"({"do":"freeze","region":[[0.4,0.6],[0.4,0.6]]})"});
  const Error frozen = refusal(session, R"({"do":"points","which":[1,44],"by":[0,0,1]})");
  EXPECT_NE(frozen.message().find("44 (4, 4) is frozen"), std::string::npos) << frozen.message();
  EXPECT_EQ(frozen.where, "points");
  run(session, {R"({"do":"points","which":[1],"by":[0,0,1]})"});

  Session mirrored = on_sheet({R"({"do":"symmetry","mirror":"u"})"});
  EXPECT_NE(
      refusal(mirrored, R"({"do":"points","which":[22],"by":[0,0,1]})").message().find("symmetry"),
      std::string::npos);
  run(mirrored, {R"({"do":"points","which":[22,72],"by":[0,0,1]})"});
  EXPECT_NE(refusal(mirrored, R"({"do":"points","which":[22,72],"by":[1,0,0]})")
                .message()
                .find("symmetry"),
            std::string::npos);
  expect_at_rest(mirrored);

  Session limited = on_sheet({R"({"do":"limit","distance":0.5})"});
  const Error far = refusal(limited, R"({"do":"points","which":[44],"by":[0,0,5]})");
  EXPECT_EQ(far.where, "points");
  EXPECT_NE(far.message().find("0.5 is the limit"), std::string::npos) << far.message();
  run(limited, {R"({"do":"points","which":[44],"by":[0,0,1]})"});
  EXPECT_LE(limited.largest_displacement(0), 0.5);
}

TEST(PointsCommand, RefusesWithThePlace) {
  Session session = on_sheet();
  for (const auto& [fields, where] : std::vector<std::pair<std::string, std::string>>{
           {R"("by":[0,0,1])", "which"},
           {R"("which":[],"by":[0,0,1])", "which"},
           {R"("which":[3,100],"by":[0,0,1])", "which[1]"},
           {R"("which":[-1],"by":[0,0,1])", "which[0]"},
           {R"("rows_u":[0,10],"by":[0,0,1])", "rows_u[1]"},
           {R"("rows_v":[-1],"by":[0,0,1])", "rows_v[0]"},
           {R"("which":[1])", "by"},
           {R"("which":[1],"by":[0,0,1],"to":[[0,0,1]])", "by"},
           {R"("which":[1,2],"to":[[0,0,1]])", "to"},
           {R"("which":[1,1],"to":[[0,0,1],[0,0,1]])", "to"},
           {R"("which":[1],"to":[[0,0,1]],"relative":true)", "relative"},
           {R"("which":[1],"by":[1e308,0,1e308],"relative":true)", "by"}}) {
    const Error e = refusal(session, R"({"do":"points",)" + fields + "}");
    EXPECT_EQ(e.kind, ErrorKind::input) << fields;
    EXPECT_EQ(e.where.substr(0, where.size()), where) << fields << ": " << e.message();
    EXPECT_FALSE(e.remedy.empty()) << e.message();
  }
  Session two = open_sample();
  EXPECT_NE(refusal(two, R"({"do":"points","which":[1],"by":[0,0,1]})").remedy.find("select"),
            std::string::npos);
  run(two, {R"({"do":"select","surfaces":["#285","#1044"]})"});
  for (const char* json :
       {R"({"do":"points","which":[1],"by":[0,0,1]})", R"({"do":"weights","which":[1],"weight":2})",
        R"({"do":"knots","direction":"u","knots":[0,1]})"}) {
    EXPECT_NE(refusal(two, json).message().find("2 surfaces are selected"), std::string::npos);
  }
}

TEST(WeightsCommand, PullTheSurfaceToThePointForGood) {
  Session session = on_sheet({R"({"do":"points","which":[44],"by":[0,0,2]})"});
  const Points points = first(session).current->control_points();
  const auto opened = first(session).opened;
  const double before = at(*first(session).current, 0.45, 0.45)[2];
  run(session,
      {R"({"do":"weights","which":[44],"weight":4})", R"({"do":"weights","rows_v":[4],"by":0.5})"});
  const SceneSurface& s = first(session);
  ASSERT_TRUE(s.current->rational());
  for (int k = 0; k < 100; ++k) {
    EXPECT_EQ(s.current->weights()[static_cast<std::size_t>(k)], k == 44       ? 2
                                                                 : k % 10 == 4 ? 0.5
                                                                               : 1)
        << k;
  }
  EXPECT_TRUE(same_bits(s.current->control_points(), points));
  EXPECT_GT(at(*s.current, 0.45, 0.45)[2], before);
  EXPECT_EQ(s.rest, s.current);
  EXPECT_EQ(s.opened, opened) << "deviations are measured from what was opened";
  EXPECT_EQ(*session.energy(), 0);
  EXPECT_EQ(session.moved_control_points(0), 10);
  expect_at_rest(session);
  run(session,
      {R"({"do":"refine","region":[[0,1],[0,1]]})", R"({"do":"coarsen","tolerance":1e-9})"});
  EXPECT_EQ(first(session).opened, opened);
  run(session, {testing::ball, R"({"do":"step","count":3})"});
  EXPECT_EQ(session.largest_displacement(0), session.state().steps.back().largest_displacement);
}

TEST(WeightsCommand, MakeAQuarterOfACylinderOfASheet) {
  Session session = fresh();
  run(session, {R"({"do":"new","degree":[2,1],"net":[3,2],)"
                R"("points":[[1,0,0],[1,0,1],[1,1,0],[1,1,1],[0,1,0],[0,1,1]]})",
                R"({"do":"weights","rows_u":[1],"weight":0.70710678118654757})"});
  const Surface& s = *first(session).current;
  for (double a : {0., 0.1, 0.5, 0.8, 1.}) {
    const Point p = at(s, a, 0.3);
    EXPECT_NEAR(std::hypot(p.x(), p.y()), 1, 4 * std::numeric_limits<double>::epsilon());
  }
  // From the parabola before, at equal parameters.
  double largest = 0;
  for (int k = 0; k <= 100000; ++k) {
    const double u = k / 1e5, a = (1 - u) * (1 - u), b = 2 * u * (1 - u), c = u * u,
                 w = std::sqrt(0.5);
    const double x = (a + b * w) / (a + b * w + c) - (a + b),
                 y = (b * w + c) / (a + b * w + c) - (b + c);
    largest = std::max(largest, std::hypot(x, y));
  }
  EXPECT_NEAR(session.largest_displacement(0), largest, 1e-9);
}

TEST(WeightsCommand, OfAFilesSurfaceAreSavedAndReadBack) {
  Session session = open_sample();
  run(session, {R"({"do":"select","surface":"#285"})", R"({"do":"hold","mode":"open"})",
                R"({"do":"weights","which":[60,61],"weight":3})"});
  ASSERT_FALSE(first(session).opened->rational());
  const auto saved = step::File::parse(*session.save(), "saved");
  ASSERT_TRUE(saved) << saved.error().message();
  EXPECT_TRUE(same_bits(saved->model().find_surface("#285")->surface, *first(session).current));
  EXPECT_EQ(saved->surfaces().size(), session.document().surfaces().size());
  EXPECT_TRUE(saved->model().unreadable.empty());
}

TEST(KnotsCommand, ChangeTheShapeForGoodAndAreSaved) {
  Session session = open_sample();
  run(session, {R"({"do":"select","surface":"#285"})", R"({"do":"hold","mode":"open"})"});
  const KnotVector before = first(session).current->knots(0);
  std::vector<double> knots(before.knots().begin(), before.knots().end());
  const auto middle = static_cast<std::size_t>(before.count() + before.degree()) / 2;
  knots[middle] = 0.5 * (knots[middle] + knots[middle + 1]);
  ASSERT_TRUE(session.execute(make_command(KnotsCommand{"u", knots})));
  EXPECT_TRUE(std::ranges::equal(first(session).current->knots(0).knots(), knots));
  EXPECT_EQ(first(session).rest, first(session).current);
  EXPECT_GT(session.largest_displacement(0), 0);
  EXPECT_EQ(session.moved_control_points(0), first(session).current->size());
  const auto saved = step::File::parse(*session.save(), "saved");
  ASSERT_TRUE(saved) << saved.error().message();
  EXPECT_TRUE(same_bits(saved->model().find_surface("#285")->surface, *first(session).current));
  Session replay = open_sample();
  for (const Command& c : session.journal())
    ASSERT_TRUE(replay.execute(*parse_command(to_json(c))));
  EXPECT_TRUE(same_state(replay.state(), session.state()));
}

TEST(KnotsCommand, KeepConstraintsWhereTheyLead) {
  Session session = fresh();
  run(session, {R"({"do":"new","size":[10,10],"degree":[2,2],"net":[5,5]})",
                R"({"do":"edge","hold":"tangent"})", R"({"do":"points","which":[12],"by":[0,0,1]})",
                R"({"do":"knots","direction":"v","knots":[0,0,0,0.2,0.9,1,1,1]})"});
  expect_at_rest(session);
  run(session, {R"({"do":"symmetry","mirror":"u"})"});
  EXPECT_FALSE(session.state().surfaces.front().constraints.empty());
  const Error e =
      refusal(session, R"({"do":"knots","direction":"u","knots":[0,0,0,0.2,0.9,1,1,1]})");
  EXPECT_EQ(e.kind, ErrorKind::input) << "the mirror image would have other knots";
}

TEST(BasisCommands, RefuseWithThePlace) {
  Session session = fresh();
  run(session, {R"({"do":"new","degree":[2,2],"net":[5,5]})"});
  for (const auto& [json, where] : std::vector<std::pair<std::string, std::string>>{
           {R"({"do":"weights","weight":2})", "which"},
           {R"({"do":"weights","which":[25],"weight":2})", "which[0]"},
           {R"({"do":"weights","which":[1]})", "weight"},
           {R"({"do":"weights","which":[1],"weight":2,"by":3})", "weight"},
           {R"({"do":"weights","which":[1],"weight":0})", "weight"},
           {R"({"do":"weights","which":[1],"weight":-1})", "weight"},
           {R"({"do":"weights","which":[1],"by":0})", "by"},
           {R"({"do":"knots","direction":"w","knots":[0,0,0,0.2,0.9,1,1,1]})", "direction"},
           {R"({"do":"knots","direction":"u","knots":[0,0,0,0.2,1,1,1]})", "knots"},
           {R"({"do":"knots","direction":"u","knots":[0,0,0,0.9,0.2,1,1,1]})", "knots"},
           {R"({"do":"knots","direction":"u","knots":[0,0,0,0,0,1,1,1]})", "knots"},
           {R"({"do":"knots","direction":"u","knots":[0,0,0,0.2,0.9,2,2,2]})", "knots"}}) {
    const Error e = refusal(session, json);
    EXPECT_EQ(e.kind, ErrorKind::input) << json;
    EXPECT_EQ(e.where.substr(0, where.size()), where) << json << ": " << e.message();
    EXPECT_FALSE(e.remedy.empty()) << e.message();
  }
  run(session, {R"({"do":"weights","which":[1],"by":1e30})"});
  EXPECT_EQ(refusal(session, R"({"do":"weights","which":[1],"by":1e30})").where, "by");
  EXPECT_EQ(refusal(session, R"({"do":"weights","which":[1],"by":1e300})").where, "by");
  run(session, {R"({"do":"undo"})"});
  EXPECT_FALSE(first(session).current->rational());
  Session torn = fresh();
  run(torn, {R"({"do":"new","degree":[2,2],"net":[6,5]})"});
  EXPECT_NE(refusal(torn, R"({"do":"knots","direction":"u","knots":[0,0,0,0.5,0.5,0.5,1,1,1]})")
                .message()
                .find("torn"),
            std::string::npos);
}

TEST(BasisCommands, AndALimitExcludeEachOther) {
  Session session = on_sheet({R"({"do":"limit","distance":1})"});
  EXPECT_NE(refusal(session, R"({"do":"weights","which":[44],"weight":2})").remedy.find("limit"),
            std::string::npos);
  run(session, {R"({"do":"limit"})", R"({"do":"weights","which":[44],"weight":2})"});
  EXPECT_EQ(refusal(session, R"({"do":"limit","distance":1})").where, "limit");
}

}  // namespace
}  // namespace knead
