// Surfaces of other forms that become B-spline surfaces: what the scene gets, what is written, and
// what follows then.

#include <set>

#include "brep/shared_edge.hpp"
#include "scene/followed.hpp"
#include "scene/trims.hpp"
#include "session/fixes.hpp"
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

const std::string convert = R"({"do":"convert","surface":"#20"})";

std::string free_edge(const TwoSheets& sheets) {
  return R"({"do":"edge","which":")" + TwoSheets::name(sheets.edge) + R"(","hold":"follow"})";
}

TEST(Convert, TheSurfaceJoinsTheSceneWithItsEdgesHeld) {
  Session session = opened(two_sheets(false, true));
  ASSERT_EQ(session.state().surfaces.size(), 1U);
  const auto status = run(session, convert);
  ASSERT_TRUE(status) << status.error().message();
  ASSERT_EQ(session.state().surfaces.size(), 2U);
  const SceneSurface& s = session.state().surfaces[1];
  EXPECT_EQ(s.id, "#20");
  EXPECT_TRUE(holds_trims(s.constraints));
  EXPECT_EQ(session.document().surfaces().size(), 2U);
  EXPECT_EQ(session.state().selected, 0) << "it is not selected by itself";
  ASSERT_TRUE(run_on(session, R"({"do":"undo"})"));
  EXPECT_EQ(session.state().surfaces.size(), 1U);
  EXPECT_EQ(session.document().surfaces().size(), 1U);
  EXPECT_EQ(*session.save(), two_sheets(false, true).text) << "undone, it is written as it was";
  ASSERT_TRUE(run_on(session, R"({"do":"redo"})"));
  EXPECT_NE(session.save()->find("#20=B_SPLINE_SURFACE_WITH_KNOTS("), std::string::npos);
}

TEST(Convert, AnEdgeToItFollowsThen) {
  const TwoSheets sheets = two_sheets(false, true);
  Session session = opened(sheets);
  const auto status = run(session, convert + "," + both + "," + free_edge(sheets) + "," + press);
  ASSERT_TRUE(status) << status.error().message();
  const auto apart = parting(session.state(), *session.state().followed.at(0).course);
  ASSERT_TRUE(apart);
  EXPECT_LE(apart->distance, apart->tolerance);
  EXPECT_LE(apart->angle, asked_angle);
  const auto bytes = session.save();
  ASSERT_TRUE(bytes) << bytes.error().message();
  const auto edge =
      SharedEdge::create(testing::parse_or_die(*bytes).model(), TwoSheets::name(sheets.edge));
  ASSERT_TRUE(edge) << edge.error().message();
  EXPECT_LE(edge->gap(), 2 * apart->tolerance);
  EXPECT_NEAR(edge->at(0.5).point.z(), -0.04, 0.004);
}

TEST(Convert, WithoutItTheErrorNamesTheFaceAndTheCommand) {
  const TwoSheets sheets = two_sheets(false, true);
  Session session = opened(sheets);
  const auto refused = run(session, R"({"do":"select","surface":"#10"},)" + free_edge(sheets));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find(TwoSheets::name(sheets.faces[1])), std::string::npos)
      << refused.error().what;
  EXPECT_NE(refused.error().what.find("#20 PLANE"), std::string::npos) << refused.error().what;
  EXPECT_EQ(testing::code_of(refused.error()), ErrorCode::edge_face_not_spline);
  const std::vector<Fix> fixes = fixes_for(*refused.error().diagnostic);
  ASSERT_EQ(fixes.size(), 1U);
  Session fixed = opened(sheets);
  for (const Command& command : fixes[0].commands) {
    const auto status = fixed.execute(command);
    ASSERT_TRUE(status) << status.error().message();
  }
  EXPECT_EQ(fixed.state().followed.size(), 1U);
  EXPECT_NE(refused.error().remedy.find(R"({"do":"convert","surfaces":["#20"]})"),
            std::string::npos)
      << refused.error().remedy;
  EXPECT_NE(refused.error().remedy.find(both), std::string::npos) << refused.error().remedy;
  const auto select = run(session, both);
  ASSERT_FALSE(select);
  EXPECT_NE(select.error().remedy.find(convert), std::string::npos) << select.error().message();
  EXPECT_EQ(testing::code_of(select.error()), ErrorCode::not_a_spline);
  const auto alone =
      run(session, convert + R"(,{"do":"select","surface":"#10"},)" + free_edge(sheets));
  ASSERT_FALSE(alone);
  EXPECT_NE(alone.error().what.find("not selected"), std::string::npos) << alone.error().message();
  EXPECT_EQ(testing::code_of(alone.error()), ErrorCode::edge_face_not_selected);
}

TEST(Convert, NeighboursOfTheSelectionAreFound) {
  Session session = opened(two_sheets(false, true));
  const auto status =
      run(session, R"({"do":"select","surface":"#10"},{"do":"convert","neighbours":true})");
  ASSERT_TRUE(status) << status.error().message();
  ASSERT_EQ(session.state().surfaces.size(), 2U);
  EXPECT_EQ(session.state().surfaces[1].id, "#20");
  const auto again = run(session, R"({"do":"convert","neighbours":true})");
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().where, "neighbours");
  EXPECT_EQ(session.state().surfaces.size(), 2U);
}

TEST(Convert, RegionsBesideItKnowItsNewForm) {
  Session session = opened(two_sheets(false, true));
  ASSERT_TRUE(run(session,
                  R"({"do":"select","surface":"#10"},{"do":"hold","mode":"position"},)" + convert));
  ASSERT_TRUE(session.state().surfaces[0].visible);
  std::set<std::string> supports;
  for (const TrimEdge& edge : session.state().surfaces[0].visible->edges) {
    supports.insert(edge.supports.begin(), edge.supports.end());
  }
  EXPECT_TRUE(supports.contains("#20 B_SPLINE_SURFACE_WITH_KNOTS"));
  EXPECT_FALSE(supports.contains("#20 PLANE"));
}

TEST(Convert, ASnapshotKeepsIt) {
  const TwoSheets sheets = two_sheets(false, true);
  Session session = opened(sheets);
  ASSERT_TRUE(run(session, convert + "," + both + "," + free_edge(sheets) + "," + press));
  auto restored = Session::restore(Document::from(*open_source(sheets.text, "sheets.step")),
                                   session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_EQ(*restored->save(), *session.save());
  EXPECT_TRUE(restored->state().followed.at(0).course);
  while (session.can_undo()) {
    for (Session* s : {&session, &*restored}) ASSERT_TRUE(run_on(*s, R"({"do":"undo"})"));
    EXPECT_EQ(restored->state().surfaces.size(), session.state().surfaces.size());
    EXPECT_EQ(*restored->save(), *session.save());
  }
}

TEST(Convert, TheJournalGivesTheSameBytes) {
  const TwoSheets sheets = two_sheets(false, true);
  Session session = opened(sheets), again = opened(sheets);
  ASSERT_TRUE(run(session, convert + "," + both + "," + free_edge(sheets) + "," + press));
  for (const Command& command : session.journal()) ASSERT_TRUE(again.execute(command));
  EXPECT_EQ(*again.save(), *session.save());
}

TEST(Convert, WithoutAFieldItSaysWhichThereAre) {
  Session session = opened(two_sheets(false, true));
  const auto status = run(session, R"({"do":"convert"})");
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().remedy.find("neighbours"), std::string::npos);
}

TEST(Convert, ADocumentWithoutFacesIsRefused) {
  Session session(Document::fresh("fresh"));
  const auto status = run(session, convert);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().kind, ErrorKind::input);
}

}  // namespace
}  // namespace knead
