// What the pressure and the tilt of a pen do to the brushes.
#include <gtest/gtest.h>

#include "brushes.hpp"
#include "support/long_run.hpp"

namespace knead::testing {
namespace {

constexpr double least = 0.25;  // pressure at the begin of the paths; it is 1 at their ends
const Point from(50, 97, 0), to(150, 97, 0);

/// Of a path of so many pieces.
std::string rising(int pieces) {
  std::string all;
  for (int k = 0; k <= pieces; ++k)
    all += fmt::format("{}{:.17g}", k == 0 ? "" : ",", least + (1 - least) * k / pieces);
  return R"(,"pressure":[)" + all + "]";
}
double pressure_at(double x) { return least + (1 - least) * (x - from.x()) / (to.x() - from.x()); }

Session pressed(const std::string& fields, int net = 64, int pieces = 1) {
  return flat(net, {brush(fields + rising(pieces), from, to, pieces)});
}

/// Across the path at x, how wide what is deeper than half of the depth there is.
double half_width(const Surface& s, double x) {
  const double half = on(s, x, 97).z() / 2;
  const auto edge = [&](double direction) {
    double inside = 0, outside = 40;
    for (int k = 0; k < 50; ++k) {
      const double middle = (inside + outside) / 2;
      (on(s, x, 97 + direction * middle).z() < half ? inside : outside) = middle;
    }
    return inside;
  };
  return edge(1) + edge(-1);
}

TEST(Pen, TheDepthOfAGrooveFollowsThePressure) {
  for (const char* presses : {"", R"(,"presses":"depth")"}) {
    const Session session =
        pressed(std::string(R"("kind":"push","radius":20,"height":4)") + presses);
    for (double x = 50; x <= 150; x += 2.5) {
      EXPECT_NEAR(on(shape(session), x, 97).z(), -4 * pressure_at(x), 0.08 * 4 * pressure_at(x))
          << x;
    }
    EXPECT_NEAR(half_width(shape(session), 80), half_width(shape(session), 130), 0.05 * 20)
        << "all of one width";
  }
}

TEST(Pen, TheWidthOfAGrooveFollowsThePressure) {
  const Session session = pressed(R"("kind":"push","radius":40,"height":4,"presses":"size")", 128);
  for (double x = 60; x <= 140; x += 10) {
    EXPECT_NEAR(half_width(shape(session), x), 40 * pressure_at(x), 0.08 * 40 * pressure_at(x))
        << x;
    EXPECT_NEAR(on(shape(session), x, 97).z(), -4, 0.05 * 4) << "all of one depth";
  }
  const Session both = pressed(R"("kind":"push","radius":40,"height":4,"presses":"both")", 128);
  for (double x = 60; x <= 140; x += 10) {
    EXPECT_NEAR(half_width(shape(both), x), 40 * pressure_at(x), 0.1 * 40 * pressure_at(x)) << x;
    EXPECT_NEAR(on(shape(both), x, 97).z(), -4 * pressure_at(x), 0.1 * 4 * pressure_at(x)) << x;
  }
}

TEST(Pen, ACreaseFollowsThePressureAndAPinchGoesAsFarAsItIsPressed) {
  const Session crease = pressed(R"("kind":"crease","radius":24,"height":6)", 123);
  const Session full = flat(123, {brush(R"("kind":"crease","radius":24,"height":6)", from, to)});
  for (double x = 60; x <= 140; x += 10) {
    const double depth = on(shape(full), x, 97).z() * pressure_at(x);
    EXPECT_NEAR(on(shape(crease), x, 97).z(), depth, 0.08 * std::abs(depth)) << x;
  }
  const Session pinch = pressed(R"("kind":"pinch","radius":20,"strength":0.8)");
  for (double x = 70; x <= 130; x += 10) {
    const double way = 5 * 0.8 * brush_falloff(5, 20, 0) * pressure_at(x);
    EXPECT_NEAR(102 - on(shape(pinch), x, 102).y(), way, 0.08 * way) << x;
  }
}

TEST(Pen, IsTheSameForManyEventsAndForFew) {
  // Pieces of 0.2 or 0.8: both are short beside the radius.
  const int events = long_run() ? 480 : 120;
  for (const char* fields : {R"("kind":"push","radius":20,"height":5)",
                             R"("kind":"push","radius":30,"height":5,"presses":"size")",
                             R"("kind":"pinch","radius":20,"presses":"both")",
                             R"("kind":"crease","radius":20,"height":5)",
                             R"("kind":"inflate","radius":20,"height":5,"steady":0.5)"}) {
    const Session few = pressed(fields, 40, 8);
    Session many = flat(40);
    for (int k = 0; k <= events; ++k) {
      const double share = k / static_cast<double>(events);
      run(many, {fmt::format(R"({{"do":"brush",{},"path":[{}],"pressure":[{:.17g}]{}}})", fields,
                             place(from + share * (to - from)), least + (1 - least) * share,
                             k < events ? R"(,"open":true)" : "")});
      if (k > 0) many.join();
    }
    const double largest = difference(shape(few), *first(few).opened);
    EXPECT_GT(largest, 0.1) << fields;
    EXPECT_LT(difference(shape(few), shape(many)), 0.03 * largest) << fields;
    EXPECT_EQ(many.journal().size(), 3U);
    Session again = fresh();
    for (const Command& command : many.journal()) ASSERT_TRUE(again.execute(command));
    EXPECT_TRUE(same_bits(shape(again), shape(many)))
        << "the joined stroke is the one that was done; " << fields;
  }
}

TEST(Pen, AMouseIsAPenThatIsPressedFully) {
  for (const char* fields :
       {R"("kind":"push","radius":20,"height":5)", R"("kind":"flatten","radius":20)",
        R"("kind":"pinch","radius":20)", R"("kind":"crease","radius":20,"height":5)",
        R"("kind":"smooth","radius":20,"steady":0.5)"}) {
    const std::string bump = dab(R"("kind":"pull","radius":50,"height":9)", {95, 100, 0});
    const Session mouse = flat(40, {bump, brush(fields, from, to)});
    for (const char* pen : {R"(,"pressure":[1,1])", R"(,"pressure":[1,1],"presses":"both")",
                            R"(,"pressure":[0.2,0.7],"presses":"none")",
                            R"(,"tilt":[[0,0,0],[0,0,0]])", R"(,"presses":"size")"}) {
      const Session session = flat(40, {bump, brush(std::string(fields) + pen, from, to)});
      EXPECT_TRUE(same_bits(shape(session), shape(mouse))) << fields << pen;
    }
  }
}

TEST(Pen, PressedHarderWhereItIsGoesDeeper) {
  Session session = flat(64);
  const auto dab_of = [](double pressure, bool open) {
    return fmt::format(R"({{"do":"brush","kind":"pull","radius":20,"height":4,"path":[[0.5,0.5]],)"
                       R"("pressure":[{}]{}}})",
                       pressure, open ? R"(,"open":true)" : "");
  };
  run(session, {dab_of(0, true)});
  EXPECT_EQ(on(shape(session), 100, 100).z(), 0) << "it touches and does not press";
  run(session, {dab_of(0.5, true)});
  EXPECT_NEAR(on(shape(session), 100, 100).z(), 2, 0.02 * 4);
  run(session, {dab_of(1, true), dab_of(0.1, false)});
  EXPECT_NEAR(on(shape(session), 100, 100).z(), 4, 0.02 * 4) << "the hardest press stays";
}

TEST(Pen, ATiltLeansWhatHasADirection) {
  const std::string tilt = R"(,"tilt":[[0,1,2],[0,1,2]])";
  const Point axis = Point(0, 1, 2).normalized();
  for (const auto& [kind, sign] : {std::pair{"push", -1}, {"pull", 1}}) {
    const std::string fields = fmt::format(R"("kind":"{}","radius":20,"height":4)", kind);
    const Session session = flat(64, {brush(fields + tilt, from, to)});
    EXPECT_LT((on(shape(session), 100, 97) - Point(100, 97, 0) - sign * 4 * axis).norm(), 0.02 * 4)
        << kind;
    // A line has no sense: seen from behind, or with the pen the other way around, it is the same
    // one.
    const Session turned = flat(64, {brush(fields + R"(,"tilt":[[0,-1,-2],[0,-1,-2]])", from, to)});
    EXPECT_TRUE(same_bits(shape(turned), shape(session)));
  }
  // Flatten makes a plane across the pen.
  const Session flattened =
      flat(64, {dab(R"("kind":"flatten","radius":30,"tilt":[[0,1,8]])", {100, 100, 0})});
  const Point a = on(shape(flattened), 100, 98), b = on(shape(flattened), 100, 102);
  EXPECT_NEAR((b - a).z() / (b - a).y(), -1. / 8, 0.02);
  const Session stamp =
      flat(64, {dab(R"("kind":"stamp","shape":"sphere","radius":30,"height":3,"tilt":[[0,1,2]])",
                    {100, 100, 0})});
  EXPECT_LT((on(shape(stamp), 100, 100) - Point(100, 100, 0)).normalized().cross(axis).norm(),
            0.05);
  // What has no direction of its own is not moved by one.
  for (const char* kind :
       {R"("kind":"inflate","height":4)", R"("kind":"smooth")", R"("kind":"mask")"}) {
    const std::string fields = std::string(kind) + R"(,"radius":20)";
    EXPECT_TRUE(same_state(flat(40, {brush(fields + tilt, from, to)}).state(),
                           flat(40, {brush(fields, from, to)}).state()))
        << kind;
  }
}

TEST(Pen, LeansByNoMoreThanSixtyDegrees) {
  const Session session =
      flat(64, {dab(R"("kind":"pull","radius":20,"height":4,"tilt":[[0,1,0]])", {100, 100, 0})});
  const Point d = on(shape(session), 100, 100) - Point(100, 100, 0);
  EXPECT_NEAR(d.z() / d.norm(), 0.5, 0.02);
}

TEST(Pen, IsMirroredWithTheStroke) {
  const Session session =
      flat(43, {brush(R"("kind":"pull","height":4,"radius":20,"mirror":[[100,0,0],[1,0,0]],)"
                      R"("pressure":[0.3,1],"tilt":[[1,1,2],[0,1,3]])",
                      {61, 71, 0}, {72, 127, 0})});
  for (int i = 0; i <= 20; ++i) {
    for (int j = 0; j <= 20; ++j) {
      const Point p = on(shape(session), 5 * i, 10 * j),
                  q = on(shape(session), 200 - 5 * i, 10 * j);
      EXPECT_LT((Point(200 - p.x(), p.y(), p.z()) - q).norm(), 1e-9 * side);
    }
  }
}

TEST(Pen, SnapshotsHoldItInOpenStrokes) {
  const std::string fields = R"({"do":"brush","kind":"push","radius":20,"presses":"both",)";
  const std::string on = fields + R"("path":[[0.5,0.45]],"pressure":[0.9],"tilt":[[0,1,1]]})";
  Session session =
      flat(40, {fields +
                R"("path":[[0.3,0.3],[0.35,0.4]],"pressure":[0.3,0.6],"tilt":[[1,0,4],[0,0,1]],)"
                R"("open":true})"});
  auto back = Session::restore(session.document(), session.snapshot());
  ASSERT_TRUE(back) << back.error().message();
  EXPECT_TRUE(same_state(back->state(), session.state()));
  run(session, {on});
  run(*back, {on});
  EXPECT_TRUE(same_state(back->state(), session.state()));
}

TEST(Pen, SaysWhatIsWrong) {
  Session session = flat(24);
  const auto wrong = [&](const std::string& fields) {
    return refusal(session, R"({"do":"brush","radius":30,)" + fields + "}").where;
  };
  EXPECT_EQ(wrong(R"("kind":"push","path":[[0.5,0.5],[0.6,0.5]],"pressure":[0.5,1.2])"),
            "pressure[1]");
  EXPECT_EQ(wrong(R"("kind":"push","path":[[0.5,0.5]],"pressure":[-0.1])"), "pressure[0]");
  EXPECT_EQ(wrong(R"("kind":"push","path":[[0.5,0.5],[0.6,0.5]],"pressure":[0.5])"), "pressure");
  EXPECT_EQ(wrong(R"("kind":"push","path":[[0.5,0.5]],"tilt":[[0,0,1],[0,0,1]])"), "tilt");
  EXPECT_EQ(wrong(R"("kind":"grab","path":[[0.5,0.5]],"by":[0,0,1],"pressure":[0.5])"), "pressure");
}

}  // namespace
}  // namespace knead::testing
