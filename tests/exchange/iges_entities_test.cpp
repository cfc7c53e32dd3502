// Entities of IGES files beyond B-spline surfaces.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "exchange/iges_builder.hpp"
#include "exchange/support.hpp"
#include "knead/brep/model.hpp"
#include "knead/exchange/format.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

using testing::IgesBuilder;
using testing::open_or_die;

const std::array<double, 2> breaks_u = {-1, 1};
const std::array<double, 3> breaks_v = {0, 0.5, 2};

/// A polynomial of degree 3 in each direction, and its derivatives by u and v at a point: what a
/// patch that begins there has for coefficients.
double height(double u, double v) { return 1 + 2 * u - u * v * v + 0.5 * u * u * u * v * v * v; }

/// Σ over powers of u and v, shifted to a corner.
std::array<double, 16> patch(std::size_t component, double u0, double v0) {
  std::array<double, 16> p{};
  // x = u, y = v, z = height, about (u0, v0).
  if (component == 0) {
    p[0] = u0;
    p[1] = 1;
  } else if (component == 1) {
    p[0] = v0;
    p[4] = 1;
  } else {
    const std::array<double, 4> cube_u = {u0 * u0 * u0, 3 * u0 * u0, 3 * u0, 1},
                                cube_v = {v0 * v0 * v0, 3 * v0 * v0, 3 * v0, 1};
    const std::array<double, 2> one_u = {u0, 1};
    const std::array<double, 3> square_v = {v0 * v0, 2 * v0, 1};
    p[0] = 1;
    for (std::size_t a = 0; a < 2; ++a) {
      p[a] += 2 * one_u[a];
      for (std::size_t b = 0; b < 3; ++b) p[a + 4 * b] -= one_u[a] * square_v[b];
    }
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) p[a + 4 * b] += 0.5 * cube_u[a] * cube_v[b];
    }
  }
  return p;
}

std::string parametric(double step = 0) {
  std::string text = "3,1,1,2";
  for (const double u : breaks_u) text += fmt::format(",{}", u);
  for (const double v : breaks_v) text += fmt::format(",{}", v);
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t c = 0; c < 3; ++c) {
        auto p = patch(c, breaks_u[i], breaks_v[j]);
        if (i == 1 || j == 2) p.fill(99);  // without meaning
        if (j == 1 && c == 2) p[0] += step;
        for (const double x : p) text += fmt::format(",{:.17g}", x);
      }
    }
  }
  return text;
}

TEST(IgesEntities, ParametricSplineSurfacesAreBSplinesExactly) {
  IgesBuilder b;
  b.add(114, parametric());
  const auto source = open_or_die(b.text(), "a.igs");
  ASSERT_EQ(source->surfaces().size(), 1U);
  const Surface& s = *source->surfaces()[0].surface;
  EXPECT_EQ(s.net(), (std::array{4, 7}));
  for (const double u : {-1.0, -0.3, 0.9, 1.0}) {
    for (const double v : {0.0, 0.2, 0.5, 1.7, 2.0}) {
      const auto p = evaluate_point<2>(s, {u, v});
      ASSERT_TRUE(p);
      EXPECT_NEAR((*p - Point(u, v, height(u, v))).norm(), 0, 1e-14 * 20);
    }
  }
}

TEST(IgesEntities, AChangedParametricSplineSurfaceBecomesABSplineInItsPlace) {
  IgesBuilder b;
  const int matrix = b.add(124, "1.,0.,0.,10.,0.,1.,0.,20.,0.,0.,1.,30.");
  b.add(110, "0.,0.,0.,1.,0.,0.");
  b.add(114, parametric(), matrix, 0, 0, "a remark");
  b.add(110, "0.,0.,0.,2.,0.,0.");
  const std::string text = b.text();
  const auto source = open_or_die(text, "a.igs");
  ASSERT_EQ(source->surfaces().size(), 1U);
  EXPECT_EQ(source->surfaces()[0].id, "#5");
  std::vector<std::shared_ptr<const Surface>> surfaces = {source->surfaces()[0].surface};
  EXPECT_EQ(*source->save(surfaces), text);
  Points points = surfaces[0]->control_points();
  points(5, 2) += 0.125;
  surfaces[0] = std::make_shared<const Surface>(*surfaces[0]->with_control_points(points));
  const auto written = source->save(surfaces);
  ASSERT_TRUE(written) << written.error().message();
  EXPECT_NE(written->find("110,0.,0.,0.,2.,0.,0.;"), std::string::npos);
  EXPECT_NE(written->find("a remark"), std::string::npos);
  const auto again = open_or_die(*written, "a.igs");
  ASSERT_EQ(again->surfaces().size(), 1U);
  EXPECT_EQ(again->surfaces()[0].id, "#5");
  EXPECT_EQ(again->surfaces()[0].surface->knots(), surfaces[0]->knots());
  EXPECT_LE((again->surfaces()[0].surface->control_points() - points).cwiseAbs().maxCoeff(),
            1e-13 * 40);
  const auto remarks = again->remarks();
  EXPECT_NE(std::ranges::find(remarks, "1 x 128 (B-spline surface)"), remarks.end());
}

TEST(IgesEntities, PatchesThatDoNotMeetAreReported) {
  IgesBuilder b;
  b.add(114, parametric(0.01));
  const auto source = open_or_die(b.text(), "a.igs");
  ASSERT_EQ(source->unreadable().size(), 1U);
  EXPECT_NE(source->unreadable()[0].reason.message().find("its patches are 0.01 apart"),
            std::string::npos)
      << source->unreadable()[0].reason.message();
}

void expect_placed_subfigures(IgesBuilder b) {
  const int surface = b.add(128, testing::plate()), alone = b.add(128, testing::plate("7."));
  const int inner = b.add(308, fmt::format("0,5HInner,1,{}", surface));
  const int nested = b.add(408, fmt::format("{},100.,0.,0.,2.", inner));
  const int outer = b.add(308, fmt::format("1,5HOuter,1,{}", nested));
  b.add(408, fmt::format("{},0.,10.,0.", outer));
  b.add(408, fmt::format("{},0.,0.,5.,3.", outer));
  b.add(408, fmt::format("{},1.,2.,3.,", inner));
  const auto source = open_or_die(b.text(), "a.igs");
  EXPECT_EQ(source->surfaces().size(), 2U);
  const auto model = source->model()->assembly;
  ASSERT_TRUE(model) << model.error().message();
  const brep::Part* part = model->part_of(fmt::format("#{}", surface));
  ASSERT_NE(part, nullptr);
  std::vector<Point> places;
  for (const brep::PartPlace& place : part->places)
    places.push_back(place.to_model * Point(1, 0, 0));
  ASSERT_EQ(places.size(), 3U);
  for (const Point& wanted : {Point(102, 10, 0), Point(306, 0, 5), Point(2, 2, 3)}) {
    EXPECT_TRUE(std::ranges::any_of(places, [&](const Point& p) {
      return (p - wanted).norm() < 1e-12;
    })) << wanted.transpose();
  }
  const brep::Part* rest = model->part_of(fmt::format("#{}", alone));
  ASSERT_NE(rest, nullptr);
  EXPECT_EQ(rest->places.size(), 1U) << "what is in no subfigure stands once, at its coordinates";
}

TEST(IgesEntities, SubfiguresStandWhereTheirInstancesPutThem) {
  expect_placed_subfigures({});
  IgesBuilder without_unit;
  without_unit.global.replace(without_unit.global.find("2,2HMM"), 6, "3,4HPACE");
  expect_placed_subfigures(without_unit);
}

TEST(IgesEntities, TheMatrixOfAnInstanceMovesWhatItsPlaceAndScaleHaveMoved) {
  IgesBuilder b;
  const int turned = b.add(124, "0.,-1.,0.,10.,1.,0.,0.,20.,0.,0.,1.,30."),
            mirrored = b.add(124, "-1.,0.,0.,0.,0.,1.,0.,0.,0.,0.,1.,0.", 0, 1),
            sheared = b.add(124, "1.,0.5,0.,0.,0.,1.,0.,0.,0.,0.,1.,0.");
  const int surface = b.add(128, testing::plate());
  const int definition = b.add(308, fmt::format("0,4HPart,1,{}", surface));
  b.add(408, fmt::format("{},100.,0.,0.,2.", definition), turned);
  b.add(408, fmt::format("{},100.,0.,0.,1.", definition), mirrored);
  b.add(408, fmt::format("{},0.,0.,0.,1.", definition), sheared);
  const auto source = open_or_die(b.text(), "a.igs");
  const auto model = source->model()->assembly;
  ASSERT_TRUE(model) << model.error().message();
  const brep::Part* part = model->part_of(fmt::format("#{}", surface));
  ASSERT_NE(part, nullptr);
  ASSERT_EQ(part->places.size(), 2U) << "the sheared one cannot be told in the words of STEP";
  // (1, 3, 0) is scaled and moved to (102, 6, 0) and (101, 3, 0) first.
  for (const Point& wanted : {Point(10 - 6, 20 + 102, 30), Point(-101, 3, 0)}) {
    EXPECT_TRUE(std::ranges::any_of(part->places, [&](const brep::PartPlace& place) {
      return (place.to_model * Point(1, 3, 0) - wanted).norm() < 1e-12;
    })) << wanted.transpose();
  }
}

TEST(IgesEntities, WhatIsNotReadIsCountedAndKept) {
  IgesBuilder b;
  const int surface = b.add(128, testing::plate());
  const int line = b.add(110, "0.,0.,0.,1.,0.,0."), other = b.add(110, "0.,1.,0.,1.,1.,0.");
  b.add(118, fmt::format("{},{},0,0", line, other));
  b.add(140, fmt::format("0.,0.,1.,0.5,{}", surface));
  const int figure = b.add(308, fmt::format("0,4HPart,1,{}", surface));
  b.add(408, fmt::format("{},1.,2.,3.,1.", figure));
  b.add(314, "100.,0.,50.,4HPink");
  b.add(406, "1,9HName;,;,;");
  b.add(404, "0,0");
  const std::string text = b.text();
  const auto source = open_or_die(text, "a.igs");
  const auto remarks = source->remarks();
  for (const char* wanted :
       {"1 x 118 (ruled surface)", "1 x 140 (offset surface)", "1 x 308 (subfigure definition)",
        "1 x 408 (subfigure instance)", "1 x 314 (colour)", "1 x 406 (property)"}) {
    EXPECT_NE(std::ranges::find(remarks, wanted), remarks.end()) << wanted;
  }
  ASSERT_EQ(source->surfaces().size(), 2U) << "and the ruled one";
  Points points = source->surfaces()[0].surface->control_points();
  points(2, 2) = 1.0 / 3;
  const std::vector moved = {
      std::make_shared<const Surface>(*source->surfaces()[0].surface->with_control_points(points)),
      source->surfaces()[1].surface};
  const auto written = source->save(moved);
  ASSERT_TRUE(written) << written.error().message();
  const auto again = open_or_die(*written, "a.igs");
  EXPECT_EQ(again->remarks(), remarks);
  EXPECT_NE(written->find("406,1,9HName;,;,;;"), std::string::npos)
      << "strings with separators in them";
}

/// A parabola over 0 … 2 whose parameters count from 3 to 7, and a cubic with a knot inside.
constexpr const char* parabola =
    "2,2,0,0,1,0,3.,3.,3.,7.,7.,7.,1.,1.,1.,0.,0.,0.,1.,0.,2.,2.,0.,0.,3.,7.,0.,0.,1.";
constexpr const char* cubic =
    "4,3,0,0,1,0,0.,0.,0.,0.,0.5,1.,1.,1.,1.,1.,1.,1.,1.,1.,0.,3.,0.,0.5,3.,1.,1.,3.,-1.,1.5,3.,0."
    "5,2.,3.,0.,0.,1.,0.,"
    "0.,1.";

Point on(const std::string& curve, double share) {
  const bool quadratic = curve == parabola;
  Points points(quadratic ? 3 : 5, 3);
  std::vector<double> knots;
  if (quadratic) {
    points << 0, 0, 0, 1, 0, 2, 2, 0, 0;
    knots = {0, 0, 0, 1, 1, 1};
  } else {
    points << 0, 3, 0, 0.5, 3, 1, 1, 3, -1, 1.5, 3, 0.5, 2, 3, 0;
    knots = {0, 0, 0, 0, 0.5, 1, 1, 1, 1};
  }
  const auto spline = Curve::create({*KnotVector::create(quadratic ? 2 : 3, knots)}, points);
  return *evaluate_point<1>(*spline, {share});
}

TEST(IgesEntities, RuledSurfacesAtEqualParametersAreBSplinesExactly) {
  for (const int turned : {0, 1}) {
    IgesBuilder b;
    const int first = b.add(126, parabola), second = b.add(126, cubic);
    b.add(118, fmt::format("{},{},{},0", first, second, turned), 0, 1);
    const auto source = open_or_die(b.text(), "a.igs");
    ASSERT_EQ(source->surfaces().size(), 1U);
    const Surface& s = *source->surfaces()[0].surface;
    EXPECT_EQ(source->surfaces()[0].id, "#5");
    EXPECT_EQ(s.knots(0).degree(), 3);
    for (const double u : {0.0, 0.2, 0.5, 0.9, 1.0}) {
      for (const double v : {0.0, 0.3, 1.0}) {
        const auto p = evaluate_point<2>(s, {u, v});
        ASSERT_TRUE(p);
        const Point wanted = (1 - v) * on(parabola, u) + v * on(cubic, turned != 0 ? 1 - u : u);
        EXPECT_LE((*p - wanted).norm(), 1e-14) << u << " " << v;
      }
    }
  }
}

TEST(IgesEntities, ARuledSurfaceEndsWhereItsCurvesDo) {
  IgesBuilder b;
  std::string part = parabola;  // from the middle on
  part.replace(part.rfind(",3.,7.,"), 7, ",5.,7.,");
  const int first = b.add(126, part), second = b.add(110, "0.,3.,1.,4.,3.,1.");
  b.add(118, fmt::format("{},{},0,0", first, second), 0, 1);
  const auto source = open_or_die(b.text(), "a.igs");
  ASSERT_EQ(source->surfaces().size(), 1U);
  for (const double u : {0.0, 0.4, 1.0}) {
    const auto p = evaluate_point<2>(*source->surfaces()[0].surface, {u, 0});
    EXPECT_LE((*p - on(parabola, 0.5 + 0.5 * u)).norm(), 1e-14);
    const auto q = evaluate_point<2>(*source->surfaces()[0].surface, {u, 1});
    EXPECT_LE((*q - Point(4 * u, 3, 1)).norm(), 1e-14);
  }
}

TEST(IgesEntities, AChangedRuledSurfaceBecomesABSplineInItsPlaceAndItsCurvesStay) {
  IgesBuilder b;
  const int first = b.add(126, parabola), second = b.add(126, cubic);
  const int matrix = b.add(124, "0.,-1.,0.,10.,1.,0.,0.,20.,0.,0.,1.,30.");
  b.add(118, fmt::format("{},{},0,0", first, second), matrix, 1, 0, "a remark");
  b.add(110, "0.,0.,0.,2.,0.,0.");
  const std::string text = b.text();
  const auto source = open_or_die(text, "a.igs");
  ASSERT_EQ(source->surfaces().size(), 1U);
  std::vector<std::shared_ptr<const Surface>> surfaces = {source->surfaces()[0].surface};
  EXPECT_EQ(*source->save(surfaces), text);
  Points points = surfaces[0]->control_points();
  points(3, 2) += 0.125;
  surfaces[0] = std::make_shared<const Surface>(*surfaces[0]->with_control_points(points));
  const auto written = source->save(surfaces);
  ASSERT_TRUE(written) << written.error().message();
  const std::size_t end = text.find("118,");
  EXPECT_EQ(written->substr(written->find("126,"), end - text.find("126,")),
            text.substr(text.find("126,"), end - text.find("126,")))
      << "its curves and its matrix";
  EXPECT_NE(written->find("110,0.,0.,0.,2.,0.,0.;"), std::string::npos);
  const auto remarks = open_or_die(*written, "a.igs")->remarks();
  EXPECT_NE(std::ranges::find(remarks, "1 x 128 (B-spline surface)"), remarks.end());
  EXPECT_NE(written->find("a remark"), std::string::npos);
  const auto again = open_or_die(*written, "a.igs");
  ASSERT_EQ(again->surfaces().size(), 1U);
  EXPECT_LE((again->surfaces()[0].surface->control_points() - points).cwiseAbs().maxCoeff(),
            1e-13 * 40);
}

TEST(IgesEntities, WhatIsNoBSplineSurfaceIsSaidWithTheReason) {
  const auto reason = [](const auto& add) {
    IgesBuilder b;
    const int plate = b.add(128, testing::plate());
    add(b, plate);
    const auto source = open_or_die(b.text(), "a.igs");
    EXPECT_EQ(source->surfaces().size(), 1U);
    EXPECT_EQ(*source->save(std::vector{source->surfaces()[0].surface}), b.text());
    return source->unreadable().size() == 1 ? source->unreadable()[0].reason.message() : "";
  };
  const auto by_lengths = reason([](IgesBuilder& b, int) {
    const int first = b.add(126, parabola), second = b.add(126, cubic);
    b.add(118, fmt::format("{},{},0,0", first, second));
  });
  EXPECT_NE(by_lengths.find("equal lengths"), std::string::npos) << by_lengths;
  const auto arc = reason([](IgesBuilder& b, int) {
    const int first = b.add(100, "0.,0.,0.,1.,0.,0.,1."), second = b.add(126, cubic);
    b.add(118, fmt::format("{},{},0,0", first, second), 0, 1);
  });
  EXPECT_NE(arc.find("which is no line or B-spline curve"), std::string::npos) << arc;
  const auto weights = reason([](IgesBuilder& b, int) {
    std::string rational = parabola;
    rational.replace(rational.find("1.,1.,1."), 8, "1.,2.,1.");
    const int first = b.add(126, rational), second = b.add(126, cubic);
    b.add(118, fmt::format("{},{},0,0", first, second), 0, 1);
  });
  EXPECT_NE(weights.find("different weights"), std::string::npos) << weights;
  const auto offset =
      reason([](IgesBuilder& b, int plate) { b.add(140, fmt::format("0.,0.,1.,0.5,{}", plate)); });
  EXPECT_NE(offset.find("offset surface"), std::string::npos) << offset;
  const auto nothing = reason([](IgesBuilder& b, int) { b.add(118, "0,99,0,0", 0, 1); });
  EXPECT_FALSE(nothing.empty());
}

}  // namespace
}  // namespace knead
