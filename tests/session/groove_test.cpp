// What strokes leave in the materials that there are by name.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "contact/groove.hpp"
#include "support.hpp"

namespace knead {
namespace {

using testing::fresh;
using testing::refusal;
using testing::run;
using testing::same_bits;
using testing::same_state;

constexpr double radius = 20, depth = 8;

std::vector<std::string> sheet_of(const std::string& material, int net) {
  return {fmt::format(R"({{"do":"new","size":[200,200],"net":[{0},{0}]}})", net),
          R"({"do":"edge"})", R"({"do":"material",)" + material + "}",
          R"({"do":"tool","shape":"sphere","radius":20,"position":[100,100,60],"plasticity":1})"};
}

std::string place_of(const Point& from, const Point& to, double share) {
  const Point at = from + share * (to - from);
  return fmt::format("[{:.17g},{:.17g},{:.17g}]", at.x(), at.y(), radius - depth);
}

/// A stroke given by so many pieces, in one command.
std::string stroke_of(const Point& from, const Point& to, int pieces = 1,
                      const std::string& more = "") {
  std::string path;
  for (int k = 0; k <= pieces; ++k)
    path += (k == 0 ? "" : ",") + place_of(from, to, static_cast<double>(k) / pieces);
  return R"({"do":"stroke","path":[)" + path + "]" + more + "}";
}

const Surface& shape(const Session& session) { return *session.state().surfaces[0].current; }
const Surface& rest(const Session& session) { return *session.state().surfaces[0].rest; }
const Surface& flat(const Session& session) { return *session.state().surfaces[0].opened; }

double difference(const Surface& a, const Surface& b) {
  return (a.control_points() - b.control_points()).rowwise().norm().maxCoeff();
}

// Figures of docs/clay.md: a bicubic sheet of 200 × 200, net 64 × 64, ball of radius 20, depth 8.
TEST(Groove, AStrokeInClayLeavesIt) {
  Session session = fresh();
  run(session, sheet_of(R"("preset":"clay")", 64));
  const double chord = 2 * std::sqrt(radius * radius - (radius - depth / 2) * (radius - depth / 2));
  for (const auto& [from, to] :
       {std::pair{Point(25, 97, 0), Point(175, 97, 0)}, {{47, 47, 0}, {153, 153, 0}}}) {
    run(session, {stroke_of(from, to)});
    const testing::Groove g =
        testing::groove_of(shape(session), flat(session), from, to, radius, depth);
    EXPECT_GT(g.shallowest, 0.92 * depth);
    EXPECT_LT(g.lowest, 1.001 * depth) << "deeper than the tool went";
    EXPECT_LT(g.width, 1.25 * chord);
    EXPECT_LT(g.beyond, 0.01 * depth);
    EXPECT_LT(g.rim, 0.02 * depth);
    EXPECT_LT(g.ripple, 0.02 * depth);
    EXPECT_LT(g.deepest - g.shallowest, 0.02 * depth);
    EXPECT_TRUE(same_bits(rest(session), shape(session)));
    EXPECT_EQ(session.state().tools[0].shape.placement().position, Point(100, 100, 60));

    const Surface once = shape(session);
    run(session, {stroke_of(from, to)});
    EXPECT_LT(difference(shape(session), once), 0.05 * depth)
        << "a second pass adds what goes deeper only";
    run(session, {R"({"do":"undo"})", R"({"do":"undo"})"});
    EXPECT_TRUE(same_bits(shape(session), flat(session))) << "one undo for each stroke";
  }
}

TEST(Groove, IsTheSameForManyEventsAndForFew) {
  const Point from(60, 97, 0), to(130, 110, 0);
  Session few = fresh(), many = fresh();
  run(few, sheet_of(R"("preset":"clay")", 40));
  run(many, sheet_of(R"("preset":"clay")", 40));
  run(few, {stroke_of(from, to, 8)});
  // One event after the other, as a pointer sends them, and one act all the same.
  for (int k = 0; k <= 480; ++k) {
    const std::string open = k < 480 ? ",\"open\":true" : "";
    run(many, {R"({"do":"stroke","path":[)" + place_of(from, to, k / 480.0) + "]" + open + "}"});
    if (k > 0) many.join();
  }
  EXPECT_LT(difference(shape(few), shape(many)), 1e-6 * depth);
  EXPECT_EQ(many.journal().size(), 5U);
  const Surface left = shape(many);
  const std::vector<Command> journal = many.journal();
  run(many, {R"({"do":"undo"})"});
  EXPECT_TRUE(same_bits(shape(many), flat(many)));
  Session again = fresh();
  for (const Command& command : journal) ASSERT_TRUE(again.execute(command));
  EXPECT_TRUE(same_bits(shape(again), left)) << "the joined stroke is the one that was done";
}

TEST(Groove, MaterialsKeepTheirShare) {
  const Point from(60, 97, 0), to(110, 97, 0);
  const auto deepest = [&](const std::string& material, const std::string& more = "") {
    Session session = fresh();
    run(session, sheet_of(material, 32));
    run(session, {stroke_of(from, to, 1, more)});
    EXPECT_TRUE(same_bits(rest(session), shape(session)));
    return testing::groove_of(shape(session), flat(session), from, to, radius, depth).lowest;
  };
  const double clay = deepest(R"("preset":"clay")"), wax = deepest(R"("preset":"wax")");
  EXPECT_NEAR(clay, depth, 0.05 * depth);
  EXPECT_LT(wax, 0.95 * clay);
  EXPECT_GT(wax, 0.8 * clay);
  for (const char* springs : {"rubber", "cloth", "membrane"}) {
    EXPECT_EQ(deepest(fmt::format(R"("preset":"{}")", springs)), 0) << springs;
  }
  // Past its yield of 3, and wider than clay.
  EXPECT_NEAR(deepest(R"("preset":"sheet metal")"), depth - 0.15 * radius, 0.05 * depth);
  EXPECT_NEAR(deepest(R"("preset":"clay","yield":0.1)"), clay - 0.1 * radius, 0.05 * depth)
      << "what goes beyond the yield";
  EXPECT_NEAR(deepest(R"("preset":"clay")", R"(,"plasticity":0.5)"), 0.5 * clay, 1e-3 * depth);
  EXPECT_EQ(deepest(R"("preset":"clay","yield":9,"lengths":"file")"), 0);
}

TEST(Groove, IsThereWhileTheToolIsDownAndEveryOtherCommandLiftsIt) {
  const Point from(60, 97, 0), to(110, 97, 0);
  Session session = fresh(), at_once = fresh();
  run(session, sheet_of(R"("preset":"clay")", 32));
  run(at_once, sheet_of(R"("preset":"clay")", 32));
  run(at_once, {stroke_of(from, to)});
  run(session, {stroke_of(from, from + 0.3 * (to - from), 1, R"(,"open":true)")});
  ASSERT_TRUE(session.state().stroke);
  EXPECT_NEAR(testing::groove_of(shape(session), flat(session), from, to, radius, depth).lowest,
              depth, 0.05 * depth);

  auto restored = Session::restore(Document::fresh("test"), session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_TRUE(same_state(restored->state(), session.state()));
  for (Session* each : {&session, &*restored}) {
    run(*each, {R"({"do":"stroke","path":[)" + place_of(from, to, 1) + R"(],"open":true})",
                R"({"do":"limit"})"});
    EXPECT_FALSE(each->state().stroke);
    EXPECT_LT(difference(shape(*each), shape(at_once)), 1e-6 * depth);
    EXPECT_EQ(each->state().tools[0].shape.placement().position, Point(100, 100, 60));
  }
  EXPECT_TRUE(same_bits(shape(*restored), shape(session)));
}

TEST(Groove, ACoarseNetIsRefinedUnderTheToolWherePermitted) {
  Session session = fresh();
  run(session, sheet_of(R"("preset":"clay")", 10));
  run(session, {R"({"do":"refine","permission":"auto"})", stroke_of({60, 97, 0}, {110, 97, 0})});
  EXPECT_GT(shape(session).size(), 100);
  const testing::Groove g =
      testing::groove_of(shape(session), flat(session), {60, 97, 0}, {110, 97, 0}, radius, depth);
  EXPECT_GT(g.shallowest, 0.92 * depth);
  EXPECT_LT(g.lowest, 1.02 * depth);
}

TEST(Groove, IsLeftByNameAndNotWithoutIt) {
  const std::vector<std::string> plain =
      sheet_of(R"("alpha":[0.1,0,0.1],"beta":[0.001,0.001,0.001])", 16);
  const auto left = [&](const std::string& more) {
    Session session = fresh();
    run(session, plain);
    run(session, {stroke_of({60, 97, 0}, {140, 97, 0}, 8, more)});
    return session.state().surfaces[0].current;
  };
  EXPECT_TRUE(same_bits(*left(""), *left(R"(,"plastic":"release")")));
  EXPECT_GT(difference(*left(""), *left(R"(,"plastic":"along")")), 0.1 * depth);
}

TEST(Groove, WrongFieldsAreRefusedByName) {
  Session session = fresh();
  run(session, sheet_of(R"("preset":"clay")", 16));
  EXPECT_EQ(refusal(session, R"({"do":"material","preset":"butter"})").where, "preset");
  EXPECT_EQ(refusal(session, R"({"do":"material","preset":"clay","region":[[0,1],[0,1]]})").where,
            "preset");
  EXPECT_EQ(refusal(session, R"({"do":"material","plasticity":2})").where, "plasticity");
  EXPECT_EQ(refusal(session, R"({"do":"material","yield":-1})").where, "yield");
  EXPECT_EQ(refusal(session, R"({"do":"material","locality":-1})").where, "locality");
  EXPECT_EQ(refusal(session, R"({"do":"stroke","path":[]})").where, "path");
  EXPECT_EQ(refusal(session, R"({"do":"stroke","path":[[0,0,12],[1e9,0,12]]})").where, "path");
}

// Pieces joined C0 and C1: their Greville abscissae are equidistant, and interpolation there swings
// by thousands.
TEST(Groove, IsAsDeepOnBezierPiecesOfHighDegree) {
  for (const int p : {10, 22, 25}) {
    for (const int multiplicity : {p - 1, p}) {
      std::string knots;
      for (int k = 0; k <= 8; ++k) {
        const int times = k == 0 || k == 8 ? p + 1 : multiplicity;
        for (int i = 0; i < times; ++i) knots += fmt::format("{}{}", knots.empty() ? "" : ",", k);
      }
      Session session = fresh();
      run(session,
          {fmt::format(
               R"({{"do":"new","size":[20,200],"degree":[1,{}],"knots_u":[0,0,1,2,3,4,5,6,7,7],)"
               R"("knots_v":[{}]}})",
               p, knots),
           R"({"do":"hold","rows":2})", R"({"do":"material","preset":"clay"})",
           R"({"do":"tool","name":"b","radius":10,"position":[10,100,30]})",
           R"({"do":"stroke","tool":"b","path":[[10,95,5],[10,105,5]]})"});
      EXPECT_GE(session.largest_displacement(0), 0.9 * 5) << p << " " << multiplicity;
      EXPECT_LE(session.largest_displacement(0), 1.05 * 5) << p << " " << multiplicity;
    }
  }
}

}  // namespace
}  // namespace knead
