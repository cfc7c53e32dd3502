#include "knead/session/session.hpp"

#include <gtest/gtest.h>

#include <random>

#include "knead/spline/extremum.hpp"
#include "scene/model/model.hpp"
#include "support.hpp"
#include "support/own_files.hpp"

namespace knead {
namespace {

using testing::open_sample;
using testing::refusal;
using testing::run;

const char* const skin = "#285";

const std::vector<std::string> press = {
    R"({"do":"select","surface":"#285"})", R"({"do":"hold","rows":2})",
    R"({"do":"tool","name":"ball","radius":160,"at":[0.4,0.5]})",
    R"({"do":"move","tool":"ball","by":[0,0,120]})", R"({"do":"step","count":4})"};

const std::string may_open = R"({"do":"hold","mode":"open","all":true})";

TEST(Session, PressesAToolIntoARealFileAndReadsTheSameBitsBack) {
  Session session = open_sample();
  run(session, press);
  const int index = *session.state().selected;
  EXPECT_GT(session.largest_displacement(index), 20);
  EXPECT_LT(session.largest_displacement(index), 40.1);
  EXPECT_GT(session.moved_control_points(index), 10);
  EXPECT_FALSE(session.save()) << "the edges of the face open";
  run(session, {R"({"do":"hold","mode":"open"})"});
  const auto bytes = session.save();
  ASSERT_TRUE(bytes);
  const auto again = step::File::parse(*bytes, "saved");
  ASSERT_TRUE(again);
  const Points& current =
      session.state().surfaces[static_cast<std::size_t>(index)].current->control_points();
  EXPECT_EQ(again->model().find_surface(skin)->surface.control_points(), current);
}

TEST(Session, WithoutStepsTheFileIsItsInputByteForByte) {
  Session session = open_sample();
  run(session, {press[0], press[1], press[2], press[3]});
  EXPECT_EQ(*session.save(), testing::bytes_of(session.document()));
}

TEST(Session, AtRestNothingMoves) {
  Session session = open_sample();
  run(session, {press[0], R"({"do":"step","count":5})"});
  EXPECT_EQ(*session.save(), testing::bytes_of(session.document()));
}

TEST(Session, UndoAfterAnyCommandRestoresTheStateBitForBit) {
  Session session = open_sample();
  run(session, {may_open});
  run(session, press);
  const std::vector<std::string> commands = {
      R"({"do":"material","alpha":[2,0,2],"beta":[1,1,1]})",
      R"({"do":"rest","mode":"none"})",
      R"({"do":"hold","rows":1})",
      R"({"do":"pin","control_points":[[5,5]]})",
      R"({"do":"release"})",
      R"({"do":"tool","name":"other","radius":10,"at":[0,0]})",
      R"({"do":"remove","tool":"ball"})",
      R"({"do":"move","tool":"ball","by":[1,1,1]})",
      R"({"do":"step","count":2})",
      R"({"do":"select","surface":"#1044"})"};
  for (const std::string& json : commands) {
    const auto state = std::make_shared<const SessionState>(session.state());
    const std::string bytes = *session.save();
    run(session, {json});
    const std::string after = *session.save();
    run(session, {R"({"do":"undo"})"});
    EXPECT_EQ(*session.save(), bytes) << json;
    EXPECT_EQ(session.state().selected, state->selected);
    EXPECT_EQ(session.state().tools.size(), state->tools.size());
    EXPECT_EQ(session.state().steps.size(), state->steps.size());
    run(session, {R"({"do":"redo"})"});
    EXPECT_EQ(*session.save(), after) << json;
    run(session, {R"({"do":"undo"})"});
  }
}

TEST(Session, ANewCommandForgetsWhatWasTakenBack) {
  Session session = open_sample();
  run(session, press);
  run(session, {R"({"do":"undo"})", R"({"do":"hold","rows":3})"});
  EXPECT_EQ(refusal(session, R"({"do":"redo"})").what, "there is nothing to redo");
  EXPECT_EQ(session.journal().size(), press.size());
}

TEST(Session, ARehearsalChangesNothingAndWhatFollowsHasTheSameBits) {
  Session rehearsed = open_sample(), other = open_sample();
  for (Session* session : {&rehearsed, &other}) {
    run(*session, press);
    run(*session, {R"({"do":"undo"})"});
  }
  const std::vector<Command> commands = {
      *parse_command(R"({"do":"move","tool":"ball","by":[5,0,1]})"),
      *parse_command(R"({"do":"step","count":2})")};
  const auto points = [](const Session& session) {
    return session.state()
        .surfaces[static_cast<std::size_t>(*session.state().selected)]
        .current->control_points();
  };
  const Points before = points(rehearsed);
  ASSERT_TRUE(rehearsed.rehearse(commands));
  EXPECT_EQ(points(rehearsed), before);
  EXPECT_EQ(rehearsed.journal().size(), other.journal().size());
  EXPECT_EQ(rehearsed.state().tools[0].shape.placement().position,
            other.state().tools[0].shape.placement().position);
  // One that is refused, or stopped.
  const std::vector<Command> wrong = {commands[0],
                                      *parse_command(R"({"do":"remove","tool":"none"})")};
  EXPECT_FALSE(rehearsed.rehearse(wrong));
  EXPECT_FALSE(rehearsed.rehearse(commands, [] { return false; }));
  EXPECT_EQ(points(rehearsed), before);
  for (Session* session : {&rehearsed, &other}) {
    run(*session, {R"({"do":"redo"})"});
    for (const Command& command : commands) ASSERT_TRUE(session->execute(command));
  }
  EXPECT_EQ(points(rehearsed), points(other));
  EXPECT_EQ(rehearsed.journal().size(), other.journal().size());
}

TEST(Session, WhatIsKnownOfFacesIsKeptWhenACommandIsUndone) {
  // A model is kept where what it is made of is the same; the region in which tools touch belongs
  // to that.
  Session session = open_sample();
  run(session, {press[0], press[1],
                R"({"do":"tool","name":"ball","radius":160,"at":[0.4,0.5],"touches":"visible"})"});
  const auto touched = [&] {
    run(session, {R"({"do":"step"})"});
    return model_input(session.state(), session.state().evolution).shapes[0].touched;
  };
  const auto first = touched();
  ASSERT_NE(first, nullptr);
  run(session, {R"({"do":"undo"})"});
  EXPECT_EQ(touched(), first);
}

TEST(Session, TheJournalReplaysToTheSameBits) {
  Session session = open_sample();
  run(session, {may_open});
  run(session, press);
  run(session, {R"({"do":"step","count":3,"lambda":7})", R"({"do":"undo"})",
                R"({"do":"step","count":2,"weight":"identity"})"});
  Session replay = open_sample();
  for (const Command& command : session.journal()) ASSERT_TRUE(replay.execute(command));
  EXPECT_EQ(*replay.save(), *session.save());
}

TEST(Session, RandomCommandsAndTheirUndoLeaveTheStartingPoint) {
  std::mt19937 random(11);
  Session session = open_sample();
  run(session, {press[0], press[1], press[2]});
  const std::vector<std::string> pool = {R"({"do":"move","by":[3,-5,-7]})",
                                         R"({"do":"step"})",
                                         R"({"do":"hold","rows":1})",
                                         R"({"do":"rest"})",
                                         R"({"do":"material","beta":[0.1,0.2,0.3]})",
                                         R"({"do":"pin","control_points":[[4,4]]})",
                                         R"({"do":"step","lambda":30})"};
  const std::string start = *session.save();
  const std::size_t depth = session.journal().size();
  for (int k = 0; k < 40; ++k) run(session, {pool[random() % pool.size()]});
  while (session.journal().size() > depth) run(session, {R"({"do":"undo"})"});
  EXPECT_EQ(*session.save(), start);
}

TEST(Session, ARefusedCommandChangesNothing) {
  Session session = open_sample();
  run(session, {may_open});
  run(session, press);
  const std::string bytes = *session.save();
  for (const char* json :
       {R"({"do":"select","surface":"#7"})", R"({"do":"material","beta":[-1,0,0]})",
        R"({"do":"pin","control_points":[[0,0],[14,0]]})", R"({"do":"hold","rows":-1})",
        R"({"do":"tool","at":[0.5,1.5]})", R"({"do":"tool","radius":-1,"at":[0,0]})",
        R"({"do":"tool","radius":1})", R"({"do":"tool","at":[0,0],"position":[0,0,0]})",
        R"({"do":"tool","shape":"teapot","at":[0,0]})",
        R"({"do":"move","tool":"none","by":[0,0,0]})", R"({"do":"remove","tool":"none"})",
        R"({"do":"step","count":-1})", R"({"do":"step","lambda":-1})"}) {
    EXPECT_FALSE(refusal(session, json).message().empty()) << json;
    EXPECT_EQ(session.journal().size(), press.size() + 1) << json;
  }
  EXPECT_EQ(*session.save(), bytes);
}

TEST(Session, AFileWithSeveralSurfacesAsksForASelection) {
  Session session = open_sample();
  const Error e = refusal(session, R"({"do":"step"})");
  EXPECT_NE(e.what.find("selected"), std::string::npos);
  EXPECT_NE(e.remedy.find("#285"), std::string::npos);
  EXPECT_NE(refusal(session, R"({"do":"select","surface":"285"})").remedy.find("#1044"),
            std::string::npos);
}

TEST(Session, RelativeLengthsAreFractionsOfTheDiagonal) {
  Session absolute = open_sample(), relative = open_sample();
  run(absolute, {press[0]});
  const auto& surface =
      *absolute.state().surfaces[static_cast<std::size_t>(*absolute.state().selected)].current;
  const double diagonal = bounding_box(surface).diagonal();
  run(relative,
      {press[0],
       R"({"do":"tool","radius":0.1,"range":0.2,"position":[0.5,0.25,0],"relative":true})",
       R"({"do":"move","by":[0,0,0.5],"relative":true})", R"({"do":"move","by":[7,0,0]})"});
  const Tool& tool = relative.state().tools.front();
  EXPECT_DOUBLE_EQ(std::get<SphereShape>(tool.shape.shape()).radius, 0.1 * diagonal);
  EXPECT_DOUBLE_EQ(tool.range, 0.2 * diagonal);
  EXPECT_DOUBLE_EQ(tool.shape.placement().position.x(), 0.5 * diagonal + 7);
  EXPECT_DOUBLE_EQ(tool.shape.placement().position.z(), 0.5 * diagonal);
}

TEST(Session, PinnedControlPointsKeepTheirBits) {
  Session session = open_sample();
  run(session, {press[0], press[1], press[2], press[3],
                R"({"do":"pin","control_points":[[5,5],[6,6]]})", R"({"do":"step","count":3})"});
  const auto index = static_cast<std::size_t>(*session.state().selected);
  const Points& before = session.document().surfaces()[index].surface->control_points();
  const Points& after = session.state().surfaces[index].current->control_points();
  for (int row : {5 * 12 + 5, 6 * 12 + 6, 0, 13, 167})
    EXPECT_EQ(after.row(row), before.row(row)) << row;
  EXPECT_NE(after.row(5 * 12 + 6), before.row(5 * 12 + 6));
}

TEST(Session, StepsAreRecordedWithWhatTheyDid) {
  Session session = open_sample();
  run(session, press);
  const auto& steps = session.state().steps;
  ASSERT_EQ(steps.size(), 4U);
  for (const StepRecord& s : steps) {
    EXPECT_GT(s.time, 0);
    EXPECT_GT(s.energy, 0);
    EXPECT_TRUE(s.converged);
  }
  EXPECT_LT(steps.back().residual, steps.front().residual);
  EXPECT_EQ(*session.state().energy_before, 0);
  EXPECT_NEAR(*session.energy(), steps.back().energy,
              1e-12 * steps.back().energy);  // from rounded coordinates
  EXPECT_EQ(session.largest_displacement(*session.state().selected),
            steps.back().largest_displacement);
}

class SessionOnFile : public testing::FileTest {};

TEST_P(SessionOnFile, EverySurfaceCanBeSculptedOrSaysWhyNot) {
  auto document = Document::open(path_);
  ASSERT_TRUE(document) << document.error().message();
  Session session(std::move(*document));
  int tried = 0, sculpted = 0;
  // The first surface whose net is not huge.
  for (const DocumentSurface& s : session.document().surfaces()) {
    if (s.surface->size() > 600) continue;
    SCOPED_TRACE(s.id);
    ++tried;
    run(session,
        {R"({"do":"select","surface":")" + s.id + R"("})", R"({"do":"hold","mode":"open"})"});
    const auto tool = session.execute(*parse_command(
        R"({"do":"tool","radius":0.2,"relative":true,"at":[0.45,0.55],"touches":"all"})"));
    if (!tool) {  // some are one point
      EXPECT_EQ(tool.error().kind, ErrorKind::numerical) << tool.error().message();
      continue;
    }
    run(session, {R"({"do":"move","by":[0.03,0.05,0.15],"relative":true})"});
    const auto status = session.execute(make_command(StepCommand{1, 1, StepWeight::mass}));
    if (!status) {
      EXPECT_EQ(status.error().kind, ErrorKind::numerical) << status.error().message();
      continue;
    }
    ++sculpted;
    const auto bytes = session.save();
    ASSERT_TRUE(bytes) << bytes.error().message();
    break;
  }
  EXPECT_EQ(sculpted, std::min(tried, 1));
}

INSTANTIATE_TEST_SUITE_P(Files, SessionOnFile, ::testing::ValuesIn(testing::step_files()),
                         testing::file_test_name);

}  // namespace
}  // namespace knead
