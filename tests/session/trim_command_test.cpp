// Faces that are cut by trimming edges: what holds them, what is refined for it, and what is said.

#include "exchange/face_builder.hpp"
#include "knead/spline/evaluate.hpp"
#include "scene/held_points.hpp"
#include "scene/trims.hpp"
#include "session/fixes.hpp"
#include "session/running.hpp"
#include "support/error_codes.hpp"

namespace knead {
namespace {

using testing::FaceBuilder;
using testing::run;
using testing::run_on;

struct Disc {
  step::File file;
  std::string edge, hole;
};

/// The bilinear unit square #10, cut to a disc of radius 0.4 with a hole of 0.1 beside its middle.
Disc disc() {
  FaceBuilder b;
  const int outer = b.circle(0.4, 0, 0.5, 0.5), hole = b.circle(0.1, 0, 0.6, 0.5);
  const int face = b.face(10, {b.bound({outer}), b.bound({-hole})});
  b.entity("OPEN_SHELL('',(#" + std::to_string(face) + "))");
  return {testing::parse_or_die(testing::step_text(testing::unit_square_points() +
                                                   testing::bilinear_patch() + b.text())),
          "#" + std::to_string(outer), "#" + std::to_string(hole)};
}

Document document(const step::File& file) {
  return Document::from(*open_source(file.bytes(), file.name()));
}

const std::string ball = R"({"do":"tool","name":"ball","radius":0.05,"rigid":true,"at":"middle"},
  {"do":"move","tool":"ball","by":[0,0,0.04]})";
const std::string pressed = ball + R"(,{"do":"evolve","mode":"static"})";

double largest_gap(const Session& session) {
  const auto report = trim_report(session.state().surfaces[0]);
  EXPECT_TRUE(report);
  return report ? report->largest : -1;
}

TEST(TrimCommands, AScriptOfVersion2HoldsTheEdgesOfFacesAndRefinesForIt) {
  Session session(document(disc().file));
  const auto result = run(session, pressed);
  ASSERT_TRUE(result) << result.error().message();
  EXPECT_GT(session.largest_displacement(0), 0.005);
  EXPECT_EQ(largest_gap(session), 0);
  const Surface& now = *session.state().surfaces[0].current;
  EXPECT_GT(now.net()[0], 10);
  EXPECT_EQ(now.knots(0).degree(), 3);
  EXPECT_FALSE(session.state().notes.empty());
}

// Pins are numbers of control points, which a finer net would give to others.
TEST(TrimCommands, ANetWithPinnedControlPointsStaysAsItIs) {
  const std::string halves = R"({"do":"refine","region":[[0,1],[0,1]]},)";
  const std::string finer = R"({"do":"elevate","by":[2,2]},)" + halves + halves + halves + halves;
  for (const bool pinned : {true, false}) {
    Session session(document(disc().file));
    const std::string pin = R"({"do":"pin","control_points":[[0,0]]},)";
    const auto result = run(session, finer + (pinned ? pin : "") + pressed);
    ASSERT_TRUE(result) << result.error().message();
    EXPECT_GT(session.largest_displacement(0), 0.005);
    EXPECT_EQ(session.state().surfaces[0].current->net() == (std::array{19, 19}), pinned);
  }
}

// The net of degree 1 gets a higher degree between tool and edges while the stroke is under way.
TEST(TrimCommands, AStrokeInClayLeavesItsGrooveInAFlatFace) {
  Session session(document(disc().file));
  const auto result = run(session, R"({"do":"material","preset":"clay"},
    {"do":"tool","name":"ball","radius":0.05,"position":[0.3,0.4,0.2],"plasticity":1},
    {"do":"stroke","tool":"ball","path":[[0.3,0.4,0.03],[0.35,0.65,0.03],[0.45,0.7,0.03]]})");
  ASSERT_TRUE(result) << result.error().message();
  EXPECT_NEAR(session.largest_displacement(0), 0.02, 0.002);
  EXPECT_EQ(largest_gap(session), 0);
  EXPECT_EQ(session.state().surfaces[0].current->knots(0).degree(), 3);
}

/// The bilinear unit square #10, all of which is a face.
step::File square() {
  FaceBuilder b;
  constexpr double corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  std::vector<int> vertices, edges;
  for (const auto& c : corners) vertices.push_back(b.vertex(c[0], c[1], 0));
  for (std::size_t k = 0; k < 4; ++k) {
    const auto &from = corners[k], &to = corners[(k + 1) % 4];
    edges.push_back(b.line(vertices[k], vertices[(k + 1) % 4], {from[0], from[1], 0},
                           {to[0] - from[0], to[1] - from[1], 0}));
  }
  b.entity("OPEN_SHELL('',(#" + std::to_string(b.face(10, {b.bound(edges)})) + "))");
  return testing::parse_or_die(
      testing::step_text(testing::unit_square_points() + testing::bilinear_patch() + b.text()));
}

// A wide brush, pressed deep beside a corner.
TEST(TrimCommands, AStrokeThatWouldFoldAFaceIsMadeShallower) {
  Session session(document(square()));
  const auto result = run(session, R"({"do":"material","preset":"clay"},
    {"do":"tool","name":"ball","radius":0.25,"position":[0.8,0.8,-0.75],"plasticity":1},
    {"do":"stroke","tool":"ball","path":[[0.8,0.8,-0.125],[0.8,0.8,0]]})");
  ASSERT_TRUE(result) << result.error().message();
  EXPECT_GT(session.largest_displacement(0), 0.05);
  EXPECT_LT(session.largest_displacement(0), 0.2);
  EXPECT_EQ(largest_gap(session), 0);
  EXPECT_NE(session.state().steps.back().note.find("of its depth, as more would fold a face"),
            std::string::npos)
      << session.state().steps.back().note;
}

// Points between the hole and the rim, pushed over the one or the other.
TEST(TrimCommands, AFoldBesideAHeldEdgeNamesIt) {
  const Disc d = disc();
  const auto refused = [&](const std::string& first, const char* at, const char* by) {
    Session session(document(d.file));
    const auto result =
        run(session, first + R"({"do":"brush","kind":"grab","radius":0.15,"path":[)" + at +
                         R"(],"by":)" + by + R"(})");
    EXPECT_FALSE(result);
    EXPECT_EQ(session.largest_displacement(0), 0);
    return result ? Error{} : result.error();
  };
  for (const auto& [edge, by] : {std::pair{d.hole, "[-0.2,0,0]"}, {d.edge, "[0.2,0,0]"}}) {
    const Error error = refused("", "[0.8,0.5]", by);
    EXPECT_NE(error.what.find("beside the edge " + edge + ", which is held"), std::string::npos)
        << error.message();
    EXPECT_EQ(testing::code_of(error), ErrorCode::step_folds_beside_edge);
    EXPECT_NE(error.remedy.find(R"({"do":"edge","edge":")" + edge + R"(","hold":"follow"})"),
              std::string::npos);
  }
  const Error freed = refused(R"({"do":"edge","edge":")" + d.hole + R"(","hold":"follow"},)",
                              "[0.8,0.5]", "[-0.2,0,0]");
  EXPECT_NE(freed.what.find("folds #10"), std::string::npos) << freed.message();
  EXPECT_EQ(testing::code_of(freed), ErrorCode::step_folds);
  EXPECT_EQ(freed.what.find(d.hole + ","), std::string::npos) << "it is not held";
}

TEST(TrimCommands, HoldingNoRowsOfAllUndoesWhatAScriptBeginsWith) {
  Session session(document(disc().file));
  const auto result =
      run(session, R"({"do":"hold","rows":0,"all":true},)" + ball + R"(,{"do":"step"})");
  ASSERT_TRUE(result) << result.error().message();
  EXPECT_EQ(session.state().surfaces[0].current->net(), (std::array{2, 2}));
  EXPECT_TRUE(session.state().surfaces[0].constraints.empty());
}

/// A ball in the middle of the disc's hole, deep in the surface that no face shows there.
const std::string in_hole =
    R"({"do":"tool","name":"ball","radius":0.09,"rigid":true,"position":[0.6,0.5,0.03])";

TEST(TrimCommands, AToolInAHoleTouchesNothing) {
  for (const char* hold : {"", R"({"do":"hold","mode":"open"},)"}) {
    Session session(document(disc().file));
    const auto result =
        run(session, hold + in_hole + R"(},{"do":"evolve","mode":"acm"},{"do":"step"})");
    ASSERT_TRUE(result) << result.error().message();
    EXPECT_EQ(session.largest_displacement(0), 0);
    const StepRecord& step = session.state().steps.back();
    EXPECT_EQ(step.gap, 0);
    EXPECT_TRUE(step.converged);
    EXPECT_EQ(step.note, "");
  }
}

TEST(TrimCommands, AToolTouchesAllOfASurfaceWhereThatIsAsked) {
  const std::string step = R"(,{"do":"evolve","mode":"acm"},{"do":"step"})";
  Session asked(document(disc().file)), edited(document(disc().file)), first(document(disc().file));
  const std::string free = R"({"do":"hold","mode":"open"},)";
  ASSERT_TRUE(run(asked, free + in_hole + R"(,"touches":"all"})" + step));
  ASSERT_TRUE(run(edited, free + in_hole + R"(},{"do":"edit_tool","touches":"all"})" + step));
  ASSERT_TRUE(run_on(first, in_hole + R"(,"touches":"all"})" + step));
  EXPECT_GT(first.largest_displacement(0), 0.01);
  for (const Session* other : {&asked, &edited}) {
    EXPECT_EQ(other->state().surfaces[0].current->control_points(),
              first.state().surfaces[0].current->control_points());
  }
  EXPECT_EQ(asked.state().tools[0].touches, ToolTouch::all);
}

TEST(TrimCommands, WhatToolsTouchIsInSnapshots) {
  Session session(document(disc().file));
  ASSERT_TRUE(run(session, in_hole + "}"));
  const auto restored = Session::restore(session.document(), session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_EQ(restored->state().tools[0].touches, ToolTouch::visible);
}

TEST(TrimCommands, WhereNothingMayBeRefinedAndNothingIsFreeThatIsAnErrorWithTheRemedy) {
  Session session(document(disc().file));
  const auto result = run(session, R"({"do":"refine","permission":"never"},)" + pressed);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::numerical);
  EXPECT_NE(result.error().message().find("nothing is free"), std::string::npos);
  EXPECT_NE(result.error().remedy.find("permission"), std::string::npos);
  EXPECT_EQ(testing::code_of(result.error()), ErrorCode::nothing_free_at_edges);
  const std::vector<Fix> fixes = fixes_for(*result.error().diagnostic);
  ASSERT_EQ(fixes.size(), 1U);
  for (const Command& command : fixes[0].commands) ASSERT_TRUE(session.execute(command));
  EXPECT_TRUE(run(session, pressed)) << "what is offered helps";
}

TEST(TrimCommands, AStepOverWhatIsHeldCanBeAllowed) {
  Session session(document(disc().file));
  const auto result = run(session, R"({"do":"refine","permission":"never"},)" + ball +
                                       R"(,{"do":"step","allow":"held"})");
  EXPECT_TRUE(result) << result.error().message();
  EXPECT_EQ(session.largest_displacement(0), 0);
}

TEST(TrimCommands, AnEdgeThatIsFreedMayMove) {
  const Disc d = disc();
  Session session(document(d.file));
  ASSERT_TRUE(run(session, R"({"do":"edge","which":")" + d.hole + R"(","hold":"follow"},
    {"do":"tool","radius":0.08,"at":[0.45,0.5]},{"do":"move","by":[0,0,0.06]},
    {"do":"evolve","mode":"static"})"));
  const auto report = trim_report(session.state().surfaces[0]);
  ASSERT_TRUE(report);
  for (const auto& edge : report->edges) {
    if (edge.held.id == d.hole) {
      EXPECT_EQ(edge.held.order, -1);
      EXPECT_GT(edge.deviation, 1e-4);
    } else {
      EXPECT_EQ(edge.deviation, 0);
    }
  }
}

TEST(TrimCommands, AnEdgeThatThereIsNotIsNamedWithThoseThereAre) {
  const Disc d = disc();
  Session session(document(d.file));
  const auto result = run(session, R"({"do":"edge","which":"#5","hold":"follow"})");
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().remedy.find(d.edge), std::string::npos);
}

TEST(TrimCommands, APlaceThatIsNotVisibleIsAnErrorThatNamesTheNearestOneThatIs) {
  Session session(document(disc().file));
  const auto result = run(session, R"({"do":"tool","radius":0.1,"at":[0.58,0.5]})");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().where, "at");
  EXPECT_NE(result.error().remedy.find("[0.5"), std::string::npos) << result.error().remedy;
}

TEST(TrimCommands, WhereNoEdgesAreHeldItIsNoted) {
  Session session(document(disc().file));
  ASSERT_TRUE(run_on(session, R"({"do":"tool","radius":0.1,"at":[0.58,0.5]})"));
  ASSERT_EQ(session.state().notes.size(), 1U);
  EXPECT_NE(session.state().notes[0].find("not visible"), std::string::npos);
}

TEST(TrimCommands, EveryHoldReplacesTheOneBefore) {
  Session session(document(disc().file));
  ASSERT_TRUE(run(session, R"({"do":"hold","mode":"curvature"})"));
  ASSERT_EQ(session.state().surfaces[0].constraints.size(), 1U);
  EXPECT_EQ(std::get<TrimHolds>(session.state().surfaces[0].constraints[0].constraint).order, 2);
  ASSERT_TRUE(run_on(session, R"({"do":"hold","rows":1})"));
  EXPECT_TRUE(session.state().surfaces[0].constraints.empty());
  EXPECT_EQ(session.state().surfaces[0].hold_rows, 1);
  ASSERT_TRUE(run_on(session, R"({"do":"hold","mode":"position"})"));
  EXPECT_EQ(session.state().surfaces[0].hold_rows, 0);
  ASSERT_TRUE(run_on(session, R"({"do":"hold","mode":"open"})"));
  EXPECT_FALSE(holds_trims(session.state().surfaces[0].constraints));
}

TEST(TrimCommands, ASnapshotKeepsTheHold) {
  const Disc d = disc();
  Session session(document(d.file));
  ASSERT_TRUE(
      run(session, R"({"do":"edge","which":")" + d.hole + R"(","hold":"tangent"},)" + pressed));
  auto restored = Session::restore(document(d.file), session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  const SceneSurface &a = session.state().surfaces[0], &b = restored->state().surfaces[0];
  ASSERT_EQ(a.constraints.size(), b.constraints.size());
  for (std::size_t k = 0; k < a.constraints.size(); ++k) {
    EXPECT_EQ(a.constraints[k].constraint, b.constraints[k].constraint);
    EXPECT_EQ(a.constraints[k].where->control_points(), b.constraints[k].where->control_points());
  }
  ASSERT_TRUE(b.visible);
  EXPECT_EQ(*a.visible, *b.visible);
  EXPECT_EQ(*held_points(held_input(a)), *held_points(held_input(b)));
}

TEST(TrimCommands, ThePointsThatAreHeldAreShown) {
  Session session(document(disc().file));
  ASSERT_TRUE(run(session, pressed));
  const auto held = held_points(held_input(session.state().surfaces[0]));
  ASSERT_TRUE(held);
  const auto report = trim_report(session.state().surfaces[0]);
  EXPECT_EQ(std::ranges::count(*held, 0), report->free);
  EXPECT_GE(report->free, 9);
}

}  // namespace
}  // namespace knead
