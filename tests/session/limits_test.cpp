// Scripts that ask for more than there is memory, time or numbers for.
#include "session/acts/limits.hpp"

#include <fmt/format.h>

#include <chrono>

#include "describe/json.hpp"
#include "exchange/step/file.hpp"
#include "support.hpp"

namespace knead {
namespace {

using namespace knead::testing;

Session sheet_and(const std::vector<std::string>& commands) {
  Session session = fresh();
  run(session, {R"({"do":"new"})"});
  run(session, commands);
  return session;
}

TEST(Limits, SizesAreCheckedBeforeTheyAreAllocated) {
  for (const std::string each :
       {R"({"do":"new","net":[2000000000,4]})", R"({"do":"new","net":[2001,2001]})",
        R"({"do":"new","shape":"cylinder","net":[4,2000000000]})",
        R"({"do":"lattice","net":[1000000000,4,4]})",
        R"({"do":"lattice","net":[2000000000,2000000000,2000000000]})",
        R"({"do":"material","coefficient":"beta12","counts":[6,1999999999],"samples":[]})",
        R"({"do":"material","coefficient":"mass","counts":[32768,131072],"samples":[]})",
        R"({"do":"load","counts":[65536,65537],"samples":[]})",
        R"({"do":"load","counts":[2000000000,2000000000],"samples":[[0,0,1]]})"}) {
    Session session = sheet_and({});
    const Error error = refusal(session, each);
    EXPECT_EQ(error.kind, ErrorKind::input) << each;
    EXPECT_FALSE(error.remedy.empty()) << error.message();
  }
}

TEST(Limits, ANetThatIsHalvedAgainAndAgainEndsInAnError) {
  Session session = sheet_and({});
  const auto halve = parse_command(R"({"do":"refine","region":[[0,1],[0,1]]})");
  Expected<void> status;
  for (int k = 0; k < 12 && status; ++k) status = session.execute(*halve);
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().what.find("million control points"), std::string::npos)
      << status.error().message();
  const auto [m, n] = session.state().surfaces[0].current->net();
  EXPECT_LE(static_cast<double>(m) * n, 4e6);
}

TEST(Limits, StepsAreCountedBeforeTheyAreTaken) {
  const std::pair<std::string, std::string> refused[] = {
      {R"({"do":"step","count":2000000000})", "2000000000 is out of range"},
      {R"({"do":"drag","by":[0,0,1],"steps":2000000000})", "2000000000 is out of range"},
      {R"({"do":"stroke","path":[[0,0,0],[1,1,1]],"steps":2000000000})",
       "2000000000 steps at each of 2 positions are too many"},
      {R"({"do":"stroke","path":[[0,0,0],[1,1,1]],"steps":500001})",
       "500001 steps at each of 2 positions are too many"},
      {R"({"do":"lattice","steps":2000000000})", "2000000000 is out of range"}};
  for (const auto& [command, what] : refused) {
    Session session = sheet_and({R"({"do":"tool","at":[0.5,0.5],"radius":0.2})"});
    const Error error = refusal(session, command);
    EXPECT_EQ(error.what, what) << command;
    EXPECT_NE(error.remedy.find("1000000"), std::string::npos) << error.message();
  }
}

TEST(Limits, AStepThatIsStoppedCountsTheStepsItHasMade) {
  const std::vector<std::string> press = {
      R"({"do":"edge","which":"all"})",
      R"({"do":"tool","shape":"sphere","radius":0.3,"at":[0.5,0.5]})",
      R"({"do":"move","by":[0,0,0.1],"relative":true})"};
  Session stopped = sheet_and(press), whole = sheet_and(press);
  const auto command = parse_command(R"({"do":"step","count":50})");
  ASSERT_TRUE(command);
  ASSERT_TRUE(stopped.execute(*command, [](int done, int total) {
    EXPECT_EQ(total, 50);
    return done < 4;
  }));
  EXPECT_EQ(stopped.state().steps.size(), 4U);
  EXPECT_EQ(fields_of<StepCommand>(stopped.journal().back())->count, 4);
  run(whole, {R"({"do":"step","count":4})"});
  EXPECT_EQ(*stopped.save(), *whole.save());
  run(stopped, {R"({"do":"undo"})"});
  EXPECT_TRUE(stopped.state().steps.empty());
}

TEST(Limits, OtherCommandsThatAreStoppedChangeNothing) {
  for (const std::string json : {R"({"do":"lattice","net":[4,4,4],"steps":3})",
                                 R"({"do":"drag","at":[0.5,0.5],"by":[0,0,0.1],"steps":3})"}) {
    Session session = sheet_and({R"({"do":"edge","which":"all"})"});
    const SessionState* before = &session.state();
    const auto command = parse_command(json);
    ASSERT_TRUE(command);
    const auto status = session.execute(*command, [](int, int) { return false; });
    ASSERT_FALSE(status) << json;
    EXPECT_NE(status.error().what.find("stopped after 1 of 3 steps"), std::string::npos)
        << status.error().message();
    EXPECT_EQ(&session.state(), before);
    EXPECT_TRUE(session.execute(*command, [](int k, int n) { return k < n; }))
        << "the last step is done";
  }
}

TEST(Limits, StatesShareTheRecordsOfSteps) {
  Session session = sheet_and({R"({"do":"step","count":1000})"});
  const StepRecord* first = &session.state().steps[0];
  for (int k = 0; k < 10; ++k) run(session, {R"({"do":"release"})", R"({"do":"step"})"});
  EXPECT_EQ(session.state().steps.size(), 1010U);
  EXPECT_EQ(&session.state().steps[0], first);
  const auto restored = Session::restore(Document::fresh("test"), session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_EQ(restored->state().steps, session.state().steps);
}

TEST(Limits, WhatIsRefinedAndCoarsenedKeepsItsBytes) {
  Session session = open_sample();
  const std::string before = *session.save();
  run(session,
      {R"({"do":"select","surface":"#285"})", R"({"do":"refine","region":[[0,1],[0,1]]})"});
  EXPECT_NE(*session.save(), before);
  run(session, {R"({"do":"coarsen","tolerance":1e-9})"});
  EXPECT_TRUE(*session.save() == before);
  run(session, {R"({"do":"points","which":[80],"by":[0,0,1e-9]})"});
  EXPECT_FALSE(*session.save() == before);
}

TEST(Limits, SurfacesOfHighDegreesAreSculpted) {
  for (const std::string degrees :
       {R"("degree":[20,3],"net":[21,7])", R"("degree":[22,2],"net":[23,6])"}) {
    Session session = fresh();
    run(session, {R"({"do":"new",)" + degrees + "}", R"({"do":"edge","which":"all"})",
                  R"({"do":"tool","shape":"sphere","radius":0.3,"at":[0.5,0.5]})",
                  R"({"do":"move","by":[0,0,0.1],"relative":true})",
                  R"({"do":"step","count":2,"lambda":1})"});
    EXPECT_NEAR(session.largest_displacement(0), 0.157, 0.01)
        << degrees;  // as far as the ball is moved, and more
    const Error error = refusal(session, R"({"do":"elevate","by":[19,0]})");
    const bool lower = degrees.find("[20") != std::string::npos;
    EXPECT_EQ(error.what,
              fmt::format("#1 has degree {} in u: it cannot be raised by 19", lower ? 20 : 22));
    EXPECT_EQ(error.where, "by");
    EXPECT_EQ(error.remedy, fmt::format("degrees go to 25: use at most {}", lower ? 5 : 3));
  }
}

TEST(Limits, TheHighestDegreesAreMovedMeshedAndWritten) {
  Session session = fresh();
  run(session, {R"({"do":"new","degree":[22,25],"net":[24,26]})",
                R"({"do":"points","rows_u":[12],"by":[0,0,0.5]})"});
  EXPECT_GT(session.largest_displacement(0), 0.01);
  const auto bytes = session.save();
  ASSERT_TRUE(bytes) << bytes.error().message();
  const auto read = step::File::parse(*bytes, "high.step");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->surfaces().size(), 1U);
  EXPECT_TRUE(same_bits(read->surfaces()[0].surface, *session.state().surfaces[0].current));
  const NamedSurface named{"high", *session.state().surfaces[0].current};
  EXPECT_TRUE(save_surfaces({&named, 1}, *find_format("stl")));
}

TEST(Limits, AToolTooSmallForItsSurfaceIsRefusedAtOnce) {
  for (const std::string each :
       {R"("radius":0.0001)", R"("shape":"ellipsoid","sizes":[0.1,0.1,0.0001])"}) {
    Session session =
        sheet_and({R"({"do":"hold"})", R"({"do":"tool","at":[0.5,0.5],)" + each + "}"});
    const auto start = std::chrono::steady_clock::now();
    EXPECT_NE(refusal(session, R"({"do":"step"})").what.find("too small"), std::string::npos);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  }
}

TEST(Limits, ToolsWhoseSquaresAreNoNumbersAreRefused) {
  Session session = sheet_and({});
  for (const std::string shape :
       {"cylinder", "cone", "torus", "bowl", "sphere", "superellipsoid"}) {
    for (const std::string scale : {"[1e300,1,1]", "[1,1,1e200]", "[1e-300,1,1]"}) {
      const Error error = refusal(
          session,
          fmt::format(R"({{"do":"tool","shape":"{}","at":[0,0],"scale":{}}})", shape, scale));
      EXPECT_EQ(error.where, "scale") << shape << " " << scale << ": " << error.message();
    }
  }
  EXPECT_NE(refusal(session, R"({"do":"tool","radius":1e200,"at":[0,0]})").remedy.find("1e"),
            std::string::npos);
}

TEST(Limits, ForcesBeyondNumbersAreAnErrorAndTheSurfaceStays) {
  Session session = sheet_and({R"({"do":"load","vector":[1.7e308,0,0]})"});
  const Error error = refusal(session, R"({"do":"step"})");
  EXPECT_EQ(error.kind, ErrorKind::numerical);
  EXPECT_NE(error.remedy.find("smaller loads"), std::string::npos) << error.message();
  EXPECT_TRUE(session.state().steps.empty());
}

TEST(Limits, CoarsenNamesTheToleranceThatWasGiven) {
  Session session = sheet_and({});
  const Error error = refusal(session, R"({"do":"coarsen","tolerance":-0.5})");
  EXPECT_EQ(error.where, "tolerance");
  EXPECT_NE(error.what.find("-0.5"), std::string::npos) << error.message();
}

std::string nested(int depth) {
  return std::string(static_cast<std::size_t>(depth), '[') +
         std::string(static_cast<std::size_t>(depth), ']');
}

TEST(Json, DepthIsLimited) {
  EXPECT_TRUE(parse_json(nested(static_cast<int>(max_json_depth))));
  for (const int depth : {static_cast<int>(max_json_depth) + 1, 52500, 1000000}) {
    const auto deep = parse_json(nested(depth));
    ASSERT_FALSE(deep);
    EXPECT_NE(deep.error().what.find("nested more than"), std::string::npos)
        << deep.error().message();
  }
}

TEST(Json, AFieldGivenTwiceIsAnErrorWithItsPlace) {
  const auto twice = parse_script(
      R"({"knead":2,"commands":[{"do":"new"},{"do":"step","count":1,"count":2}]})", "s");
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().where, "commands[1].count");
  EXPECT_NE(twice.error().what.find("twice"), std::string::npos);
  EXPECT_TRUE(parse_json(R"({"a":{"a":[{"a":1},{"a":2}]},"b":1})"));
}

TEST(Json, ManyFieldsAreReadInTimeInProportion) {
  std::string text = "{";
  for (int k = 0; k < 300000; ++k) text += fmt::format("{}\"{}\":1", k == 0 ? "" : ",", k);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(parse_json(text + "}"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST(Json, WhatIsNotJsonIsCalledByItsName) {
  const auto what = [](std::string_view text) { return parse_json(text).error().what; };
  EXPECT_EQ(what("{\"a\": NaN}"), "NaN is not a number in JSON");
  EXPECT_EQ(what("[1, -Infinity]"), "-Infinity is not a number in JSON");
  EXPECT_EQ(what("[1, 1e999]"), "1e999 is too large for a number");
  EXPECT_EQ(what(std::string_view("{\0\"\0a\0", 6)), "the text is UTF-16");
  EXPECT_EQ(what("\xFF\xFE{"), "the text is UTF-16");
  EXPECT_EQ(what("{"), "this is not JSON");
}

TEST(Json, ValuesInMessagesAreShort) {
  Json list{.kind = Json::Kind::list};
  for (int k = 0; k < 100000; ++k) list.list.push_back({.kind = Json::Kind::number, .number = 1});
  EXPECT_LE(shown(list).size(), 120U);
  EXPECT_LE(shown({.kind = Json::Kind::text, .text = std::string(2000000, 'x')}).size(), 120U);
  EXPECT_EQ(shown({.kind = Json::Kind::text, .text = "a\nb"}), R"("a\nb")");
  EXPECT_EQ(shown(*parse_json(R"([1,[],{"a":[2,3],"b":{}},null,true])")),
            R"([1,[],{"a":[2,3],"b":{}},null,true])");
}

}  // namespace
}  // namespace knead
