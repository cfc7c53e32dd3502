#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "knead/spline/evaluate.hpp"
#include "knead/spline/extremum.hpp"
#include "sheet.hpp"

namespace knead {
namespace {

using testing::at;
using testing::ball;
using testing::first;
using testing::fresh;
using testing::lift;
using testing::moved;
using testing::new_sheet;
using testing::on_sheet;
using testing::open_sample;
using testing::refusal;
using testing::run;
using testing::same_bits;
using testing::same_state;

// What each command promises, on sheets of size 10 by 10 with nets of 10 by 10.

TEST(Command, NewMakesAFlatSheetAndSelectsIt) {
  Session session = fresh();
  run(session, {R"({"do":"new","size":[3,2],"degree":[2,4],"net":[5,7],"name":"a"})",
                R"({"do":"new","knots_u":[0,0,0,0,2,5,5,5,5],"knots_v":[-1,-1,-1,-1,1,1,1,1],)"
                R"("net":[9,9]})"});
  ASSERT_EQ(session.state().surfaces.size(), 2U);
  const Surface& a = *session.state().surfaces[0].current;
  EXPECT_EQ(a.net(), (std::array<int, 2>{5, 7}));
  EXPECT_EQ(a.knots(0).degree(), 2);
  for (double s : {0., 0.3, 1.}) {
    for (double t : {0., 0.6, 1.}) EXPECT_LT((at(a, s, t) - Point(3 * s, 2 * t, 0)).norm(), 1e-15);
  }
  EXPECT_EQ(session.state().surfaces[1].current->net(), (std::array<int, 2>{5, 4}))
      << "from the knots";
  EXPECT_EQ(session.state().selected, 1);
  const auto saved = step::File::parse(*session.save(), "saved");
  ASSERT_TRUE(saved) << saved.error().message();
  EXPECT_EQ(saved->surfaces().size(), 2U);
  EXPECT_TRUE(same_bits(saved->surfaces()[0].surface, a));
}

TEST(Command, NewRefuses) {
  Session session = fresh();
  EXPECT_EQ(refusal(session, R"({"do":"step"})").what, "there is no surface yet");
  for (const auto& [json, field] : std::vector<std::pair<std::string, std::string>>{
           {R"({"do":"new","size":[0,1]})", "size"},
           {R"({"do":"new","degree":[0,3]})", "degree"},
           {R"({"do":"new","degree":[3,99]})", "degree"},
           {R"({"do":"new","net":[3,8]})", "net"},
           {R"({"do":"new","net":[100000,100000]})", "net"},
           {R"({"do":"new","knots_u":[1,0]})", "knots_u"},
           {R"({"do":"new","knots_v":[0,0,0,0,0,1,1,1,1,1]})", "knots_v"}}) {
    const Error e = refusal(session, json);
    EXPECT_EQ(e.kind, ErrorKind::input) << json;
    EXPECT_NE(e.message().find(field), std::string::npos) << json << ": " << e.message();
  }
  EXPECT_FALSE(session.can_undo());
  Session file = open_sample();
  EXPECT_NE(refusal(file, new_sheet).remedy.find("--new"), std::string::npos);
}

TEST(Command, RawUnitsGiveThePlatesDeflections) {
  // Thin plate, energy of thesis Eq. 4.15: half the biharmonic one; series: 0.00126532 clamped,
  // 0.00406235 supported.
  const auto deflection = [](const std::string& hold) {
    Session session = fresh();
    run(session,
        {R"({"do":"scaling","mode":"raw"})", R"({"do":"new","net":[34,34]})",
         R"({"do":"material","alpha":[0,0,0],"beta":[1,1,1]})",
         R"({"do":"edge","hold":")" + hold + R"("})", lift, R"({"do":"evolve","mode":"static"})"});
    return session.largest_displacement(0);
  };
  EXPECT_NEAR(deflection("tangent"), 0.0012653, 0.0012653 * 2e-5);
  EXPECT_NEAR(deflection("position"), 0.00406235, 0.00406235 * 1e-5);
}

TEST(Command, SelectSeveralAndConnected) {
  Session session = open_sample();
  run(session, {R"({"do":"select","surfaces":["#1044","#285"]})"});
  EXPECT_EQ(session.state().selection(), (std::vector<int>{1, 0}));
  run(session, {R"({"do":"select","surface":"#285","connected":true})"});
  EXPECT_EQ(session.state().selected, 0);
  EXPECT_EQ(refusal(session, R"({"do":"select"})").where, "surface");
  EXPECT_EQ(refusal(session, R"({"do":"select","surfaces":["#285","#7"]})").where, "surfaces");
  EXPECT_EQ(refusal(session, R"({"do":"select","surfaces":[]})").where, "surface");
}

TEST(Command, MaterialInARegionIsSoftThereAndStiffElsewhere) {
  Session session = on_sheet(
      {R"({"do":"material","alpha":[50,0,50],"beta":[1,1,1]})",
       R"({"do":"material","alpha":[1,0,1],"beta":[0.01,0.01,0.01],"region":[[0,0.4],[0,1]]})",
       lift, R"({"do":"evolve","mode":"static"})"});
  EXPECT_GT(moved(session, 0.1, 0.3, 0.2, 0.8), 3 * moved(session, 0.6, 0.9, 0.2, 0.8));
  for (const auto& [json, field] : std::vector<std::pair<std::string, std::string>>{
           {R"({"do":"material","alpha":[1,0,1],"region":[[0.5,0.2],[0,1]]})", "region"},
           {R"({"do":"material","alpha":[1,0,1],"region":[[0,2],[0,1]]})", "region"},
           {R"({"do":"material","alpha":[1,0,1],"region":[[0,0.5],[0,1]],"falloff":-1})",
            "falloff"},
           {R"({"do":"material","mass":-1})", "mass"},
           {R"({"do":"material","damping":-1})", "damping"},
           {R"({"do":"material","alpha":[-1,0,1]})", "alpha"}}) {
    EXPECT_NE(refusal(session, json).message().find(field), std::string::npos)
        << refusal(session, json).message();
  }
}

TEST(Command, EdgesHoldPositionTangentCurvatureOrNothing) {
  const auto displacement = [](const std::string& hold, int order) {
    Session session = on_sheet({R"({"do":"edge","which":"u0","hold":")" + hold + R"("})", lift,
                                R"({"do":"step","count":5})"});
    const Surface &s = *first(session).current, &r = *first(session).opened;
    const double u = s.knots(0).domain().lower;
    double largest = 0;
    for (double v : {0.1, 0.5, 0.9}) {
      Parameters<2> where(1, 2);
      where << u, v;
      const auto a = evaluate<2>(s, where, order), b = evaluate<2>(r, where, order);
      largest = std::max(largest, (a->at({order, 0}) - b->at({order, 0})).norm());
    }
    return largest;
  };
  EXPECT_EQ(displacement("position", 0), 0);
  EXPECT_GT(displacement("position", 1), 1e-3);
  EXPECT_LT(displacement("tangent", 1), 1e-12);
  EXPECT_GT(displacement("tangent", 2), 1e-2);
  EXPECT_LT(displacement("curvature", 2), 1e-11);
  EXPECT_GT(displacement("open", 0), 1e-3) << "one edge of those that are held can be freed";
}

TEST(Command, APinnedPointStaysOrGoesToItsPlace) {
  Session session =
      on_sheet({R"({"do":"pin","at":[0.3,0.6],"to":[3,6,2]})", R"({"do":"pin","at":[0.7,0.2]})",
                lift, R"({"do":"step","count":3})"});
  EXPECT_LT((at(*first(session).current, 0.3, 0.6) - Point(3, 6, 2)).norm(), 1e-10 * 14);
  EXPECT_LT((at(*first(session).current, 0.7, 0.2) - Point(7, 2, 0)).norm(), 1e-10 * 14);
  EXPECT_EQ(refusal(session, R"({"do":"pin"})").where, "control_points");
  EXPECT_EQ(refusal(session, R"({"do":"pin","to":[0,0,0]})").where, "to");
  EXPECT_EQ(refusal(session, R"({"do":"pin","at":[0.5,1.5]})").where, "at[1]");
  const Error e = refusal(session, R"({"do":"pin","at":[0.3,0.6],"to":[3,6,1]})");
  EXPECT_NE(e.message().find("0.3"), std::string::npos)
      << "contradictions are named: " << e.message();
}

TEST(Command, WhatIsHeldLaterStaysWhereItIsThen) {
  Session session = on_sheet({lift, R"({"do":"step","count":3})"});
  const Point there = at(*first(session).current, 0.5, 0.5);
  ASSERT_GT(there.z(), 0.01);
  run(session, {R"({"do":"keep","u":0.5})", R"({"do":"step","count":3})", ball, R"({"do":"step"})",
                R"({"do":"remove"})", R"({"do":"rest"})", R"({"do":"step","count":3})"});
  EXPECT_LT((at(*first(session).current, 0.5, 0.5) - there).norm(), 1e-10 * 14);
}

TEST(Command, FrozenRegionsAndKeptCurvesDoNotMove) {
  Session session = on_sheet(
      {R"({"do":"freeze","region":[[0.4,0.6],[0.3,0.7]]})", lift, R"({"do":"step","count":3})"});
  EXPECT_EQ(moved(session, 0.4, 0.6, 0.3, 0.7), 0);
  EXPECT_GT(moved(session, 0, 1, 0, 1), 1e-3);
  ASSERT_FALSE(session.state().notes.empty());
  EXPECT_NE(session.state().notes.front().find("frozen"), std::string::npos);
  EXPECT_EQ(refusal(session, R"({"do":"freeze","region":[[0.6,0.4],[0,1]]})").where, "region");

  Session lines = on_sheet({R"({"do":"keep","u":0.5})",
                            R"({"do":"keep","curve":[[0.1,0.2],[0.4,0.8]],"tolerance":1e-3})", lift,
                            R"({"do":"step","count":3})"});
  EXPECT_LT(moved(lines, 0.5, 0.5, 0, 1), 1e-10 * 14);
  const double all = moved(lines, 0, 1, 0, 1);
  for (double k = 0; k <= 1; k += 0.125) {
    EXPECT_LT(moved(lines, 0.1 + 0.3 * k, 0.1 + 0.3 * k, 0.2 + 0.6 * k, 0.2 + 0.6 * k), 1e-2 * all)
        << k;
  }
  EXPECT_EQ(refusal(lines, R"({"do":"keep"})").where, "keep");
  EXPECT_EQ(refusal(lines, R"({"do":"keep","u":0.5,"v":0.5})").where, "keep");
  EXPECT_EQ(refusal(lines, R"({"do":"keep","u":-0.5})").where, "u");
  EXPECT_EQ(refusal(lines, R"({"do":"keep","v":1.5})").where, "v");
  EXPECT_EQ(refusal(lines, R"({"do":"keep","curve":[[0,2],[1,1]]})").where, "curve[0]");
}

TEST(Command, SymmetryOfAnEdgeAndOfAWholeSheet) {
  Session half = fresh();
  run(half, {new_sheet, R"({"do":"edge","which":"u1"})",
             R"({"do":"symmetry","edge":"u0","point":[0,0,0],"normal":[1,0,0]})", ball,
             R"({"do":"step","count":3})"});
  Parameters<2> where(1, 2);
  where << 0, 0.4;
  const auto jet = evaluate<2>(*first(half).current, where, 1);
  EXPECT_LT(std::abs(jet->points()(0, 0)), 1e-9);
  EXPECT_LT(std::abs(jet->at({1, 0})(0, 2)), 1e-8) << "perpendicular to the plane";

  Session whole = on_sheet({R"({"do":"symmetry","mirror":"u"})",
                            R"({"do":"tool","name":"ball","radius":2,"position":[3,5,-1]})",
                            R"({"do":"step","count":3})"});
  for (double s : {0.1, 0.3, 0.45}) {
    const Point a = at(*first(whole).current, s, 0.45), b = at(*first(whole).current, 1 - s, 0.45);
    EXPECT_LT((a - Point(10 - b.x(), b.y(), b.z())).norm(), 1e-9) << s;
  }
  EXPECT_GT(moved(whole, 0, 1, 0, 1), 0.1);
  EXPECT_EQ(refusal(whole, R"({"do":"symmetry"})").where, "symmetry");
  EXPECT_EQ(refusal(whole, R"({"do":"symmetry","edge":"u0"})").where, "normal");
  EXPECT_EQ(refusal(whole, R"({"do":"symmetry","mirror":"w"})").where, "mirror");
  run(whole, {R"({"do":"refine","knots_u":[0.123]})"});
  Session uneven = fresh();
  run(uneven, {new_sheet, R"({"do":"refine","knots_u":[0.123]})"});
  EXPECT_NE(refusal(uneven, R"({"do":"symmetry","mirror":"u"})").message().find("0.877"),
            std::string::npos);
  run(uneven, {R"({"do":"refine","permission":"auto"})", R"({"do":"symmetry","mirror":"u"})"});
  EXPECT_EQ(first(uneven).current->net()[0], 12);
}

TEST(Command, InteractiveStepsAreRecordedAndRepeated) {
  const std::vector<std::string> press = {
      testing::ball, R"({"do":"move","tool":"ball","by":[0,0,0.5]})", R"({"do":"step","count":3})",
      R"({"do":"stroke","tool":"ball","path":[[5,5,-1],[5.5,5,-1]],"open":true})",
      R"({"do":"stroke","path":[]})"};
  Session exact = on_sheet({R"({"do":"evolve","lambda":20})"});
  Session quick = on_sheet({R"({"do":"evolve","lambda":20,"accuracy":"interactive"})"});
  run(exact, press);
  run(quick, press);
  const Points a = first(exact).current->control_points(),
               b = first(quick).current->control_points();
  EXPECT_GT((a - b).cwiseAbs().maxCoeff(), 0);
  EXPECT_LE((a - b).cwiseAbs().maxCoeff(), interactive_accuracy * exact.largest_displacement(0));
  Session again = fresh();
  for (const Command& command : quick.journal()) ASSERT_TRUE(again.execute(command));
  EXPECT_EQ(first(again).current->control_points(), b);
}

TEST(Command, StepsOfRationalShapesSayHowExactTheirEnergyIs) {
  const std::string patch =
      R"({"do":"new","degree":[2,2],"net":[3,3],)"
      R"("points":[[0,0,0],[0,5,0],[0,10,0],[5,0,0],[5,5,3],[5,10,0],[10,0,0],[10,5,0],[10,10,0]],)"
      R"("weights":[1,0.1,2,5,10,0.3,1,1,4]})";
  Session session = fresh();
  run(session, {patch, R"({"do":"step"})", R"({"do":"evolve","energy_tolerance":1e-5})",
                R"({"do":"step"})"});
  const auto& steps = session.state().steps;
  ASSERT_EQ(steps.size(), 2U);
  ASSERT_TRUE(steps[0].energy_error && steps[1].energy_error);
  EXPECT_LE(*steps[0].energy_error, default_rational_tolerance);
  EXPECT_LE(*steps[1].energy_error, 1e-5);
  EXPECT_GT(*steps[1].energy_error, *steps[0].energy_error);
  const auto restored = Session::restore(session.document(), session.snapshot());
  ASSERT_TRUE(restored);
  EXPECT_EQ(restored->state().steps, steps);
  EXPECT_EQ(restored->state().evolution.energy_tolerance, 1e-5);
  for (const std::string wrong : {"0", "-1", "1"}) {
    EXPECT_EQ(refusal(session, R"({"do":"evolve","energy_tolerance":)" + wrong + "}").where,
              "energy_tolerance");
  }
  // Without weights there is nothing to say.
  Session plain = on_sheet({R"({"do":"step"})"});
  EXPECT_FALSE(plain.state().steps.back().energy_error);
}

TEST(Command, StaticIsTheBalanceAndDynamicSwings) {
  Session still = on_sheet({lift, R"({"do":"evolve","mode":"static"})"});
  EXPECT_LT(still.state().steps.back().residual, 1e-8);
  const double balance = still.largest_displacement(0);
  Session swing = on_sheet({lift, R"({"do":"evolve","mode":"dynamic","time_step":0.05})"});
  double highest = 0;
  for (int k = 0; k < 60; ++k) {
    run(swing, {R"({"do":"step"})"});
    highest = std::max(highest, swing.largest_displacement(0));
  }
  EXPECT_GT(highest, 1.2 * balance) << "it overshoots";
  run(swing, {R"({"do":"step","count":1500})"});
  EXPECT_NEAR(swing.largest_displacement(0), balance, 1e-3 * balance);
  EXPECT_EQ(refusal(swing, R"({"do":"evolve","lambda":-1})").where, "lambda");
  EXPECT_EQ(refusal(swing, R"({"do":"evolve","time_step":0})").where, "time_step");
  EXPECT_EQ(refusal(swing, R"({"do":"step","lambda":-1})").where, "lambda");
  Session loose = fresh();
  run(loose, {new_sheet, lift});
  const Error e = refusal(loose, R"({"do":"evolve","mode":"static"})");
  EXPECT_EQ(e.kind, ErrorKind::numerical);
  EXPECT_NE(e.message().find("hold"), std::string::npos) << e.message();
}

TEST(Command, AStrokeAndADragAreOneUndoStepEach) {
  Session session = on_sheet({R"({"do":"tool","radius":1.5,"position":[2,5,-9]})"});
  const auto before = std::make_shared<const SessionState>(session.state());
  run(session, {R"({"do":"stroke","path":[[2,5,-0.8],[5,5,-0.8],[8,5,-0.8]]})"});
  EXPECT_GT(session.largest_displacement(0), 0.2);
  EXPECT_EQ(session.state().steps.size(), 6U);
  EXPECT_TRUE(same_bits(*first(session).rest, *first(session).current)) << "plastic";
  EXPECT_EQ(session.state().tools.front().shape.placement().position, Point(2, 5, -9))
      << "taken back";
  run(session, {R"({"do":"undo"})"});
  EXPECT_TRUE(same_state(session.state(), *before));
  run(session, {R"({"do":"remove"})", R"({"do":"drag","at":[0.5,0.5],"by":[0,0,1],"radius":2})"});
  const Point dragged = at(*first(session).current, 0.5, 0.5);
  EXPECT_GT(dragged.z(), 0.5);
  EXPECT_LT(dragged.z(), 1.1);
  run(session, {R"({"do":"undo"})", R"({"do":"undo"})"});
  EXPECT_TRUE(same_state(session.state(), *before));
  EXPECT_EQ(refusal(session, R"({"do":"stroke","path":[]})").where, "path");
  EXPECT_EQ(refusal(session, R"({"do":"stroke","path":[[0,0,0]],"steps":0})").where, "steps");
  EXPECT_EQ(refusal(session, R"({"do":"stroke","path":[[0,0,0]],"plasticity":2})").where,
            "plasticity");
  EXPECT_EQ(refusal(session, R"({"do":"drag","at":[2,0],"by":[0,0,1]})").where, "at");
  EXPECT_EQ(refusal(session, R"({"do":"drag","at":[0,0],"by":[0,0,1],"radius":0})").where,
            "radius");
  EXPECT_EQ(refusal(session, R"({"do":"drag","at":[0,0],"by":[0,0,1],"steps":0})").where, "steps");
  EXPECT_EQ(refusal(session, R"({"do":"drag","at":[0,0],"by":[0,0,1],"strength":-1})").where,
            "strength");
  EXPECT_EQ(refusal(session, R"({"do":"drag","at":[0,0],"by":[0,0,1],"plasticity":-1})").where,
            "plasticity");
}

TEST(Command, RefineElevateAndCoarsenKeepTheShape) {
  Session session = on_sheet({ball, R"({"do":"step","count":3})"});
  const auto before = first(session).current;
  const double size = bounding_box(*before).diagonal();
  run(session,
      {R"({"do":"refine","region":[[0.4,0.6],[0,0.2]]})", R"({"do":"refine","under":"ball"})",
       R"({"do":"refine","knots_u":[0.111,0.111]})", R"({"do":"elevate","by":[1,0]})"});
  EXPECT_GT(first(session).current->net()[0], 20);
  EXPECT_EQ(first(session).current->knots(0).degree(), 4);
  const auto distance = [&] {
    double largest = 0;
    for (double s = 0; s <= 1; s += 0.0625) {
      for (double t = 0; t <= 1; t += 0.0625) {
        largest = std::max(largest, (at(*before, s, t) - at(*first(session).current, s, t)).norm());
      }
    }
    return largest;
  };
  EXPECT_LT(distance(), 1e-12 * size);
  const int net = first(session).current->size();
  run(session, {R"({"do":"step","count":1,"lambda":1e6})", R"({"do":"undo"})",
                R"({"do":"coarsen","tolerance":1e-3})"});
  EXPECT_LT(first(session).current->size(), net);
  EXPECT_LT(distance(), 1e-3);
  run(session, {R"({"do":"step"})"});
  EXPECT_EQ(refusal(session, R"({"do":"refine"})").where, "region");
  EXPECT_EQ(refusal(session, R"({"do":"refine","under":"x"})").where, "tool");
  EXPECT_EQ(refusal(session, R"({"do":"elevate","by":[-1,0]})").where, "by");
  EXPECT_NE(refusal(session, R"({"do":"elevate","by":[90,0]})").message().find("degree"),
            std::string::npos);
  EXPECT_NE(refusal(session, R"({"do":"coarsen","tolerance":-1})").message().find("tolerance"),
            std::string::npos);
  EXPECT_NE(refusal(session, R"({"do":"refine","knots_u":[7]})").message().find("7"),
            std::string::npos);
  run(session, {R"({"do":"pin","control_points":[[4,4]]})"});
  EXPECT_NE(refusal(session, R"({"do":"elevate"})").what.find("pinned"), std::string::npos);
}

TEST(Command, WithPermissionTheNetUnderASmallToolIsRefined) {
  Session session = on_sheet(
      {R"({"do":"tool","name":"pin","radius":0.4,"position":[5,5,-0.2]})", R"({"do":"step"})"});
  EXPECT_NE(session.state().steps.back().note.find("coarse"), std::string::npos);
  run(session, {R"({"do":"undo"})", R"({"do":"refine","permission":"auto"})", R"({"do":"step"})"});
  EXPECT_GT(first(session).current->net()[0], 12);
  EXPECT_EQ(session.state().steps.size(), 1U);
  EXPECT_TRUE(session.state().steps.back().note.empty()) << session.state().steps.back().note;
}

TEST(Command, WithPermissionANetGrowsToALimit) {
  Session session = fresh();
  run(session,
      {R"({"do":"new","size":[10,10],"net":[60,60]})", R"({"do":"refine","permission":"auto"})",
       R"({"do":"tool","name":"ring","shape":"torus","radius":4,"minor":0.02,)"
       R"("position":[0,0,0]})"});
  const Error error = refusal(session, R"({"do":"step"})");
  EXPECT_EQ(error.kind, ErrorKind::numerical);
  EXPECT_NE(error.message().find("the tool ring needs a net of 2"), std::string::npos)
      << error.message();
  EXPECT_NE(error.message().find("40000 control points"), std::string::npos) << error.message();
  EXPECT_EQ(first(session).current->net(), (std::array<int, 2>{60, 60})) << "nothing of it is left";
}

}  // namespace
}  // namespace knead
