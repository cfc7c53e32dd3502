// Edges that follow their faces: what moves, what is written, what is refused, and what is said.

#include "brep/shared_edge.hpp"
#include "scene/followed.hpp"
#include "session/running.hpp"
#include "support/error_codes.hpp"

namespace knead {
namespace {

using testing::both;
using testing::opened;
using testing::press;
using testing::run;
using testing::run_on;
using testing::two_sheets;
using testing::TwoSheets;

std::string edge_command(const TwoSheets& sheets, const std::string& hold) {
  return R"({"do":"edge","which":")" + TwoSheets::name(sheets.edge) + R"(","hold":")" + hold +
         R"("})";
}

TEST(FollowCommands, AnEdgeFreedInVersion2MovesWithItsFacesAndStaysClosed) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  const auto status = run(session, both + "," + edge_command(sheets, "follow") + "," + press);
  ASSERT_TRUE(status) << status.error().message();
  const SessionState& state = session.state();
  ASSERT_EQ(state.followed.size(), 1U);
  const auto apart = parting(state, *state.followed[0].course);
  ASSERT_TRUE(apart);
  EXPECT_LE(apart->distance, apart->tolerance);
  const auto sample = state.followed[0].course->at(0.5);
  for (const auto& s : state.surfaces) {
    const auto way = displacement_at(*s.opened, *s.current, sample.feet[s.id == "#10" ? 0 : 1]);
    ASSERT_TRUE(way);
    EXPECT_NEAR(way->z(), -0.04, 0.004);
  }
  const auto bytes = session.save();
  ASSERT_TRUE(bytes) << bytes.error().message();
  const auto edge =
      SharedEdge::create(testing::parse_or_die(*bytes).model(), TwoSheets::name(sheets.edge));
  ASSERT_TRUE(edge) << edge.error().message();
  EXPECT_LE(edge->gap(), 2 * apart->tolerance);
  EXPECT_NEAR(edge->at(0.5).point.z(), -0.04, 0.004);
}

/// Without seams, which would keep tangent planes common by themselves where both nets are alike.
const std::string no_seams = R"({"do":"seams","couple":false})";

Parting parted(const Session& session) {
  const auto apart = parting(session.state(), *session.state().followed.at(0).course);
  EXPECT_TRUE(apart);
  return apart.value_or(Parting{});
}

TEST(FollowCommands, ASmoothEdgeStaysSmooth) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  const auto status =
      run(session, both + "," + edge_command(sheets, "follow") + "," + no_seams + "," + press);
  ASSERT_TRUE(status) << status.error().message();
  EXPECT_TRUE(is_smooth(*session.state().followed[0].course));
  const Parting apart = parted(session);
  EXPECT_LE(apart.angle, asked_angle);
  EXPECT_LE(apart.distance, apart.tolerance);
  const auto sample = session.state().followed[0].course->at(0.5);
  const SceneSurface& s = session.state().surfaces[0];
  EXPECT_NEAR(displacement_at(*s.opened, *s.current, sample.feet[0])->z(), -0.04, 0.004);
  EXPECT_GT(angle_between_planes(*normal_at_foot(*s.current, {0.85, 0.5}), Point::UnitZ()), 0.05);
}

TEST(FollowCommands, DirectionsAcrossAnEdgeAreOneInSpaceWhateverTheParameters) {
  // The right sheet is skewed, and its v runs to 3.
  TwoSheets sheets = two_sheets();
  const auto replace = [&](const std::string& from, const std::string& to) {
    const auto at = sheets.text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    sheets.text.replace(at, from.size(), to);
  };
  replace("(2.,0.,0.)", "(2.,0.5,0.)");
  replace("(2.,1.,0.)", "(2.,1.5,0.)");
  const auto right = sheets.text.find("'right'");
  sheets.text.replace(sheets.text.find("(0.,1.),.UNSPECIFIED.", right), 7, "(0.,3.)");
  const step::File file = testing::parse_or_die(sheets.text);
  const auto course = SharedEdge::create(file.model(), TwoSheets::name(sheets.edge));
  ASSERT_TRUE(course) << course.error().message();
  std::vector<const Surface*> patches;
  for (const auto& s : file.surfaces()) patches.push_back(&s.surface);
  const auto edges =
      coupled_edges({{std::make_shared<const SharedEdge>(*course), {0, 1}}}, patches);
  ASSERT_EQ(edges.size(), 1U);
  ASSERT_EQ(edges[0].across.size(), edges[0].points.size());
  for (std::size_t k = 0; k < edges[0].points.size(); ++k) {
    std::array<Point, 2> ways;
    for (std::size_t side = 0; side < 2; ++side) {
      const auto& [patch, u] = edges[0].points[k][side];
      Parameters<2> here(1, 2);
      here << u[0], u[1];
      const auto jet = evaluate<2>(*patches[static_cast<std::size_t>(patch)], here, 1);
      ASSERT_TRUE(jet);
      const Eigen::Vector2d across = edges[0].across[k][side];
      ways[side] =
          (across[0] * jet->at({1, 0}).row(0) + across[1] * jet->at({0, 1}).row(0)).transpose();
      EXPECT_NEAR(std::abs(ways[side].x()), 1, 1e-12);
    }
    EXPECT_LT((ways[0] - ways[1]).norm(), 1e-12)
        << ways[0].transpose() << " and " << ways[1].transpose();
  }
}

TEST(FollowCommands, WhatWouldCreaseASmoothEdgeIsRefused) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  ASSERT_TRUE(run(session, both + "," + edge_command(sheets, "follow")));
  const auto status = run_on(
      session, R"({"do":"select","surface":"#10"},{"do":"points","which":[0,1],"by":[0,0,0.1]})");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().kind, ErrorKind::numerical);
  EXPECT_NE(status.error().what.find("degrees"), std::string::npos) << status.error().message();
  EXPECT_EQ(session.largest_displacement(0), 0);
}

TEST(FollowCommands, AnEdgeHeldAgainIsStillWrittenWhereItWent) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  ASSERT_TRUE(run(session, both + "," + edge_command(sheets, "follow") + "," + press));
  const auto before = session.save();
  ASSERT_TRUE(run_on(session, R"({"do":"hold","mode":"position"})"));
  EXPECT_EQ(*session.save(), *before);
}

TEST(FollowCommands, TheFaceThatWouldHaveToFollowIsNamed) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  const auto alone =
      run(session, R"({"do":"select","surface":"#10"},)" + edge_command(sheets, "follow"));
  ASSERT_FALSE(alone);
  EXPECT_EQ(alone.error().kind, ErrorKind::input);
  EXPECT_NE(alone.error().what.find("#20"), std::string::npos);
  EXPECT_NE(alone.error().remedy.find(R"(["#10","#20"])"), std::string::npos)
      << alone.error().remedy;

  const TwoSheets flat = two_sheets(false, true);
  Session other = opened(flat);
  const auto plane =
      run(other, R"({"do":"select","surface":"#10"},)" + edge_command(flat, "follow"));
  ASSERT_FALSE(plane);
  EXPECT_NE(plane.error().what.find("#20 PLANE"), std::string::npos) << plane.error().message();
}

TEST(FollowCommands, WithOneOfItsFacesNoLongerSelectedTheStepIsRefused) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  const auto status = run(session, both + "," + edge_command(sheets, "follow") +
                                       R"(,{"do":"select","surface":"#10"},)" + press);
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().message().find("#20"), std::string::npos) << status.error().message();
}

TEST(FollowCommands, WhatPartsTheFacesIsRefused) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  ASSERT_TRUE(run(session, both + "," + edge_command(sheets, "follow") +
                               R"(,{"do":"select","surface":"#10"})"));
  const auto status = run_on(session, R"({"do":"points","which":[2],"by":[0,0,0.1]})");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().kind, ErrorKind::numerical);
  EXPECT_NE(status.error().what.find("part by 0.1"), std::string::npos) << status.error().message();
  EXPECT_EQ(testing::code_of(status.error()), ErrorCode::edge_would_part);
  EXPECT_EQ(session.largest_displacement(0), 0);
}

TEST(FollowCommands, AnEdgeThatMayOpenIsNoted) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  ASSERT_TRUE(
      run_on(session, R"({"do":"select","surface":"#10"},{"do":"hold","mode":"position"},)" +
                          edge_command(sheets, "open")));
  EXPECT_TRUE(session.state().followed.empty());
  ASSERT_EQ(session.state().notes.size(), 1U);
  EXPECT_NE(session.state().notes[0].find("#20"), std::string::npos);
}

TEST(FollowCommands, AJournalSaysWhatFollowsAndWhatMayOpen) {
  const TwoSheets sheets = two_sheets();
  for (const char* const hold : {"follow", "open"}) {
    Session session = opened(sheets), again = opened(sheets);
    ASSERT_TRUE(run(session, both + "," + edge_command(sheets, hold)));
    const std::string script = script_json(session.journal());
    ASSERT_TRUE(testing::run_all(again, parse_script(script, "journal"))) << script;
    EXPECT_EQ(script_json(again.journal()), script);
    for (std::size_t k = 0; k < 2; ++k) {
      const auto &constraints = session.state().surfaces[k].constraints,
                 &other = again.state().surfaces[k].constraints;
      EXPECT_TRUE(std::ranges::equal(constraints, other, {}, &KeptConstraint::constraint,
                                     &KeptConstraint::constraint));
    }
    EXPECT_EQ(again.state().followed.size(), std::string_view(hold) == "open" ? 0U : 1U);
  }
}

TEST(FollowCommands, ASnapshotKeepsWhatFollows) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  ASSERT_TRUE(run(session, both + "," + edge_command(sheets, "follow") + "," + press));
  auto restored = Session::restore(Document::from(*open_source(sheets.text, "sheets.step")),
                                   session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_EQ(restored->state().coupling, session.state().coupling);
  EXPECT_EQ(restored->state().bend, session.state().bend);
  ASSERT_EQ(restored->state().followed.size(), 1U);
  EXPECT_TRUE(restored->state().followed[0].course);
  EXPECT_EQ(*restored->save(), *session.save());
  for (Session* s : {&session, &*restored}) ASSERT_TRUE(run_on(*s, R"({"do":"step"})"));
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(restored->state().surfaces[k].current->control_points(),
              session.state().surfaces[k].current->control_points());
  }
}

TEST(FollowCommands, BoundaryIsocurvesDoNotFollow) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  ASSERT_TRUE(run(session, both));
  const auto status = run(session, R"({"do":"edge","which":"u0","hold":"follow"})");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().where, "hold");
}

const std::string clay = R"({"do":"material","preset":"clay"},
  {"do":"tool","name":"ball","radius":0.2,"position":[1,0.5,1],"plasticity":1})";

TEST(FollowStrokes, AGrooveAcrossAnEdgeIsLeftOnBothSidesOfIt) {
  for (const std::string& seams : {std::string(R"({"do":"seams","couple":true})"), no_seams}) {
    const TwoSheets sheets = two_sheets();
    Session session = opened(sheets);
    ASSERT_TRUE(
        run(session, both + "," + edge_command(sheets, "follow") + "," + seams + "," + clay));
    const std::size_t ready = session.journal().size();
    const auto status =
        run_on(session, R"({"do":"stroke","path":[[0.6,0.5,0.15],[1.4,0.5,0.15]]})");
    ASSERT_TRUE(status) << status.error().message();
    const Parting apart = parted(session);
    EXPECT_LE(apart.distance, apart.tolerance);
    EXPECT_LE(apart.angle, asked_angle);
    for (const auto& s : session.state().surfaces) {
      EXPECT_EQ(s.rest, s.current) << "it stays";
      const auto sample = session.state().followed[0].course->at(0.5);
      EXPECT_NEAR(displacement_at(*s.opened, *s.current, sample.feet[s.id == "#10" ? 0 : 1])->z(),
                  -0.05, 0.006);
      EXPECT_NEAR(displacement_at(*s.opened, *s.current, {s.id == "#10" ? 0.75 : 0.25, 0.5})->z(),
                  -0.05, 0.006);
    }
    EXPECT_EQ(session.journal().size(), ready + 1);
    ASSERT_TRUE(run_on(session, R"({"do":"undo"})"));
    EXPECT_EQ(session.largest_displacement(0), 0);
  }
}

TEST(FollowStrokes, AnOpenStrokeGoesOverAnEdgeInParts) {
  const TwoSheets sheets = two_sheets();
  Session whole = opened(sheets), parts = opened(sheets);
  for (Session* s : {&whole, &parts}) {
    ASSERT_TRUE(run(*s, both + "," + edge_command(sheets, "follow") + "," + no_seams + "," + clay));
  }
  ASSERT_TRUE(run_on(whole, R"({"do":"stroke","path":[[0.6,0.5,0.15],[1.4,0.5,0.15]]})"));
  ASSERT_TRUE(run_on(parts, R"({"do":"stroke","path":[[0.6,0.5,0.15],[0.9,0.5,0.15]],"open":true},
    {"do":"stroke","path":[[1.1,0.5,0.15],[1.4,0.5,0.15]],"open":true})"));
  EXPECT_LE(parted(parts).distance, parted(parts).tolerance);
  EXPECT_LE(parted(parts).angle, asked_angle);
  ASSERT_TRUE(run_on(parts, R"({"do":"stroke","path":[]})"));
  EXPECT_LE(parted(parts).distance, parted(parts).tolerance);
  for (std::size_t k = 0; k < 2; ++k) {
    const Eigen::Vector2d at(0.6, 0.5);
    const auto &a = whole.state().surfaces[k], &b = parts.state().surfaces[k];
    EXPECT_LE(
        (*displacement_at(*a.opened, *a.current, at) - *displacement_at(*b.opened, *b.current, at))
            .norm(),
        5e-3);
  }
}

TEST(FollowStrokes, ABrushOverAnEdgeMovesBothFaces) {
  for (const std::string& kind :
       {std::string(R"("kind":"grab","path":[[0.95,0.5]],"by":[0,0,0.1])"),
        std::string(R"("kind":"push","path":[[0.7,0.5],[1,0.5]],"height":0.05)"),
        std::string(R"("kind":"inflate","path":[[0.75,0.3],[0.75,0.7]],"height":0.05)")}) {
    for (const std::string& seams : {std::string(R"({"do":"seams","couple":true})"), no_seams}) {
      const TwoSheets sheets = two_sheets();
      Session session = opened(sheets);
      const auto status = run(session, both + "," + edge_command(sheets, "follow") + "," + seams +
                                           R"(,{"do":"brush","radius":0.35,)" + kind + "}");
      ASSERT_TRUE(status) << status.error().message();
      const Parting apart = parted(session);
      EXPECT_LE(apart.distance, apart.tolerance) << kind;
      EXPECT_LE(apart.angle, asked_angle) << kind;
      const auto sample = session.state().followed[0].course->at(0.5);
      for (const auto& s : session.state().surfaces) {
        EXPECT_GT(
            displacement_at(*s.opened, *s.current, sample.feet[s.id == "#10" ? 0 : 1])->norm(),
            0.005)
            << kind;
      }
      ASSERT_TRUE(run_on(session, R"({"do":"undo"})"));
      for (const std::size_t k : {0U, 1U})
        EXPECT_EQ(session.largest_displacement(static_cast<int>(k)), 0);
    }
  }
}

}  // namespace
}  // namespace knead
