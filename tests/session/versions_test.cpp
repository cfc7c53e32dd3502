// What was written by programs before opens: scripts of version 1, and documents with the snapshot of that time.
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "sheet.hpp"

namespace knead {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::fresh;

const fs::path data = fs::path(KNEAD_SOURCE_DIR) / "tests/session/data";

std::string text_of(const std::string& name) {
  std::ifstream in(data / name);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string bytes_of(const std::string& base64) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (char c : base64) {
    if (c == '=') break;
    bits = bits << 6U | static_cast<unsigned>(digits.find(c));
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<char>(bits >> static_cast<unsigned>(count) & 0xffU));
    }
  }
  return bytes;
}

Session after(const std::vector<Command>& commands) {
  Session session = fresh();
  for (const Command& command : commands) {
    const auto done = session.execute(command);
    EXPECT_TRUE(done) << to_json(command) << ": " << done.error().message();
  }
  return session;
}

/// The surface on which a press of its time swung a fifth beyond its tool, which it does not any more: its shape is not
/// that of its script; −1: none.
int swung_in(std::string_view name) { return name == "symmetry_1" ? 1 : -1; }

void expect_close(const SessionState& a, const SessionState& b, int swung = -1) {
  ASSERT_EQ(a.surfaces.size(), b.surfaces.size());
  for (std::size_t k = 0; k < a.surfaces.size(); ++k) {
    const SceneSurface &s = a.surfaces[k], &t = b.surfaces[k];
    ASSERT_EQ(s.current->net(), t.current->net());
    for (const auto& shapes : {std::pair{s.current, t.current}, std::pair{s.rest, t.rest}}) {
      if (static_cast<int>(k) == swung) continue;
      const Points way = shapes.first->control_points() - shapes.second->control_points();
      EXPECT_LE(way.cwiseAbs().maxCoeff(), 1e-9) << "surface " << k;
    }
    ASSERT_EQ(s.velocity.rows(), t.velocity.rows());
    if (s.velocity.rows() > 0) {
      EXPECT_LE((s.velocity - t.velocity).cwiseAbs().maxCoeff(), 1e-7);
    }
    EXPECT_EQ(s.pins, t.pins);
    ASSERT_EQ(s.constraints.size(), t.constraints.size());
    for (std::size_t c = 0; c < s.constraints.size(); ++c) {
      EXPECT_EQ(s.constraints[c].constraint, t.constraints[c].constraint);
    }
  }
  EXPECT_EQ(a.load, b.load);
  EXPECT_EQ(a.forces, b.forces);
  EXPECT_EQ(a.evolution, b.evolution);
  EXPECT_EQ(a.tools.size(), b.tools.size());
}

class OldDocument : public ::testing::TestWithParam<const char*> {};

TEST_P(OldDocument, OpensBySnapshotAndByCommandsWithOneResult) {
  const Json document = Json::parse(text_of(std::string(GetParam()) + ".knead"));
  ASSERT_EQ(document.at("knead"), 2);
  auto restored = Session::restore(Document::fresh("old"), bytes_of(document.at("snapshot")));
  ASSERT_TRUE(restored) << restored.error().message();
  std::vector<Command> commands;
  for (const Json& json : document.at("commands")) {
    const auto command = parse_command(json.dump());
    ASSERT_TRUE(command) << json << command.error().message();
    commands.push_back(*command);
  }
  const Session replayed = after(commands);
  expect_close(replayed.state(), restored->state(), swung_in(GetParam()));
  EXPECT_EQ(restored->journal().size(), replayed.journal().size());
  // All of the history is there.
  ASSERT_TRUE(restored->can_undo());
  while (restored->can_undo()) testing::run(*restored, {R"({"do":"undo"})"});
  EXPECT_TRUE(restored->state().surfaces.empty());
}

TEST_P(OldDocument, HasTheResultOfItsScript) {
  const Json document = Json::parse(text_of(std::string(GetParam()) + ".knead"));
  const auto restored = Session::restore(Document::fresh("old"), bytes_of(document.at("snapshot")));
  ASSERT_TRUE(restored) << restored.error().message();
  const auto commands = parse_script(text_of(std::string(GetParam()) + ".json"), GetParam());
  ASSERT_TRUE(commands) << commands.error().message();
  expect_close(after(*commands).state(), restored->state(), swung_in(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Version1, OldDocument, ::testing::Values("holds_1", "symmetry_1"));

TEST(OldScript, ThatResetsAPaintedMaterialHasTheEnergyOfItsTime) {
  const auto commands = parse_script(text_of("paint_1.json"), "paint_1.json");
  ASSERT_TRUE(commands) << commands.error().message();
  const Session session = after(*commands);
  EXPECT_NEAR(session.state().steps.back().energy, 0.0024080287226643012, 1e-12);
  EXPECT_NEAR(session.state().steps.back().largest_displacement, 0.13526452927786894, 1e-10);
}

TEST(OldScript, IsWrittenWithTheSameResult) {
  for (const char* name : {"holds_1.json", "symmetry_1.json", "paint_1.json"}) {
    const auto commands = parse_script(text_of(name), name);
    ASSERT_TRUE(commands);
    const Session session = after(*commands);
    const std::string journal = script_json(session.journal());
    const auto again = parse_script(journal, "journal");
    ASSERT_TRUE(again) << again.error().message();
    expect_close(after(*again).state(), session.state());
  }
}

}  // namespace
}  // namespace knead
