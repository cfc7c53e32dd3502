// Many commands as one entry of the history.
#include <gtest/gtest.h>

#include "session/commands.hpp"
#include "session/session_state.hpp"

namespace knead {
namespace {

Session sheet() {
  Session session(Document::fresh("sheet"));
  NewCommand make;
  make.net = {10, 10};
  EXPECT_TRUE(session.execute(make_command(make)));
  EXPECT_TRUE(session.execute(make_command(HoldCommand{})));
  return session;
}

Command ball(double x) {
  ToolCommand tool;
  tool.name = "ball";
  tool.measures.radius = 0.2;
  tool.position = Vector3{x, 0.5, 0.1};
  tool.plasticity = 1;
  return make_command(tool);
}

const Points& points(const Session& session) {
  return session.state().surfaces[0].current->control_points();
}

TEST(SessionJoin, MakesAStrokeOneEntryThatUndoTakesBackBitForBit) {
  Session session = sheet();
  const Points before = points(session);
  ASSERT_TRUE(session.execute(ball(0.4)));
  for (double x : {0.4, 0.5, 0.6}) {
    ASSERT_TRUE(session.execute(ball(x)));
    session.join();
    ASSERT_TRUE(session.execute(make_command(StepCommand{})));
    session.join();
  }
  ASSERT_TRUE(session.execute(make_command(RemoveCommand{})));
  session.join();
  const Points after = points(session);
  ASSERT_NE(after, before);
  ASSERT_TRUE(session.execute(make_command(UndoCommand{})));
  EXPECT_EQ(points(session), before);
  EXPECT_TRUE(session.state().tools.empty());
  EXPECT_EQ(session.journal().size(), 2U);
  ASSERT_TRUE(session.execute(make_command(RedoCommand{})));
  EXPECT_EQ(points(session), after);
  EXPECT_EQ(session.journal().size(), 2U + 8U);
}

TEST(SessionJoin, KeepsAJournalThatReplaysToTheSameBits) {
  Session session = sheet();
  ASSERT_TRUE(session.execute(ball(0.5)));
  for (int k = 0; k < 5; ++k) {
    ASSERT_TRUE(session.execute(make_command(StepCommand{})));
    session.join();
  }
  const std::vector<Command> journal = session.journal();
  ASSERT_EQ(journal.size(), 4U);
  EXPECT_EQ(fields_of<StepCommand>(journal.back())->count, 5);
  Session again(Document::fresh("sheet"));
  for (const Command& command : journal) ASSERT_TRUE(again.execute(command));
  EXPECT_EQ(points(again), points(session));
}

TEST(SessionJoin, AddsUpOnlyStepsThatAreAlike) {
  Session session = sheet();
  StepCommand stiff;
  stiff.lambda = 50;
  ASSERT_TRUE(session.execute(make_command(StepCommand{})));
  ASSERT_TRUE(session.execute(make_command(stiff)));
  session.join();
  EXPECT_EQ(session.journal().size(), 4U);
}

TEST(SessionJoin, DoesNothingWhereThereIsNothingToJoinOrSomethingToRedo) {
  Session session(Document::fresh("sheet"));
  session.join();
  ASSERT_TRUE(session.execute(make_command(NewCommand{})));
  session.join();
  EXPECT_EQ(session.journal().size(), 1U);
  ASSERT_TRUE(session.execute(make_command(HoldCommand{})));
  ASSERT_TRUE(session.execute(make_command(HoldCommand{1})));
  ASSERT_TRUE(session.execute(make_command(UndoCommand{})));
  session.join();
  ASSERT_TRUE(session.execute(make_command(UndoCommand{})));
  EXPECT_EQ(session.state().surfaces[0].hold_rows, 0);
  ASSERT_TRUE(session.execute(make_command(RedoCommand{})));
  ASSERT_TRUE(session.execute(make_command(RedoCommand{})));
  EXPECT_EQ(session.state().surfaces[0].hold_rows, 1);
}

}  // namespace
}  // namespace knead
