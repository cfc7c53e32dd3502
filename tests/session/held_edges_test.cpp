// Edges of faces that are held: what would open them is refused, and what is open is not written
// without a word.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/followed.hpp"
#include "scene/parted_edges.hpp"
#include "scene/trims.hpp"
#include "session/running.hpp"
#include "support/error_codes.hpp"
#include "support/made_files.hpp"

namespace knead {
namespace {

using testing::both;
using testing::opened;
using testing::press;
using testing::run;
using testing::run_on;
using testing::two_sheets;
using testing::TwoSheets;

const std::string left = R"({"do":"select","surface":"#10"})";
// The net of #10 is (0, 0), (0, 1), (1, 0), (1, 1); the two last are on the edge that it shares
// with #20.
const std::string lift_corner = R"({"do":"points","which":[2],"by":[0,0,0.25]})";

Error refused(const Expected<void>& status) {
  EXPECT_FALSE(status);
  return status ? Error{} : status.error();
}

Error refused(Session& session, const std::string& commands) {
  return refused(run(session, commands));
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(HeldEdges, APointThatWouldOpenOneStays) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  const Error error = refused(session, left + "," + lift_corner);
  const std::string id = TwoSheets::name(sheets.edge);
  EXPECT_EQ(error.kind, ErrorKind::numerical);
  EXPECT_TRUE(says(error.what, "open by 0.25 at (1, 0, 0)")) << error.message();
  EXPECT_EQ(testing::code_of(error), ErrorCode::edge_would_open);
  EXPECT_TRUE(says(error.what, TwoSheets::name(sheets.outer)) || says(error.what, id))
      << error.message();
  EXPECT_TRUE(says(error.what, "1 other edge likewise")) << error.message();
  EXPECT_TRUE(says(error.remedy, R"({"do":"edge","edge":")" + id + R"(","hold":"follow"})"))
      << error.remedy;
  EXPECT_EQ(session.largest_displacement(0), 0);
  EXPECT_EQ(*session.save(), sheets.text);
}

TEST(HeldEdges, ALatticeOverThemIsRefused) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  const std::string pull =
      R"({"do":"lattice","net":[4,4,4],"which":[21,22,25,26,37,38,41,42],"by":[0,0,0.2]})";
  const Error error = refused(session, both + "," + pull);
  EXPECT_TRUE(says(error.what, "is held, and would open by")) << error.message();
  EXPECT_TRUE(says(error.what, "6 other edges likewise")) << error.message();
  for (int k : {0, 1}) EXPECT_EQ(session.largest_displacement(k), 0);
  // With a net of its own, of which a pull in the middle leaves the boundary where it is, it is
  // done.
  Session inner = opened(sheets);
  const auto status =
      run(inner, left +
                     R"(,{"do":"elevate","by":[2,2]},{"do":"refine","region":[[0,1],[0,1]]},
      {"do":"refine","region":[[0,1],[0,1]]},
      {"do":"lattice","net":[9,9,4],"degree":[2,2,1],"which":[161],"by":[0,0,0.2]})");
  ASSERT_TRUE(status) << status.error().message();
  EXPECT_GT(inner.largest_displacement(0), 0.01);
  EXPECT_TRUE(inner.save());
}

TEST(HeldEdges, WhatLeavesThemMayMove) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  const auto status = run(
      session, left + R"(,{"do":"elevate","by":[1,1]},{"do":"points","which":[4],"by":[0,0,0.2]})");
  ASSERT_TRUE(status) << status.error().message();
  EXPECT_NEAR(session.largest_displacement(0), 0.05, 1e-6);
  EXPECT_TRUE(session.save());
}

TEST(HeldEdges, TangentPlanesThatAreHeldDoNotTurn) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  const Error error =
      refused(session, left + R"(,{"do":"hold","mode":"tangent"},{"do":"elevate","by":[1,1]},
      {"do":"points","which":[4],"by":[0,0,0.2]})");
  EXPECT_TRUE(says(error.what, "are held, and would turn by")) << error.message();
  EXPECT_EQ(testing::code_of(error), ErrorCode::edge_would_turn);
  EXPECT_EQ(session.largest_displacement(0), 0);
}

TEST(HeldEdges, WeightsThatWouldOpenOneStay) {
  TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  ASSERT_TRUE(run_on(session, left + R"(,{"do":"hold","mode":"open"},{"do":"elevate","by":[1,1]},
      {"do":"points","which":[7],"by":[0.2,0,0]},{"do":"hold","mode":"position"})"));
  const Error error = refused(run_on(session, R"({"do":"weights","which":[7],"weight":3})"));
  EXPECT_TRUE(says(error.what, "is held, and would open by")) << error.message();
}

TEST(HeldEdges, WhereAllFollowALatticeMovesThemAlong) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  std::string commands = both;
  for (const SceneSurface& s : session.state().surfaces) {
    const auto contacts = edge_contacts(*session.document().model(), s.id);
    ASSERT_TRUE(contacts);
    for (const EdgeContact& c : *contacts)
      commands += R"(,{"do":"edge","edge":")" + c.id + R"(","hold":"follow"})";
  }
  const auto status = run(session, commands + R"(,{"do":"lattice","net":[2,2,2],"degree":[1,1,1],
      "which":[0,1,2,3],"by":[0,0,0.2]})");
  ASSERT_TRUE(status) << status.error().message();
  EXPECT_TRUE(session.parted_edges()->empty());
  EXPECT_TRUE(session.save());
}

TEST(PartedEdges, WhatWasNeverHeldIsNotWrittenOpen) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  ASSERT_TRUE(run_on(session, left + "," + lift_corner));
  const auto parted = session.parted_edges();
  ASSERT_TRUE(parted);
  ASSERT_EQ(parted->size(), 2U);
  for (const PartedEdge& edge : *parted) {
    EXPECT_NEAR(edge.distance, 0.25, 1e-14);
    EXPECT_LE(edge.opened, 1e-15);
    EXPECT_FALSE(edge.freed);
  }
  const auto bytes = session.save();
  ASSERT_FALSE(bytes);
  EXPECT_EQ(bytes.error().kind, ErrorKind::numerical);
  EXPECT_TRUE(says(bytes.error().what, "would be left 0.25 from the face"))
      << bytes.error().message();
  EXPECT_EQ(testing::code_of(bytes.error()), ErrorCode::edge_left_open);
  EXPECT_TRUE(says(bytes.error().what, "at (1, 0, 0)")) << bytes.error().message();
  EXPECT_TRUE(says(bytes.error().remedy, R"({"do":"hold","mode":"open"})")) << bytes.error().remedy;
  // As the remedy says.
  ASSERT_TRUE(run_on(session, R"({"do":"hold","mode":"open"})"));
  const auto open = session.save();
  ASSERT_TRUE(open) << open.error().message();
  ASSERT_EQ(session.parted_edges()->size(), 2U);
  EXPECT_TRUE(session.parted_edges()->front().freed);
  EXPECT_TRUE(says(note_on(session.parted_edges()->front()), "is open: it is up to 0.25 from"));
}

TEST(PartedEdges, AnEdgeFreedByNameIsWritten) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  const std::string free = R"(,{"do":"edge","hold":"open","edge":)";
  ASSERT_TRUE(run_on(session, left + free + '"' + TwoSheets::name(sheets.edge) + "\"}" + free +
                                  '"' + TwoSheets::name(sheets.outer) + "\"}," + lift_corner));
  EXPECT_TRUE(session.save());
  EXPECT_EQ(session.parted_edges()->size(), 2U);
}

TEST(PartedEdges, TheFreedAreStillFreedInASnapshotAndAScript) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  ASSERT_TRUE(
      run_on(session, R"({"do":"hold","mode":"open","all":true},)" + left + "," + lift_corner));
  const auto restored = Session::restore(Document::from(*open_source(sheets.text, "sheets.step")),
                                         session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_EQ(*restored->save(), *session.save());
  ASSERT_TRUE(run_on(session, R"({"do":"hold","rows":1})"));
  EXPECT_TRUE(session.save()) << "they are free as before";
  ASSERT_TRUE(run_on(session, R"({"do":"release"})"));
  EXPECT_TRUE(session.save());
  ASSERT_TRUE(run_on(session, R"({"do":"hold","mode":"position"})"));
  EXPECT_FALSE(session.save()) << "they are held where they are not any more";
}

TEST(PartedEdges, AnEdgeOfOneFaceThatIsLeftBehindCounts) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  ASSERT_TRUE(run_on(session, left + R"(,{"do":"points","which":[0],"by":[0,0,0.5]})"));
  const auto bytes = session.save();
  ASSERT_FALSE(bytes);
  EXPECT_TRUE(says(bytes.error().what, "from the face " + TwoSheets::name(sheets.faces[0])))
      << bytes.error().message();
}

TEST(PartedEdges, FacesWhoseNetsMoveTogetherLeaveTheirEdgeToo) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  const auto status = run_on(session, both + R"(,{"do":"hold","mode":"open","all":true},
      {"do":"lattice","net":[2,2,2],"degree":[1,1,1],"which":[0,1,2,3,4,5,6,7],"by":[0,0,1]})");
  ASSERT_TRUE(status) << status.error().message();
  EXPECT_EQ(session.parted_edges()->size(), 7U);
}

TEST(PartedEdges, OnAPlaneTheFaceStaysBehind) {
  const TwoSheets sheets = two_sheets(false, true);
  Session session = opened(sheets);
  ASSERT_TRUE(run_on(session, left + "," + lift_corner));
  EXPECT_FALSE(session.save());
  ASSERT_TRUE(run_on(session, R"({"do":"undo"})"));
  EXPECT_EQ(*session.save(), sheets.text);
}

TEST(PartedEdges, BothSidesOfASeamCount) {
  // The curved surfaces of a tube are closed; either side of the line where one meets itself is
  // torn away.
  for (const bool last : {false, true}) {
    Session session(Document::from(*open_source(testing::tube_file(), "tube.step")));
    int seams = 0;
    for (std::size_t k = 0; k < session.state().surfaces.size(); ++k) {
      const SceneSurface& s = session.state().surfaces[k];
      const auto contacts = edge_contacts(*session.document().model(), s.id);
      ASSERT_TRUE(contacts) << contacts.error().message();
      const auto seam = std::ranges::find(*contacts, true, &EdgeContact::seam);
      if (seam == contacts->end()) continue;
      ++seams;
      const int d = brep::closed_directions(*s.opened)[0] ? 0 : 1;
      const int row = last ? s.opened->net()[static_cast<std::size_t>(d)] - 1 : 0;
      const auto status = run_on(
          session, fmt::format(R"({{"do":"select","surface":"{}"}},{{"do":"seams","couple":false}},
          {{"do":"points","rows_{}":[{}],"by":[0,0.1,0]}})",
                               s.id, d == 0 ? 'u' : 'v', row));
      ASSERT_TRUE(status) << status.error().message();
      const auto parted = session.parted_edges();
      ASSERT_TRUE(parted);
      const auto torn = std::ranges::find(*parted, seam->id, &PartedEdge::id);
      ASSERT_NE(torn, parted->end());
      EXPECT_NEAR(torn->distance, 0.1, 1e-9);
    }
    EXPECT_GE(seams, 1);
  }
}

const std::string right_alone = R"({"do":"select","surface":"#20"})";

std::vector<int> orders_of(const Session& session, std::size_t surface) {
  const SceneSurface& s = session.state().surfaces[surface];
  EXPECT_TRUE(s.visible);
  return s.visible ? trim_orders(s.constraints, *s.visible) : std::vector<int>();
}

TEST(SecondFace, IsHeldAsTheFirst) {
  for (const std::string& order : {std::string("position"), std::string("tangent")}) {
    const TwoSheets sheets = two_sheets();
    Session session = opened(sheets);
    ASSERT_TRUE(run_on(session, left + R"(,{"do":"hold","mode":")" + order + R"("},)" + both));
    EXPECT_EQ(orders_of(session, 1), std::vector<int>(4, order == "position" ? 0 : 1));
    ASSERT_TRUE(run_on(session, R"({"do":"edge","hold":"follow","edge":")" +
                                    TwoSheets::name(sheets.edge) + "\"}"));
    EXPECT_EQ(std::ranges::count(orders_of(session, 1), -1), 1);
    const auto status = run_on(session, press);
    ASSERT_TRUE(status) << status.error().message();
    EXPECT_GT(session.largest_displacement(1), 0.01);
    const auto parted = session.parted_edges();
    ASSERT_TRUE(parted);
    EXPECT_TRUE(parted->empty()) << note_on(parted->front());
    EXPECT_TRUE(session.save());
  }
}

TEST(SecondFace, IsHeldWhereAnEdgeFollowsThatWasAskedOfBoth) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  const std::string follow =
      R"({"do":"edge","hold":"follow","edge":")" + TwoSheets::name(sheets.edge) + "\"}";
  ASSERT_TRUE(run_on(session, both + "," + follow + "," + left +
                                  R"(,{"do":"hold","mode":"position"},)" + both + "," + follow));
  for (const std::size_t k : {0U, 1U}) EXPECT_EQ(std::ranges::count(orders_of(session, k), 0), 3);
}

TEST(SecondFace, IsHeldAsItIsSaid) {
  const TwoSheets sheets = two_sheets();
  const std::string said[] = {R"({"do":"hold","mode":"open"})", R"({"do":"hold","rows":1})",
                              R"({"do":"pin","at":[0.5,0.5]})"};
  for (const std::string& command : said) {
    Session session = opened(sheets);
    ASSERT_TRUE(run_on(session, right_alone + "," + command + "," + left +
                                    R"(,{"do":"hold","mode":"position"},)" + both));
    EXPECT_FALSE(holds_trims(session.state().surfaces[1].constraints)) << command;
  }
  // Where the first is not held, nor is the second.
  Session session = opened(sheets);
  ASSERT_TRUE(run_on(session, both));
  EXPECT_TRUE(session.state().surfaces[1].constraints.empty());
}

TEST(SecondFace, ASeamThatWasNearlySmoothStaysSo) {
  // The right sheet is turned about the edge by 0.34 degrees.
  TwoSheets sheets = two_sheets();
  const double rise = std::tan(0.34 * std::numbers::pi / 180);
  for (const char* const point : {"(2.,0.,0.)", "(2.,1.,0.)"}) {
    const auto at = sheets.text.find(point);
    ASSERT_NE(at, std::string::npos);
    sheets.text.replace(at + 7, 2, fmt::format("{:.12f}", rise));
  }
  Session session = opened(sheets);
  const auto status =
      run(session, both + R"(,{"do":"edge","edge":")" + TwoSheets::name(sheets.edge) +
                       R"(","hold":"follow"},
      {"do":"seams","couple":false},)" +
                       press);
  ASSERT_TRUE(status) << status.error().message();
  const auto apart = parting(session.state(), *session.state().followed.at(0).course);
  ASSERT_TRUE(apart);
  EXPECT_NEAR(apart->angle_before, 0.34 * std::numbers::pi / 180, 1e-6);
  EXPECT_LE(apart->angle, 2 * apart->angle_before);
  EXPECT_GT(session.largest_displacement(0), 0.03);
  // By hand it is not creased either.
  Session other = opened(sheets);
  const Error error =
      refused(run_on(other, both + R"(,{"do":"edge","edge":")" + TwoSheets::name(sheets.edge) +
                                R"(","hold":"follow"},)" + right_alone +
                                R"(,{"do":"points","which":[2,3],"by":[0,0,0.5]})"));
  EXPECT_TRUE(says(error.what, "degrees")) << error.message();
}

}  // namespace
}  // namespace knead
