// All faces of a document follow data by one command.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knead/brep/edge_measures.hpp"
#include "session/info_values.hpp"
#include "session/queries/morph.hpp"
#include "session/running.hpp"
#include "support/error_codes.hpp"
#include "support/made_files.hpp"

namespace knead {
namespace {

using testing::opened;
using testing::run_on;
using testing::two_sheets;
using testing::TwoSheets;

const std::string bulge = R"({"do":"morph","space":"0; 0; 0.1*sin(3*x)*y"})";

/// What the query says the saved file would be.
std::string asked(const Session& session, const std::string& space) {
  MorphQuery query;
  query.request.space = space;
  const auto answer = ask(session, query);
  EXPECT_TRUE(answer) << answer.error().message();
  return answer ? answer->file.data : std::string();
}

void expect_closed(const std::string& bytes) {
  const auto source = open_source(bytes, "morphed.step");
  ASSERT_TRUE(source) << source.error().message();
  const auto measures = brep::measure_edges(*(*source)->model());
  ASSERT_TRUE(measures) << measures.error().message();
  for (const auto& edge : measures->edges) {
    EXPECT_LE(edge.gap ? edge.gap->value : 0, measures->gap_tolerance) << edge.id;
  }
}

Session block() {
  return Session(Document::from(*open_source(testing::block_file(), "block.step")));
}

TEST(MorphCommand, WhatIsSavedIsTheFileThatTheQueryGives) {
  for (const bool converts : {false, true}) {
    const TwoSheets sheets = two_sheets(false, converts);
    Session session = opened(sheets);
    const std::string wanted = asked(session, "0; 0; 0.1*sin(3*x)*y");
    const auto status = run_on(session, bulge);
    ASSERT_TRUE(status) << status.error().message();
    EXPECT_EQ(session.state().surfaces.size(), 2U);
    const auto saved = session.save();
    ASSERT_TRUE(saved) << saved.error().message();
    EXPECT_TRUE(*saved == wanted);
    ASSERT_TRUE(run_on(session, R"({"do":"undo"})"));
    EXPECT_EQ(*session.save(), sheets.text);
    ASSERT_TRUE(run_on(session, R"({"do":"redo"})"));
    EXPECT_TRUE(*session.save() == wanted);
  }
}

TEST(MorphCommand, ASolidWithConvertedPlanesStaysClosedAndIsSculptedOn) {
  Session session = block();
  const std::string before = *session.save();
  const auto status = run_on(session, R"({"do":"morph","space":"0; 0.05*z*sin(x); 0.1*x*y"})");
  ASSERT_TRUE(status) << status.error().message();
  EXPECT_EQ(session.state().surfaces.size(), 7U) << "two of the roof, and five planes";
  expect_closed(*session.save());
  // Edges are held where they are now.
  const std::string roof = session.state().surfaces[0].id;
  const auto pressed = run_on(
      session, fmt::format(R"({{"do":"select","surface":"{}"}},{{"do":"hold","mode":"position"}},
        {{"do":"drag","at":[0.5,0.5],"by":[0,0,0.05]}})",
                           roof));
  ASSERT_TRUE(pressed) << pressed.error().message();
  EXPECT_GT(session.largest_displacement(0), 0.02);
  expect_closed(*session.save());
  // And all of it moves on.
  const auto again = run_on(session, R"({"do":"morph","space":"0.02*z; 0; 0"})");
  ASSERT_TRUE(again) << again.error().message();
  expect_closed(*session.save());
}

TEST(MorphCommand, TheJournalAndTheSnapshotGiveTheSameFile) {
  Session session = block();
  const auto status = run_on(session, R"({"do":"morph","space":"0; 0; 0.1*sin(x)*y"})");
  ASSERT_TRUE(status) << status.error().message();
  ASSERT_TRUE(run_on(session, R"({"do":"morph","vectors":"0 0 0 0 0 0\n4 2 0 0 0 0.01\n",
                                  "reach":10,"tolerance":0.001})"));
  const std::string saved = *session.save();
  Session replayed = block();
  for (const Command& command : session.journal()) ASSERT_TRUE(replayed.execute(command));
  EXPECT_TRUE(*replayed.save() == saved);
  const Session fresh = block();
  auto restored = Session::restore(fresh.document(), session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_TRUE(*restored->save() == saved);
}

TEST(MorphCommand, DataAreTextOrBytes) {
  Session text = opened(two_sheets()), bytes = opened(two_sheets());
  // "0 0 0 0 0 0.1\n1 0 0 0 0 0.1\n2 1 0 0 0 0.1\n"
  ASSERT_TRUE(run_on(text, R"({"do":"morph",
      "vectors":"0 0 0 0 0 0.1\n1 0 0 0 0 0.1\n2 1 0 0 0 0.1\n"})"));
  ASSERT_TRUE(run_on(bytes, R"({"do":"morph",
      "vectors":"base64:MCAwIDAgMCAwIDAuMQoxIDAgMCAwIDAgMC4xCjIgMSAwIDAgMCAwLjEK"})"));
  EXPECT_GT(text.largest_displacement(0), 0.09);
  EXPECT_EQ(*text.save(), *bytes.save());
}

TEST(MorphCommand, SurfacesWithoutAFileFollowToo) {
  auto session = Session(Document::fresh("made", "mm"));
  ASSERT_TRUE(run_on(session, R"({"do":"new","net":[5,5]})"));
  ASSERT_TRUE(run_on(session, R"({"do":"morph","space":"0; 0; 0.1*x"})"));
  EXPECT_GT(session.largest_displacement(0), 0.01);
}

TEST(MorphCommand, SurfacesThatAreLockedStay) {
  Session locked = opened(two_sheets());
  ASSERT_TRUE(run_on(locked, R"({"do":"lock","surfaces":["#10"]})"));
  const auto status = run_on(locked, R"({"do":"morph","space":"0; 0; 0.01*max(x-1,0)^2"})");
  EXPECT_EQ(locked.largest_displacement(0), 0);
  EXPECT_TRUE(status || status.error().kind == ErrorKind::numerical) << status.error().message();
}

TEST(MorphCommand, EdgesHaveMovedWithTheirFaces) {
  Session session = opened(two_sheets());
  ASSERT_TRUE(run_on(session, bulge));
  std::size_t count = 0;
  for (const EdgesInfo& surface : edges_info(session)) {
    for (const EdgeInfo& edge : surface.edges) {
      EXPECT_EQ(edge.deviation, 0) << edge.id << ": it is where its faces are";
      ++count;
    }
  }
  EXPECT_EQ(count, 8U);
}

TEST(MorphCommand, ErrorsNameTheField) {
  const std::pair<std::string, std::string> wrong[] = {
      {R"({"do":"morph"})", "vectors"},
      {R"({"do":"morph","space":"0;0;0","vectors":"0 0 0 0 0 0"})", "vectors"},
      {R"({"do":"morph","from":"0 0 0"})", "to"},
      {R"({"do":"morph","vectors":"base64:*"})", "vectors"},
      {R"({"do":"morph","vectors":"0 0 0 0 0 x"})", "vectors"},
      {R"({"do":"morph","space":"0; 0"})", "space"}};
  for (const auto& [text, field] : wrong) {
    Session session = opened(two_sheets());
    const auto status = run_on(session, text);
    ASSERT_FALSE(status) << text;
    EXPECT_EQ(status.error().kind, ErrorKind::input) << status.error().message();
    EXPECT_NE(status.error().message().find(field), std::string::npos) << status.error().message();
    EXPECT_FALSE(session.can_undo());
  }
}

/// A scan of the bulge, in which its edges lie.
std::string scan_of_bulge() {
  std::string points;
  for (int i = 0; i <= 40; ++i) {
    for (int j = 0; j <= 20; ++j) {
      const double x = i / 20.0, y = j / 20.0;
      points += fmt::format("{} {} {}\\n", x, y, 0.1 * std::sin(3 * x) * y);
    }
  }
  return R"({"do":"morph","reach":1,"noise":0.001,"scan":")" + points + "\"}";
}

TEST(MorphCommand, TellsItsPhasesAndEndsWhereItIsStopped) {
  for (const std::string& text : {bulge, scan_of_bulge()}) {
    const auto command = parse_command(text);
    ASSERT_TRUE(command) << command.error().message();
    std::vector<int> told;
    long long asked = 0;
    Session whole = opened(two_sheets());
    const auto status = whole.execute(
        *command,
        [&](int done, int of) {
          EXPECT_EQ(of, 48);
          told.push_back(done);
          return true;
        },
        [&] { return ++asked > 0; });
    ASSERT_TRUE(status) << status.error().message();
    EXPECT_TRUE(std::ranges::is_sorted(told));
    for (const int phase : {0, 8, 16, 24, 32, 40}) EXPECT_TRUE(std::ranges::count(told, phase) > 0);
    // Turns of the scan.
    EXPECT_EQ(std::ranges::count_if(told, [](int k) { return k > 16 && k < 24; }) > 0,
              text != bulge);
    EXPECT_GT(asked, 20);
    for (const double share : {0.0, 0.3, 0.6, 0.95}) {
      const auto until = static_cast<long long>(share * static_cast<double>(asked));
      const auto parts = static_cast<int>(share * static_cast<double>(told.size()));
      long long again = 0;
      int count = 0;
      Session session = opened(two_sheets());
      const auto ended = session.execute(*command, {}, [&] { return again++ < until; });
      ASSERT_FALSE(ended) << share;
      EXPECT_NE(ended.error().what.find("stopped"), std::string::npos) << ended.error().message();
      EXPECT_EQ(again, until + 1) << "nobody asks again";
      const auto refused = session.execute(*command, [&](int, int) { return count++ < parts; });
      ASSERT_FALSE(refused) << share;
      EXPECT_NE(refused.error().what.find("stopped"), std::string::npos);
      EXPECT_EQ(count, parts + 1);
      EXPECT_FALSE(session.can_undo());
      EXPECT_EQ(*session.save(), two_sheets().text);
    }
  }
}

}  // namespace
}  // namespace knead
