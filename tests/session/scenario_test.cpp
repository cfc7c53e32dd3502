// The scenarios of tests/scenarios, run by the native session; tests/web/scenarios.test.ts runs the
// same files in WebAssembly. A step is a command, {"refused": command, "where": field}, or
// {"expect": pointer into the state's JSON} with "is", or "min" and "max".
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "knead/session/session_info.hpp"
#include "support.hpp"

namespace knead {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const fs::path root = KNEAD_SOURCE_DIR;

std::vector<std::string> scenarios() {
  std::vector<std::string> names;
  for (const auto& file : fs::directory_iterator(root / "tests/scenarios"))
    names.push_back(file.path().stem().string());
  std::ranges::sort(names);
  return names;
}

class Scenario : public ::testing::TestWithParam<std::string> {};

TEST_P(Scenario, RunsAsItSays) {
  std::ifstream in(root / "tests/scenarios" / (GetParam() + ".json"));
  const Json scenario = Json::parse(in);
  auto document = scenario.contains("open")
                      ? Document::open((root / scenario.at("open").get<std::string>()).string())
                      : Expected<Document>(Document::fresh(GetParam()));
  ASSERT_TRUE(document) << document.error().message();
  Session session(std::move(*document));
  int expectations = 0;
  for (const Json& step : scenario.at("steps")) {
    if (step.contains("do")) {
      testing::run(session, {step.dump()});
      if (HasFatalFailure()) return;
    } else if (step.contains("refused")) {
      const Json before = Json::parse(session_json(session));
      EXPECT_EQ(testing::refusal(session, step.at("refused").dump()).where,
                step.at("where").get<std::string>())
          << step;
      EXPECT_EQ(Json::parse(session_json(session)), before) << step;
    } else {
      // What is not there is null.
      const Json value =
          Json::parse(session_json(session)).value(Json::json_pointer(step.at("expect")), Json());
      if (step.contains("is")) {
        EXPECT_EQ(value, step.at("is")) << step;
      } else {
        EXPECT_GE(value.get<double>(), step.at("min").get<double>()) << step;
        EXPECT_LE(value.get<double>(), step.at("max").get<double>()) << step;
      }
      ++expectations;
    }
  }
  EXPECT_GT(expectations, 0);
}

INSTANTIATE_TEST_SUITE_P(Files, Scenario, ::testing::ValuesIn(scenarios()),
                         [](const auto& scenario) { return scenario.param; });

}  // namespace
}  // namespace knead
