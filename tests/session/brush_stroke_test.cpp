// What strokes of all brushes have in common: events, copies, what is held, masks, snapshots,
// errors.
#include <gtest/gtest.h>

#include <numeric>

#include "brushes.hpp"
#include "scene/trims.hpp"
#include "support/long_run.hpp"

namespace knead::testing {
namespace {

TEST(BrushStroke, StatesOfAnOpenStrokeShareItsPath) {
  Session session = flat(12);
  const auto step = [](int k) {
    return fmt::format(
        R"({{"do":"brush","kind":"pull","radius":20,"path":[[{},0.5]],"open":true}})",
        0.2 + 0.001 * k);
  };
  for (int k = 0; k < 300; ++k) run(session, {step(k)});
  const BrushPoint* first = &session.state().brush->path.front();
  EXPECT_EQ(session.state().brush->path.size(), 300U);
  for (int k = 0; k < 100; ++k) run(session, {R"({"do":"undo"})"});
  EXPECT_EQ(session.state().brush->path.size(), 200U);
  EXPECT_EQ(&session.state().brush->path.front(), first);
}

TEST(BrushStroke, IsTheSameForManyEventsAndForFew) {
  const Point from(60, 97, 0), to(130, 110, 0);
  // Pieces of 0.15 or 0.6: both are short beside the radius of 20.
  const int events = long_run() ? 480 : 120;
  for (const char* fields :
       {R"("kind":"push","radius":20,"height":5)", R"("kind":"inflate","radius":20,"height":5)",
        R"("kind":"flatten","radius":20)", R"("kind":"smooth","radius":20)",
        R"("kind":"pinch","radius":20)", R"("kind":"crease","radius":20,"height":5)",
        R"("kind":"push","radius":20,"height":5,"steady":0.5)"}) {
    const std::string bump = dab(R"("kind":"pull","radius":50,"height":9)", {95, 100, 0});
    Session few = flat(40, {bump}), many = flat(40, {bump});
    const Surface before = shape(few);
    run(few, {brush(fields, from, to, 8)});
    // One event after the other, as a pointer sends them, and one act all the same.
    for (int k = 0; k <= events; ++k) {
      const Point here = from + k / static_cast<double>(events) * (to - from);
      run(many, {fmt::format(R"({{"do":"brush",{},"path":[{}]{}}})", fields, place(here),
                             k < events ? R"(,"open":true)" : "")});
      if (k > 0) many.join();
    }
    const double largest = difference(shape(few), before);
    EXPECT_GT(largest, 0.1) << fields;
    EXPECT_LT(difference(shape(few), shape(many)), 0.03 * largest) << fields;
    EXPECT_EQ(many.journal().size(), 4U);
    EXPECT_FALSE(many.state().brush);
    const Surface left = shape(many);
    const std::vector<Command> journal = many.journal();
    run(many, {R"({"do":"undo"})"});
    EXPECT_TRUE(same_bits(shape(many), before)) << fields;
    Session again = fresh();
    for (const Command& command : journal) ASSERT_TRUE(again.execute(command));
    EXPECT_TRUE(same_bits(shape(again), left))
        << "the joined stroke is the one that was done; " << fields;
  }
}

TEST(BrushStroke, PassingTwiceAddsNothingToADepth) {
  const Point from(60, 97, 0), to(130, 97, 0);
  Session once = flat(40), twice = flat(40);
  run(once, {brush(R"("kind":"push","radius":20,"height":5)", from, to)});
  run(twice,
      {fmt::format(R"({{"do":"brush","kind":"push","radius":20,"height":5,"path":[{0},{1},{0}]}})",
                   place(from), place(to))});
  EXPECT_LT(difference(shape(once), shape(twice)), 1e-9);
}

TEST(BrushStroke, AHandDragsTheGrabbedPointOn) {
  Session session = flat(40);
  const auto by = [&](int z, const char* path, const char* open) {
    return fmt::format(R"({{"do":"brush","kind":"grab","radius":30,"by":[0,0,{}],"path":{}{}}})", z,
                       path, open);
  };
  run(session, {by(0, "[[0.5,0.5]]", R"(,"open":true)")});
  for (int z = 1; z < 6; ++z) {
    run(session, {by(z, "[]", z < 5 ? R"(,"open":true)" : "")});
    session.join();
  }
  EXPECT_NEAR(on(shape(session), 100, 100).z(), 5, 1e-9) << "by the last vector, not by the sum";
  EXPECT_EQ(session.journal().size(), 3U);
  Session again = flat(40, {by(5, "[[0.5,0.5]]", "")});
  EXPECT_TRUE(same_bits(shape(again), shape(session)));
}

TEST(BrushStroke, IsRepeatedInAMirrorAndAroundAnAxis) {
  for (const char* kind : {R"("kind":"push","height":4)", R"("kind":"grab","by":[3,2,8])",
                           R"("kind":"twist","angle":40)"}) {
    Session session = flat(43);
    // Near the plane x = 100, so that both overlap.
    run(session,
        {dab(fmt::format(R"({},"radius":25,"mirror":[[100,0,0],[2,0,0]])", kind), {88, 91, 0})});
    double most = 0;
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; j <= 40; ++j) {
        const Point p = on(shape(session), 50 + 2.5 * i, 50 + 2.5 * j),
                    q = on(shape(session), 150 - 2.5 * i, 50 + 2.5 * j);
        EXPECT_LT((Point(200 - p.x(), p.y(), p.z()) - q).norm(), 1e-9 * side) << kind;
        most = std::max(most, (p - Point(50 + 2.5 * i, 50 + 2.5 * j, 0)).norm());
      }
    }
    EXPECT_GT(most, 1);
  }
  Session session = flat(43);
  run(session,
      {dab(R"("kind":"pull","height":4,"radius":20,"radial":4,"axis":[[100,100,0],[0,0,1]])",
           {140, 100, 0})});
  for (const Point& p :
       {Point(140, 100, 4), Point(100, 140, 4), Point(60, 100, 4), Point(100, 60, 4)}) {
    EXPECT_NEAR(on(shape(session), p.x(), p.y()).z(), 4, 0.02 * 4);
  }
  EXPECT_NEAR(on(shape(session), 100, 100).z(), 0, 1e-12);
}

// The end of the path is a radius from a point at which the brush is sampled.
TEST(BrushStroke, IsRepeatedInAMirrorWhereItEndsAtASample) {
  for (const char* kind : {"push", "crease"}) {
    Session session = flat(43);
    run(session,
        {brush(
            fmt::format(R"("kind":"{}","height":4,"radius":20,"mirror":[[100,0,0],[1,0,0]])", kind),
            {60, 70, 0}, {70, 130, 0})});
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; j <= 40; ++j) {
        const Point p = on(shape(session), 2.5 * i, 5 * j),
                    q = on(shape(session), 200 - 2.5 * i, 5 * j);
        EXPECT_LT((Point(200 - p.x(), p.y(), p.z()) - q).norm(), 1e-9 * side) << kind;
      }
    }
  }
}

TEST(BrushStroke, AKeptSymmetryIsKept) {
  Session session = flat(43, {R"({"do":"symmetry","mirror":"u"})"});
  run(session, {dab(R"("kind":"pull","height":4,"radius":20)", {60, 90, 0})});
  EXPECT_NEAR(on(shape(session), 60, 90).z(), 4, 0.02 * 4);
  EXPECT_NEAR(on(shape(session), 140, 90).z(), 4, 0.02 * 4);
}

TEST(BrushStroke, WhatIsHeldKeepsItsBitsAndTheShapeComesToItSmoothly) {
  Session session = flat(64, {R"({"do":"hold","rows":3})", R"({"do":"pin","at":[0.5,0.5]})"});
  const Surface before = shape(session);
  run(session, {brush(R"("kind":"pull","radius":30,"height":6)", {100, 12, 0}, {100, 120, 0})});
  const auto [m, n] = before.net();
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      if (std::min({i, j, m - 1 - i, n - 1 - j}) < 3) {
        EXPECT_EQ(shape(session).control_points().row(i * n + j),
                  before.control_points().row(i * n + j));
      }
    }
  }
  EXPECT_LT((on(shape(session), 100, 100) - on(before, 100, 100)).norm(), 1e-9);
  EXPECT_GT(on(shape(session), 100, 60).z(), 4);
  double steepest = 0;  // from the edge on
  for (int y = 0; y < 60; ++y) {
    steepest =
        std::max(steepest, on(shape(session), 100, y + 1).z() - on(shape(session), 100, y).z());
  }
  EXPECT_LT(steepest, 1.2) << "no cliff beside what is held: 6 within a span would be 2";
}

TEST(BrushStroke, AMaskKeepsWhatItCovers) {
  Session session = flat(64);
  run(session, {dab(R"("kind":"mask","radius":30)", {100, 100, 0})});
  const std::vector<double> mask = first(session).mask;
  ASSERT_EQ(mask.size(), 64U * 64U);
  EXPECT_TRUE(same_bits(shape(session), *first(session).opened));
  EXPECT_GT(std::ranges::count(mask, 1.), 20);
  EXPECT_GT(std::ranges::count_if(mask, [](double m) { return m > 0 && m < 1; }), 20)
      << "it falls off";
  const auto keeps = [&](const Surface& before, const Surface& after) {
    for (Eigen::Index i = 0; i < before.size(); ++i) {
      if (mask[static_cast<std::size_t>(i)] < 1) continue;
      EXPECT_EQ(before.control_points().row(i), after.control_points().row(i));
    }
  };
  const Surface before = shape(session);
  for (const char* kind : {R"("kind":"pull","height":5)", R"("kind":"grab","by":[1,2,8])",
                           R"("kind":"twist","angle":20)"}) {
    run(session, {dab(fmt::format(R"({},"radius":50)", kind), {112, 100, 0})});
    keeps(before, shape(session));
    EXPECT_GT(difference(before, shape(session)), 1) << "beside it things move";
    run(session, {R"({"do":"undo"})"});
  }
  // Half a mask is half of the displacement, and steps of tools are held by a whole one.
  run(session,
      {R"({"do":"material","preset":"clay"})",
       R"({"do":"tool","shape":"sphere","radius":20,"position":[100,100,60],"plasticity":1})",
       R"({"do":"stroke","path":[[60,100,14],[140,100,14]]})"});
  keeps(before, shape(session));
  EXPECT_LT(on(shape(session), 60, 100).z(), -4);
  EXPECT_GT(on(shape(session), 100, 100).z(), -0.1);
}

TEST(BrushStroke, AMaskIsChangedAsAWholeAndFollowsTheNet) {
  Session session = flat(40, {dab(R"("kind":"mask","radius":30,"strength":0.5)", {100, 100, 0})});
  const std::vector<double> mask = first(session).mask;
  EXPECT_EQ(*std::ranges::max_element(mask), 0.5);
  run(session, {R"({"do":"mask","change":"invert"})"});
  for (std::size_t k = 0; k < mask.size(); ++k) EXPECT_EQ(first(session).mask[k], 1 - mask[k]);
  run(session, {R"({"do":"undo"})", R"({"do":"mask","change":"grow","radius":12})"});
  const auto sum = [&] {
    double total = 0;
    for (double m : first(session).mask) total += m;
    return total;
  };
  const double whole = std::accumulate(mask.begin(), mask.end(), 0.);
  EXPECT_GT(sum(), 1.2 * whole);
  run(session, {R"({"do":"undo"})", R"({"do":"mask","change":"shrink","radius":12})"});
  EXPECT_LT(sum(), 0.8 * whole);
  run(session, {R"({"do":"undo"})", R"({"do":"mask","change":"blur","radius":12})"});
  EXPECT_NEAR(sum(), whole, 0.05 * whole);
  EXPECT_GT(std::ranges::count_if(first(session).mask, [](double m) { return m > 0; }),
            std::ranges::count_if(mask, [](double m) { return m > 0; }));
  run(session, {R"({"do":"undo"})", R"({"do":"refine","region":[[0.2,0.8],[0.2,0.8]]})"});
  EXPECT_EQ(first(session).mask.size(), static_cast<std::size_t>(shape(session).size()));
  EXPECT_NEAR(*std::ranges::max_element(first(session).mask), 0.5, 1e-12);
  run(session, {R"({"do":"release","what":["mask"]})"});
  EXPECT_TRUE(first(session).mask.empty());
  run(session, {R"({"do":"mask","change":"fill"})"});
  EXPECT_NE(refusal(session, dab(R"("kind":"pull","radius":30)", {100, 100, 0}))
                .what.find("nothing is free"),
            std::string::npos);
  run(session, {dab(R"("kind":"unmask","radius":30)", {100, 100, 0}),
                dab(R"("kind":"pull","radius":20)", {100, 100, 0})});
  EXPECT_GT(on(shape(session), 100, 100).z(), 4);
}

TEST(BrushStroke, SnapshotsHoldMasksAndOpenBrushes) {
  Session session = flat(40, {dab(R"("kind":"mask","radius":30)", {100, 100, 0})});
  const std::string open =
      R"({"do":"brush","kind":"push","radius":20,"mirror":[[100,0,0],[1,0,0]],)"
      R"("path":[[0.3,0.3],[0.35,0.4]],"open":true})";
  const std::string on = R"({"do":"brush","kind":"push","radius":20,"mirror":[[100,0,0],[1,0,0]],)"
                         R"("path":[[0.4,0.45]]})";
  run(session, {open});
  auto back = Session::restore(session.document(), session.snapshot());
  ASSERT_TRUE(back) << back.error().message();
  EXPECT_TRUE(same_state(back->state(), session.state()));
  ASSERT_TRUE(back->state().brush);
  run(session, {on});
  run(*back, {on});
  EXPECT_TRUE(same_state(back->state(), session.state()));
  run(session, {R"({"do":"undo"})", R"({"do":"undo"})", R"({"do":"undo"})"});
  EXPECT_TRUE(first(session).mask.empty()) << "a mask is undone like all else";
}

TEST(BrushStroke, ATrimmedFaceStaysWithinItsEdges) {
  const std::string middle = "[0.45,0.5]",
                    beside = "[0.15,0.5],[0.15,0.8]";  // in the middle, and over the edges
  for (const auto& [fields, path] :
       {std::pair{R"("kind":"inflate","height":20)", middle + ",[0.55,0.52]"},
        {R"("kind":"grab","by":[0,0,30])", middle},
        {R"("kind":"smooth")", middle},
        {R"("kind":"flatten")", middle},
        {R"("kind":"inflate","height":20)", beside},
        {R"("kind":"crease","height":20)", beside}}) {
    Session session = open_sample();
    run(session, {R"({"do":"select","surface":"#285"})", R"({"do":"hold","mode":"position"})",
                  fmt::format(R"({{"do":"brush",{},"radius":200,"path":[{}]}})", fields, path)});
    const SceneSurface& s = first(session);
    const auto report = trim_report(s);
    ASSERT_TRUE(report);
    EXPECT_GT(report->edges.size(), 0U);
    EXPECT_LE(report->largest, trim_tolerance(*s.opened, *s.visible)) << fields;
    EXPECT_GT(session.largest_displacement(0), 0.1) << fields;
  }
}

TEST(BrushStroke, SaysWhatIsWrong) {
  Session session = flat(24);
  const auto wrong = [&](const std::string& json) { return refusal(session, json).where; };
  EXPECT_EQ(wrong(R"({"do":"brush","kind":"push","path":[]})"), "path");
  EXPECT_EQ(wrong(R"({"do":"brush","kind":"push","path":[[0.5,1.5]]})"), "path");
  EXPECT_EQ(wrong(R"({"do":"brush","kind":"grab","path":[[0.5,0.5],[0.6,0.6]]})"), "path");
  EXPECT_EQ(wrong(R"({"do":"brush","kind":"push","radius":-1,"path":[[0.5,0.5]]})"), "radius");
  EXPECT_EQ(wrong(R"({"do":"brush","kind":"push","radius":0.5,"path":[[0.51,0.51]]})"), "radius");
  EXPECT_EQ(wrong(R"({"do":"brush","kind":"flatten","strength":1.5,"path":[[0.5,0.5]]})"),
            "strength");
  EXPECT_EQ(wrong(R"({"do":"brush","kind":"push","radial":3,"path":[[0.5,0.5]]})"), "axis");
  EXPECT_EQ(wrong(R"({"do":"brush","kind":"push","mirror":[[0,0,0],[0,0,0]],"path":[[0.5,0.5]]})"),
            "mirror");
  EXPECT_EQ(wrong(R"({"do":"mask","change":"grow","radius":0})"), "radius");
  run(session, {R"({"do":"hold","rows":12})"});
  EXPECT_NE(refusal(session, R"({"do":"brush","kind":"push","path":[[0.5,0.5]]})")
                .what.find("nothing is free"),
            std::string::npos);
}

TEST(BrushStroke, ATremblingHandIsSteadiedByARope) {
  const auto trembling = [](const char* steady) {
    std::string path;
    for (int k = 0; k <= 100; ++k)
      path += (k == 0 ? "" : ",") + place({50. + k, 100 + (k % 2 == 0 ? 3. : -3.), 0});
    Session session = flat(64);
    run(session, {R"({"do":"brush","kind":"push","radius":12,"height":4,"path":[)" + path + "]" +
                  steady + "}"});
    double width = 0;
    for (double y = 80; y <= 120; y += 0.25) width += on(shape(session), 95, y).z() < -2 ? 0.25 : 0;
    return width;
  };
  EXPECT_LT(trembling(R"(,"steady":1)"), 0.85 * trembling(""));
}

}  // namespace
}  // namespace knead::testing
