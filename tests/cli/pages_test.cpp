#include <sstream>

#include "knead/session/command_json.hpp"
#include "program.hpp"

namespace knead::testing {
namespace {

// What the documentation shows and promises of scripts.

std::string page(const std::string& name) {
  return content_of(std::string(KNEAD_SOURCE_DIR) + "/" + name);
}

/// The indented blocks of a page that are scripts.
std::vector<Json> scripts_in(const std::string& text) {
  std::vector<Json> scripts;
  const std::string begin = "\n    {\"knead\": ", end = "\n    ]}";
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at + 1)) {
    scripts.push_back(Json::parse(text.substr(at, text.find(end, at) + end.size() - at)));
  }
  return scripts;
}

TEST(Pages, EveryScriptShownSculptsTheSample) {
  for (const char* name : {"docs/scripts.md", "docs/trims.md", "README.md"}) {
    const std::vector<Json> scripts = scripts_in(page(name));
    EXPECT_FALSE(scripts.empty()) << name;
    for (const Json& script : scripts) {
      const Workshop workshop;
      const std::string report = workshop / "report.json";
      const Outcome run = knead({"sculpt", bonnet(), "-o", workshop / "out.step", "--script",
                                 workshop.file("script.json", script.dump()), "--report", report});
      EXPECT_EQ(run.code, 0) << name << ": " << script << "\n" << run.err;
      EXPECT_GT(Json::parse(content_of(report)).at("largest_displacement").get<double>(), 1)
          << "mm; " << script;
    }
  }
}

TEST(Pages, ThePlateShownHasTheDeflectionStated) {
  const std::string text = page("docs/scripts.md"), begin = "\n    {\"knead\":2,", end = "\n    ]}";
  const std::size_t at = text.find(begin);
  ASSERT_NE(at, std::string::npos);
  const std::string script = text.substr(at, text.find(end, at) + end.size() - at);
  const auto deflection = [](const std::string& script_text) {
    const Workshop workshop;
    const Outcome run =
        knead({"sculpt", "--new", "-o", workshop / "plate.step", "--script",
               workshop.file("script.json", script_text), "--report", workshop / "report.json"});
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(knead({"info", workshop / "plate.step"}).code, 0);
    return Json::parse(content_of(workshop / "report.json"))
        .at("largest_displacement")
        .get<double>();
  };
  EXPECT_NEAR(deflection(script), 0.00126532, 5e-9);
  std::string supported = script;
  supported.replace(supported.find("tangent"), 7, "position");
  EXPECT_NEAR(deflection(supported), 0.00406235, 5e-9);
}

TEST(Pages, EveryCommandAndFieldOfTheHelpIsExplained) {
  const std::string text = page("docs/scripts.md");
  int fields = 0;
  for (const std::string& name : command_names()) {
    const std::size_t from = text.find("\n### " + name + "\n");
    ASSERT_NE(from, std::string::npos) << name;
    std::istringstream help(knead({"commands", name}).out);
    std::string line, field;
    std::getline(help, line);  // what it does
    while (std::getline(help, line)) {
      std::istringstream(line) >> field;
      if (field == "(no") continue;
      const std::size_t at = text.find("\n| `" + field + "` |", from);
      EXPECT_LT(at, text.find("\n### ", from + 1)) << name << "." << field << " is not explained";
      ++fields;
    }
  }
  EXPECT_GE(fields, 80);
}

TEST(Pages, TheGramianShownIsTheOnePrinted) {
  const std::string text = page("docs/command-line.md");
  std::istringstream run(
      knead({"gramian", "--degree", "1", "--knots", "-1,-1,0,1,1", "--a", "1", "--b", "1"}).out);
  for (std::string line; std::getline(run, line);)
    EXPECT_NE(text.find("    " + line + "\n"), std::string::npos) << line;
}

}  // namespace
}  // namespace knead::testing
