// What commands have made of a session, as values.
#include "knead/session/report.hpp"

#include <algorithm>

#include "support.hpp"

namespace knead::testing {
namespace {

const char* const sheet = R"({"do":"new","size":[200,100],"net":[14,10]})";
const std::string bonnet = std::string(KNEAD_SOURCE_DIR) + "/samples/bonnet.step";

TEST(Outcome, OfNothingDoneIsNothing) {
  Session session(Document::fresh("sheet"));
  run(session, {sheet});
  const Outcome o = outcome_of(session, 0);
  EXPECT_EQ(o.moved, 0);
  EXPECT_EQ(o.surfaces, 0);
  EXPECT_EQ(o.time, 0);
  EXPECT_EQ(o.largest_displacement, 0);
  EXPECT_EQ(o.energy_before, o.energy_after);
  EXPECT_FALSE(o.no_energy);
}

TEST(Outcome, AddsUpTheStepsAndWhatTheyMoved) {
  Session session(Document::fresh("sheet"));
  run(session,
      {sheet, R"({"do":"edge"})", R"({"do":"tool","radius":20,"position":[100,50,14]})", R"({"do":"step","count":3})"});
  const Outcome o = outcome_of(session, 0);
  const auto& steps = session.state().steps;
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_DOUBLE_EQ(o.time, steps[0].time + steps[1].time + steps[2].time);
  EXPECT_EQ(o.residual, steps.back().residual);
  EXPECT_EQ(o.gap, steps.back().gap);
  EXPECT_EQ(o.surfaces, 1);
  EXPECT_EQ(o.bodies, 0);
  EXPECT_EQ(o.moved, session.moved_control_points(0));
  EXPECT_GT(o.moved, 0);
  EXPECT_EQ(o.largest_displacement, session.largest_displacement(0));
  EXPECT_GT(o.energy_after, o.energy_before);
}

TEST(ReportProbes, GivesTheReadingOfEach) {
  Session session(Document::fresh("sheet"));
  run(session, {sheet, R"({"do":"measure","name":"a","at":[0.5,0.25]})", R"({"do":"measure","name":"b","at":[1,1]})"});
  const auto probes = report_probes(session.state());
  ASSERT_TRUE(probes);
  ASSERT_EQ(probes->size(), 2u);
  EXPECT_EQ(probes->front().probe.name, "a");
  EXPECT_EQ(probes->front().surface, "#1");
  EXPECT_LT((probes->front().reading.point - Point(100, 25, 0)).norm(), 1e-11);
  EXPECT_LT((probes->back().reading.point - Point(200, 100, 0)).norm(), 1e-11);
  EXPECT_FALSE(probes->front().shell) << "a linear sheet has no stresses";
}

TEST(ReportEdges, SaysHowTheEdgesOfFacesAreHeld) {
  auto document = Document::open(bonnet);
  ASSERT_TRUE(document);
  Session session(*std::move(document));
  EXPECT_TRUE(report_edges(session.state()).empty()) << "nothing moved, and nothing is held";
  run(session, {R"({"do":"select","surface":"#285"})", R"({"do":"hold","mode":"trim-g1"})"});
  const auto edges = report_edges(session.state());
  ASSERT_EQ(edges.size(), 1u);
  const SceneSurface& s = session.state().surfaces[static_cast<std::size_t>(edges[0].surface)];
  EXPECT_EQ(s.id, "#285");
  const TrimReport& trims = edges[0].trims;
  ASSERT_FALSE(trims.edges.empty());
  EXPECT_EQ(edges[0].angles.size(), trims.edges.size());
  for (const TrimReport::Edge& edge : trims.edges) EXPECT_EQ(hold_of(edge), "clamped") << edge.held.id;
  EXPECT_EQ(trims.largest, 0) << "it is as it was opened";
  EXPECT_LT(trims.free, s.current->size());
  TrimReport::Edge other = trims.edges.front();
  other.held.order = -1;
  EXPECT_EQ(hold_of(other), "free");
  other.follows = true;
  EXPECT_EQ(hold_of(other), "follow");
}

TEST(ResultGrids, HaveTheDisplacementAndTheModes) {
  Session session(Document::fresh("plate"));
  run(session, {R"({"do":"new","size":[100,100],"net":[9,9]})",
                R"({"do":"material","model":"shell","young":70000,"thickness":1,"poisson":0.3,"density":1e-6})",
                R"({"do":"edge","hold":"clamped"})", R"({"do":"modes","count":2})"});
  const auto grids = result_grids(session.state(), 5);
  ASSERT_TRUE(grids);
  ASSERT_EQ(grids->size(), 1u);
  EXPECT_EQ(grids->front().name, "#1");
  std::vector<std::string> names;
  for (const GridField& field : grids->front().fields) names.push_back(field.name);
  for (const char* name : {"displacement", "membrane", "moment", "von_mises", "bending_strain", "mode_1", "mode_2"}) {
    EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
  }
  EXPECT_EQ(result_grids(session.state(), 1).error().where.substr(0, 2), "#1");
}

}  // namespace
}  // namespace knead::testing
