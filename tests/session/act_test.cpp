#include <gtest/gtest.h>

#include <vector>

#include "knead/session/command_json.hpp"
#include "session/session_state.hpp"

namespace knead {
namespace {

Command told(const char* json) {
  auto command = parse_command(json);
  EXPECT_TRUE(command) << json << ": " << (command ? "" : command.error().message());
  return *std::move(command);
}

std::vector<Command> all_of(std::initializer_list<const char*> list) {
  std::vector<Command> commands;
  for (const char* json : list) commands.push_back(told(json));
  return commands;
}

constexpr const char *pull = R"({"do":"points","which":[27],"by":[0,0,1]})",
                     *undo = R"({"do":"undo"})", *redo = R"({"do":"redo"})",
                     *nowhere = R"({"do":"select","surface":"#77"})",
                     *rubber = R"({"do":"material","preset":"rubber"})", *step = R"({"do":"step"})";

/// A sheet whose document ends here: what stands cannot be undone.
Session opened_sheet() {
  Session session(Document::fresh("sheet"));
  for (const char* json : {R"({"do":"new","size":[10,10]})", R"({"do":"hold","rows":2})"}) {
    EXPECT_TRUE(session.execute(told(json)));
  }
  session.begin_history();
  return session;
}

Points points_of(const Session& session) {
  return session.state().surfaces[0].current->control_points();
}

void expect_done(Session& session, std::initializer_list<const char*> commands,
                 const ActOptions& options = {}) {
  const auto status = session.act(all_of(commands), options);
  ASSERT_TRUE(status) << status.error().message();
}

TEST(Act, IsOneEntryOfTheHistory) {
  Session session = opened_sheet();
  const Points before = points_of(session);
  expect_done(session, {pull, pull, rubber});
  EXPECT_EQ(session.journal().size(), 5U);
  expect_done(session, {undo});
  EXPECT_EQ(points_of(session), before);
  EXPECT_FALSE(session.can_undo());
  expect_done(session, {redo});
  EXPECT_EQ(session.journal().size(), 5U);
  EXPECT_FALSE(session.can_redo());
}

TEST(Act, ThatFailsChangesNothing) {
  Session session = opened_sheet();
  expect_done(session, {pull});
  expect_done(session, {pull});
  expect_done(session, {undo});
  const Points before = points_of(session);
  for (const bool join : {false, true}) {
    for (const auto& commands : {all_of({pull, rubber, nowhere}), all_of({undo, pull, nowhere}),
                                 all_of({redo, nowhere}), all_of({nowhere})}) {
      EXPECT_FALSE(session.act(commands, {.join = join}));
      EXPECT_EQ(points_of(session), before);
      EXPECT_EQ(session.journal().size(), 3U);
      EXPECT_TRUE(session.can_redo());
      EXPECT_TRUE(session.can_undo());
    }
  }
  expect_done(session, {redo});
  EXPECT_EQ(points_of(session)(27, 2), before(27, 2) + 1);
}

TEST(Act, ThatChangesNothingIsNoEntry) {
  Session session = opened_sheet();
  expect_done(session, {rubber});
  expect_done(session, {pull});
  expect_done(session, {undo});
  for (const auto& commands :
       {all_of({step}), all_of({rubber}), all_of({R"({"do":"hold","rows":2})", step})}) {
    const auto changed = session.act(commands);
    ASSERT_TRUE(changed) << changed.error().message();
    EXPECT_FALSE(*changed);
    EXPECT_EQ(session.journal().size(), 3U);
    EXPECT_TRUE(session.can_redo()) << "what can be redone stays";
  }
  EXPECT_EQ(session.act(all_of({R"({"do":"material","preset":"clay"})"})), true);
  EXPECT_EQ(session.act(all_of({step}), {.keep = true}), true);
  EXPECT_EQ(session.journal().size(), 5U);
  session.drop_unchanged();
  EXPECT_EQ(session.journal().size(), 4U);
  session.drop_unchanged();
  EXPECT_EQ(session.journal().size(), 4U) << "the material was another one";
  expect_done(session, {R"({"do":"tool","position":[5,5,3]})"});
  session.drop_unchanged();
  EXPECT_EQ(session.journal().size(), 5U) << "tools are not among what steps change";
}

TEST(Act, ThatIsJoinedIsUndoneWithTheEntryBefore) {
  Session session = opened_sheet();
  const Points before = points_of(session);
  expect_done(session, {pull});
  expect_done(session, {pull, rubber}, {.join = true});
  EXPECT_EQ(points_of(session)(27, 2), before(27, 2) + 2);
  EXPECT_FALSE(session.act(all_of({pull, nowhere}), {.join = true}));
  EXPECT_EQ(points_of(session)(27, 2), before(27, 2) + 2);
  expect_done(session, {undo});
  EXPECT_EQ(points_of(session), before);
}

TEST(Act, ThatOnlyLooksIsNotJoinedByTheNext) {
  Session session = opened_sheet();
  expect_done(session, {pull});
  const Points before = points_of(session);
  expect_done(session, {R"({"do":"modes","count":1})", pull});
  expect_done(session, {undo});
  EXPECT_EQ(points_of(session), before);
}

TEST(Act, NeverReachesBelowTheFloor) {
  Session session = opened_sheet();
  EXPECT_EQ(session.opening_commands(), 2U);
  EXPECT_FALSE(session.act(all_of({undo})));
  expect_done(session, {pull}, {.join = true});
  expect_done(session, {undo});
  EXPECT_EQ(session.journal().size(), 2U);
  EXPECT_FALSE(session.can_undo());
}

TEST(Act, FindsTheFloorAgainInARestoredSession) {
  Session session = opened_sheet();
  for (int k = 0; k < 3; ++k) expect_done(session, {pull});
  expect_done(session, {undo});
  auto restored = Session::restore(Document::fresh("sheet"), session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  restored->begin_history_after(session.opening_commands());
  EXPECT_EQ(restored->opening_commands(), 2U);
  EXPECT_TRUE(restored->can_redo());
  int undone = 0;
  for (; restored->can_undo(); ++undone) expect_done(*restored, {undo});
  EXPECT_EQ(undone, 2);
  EXPECT_EQ(restored->journal().size(), 2U);
}

TEST(Run, MakesAnEntryOfEachCommandOrNone) {
  Session session = opened_sheet();
  const auto named = [](Error error, std::size_t k) {
    error.where = "command " + std::to_string(k);
    return error;
  };
  ASSERT_TRUE(session.run(all_of({pull, rubber}), named));
  EXPECT_EQ(session.journal().size(), 4U);
  expect_done(session, {undo});
  const Points before = points_of(session);
  const auto failed = session.run(all_of({undo, pull, nowhere}), named);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().where, "command 2");
  EXPECT_EQ(points_of(session), before);
  EXPECT_TRUE(session.can_undo() && session.can_redo());
}

TEST(Run, ThatIsStoppedKeepsWhatIsDone) {
  Session session = opened_sheet();
  const auto unnamed = [](Error error, std::size_t) { return error; };
  int told_of = 0;
  ASSERT_TRUE(
      session.run(all_of({pull, R"({"do":"step","count":5})", pull}), unnamed, [&](int steps, int) {
        told_of = steps;
        return steps < 2;
      }));
  EXPECT_EQ(told_of, 2);
  EXPECT_EQ(session.steps().size(), 2U);
  EXPECT_EQ(session.journal().size(), 4U) << "the last command was not begun";
}

}  // namespace
}  // namespace knead
