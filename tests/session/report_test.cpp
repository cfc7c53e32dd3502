// What commands have made of a session, as values; errors of scripts with their places.
#include "knead/session/report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "knead/session/command_json.hpp"
#include "knead/session/session_info.hpp"
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
  run(session, {sheet, R"({"do":"edge"})", R"({"do":"tool","radius":20,"position":[100,50,14]})",
                R"({"do":"step","count":3})"});
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

TEST(Report, GivesTheReadingOfEachProbeInItsList) {
  Session session(Document::fresh("sheet"));
  run(session, {sheet, R"({"do":"measure","name":"a","at":[0.5,0.25]})",
                R"({"do":"measure","name":"b","at":[1,1]})"});
  const auto text = report_json(session, outcome_of(session, 0));
  ASSERT_TRUE(text);
  const auto probes = nlohmann::json::parse(*text).at("measurements");
  ASSERT_EQ(probes.size(), 2u);
  EXPECT_EQ(probes[0].at("name"), "a");
  EXPECT_EQ(probes[0].at("surface"), "#1");
  EXPECT_NEAR(probes[0].at("point")[0].get<double>(), 100, 1e-11);
  EXPECT_NEAR(probes[0].at("point")[1].get<double>(), 25, 1e-11);
  EXPECT_NEAR(probes[1].at("point")[0].get<double>(), 200, 1e-11);
  EXPECT_FALSE(probes[0].contains("von_mises")) << "a linear sheet has no stresses";
}

TEST(Report, HasEveryFigureThatTheDescriptionOfAStepHas) {
  Session session(Document::fresh("sheet"));
  run(session, {sheet, R"({"do":"step"})"});
  const auto text = report_json(session, outcome_of(session, 0));
  ASSERT_TRUE(text);
  const auto step = nlohmann::json::parse(*text).at("steps").at(0);
  const auto page = nlohmann::json::parse(steps_json(session, 0)).at(0);
  for (const auto& [name, value] : page.items()) {
    if (name != "surface" && name != "iterations") {
      EXPECT_EQ(step.at(name), value) << name;
    }
  }
  EXPECT_EQ(step.size() + 2, page.size());
}

TEST(ReportEdges, SaysHowTheEdgesOfFacesAreHeld) {
  auto document = Document::open(bonnet);
  ASSERT_TRUE(document);
  Session session(*std::move(document));
  EXPECT_TRUE(report_edges(session).empty()) << "nothing moved, and nothing is held";
  run(session, {R"({"do":"select","surface":"#285"})", R"({"do":"hold","mode":"tangent"})"});
  const auto edges = report_edges(session);
  ASSERT_EQ(edges.size(), 1u);
  const SceneSurface& s = session.state().surfaces[static_cast<std::size_t>(edges[0].surface)];
  EXPECT_EQ(s.id, "#285");
  const EdgesReport& report = edges[0];
  ASSERT_FALSE(report.edges.empty());
  for (const EdgeReport& edge : report.edges) {
    EXPECT_EQ(edge.hold, "tangent") << edge.id;
    EXPECT_TRUE(edge.held) << edge.id;
  }
  EXPECT_TRUE(report_followed(session).empty()) << "no angles are reported";
  EXPECT_EQ(report.largest_gap, 0) << "it is as it was opened";
  EXPECT_LT(report.free, s.current->size());
}

TEST(ReportEdges, SaysWhichAreFree) {
  auto document = Document::open(bonnet);
  ASSERT_TRUE(document);
  Session session(*std::move(document));
  run(session, {R"({"do":"select","surface":"#285"})", R"({"do":"hold","mode":"position"})"});
  const auto held = report_edges(session);
  ASSERT_EQ(held.size(), 1u);
  ASSERT_FALSE(held[0].edges.empty());
  const EdgeReport& first = held[0].edges.front();
  EXPECT_EQ(first.hold, "position");
  run(session, {R"({"do":"edge","hold":"open","edge":")" + first.id + "\"}"});
  const auto opened = report_edges(session);
  ASSERT_EQ(opened.size(), 1u);
  EXPECT_EQ(opened[0].edges.front().id, first.id);
  EXPECT_EQ(opened[0].edges.front().hold, "open");
  EXPECT_FALSE(opened[0].edges.front().held);
}

TEST(Session, GivesItsSurfacesAndToolsAsValues) {
  Session session(Document::fresh("sheet"));
  EXPECT_TRUE(session.surfaces().empty());
  EXPECT_TRUE(session.selection().empty());
  run(session, {sheet, R"({"do":"edge"})", R"({"do":"tool","radius":20,"position":[100,50,14]})",
                R"({"do":"step","count":3})"});
  const auto surfaces = session.surfaces();
  ASSERT_EQ(surfaces.size(), 1u);
  EXPECT_EQ(surfaces[0].id, "#1");
  EXPECT_EQ(surfaces[0].current, session.state().surfaces[0].current) << "shared, not copied";
  EXPECT_NE(surfaces[0].current, surfaces[0].opened);
  EXPECT_EQ(session.selection(), std::vector<int>{0});
  ASSERT_EQ(session.tools().size(), 1u);
  EXPECT_EQ(session.steps().size(), 3u);
  EXPECT_EQ(in_words(session.tools()[0].shape.shape()), "sphere of radius 20");
}

TEST(ResultGrids, HaveTheDisplacementAndTheModes) {
  Session session(Document::fresh("plate"));
  run(session, {R"({"do":"new","size":[100,100],"net":[9,9]})",
                R"({"do":"material","model":"shell","young":70000,"thickness":1,"poisson":0.3,)"
                R"("density":1e-6})",
                R"({"do":"edge","hold":"tangent"})", R"({"do":"modes","count":2})"});
  const auto grids = result_grids(session, 5);
  ASSERT_TRUE(grids);
  ASSERT_EQ(grids->size(), 1u);
  EXPECT_EQ(grids->front().name, "#1");
  std::vector<std::string> names;
  for (const GridField& field : grids->front().fields) names.push_back(field.name);
  for (const char* name :
       {"displacement", "membrane", "moment", "von_mises", "bending_strain", "mode_1", "mode_2"}) {
    EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
  }
  EXPECT_EQ(result_grids(session, 1).error().where.substr(0, 2), "#1");
}

TEST(ScriptErrors, NameScriptCommandAndFile) {
  Session fresh(Document::fresh("sheet"));
  const Error error{ErrorKind::usage, "too large", "radius", "use less"};
  const Error made = error_at_command(error, fresh.document(), "press.json", 3);
  EXPECT_EQ(made.message(), "press.json: commands[3]: radius: too large; use less");
  EXPECT_EQ(made.kind, ErrorKind::input) << "what is wrong in a script is wrong input";
  EXPECT_EQ(error_at_command(error, fresh.document(), "press.json", std::nullopt).message(),
            "press.json: radius: too large; use less");

  const auto document = Document::open(bonnet);
  ASSERT_TRUE(document);
  const Error entity{ErrorKind::numerical, "has no area", "#285", ""};
  const Error in_file = error_at_command(entity, *document, "press.json", 0);
  EXPECT_EQ(in_file.message(), "press.json: commands[0]: " + bonnet + ": #285: has no area");
  EXPECT_EQ(in_file.kind, ErrorKind::numerical);
  EXPECT_EQ(error_at_command(entity, fresh.document(), "press.json", 0).where, "commands[0]: #285")
      << "a new document has no file";
}

TEST(ScriptErrors, SayWhatAFileIsThatIsNoScript) {
  const Error error{ErrorKind::input, "this is not JSON", "", ""};
  EXPECT_EQ(error_of_script(error, "ISO-10303-21;\nHEADER;", "a").what,
            "this is a STEP file, not a script");
  EXPECT_EQ(error_of_script(error, " \n", "a").what, "this is an empty file, not a script");
  EXPECT_EQ(error_of_script(error, "\x89PNG....", "a").what, "this is an image, not a script");
  EXPECT_EQ(error_of_script(error, "NRRD0004\n", "a").what, "this is an NRRD file, not a script");
  EXPECT_EQ(error_of_script(error, "{", "a").message(), "a: this is not JSON");
}

}  // namespace
}  // namespace knead::testing
