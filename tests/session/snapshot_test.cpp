// A session as bytes, and the same session again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "knead/session/session_info.hpp"
#include "sheet.hpp"

namespace knead {
namespace {

using testing::fresh;
using testing::on_sheet;
using testing::run;
using testing::same_state;

/// Something of everything that a state can hold.
const std::vector<std::string> rich = {
    R"({"do":"material","alpha":[0.1,0,0.1],"beta":[0.001,0.001,0.001]})",
    R"({"do":"material","alpha":[1,0,1],"beta":[0.01,0.01,0.01],)"
    R"("region":[[0.2,0.6],[0.2,0.6]],"falloff":0.2})",
    R"({"do":"refine","region":[[0,0.5],[0,0.5]]})",
    R"({"do":"pin","control_points":[[4,4],[5,4]]})",
    R"({"do":"pin","at":[0.3,0.3]})",
    R"({"do":"freeze","region":[[0.8,1],[0.8,1]]})",
    R"({"do":"evolve","mode":"dynamic","time_step":0.03})",
    R"({"do":"load","gravity":[0,0,-2],"pressure":0.1})",
    R"({"do":"force","name":"pull","at":[0.5,0.5],"to":[5,5,2],"strength":3})",
    R"({"do":"tool","name":"ball","radius":2,"position":[5,5,-1.5],"plasticity":0.5})",
    R"({"do":"tool","name":"box","shape":"box","sizes":[1,2,0.5],"rounding":0.1,)"
    R"("axis":[1,1,1],"position":[2,2,-0.2]})",
    R"({"do":"step","count":3})",
    R"({"do":"turn","tool":"box","axis":[1,2,3],"angle":30})",
    R"({"do":"step","count":2})",
    R"({"do":"remove","tool":"ball"})",
    R"({"do":"limit","distance":3})",
    R"({"do":"step"})",
};

Session again(const Session& session, std::size_t history = std::size_t{64} << 20U) {
  auto restored = Session::restore(session.document(), session.snapshot(history));
  EXPECT_TRUE(restored) << (restored ? "" : restored.error().message());
  return std::move(*restored);
}

TEST(Snapshot, RestoresEveryStateOfTheHistoryBitForBit) {
  Session session = on_sheet(rich);
  Session restored = again(session);
  EXPECT_EQ(script_json(restored.journal()), script_json(session.journal()));
  while (session.can_undo()) {
    ASSERT_TRUE(restored.can_undo());
    EXPECT_TRUE(same_state(session.state(), restored.state()));
    EXPECT_EQ(session.state().steps, restored.state().steps);
    EXPECT_EQ(session.state().notes, restored.state().notes);
    run(session, {R"({"do":"undo"})"});
    run(restored, {R"({"do":"undo"})"});
  }
  EXPECT_FALSE(restored.can_undo());
  while (session.can_redo()) {
    run(session, {R"({"do":"redo"})"});
    run(restored, {R"({"do":"redo"})"});
  }
  EXPECT_TRUE(same_state(session.state(), restored.state()));
  EXPECT_FALSE(restored.can_redo());
}

TEST(Snapshot, GoesOnToTheSameBits) {
  Session session = on_sheet(rich);
  Session restored = again(session);
  const std::vector<std::string> more = {R"({"do":"step","count":3})",
                                         R"({"do":"move","tool":"box","by":[0.2,0,0]})",
                                         R"({"do":"step","count":2})", R"({"do":"remove"})"};
  run(session, more);
  run(restored, more);
  EXPECT_TRUE(same_state(session.state(), restored.state()));
  EXPECT_EQ(session.snapshot().size(), restored.snapshot().size());
}

TEST(Snapshot, KeepsWhatIsToBeRedone) {
  Session session = on_sheet(rich);
  for (int k = 0; k < 5; ++k) run(session, {R"({"do":"undo"})"});
  Session restored = again(session);
  for (int k = 0; k < 5; ++k) {
    ASSERT_TRUE(restored.can_redo());
    run(session, {R"({"do":"redo"})"});
    run(restored, {R"({"do":"redo"})"});
    EXPECT_TRUE(same_state(session.state(), restored.state()));
  }
  EXPECT_FALSE(restored.can_redo());
}

TEST(Snapshot, LeavesOutTheOldestStatesButNoCommand) {
  Session session = on_sheet(rich);
  Session restored = again(session, 0);
  EXPECT_TRUE(same_state(session.state(), restored.state()));
  EXPECT_EQ(script_json(restored.journal()), script_json(session.journal()));
  EXPECT_FALSE(restored.can_undo());
  EXPECT_LT(session.snapshot(0).size(), session.snapshot().size());
  // What was left out once stays in the journal the next time.
  run(restored, {R"({"do":"step"})"});
  EXPECT_EQ(again(restored).journal().size(), session.journal().size() + 1);
}

TEST(Snapshot, SharesWhatTheHistoryShares) {
  Session session = on_sheet();
  const std::size_t before = session.snapshot().size();
  for (int k = 0; k < 50; ++k) run(session, {R"({"do":"limit","distance":3})"});
  // Fifty entries without a new shape: no control point is written again.
  EXPECT_LT(session.snapshot().size() - before, 50U * 1000U);
}

TEST(Snapshot, KeepsWhatProgramsReadOfNotes) {
  Session session = fresh();
  run(session, {R"({"do":"new","size":[10,10],"net":[10,10]})",
                R"({"do":"tool","name":"ball","radius":1.2,"position":[5,5,0.6],"plasticity":1})",
                R"({"do":"step"})"});
  const std::vector<Note>& notes = session.state().notes;
  ASSERT_TRUE(std::ranges::any_of(notes, [](const Note& n) { return n.diagnostic != nullptr; }));
  const Session restored = again(session);
  ASSERT_EQ(restored.state().notes, notes);
  for (std::size_t k = 0; k < notes.size(); ++k)
    EXPECT_EQ(note_json(restored.state().notes[k]), note_json(notes[k]));
}

TEST(Snapshot, SharesAgainWhatStatesShared) {
  Session session = on_sheet(rich);
  run(session, {R"({"do":"load","pressure":0.2})"});
  Session restored = again(session);
  const SceneSurface* const last = &restored.state().surfaces.front();
  const StepRecord* const step = &restored.state().steps.front();
  run(restored, {R"({"do":"undo"})"});
  EXPECT_EQ(&restored.state().surfaces.front(), last);
  EXPECT_EQ(&restored.state().steps.front(), step);
  run(restored, {R"({"do":"redo"})"});
  EXPECT_EQ(restored.snapshot(), session.snapshot());
}

constexpr std::size_t head = std::string_view("Knead snapshot e\n").size();

/// The bytes of a snapshot after its head with the version and the checksum that they have there.
std::string sealed(std::string snapshot, char version) {
  snapshot[head - 2] = version;
  std::uint64_t hash = 0xcbf29ce484222325U;
  const std::string_view content = std::string_view(snapshot).substr(head + 8);
  for (std::size_t k = 0; k < content.size(); k += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, content.data() + k, std::min<std::size_t>(8, content.size() - k));
    hash = (hash ^ word) * 0x100000001b3U;
  }
  hash ^= content.size();
  std::memcpy(&snapshot[head], &hash, sizeof hash);
  return snapshot;
}

TEST(Snapshot, ThatOfAnotherVersionIsRefusedWithWhatToDo) {
  const Session session = on_sheet();
  for (const char version : {'1', '9', 'a', 'b', 'c', 'd', 'f'}) {
    const auto restored =
        Session::restore(Document::fresh("test"), sealed(session.snapshot(), version));
    ASSERT_FALSE(restored) << version;
    EXPECT_EQ(restored.error().message().find('\n'), std::string::npos);
    EXPECT_NE(restored.error().what.find("another version"), std::string::npos)
        << restored.error().message();
    EXPECT_NE(restored.error().remedy.find("commands"), std::string::npos);
  }
}

std::string bytes_of(std::span<const double> numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()};
}

TEST(Snapshot, RefusesAShapeWithAnotherDomainThanTheSurfaceAsOpened) {
  Session session = fresh();
  run(session, {R"({"do":"new","size":[10,10],"net":[5,6]})",
                R"({"do":"points","rows_u":[2],"by":[0,0,1]})"});
  const SceneSurface& surface = session.state().surfaces.front();
  ASSERT_NE(surface.opened, surface.current);
  const std::string good = session.snapshot();
  const std::string knots = bytes_of(surface.current->knots(0).knots());
  std::vector<double> longer(surface.current->knots(0).knots().begin(),
                             surface.current->knots(0).knots().end());
  for (double& u : longer) u *= 2;
  std::string bad = good;  // with the last shape over a domain twice as long
  const std::size_t last = bad.rfind(knots);
  ASSERT_NE(last, bad.find(knots));
  bad.replace(last, knots.size(), bytes_of(longer));
  const auto refused = Session::restore(Document::fresh("test"), sealed(bad, good[head - 2]));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().where, "snapshot");
  for (std::size_t at = bad.find(knots); at != std::string::npos; at = bad.find(knots, at)) {
    bad.replace(at, knots.size(), bytes_of(longer));
  }
  EXPECT_TRUE(Session::restore(Document::fresh("test"),
                               sealed(bad, good[head - 2])));  // all over the longer one
}

/// The number as a snapshot has it: in lists as it lies in memory, else with the highest byte
/// first.
std::array<std::string, 2> forms_of(double number) {
  const std::string forward = bytes_of(std::span(&number, 1));
  return {forward, {forward.rbegin(), forward.rend()}};
}

TEST(Snapshot, RefusesNumbersOutOfTheRangesOfTheCommandsThatAreKept) {
  struct Kept {
    std::string command;
    double number, wrong;
  };
  for (const auto& [command, number, wrong] :
       {Kept{R"({"do":"evolve","mode":"dynamic","time_step":0.0316})", 0.0316, -0.0316},
        Kept{R"({"do":"pin","at":[0.3125,0.3125]})", 0.3125, 1.3125},
        Kept{R"({"do":"freeze","region":[[0.8125,1],[0.8125,1]]})", 0.8125, -0.8125},
        Kept{R"({"do":"keep","u":0.40625})", 0.40625, 1.40625},
        Kept{R"({"do":"force","name":"pull","at":[0.34375,0.5],"to":[5,5,2],"strength":3})",
             0.34375, 1.34375}}) {
    const Session session = on_sheet({command});
    const std::string good = session.snapshot();
    std::string bad = good;
    const auto from = forms_of(number), to = forms_of(wrong);
    for (std::size_t k = 0; k < 2; ++k) {
      for (std::size_t at = bad.find(from[k]); at != std::string::npos;
           at = bad.find(from[k], at)) {
        bad.replace(at, 8, to[k]);
      }
    }
    ASSERT_NE(bad, good) << command;
    EXPECT_TRUE(Session::restore(session.document(), good)) << command;
    EXPECT_FALSE(Session::restore(session.document(), sealed(bad, good[head - 2]))) << command;
  }
}

TEST(Snapshot, RefusesBytesThatAreNotItsOwn) {
  Session session = on_sheet(rich);
  const std::string good = session.snapshot();
  EXPECT_FALSE(Session::restore(session.document(), ""));
  EXPECT_FALSE(Session::restore(session.document(), "Knead snapshot a\n"));
  for (std::size_t size = 0; size < good.size(); size += 997) {
    EXPECT_FALSE(Session::restore(session.document(), std::string_view(good).substr(0, size)))
        << size;
  }
  for (std::size_t k = 0; k < good.size(); k += 1009) {
    std::string bad = good;
    bad[k] = static_cast<char>(bad[k] ^ 0x10);
    EXPECT_FALSE(Session::restore(session.document(), bad)) << k;
  }
  const auto other = Session::restore(session.document(), "garbage");
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message().find("snapshot"), std::string::npos);
}

}  // namespace
}  // namespace knead
