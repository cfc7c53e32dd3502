// Surfaces that come back with another net, other degrees or other knots.

#include <gtest/gtest.h>

#include "exchange/support.hpp"
#include "knead/spline/spline_refinement.hpp"

namespace knead {
namespace {

using testing::bilinear_patch;
using testing::parse_or_die;
using testing::same_bits;
using testing::step_text;
using testing::unit_square_points;

Surface surface_of(const std::string& bytes) {
  return parse_or_die(bytes).model().find_surface("#10")->surface;
}

std::string replaced(const std::string& bytes, const Surface& surface) {
  const brep::Replacement replacement{"#10", surface};
  const auto result = parse_or_die(bytes).with_surfaces({&replacement, 1});
  if (!result) {
    ADD_FAILURE() << result.error().message();
    return {};
  }
  const auto read = surface_of(*result);
  EXPECT_EQ(read.knots(), surface.knots());
  EXPECT_TRUE(same_bits(read.control_points(), surface.control_points()));
  EXPECT_TRUE(std::ranges::equal(read.weights(), surface.weights()));
  return *result;
}

Surface inserted(const std::string& bytes, std::vector<double> u, std::vector<double> v = {}) {
  return *insert_knots<2>(surface_of(bytes), {std::move(u), std::move(v)});
}

// The text with each first occurrence of a pair's left replaced by its right.
std::string edited(std::string text,
                   const std::vector<std::pair<std::string, std::string>>& pairs) {
  for (const auto& [from, to] : pairs) {
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) text.replace(at, from.size(), to);
  }
  return text;
}

const std::string quarter = "2.5000000000000000E-01", half = "5.0000000000000000E-01",
                  zero = "0.0000000000000000E+00", one = "1.0000000000000000E+00";

TEST(RefinedSurface, AnInsertedKnotChangesTheNetAndTheKnotsOfItsDirectionAlone) {
  const auto bytes = step_text(unit_square_points() + bilinear_patch());
  EXPECT_EQ(replaced(bytes, inserted(bytes, {0.25})),
            edited(bytes, {{"((#1,#2),(#3,#4))", "((#1,#2),\n(#11,#12),\n(#3,#4))"},
                           {"(2,2),(2,2),(0.,1.),(0.,1.)", "(2,1,2),(2,2),(0.,0.25,1.),(0.,1.)"},
                           {".UNSPECIFIED.);\n", ".UNSPECIFIED.);\n#11=CARTESIAN_POINT('',(" +
                                                     quarter + "," + zero + "," + zero +
                                                     "));\n#12=CARTESIAN_POINT('',(" + quarter +
                                                     "," + one + "," + zero + "));\n"}}));
}

TEST(RefinedSurface, TheSameSurfaceGivesTheSameBytesAndTheSameNetTheSameAsAnEditOfPoints) {
  const auto bytes = step_text(unit_square_points() + bilinear_patch());
  EXPECT_EQ(replaced(bytes, surface_of(bytes)), bytes);
  Points points = surface_of(bytes).control_points();
  points(1, 2) = 7;
  const step::Edit edit{"#10", points};
  EXPECT_EQ(replaced(bytes, *surface_of(bytes).with_control_points(points)),
            *parse_or_die(bytes).with_control_points({&edit, 1}));
}

// Three rows of which the middle one is nobody else's.
const std::string quadratic =
    unit_square_points() +
    "#5= CARTESIAN_POINT ( 'mid' , (0.5,0.,1.));\n#6=CARTESIAN_POINT('',(0.5,1.,1.));\n" +
    "#10=B_SPLINE_SURFACE_WITH_KNOTS('patch',2,1,((#1,#2),(#5,#6),(#3,#4)),.RULED_SURF.,.F.,.U.,.T."
    ",(3,3),(2,2),"
    "(0.0E0,1.00),(0,1.),.PIECEWISE_BEZIER_KNOTS.);\n";

TEST(RefinedSurface, RecordsNobodyNeedsTakeOverNewValues) {
  const auto bytes = step_text(quadratic);
  EXPECT_EQ(
      replaced(bytes, inserted(bytes, {0.5})),
      edited(bytes, {{"((#1,#2),(#5,#6),(#3,#4))", "((#1,#2),\n(#5,#6),\n(#11,#12),\n(#3,#4))"},
                     {"(0.5,0.,1.)", "(" + quarter + ",0.," + half + ")"},
                     {"(0.5,1.,1.)", "(" + quarter + ",1.," + half + ")"},
                     {"(3,3),(2,2),(0.0E0,1.00)", "(3,1,3),(2,2),(0.0E0,0.5,1.00)"},
                     {".PIECEWISE_BEZIER_KNOTS.);\n",
                      ".UNSPECIFIED.);\n#11=CARTESIAN_POINT('',(7.5000000000000000E-01," + zero +
                          "," + half + "));\n#12=CARTESIAN_POINT('',(7.5000000000000000E-01," +
                          one + "," + half + "));\n"}}));
}

TEST(RefinedSurface, RecordsSomebodyElseNeedsStay) {
  const auto bytes = step_text(quadratic + "#8=VERTEX_POINT('',#5);\n");
  const auto result = replaced(bytes, inserted(bytes, {0.5}));
  EXPECT_NE(result.find("#5= CARTESIAN_POINT ( 'mid' , (0.5,0.,1.));\n"), std::string::npos);
  // #6 is free and comes first in line for the first new value.
  EXPECT_NE(result.find("((#1,#2),\n(#6,#11),\n(#12,#13),\n(#3,#4))"), std::string::npos);
}

TEST(RefinedSurface, ElevationAndBothDirectionsAtOnce) {
  const auto bytes = step_text(quadratic);
  const auto higher =
      *elevate_degree(*elevate_degree(inserted(bytes, {0.5, 0.5}, {1.0 / 3}), 0), 1, 2);
  const auto result = replaced(bytes, higher);
  EXPECT_NE(result.find("('patch',3,3,((#1,"), std::string::npos);
  EXPECT_NE(
      result.find(
          ",.RULED_SURF.,.F.,.U.,.T.,(4,3,4),(4,3,4),(0.0E0,0.5,1.00),(0,0.3333333333333333,1.),"
          ".UNSPECIFIED.);"),
      std::string::npos)
      << "form and flags stay";
}

TEST(RefinedSurface, WhatWasInsertedAndIsRemovedAgainLeavesSpareRecordsBehind) {
  const auto bytes = step_text(quadratic);
  const auto finer = replaced(bytes, inserted(bytes, {0.5, 0.25}));
  const auto coarse = remove_knots(surface_of(finer), 0, 1e-12);
  ASSERT_TRUE(coarse);
  ASSERT_EQ(coarse->removed.size(), 2U);
  const auto again = replaced(finer, coarse->spline);
  EXPECT_EQ(again.find("#13=CARTESIAN_POINT") != std::string::npos,
            finer.find("#13=CARTESIAN_POINT") != std::string::npos)
      << "nothing is deleted";
}

TEST(RefinedSurface, ImpliedKnotsAreListedOnceTheyAreOthers) {
  const auto bezier =
      step_text(unit_square_points() +
                "#10=BEZIER_SURFACE('b',1,1,((#1,#2),(#3,#4)),.UNSPECIFIED.,.F.,.F.,.F.);\n");
  EXPECT_NE(replaced(bezier, inserted(bezier, {0.25}))
                .find("#10=B_SPLINE_SURFACE_WITH_KNOTS('b',1,1,((#1,#2),\n(#11,#12),\n(#3,#4)),."
                      "UNSPECIFIED.,.F.,.F.,.F."
                      ",(2,1,2),(2,2),(0.,0.25,1.),(0.,1.),.UNSPECIFIED.);\n"),
            std::string::npos);
  EXPECT_NE(
      replaced(bezier, *elevate_degree(surface_of(bezier), 0)).find("#10=BEZIER_SURFACE('b',2,1,"),
      std::string::npos)
      << "still one Bezier piece";
  for (const auto* form : {"QUASI_UNIFORM_SURFACE", "UNIFORM_SURFACE"}) {
    const auto bytes = edited(bezier, {{"BEZIER_SURFACE", form}});
    EXPECT_NE(replaced(bytes, inserted(bytes, {}, {0.5}))
                  .find("#10=B_SPLINE_SURFACE_WITH_KNOTS('b',1,1,"),
              std::string::npos);
  }
}

const std::string complex_surface = unit_square_points() +
                                    "#10=(BEZIER_SURFACE()BOUNDED_SURFACE()B_SPLINE_SURFACE(1,1,((#"
                                    "1,#2),(#3,#4)),.UNSPECIFIED.,.F.,.F.,.F.)"
                                    "GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(((1.,"
                                    "2.00),(1.,4.)))REPRESENTATION_ITEM('')SURFACE());\n";

TEST(RefinedSurface, ComplexInstancesKeepTheOrderOfTheirParts) {
  const auto bytes = step_text(complex_surface);
  const auto result = replaced(bytes, inserted(bytes, {0.5}));
  EXPECT_NE(
      result.find(
          "#10=(BOUNDED_SURFACE()B_SPLINE_SURFACE(1,1,((#1,#2),\n(#11,#12),\n(#3,#4)),.UNSPECIFIED."
          ",.F.,"
          ".F.,.F.)B_SPLINE_SURFACE_WITH_KNOTS((2,1,2),(2,2),(0.,0.5,1.),(0.,1.),.UNSPECIFIED.)"
          "GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(((1.,2.00),\n(1.,3.),\n(1.,4.))"
          ")"
          "REPRESENTATION_ITEM('')SURFACE());\n"),
      std::string::npos)
      << result;
  const auto twice = replaced(result, inserted(result, {}, {0.25}));
  EXPECT_NE(
      twice.find(
          "B_SPLINE_SURFACE_WITH_KNOTS((2,1,2),(2,1,2),(0.,0.5,1.),(0.,0.25,1.),.UNSPECIFIED.)"),
      std::string::npos);
}

TEST(RefinedSurface, WeightsAloneCanChange) {
  const auto bytes = step_text(complex_surface);
  const auto s = surface_of(bytes);
  const auto heavier = Surface::create(s.knots(), s.control_points(), {1, 2, 1, 0.1});
  EXPECT_EQ(replaced(bytes, *heavier),
            edited(bytes, {{"((#1,#2),(#3,#4))", "((#1,#2),\n(#3,#4))"},
                           {"((1.,2.00),(1.,4.))", "((1.,2.00),\n(1.,0.1))"}}));
}

Surface weighted(const Surface& s, std::vector<double> weights = {1, 0.5, 1, 3}) {
  return *Surface::create(s.knots(), s.control_points(), std::move(weights));
}

const std::string three_weights = "RATIONAL_B_SPLINE_SURFACE(((1.,0.5),\n(1.,3.)))";

TEST(RefinedSurface, ASimpleRecordThatGetsWeightsBecomesAComplexOne) {
  const auto bytes =
      step_text(unit_square_points() + bilinear_patch() + "#11=VERTEX_POINT('',#2);\n");
  EXPECT_EQ(replaced(bytes, weighted(surface_of(bytes))),
            edited(bytes, {{"#10=B_SPLINE_SURFACE_WITH_KNOTS('patch',1,1,",
                            "#10=(BOUNDED_SURFACE()B_SPLINE_SURFACE(1,1,"},
                           {"((#1,#2),(#3,#4))", "((#1,#2),\n(#3,#4))"},
                           {".F.,.F.,.F.,(2,2)", ".F.,.F.,.F.)B_SPLINE_SURFACE_WITH_KNOTS((2,2)"},
                           {".UNSPECIFIED.);", ".UNSPECIFIED.)GEOMETRIC_REPRESENTATION_ITEM()" +
                                                   three_weights +
                                                   "REPRESENTATION_ITEM('patch')SURFACE());"}}));
  const auto twice = replaced(bytes, weighted(inserted(bytes, {0.25}), {1, 2, 3, 4, 5, 6}));
  EXPECT_NE(
      twice.find(
          "B_SPLINE_SURFACE_WITH_KNOTS((2,1,2),(2,2),(0.,0.25,1.),(0.,1.),.UNSPECIFIED.)GEOMETRIC"),
      std::string::npos)
      << "knots at once";
}

TEST(RefinedSurface, CommentsBetweenAttributesStayWhenWeightsCome) {
  const auto bytes = step_text(unit_square_points() +
                               "#10 = B_SPLINE_SURFACE_WITH_KNOTS ( 'a,b' , "
                               "1,1,((#1,#2),(#3,#4)),.UNSPECIFIED.,.F.,.F.,.F. /* here, there */ ,"
                               " (2,2),(2,2),(0.,1.),(0.,1.),.UNSPECIFIED. ) ;\n");
  const auto result = replaced(bytes, weighted(surface_of(bytes)));
  EXPECT_NE(result.find("#10 = (BOUNDED_SURFACE()B_SPLINE_SURFACE( 1,1,"), std::string::npos)
      << result;
  EXPECT_NE(result.find(".F. /* here, there */ )B_SPLINE_SURFACE_WITH_KNOTS( (2,2),"),
            std::string::npos)
      << result;
  EXPECT_NE(result.find("REPRESENTATION_ITEM('a,b')SURFACE()) ;"), std::string::npos) << result;
}

TEST(RefinedSurface, ImpliedKnotsStayImpliedWhenWeightsCome) {
  const auto bezier =
      step_text(unit_square_points() +
                "#10=BEZIER_SURFACE('b',1,1,((#1,#2),(#3,#4)),.UNSPECIFIED.,.F.,.F.,.F.);\n");
  const auto shared_part =
      "BOUNDED_SURFACE()B_SPLINE_SURFACE(1,1,((#1,#2),\n(#3,#4)),.UNSPECIFIED.,.F.,.F.,.F.)";
  const auto tail = three_weights + "REPRESENTATION_ITEM('b')SURFACE()";
  const std::tuple<const char*, std::string> expected[] = {
      {"BEZIER_SURFACE", std::string("#10=(BEZIER_SURFACE()") + shared_part +
                             "GEOMETRIC_REPRESENTATION_ITEM()" + tail + ");\n"},
      {"QUASI_UNIFORM_SURFACE", std::string("#10=(") + shared_part +
                                    "GEOMETRIC_REPRESENTATION_ITEM()QUASI_UNIFORM_SURFACE()" +
                                    tail + ");\n"},
      {"UNIFORM_SURFACE", std::string("#10=(") + shared_part + "GEOMETRIC_REPRESENTATION_ITEM()" +
                              tail + "UNIFORM_SURFACE());\n"}};
  for (const auto& [form, text] : expected) {
    const auto bytes = edited(bezier, {{"BEZIER_SURFACE", form}});
    const auto result = replaced(bytes, weighted(surface_of(bytes)));
    EXPECT_NE(result.find(text), std::string::npos) << result;
    EXPECT_NE(replaced(bytes, weighted(inserted(bytes, {0.25}), {1, 2, 3, 4, 5, 6}))
                  .find(std::string(".F.)B_SPLINE_SURFACE_WITH_KNOTS((")),
              std::string::npos)
        << form;
    // And once more, now that it is complex.
    EXPECT_NE(replaced(result, weighted(surface_of(bytes), {1, 1, 1, 2}))
                  .find("SURFACE(((1.,1.),\n(1.,2.)))"),
              std::string::npos);
  }
}

TEST(RefinedSurface, AComplexRecordGetsThePartForItsWeights) {
  const auto bytes = step_text(
      unit_square_points() +
      "#10=(BOUNDED_SURFACE()B_SPLINE_SURFACE(1,1,((#1,#2),(#3,#4)),.UNSPECIFIED.,.F.,.F.,.F.)"
      "B_SPLINE_SURFACE_WITH_KNOTS((2,2),(2,2),(0.,1.),(0.,1.),.UNSPECIFIED.)GEOMETRIC_"
      "REPRESENTATION_ITEM()"
      "REPRESENTATION_ITEM('')SURFACE());\n");
  EXPECT_EQ(replaced(bytes, weighted(surface_of(bytes))),
            edited(bytes, {{"((#1,#2),(#3,#4))", "((#1,#2),\n(#3,#4))"},
                           {"ITEM()REPRESENTATION_ITEM('')",
                            "ITEM()" + three_weights + "REPRESENTATION_ITEM('')"}}));
}

TEST(RefinedSurface, PolesAndSeamsShareTheirRecords) {
  const auto bytes = step_text(unit_square_points() + bilinear_patch("((#1,#1),(#2,#3))"));
  const auto result = replaced(bytes, inserted(bytes, {}, {0.5}));
  EXPECT_NE(result.find("((#1,#1,#1),\n(#2,#11,#3))"), std::string::npos);
}

TEST(RefinedSurface, AFileInOneLineStaysInOneLineAndScopesAreKept) {
  auto bytes = step_text("#20=&SCOPE\n" + unit_square_points() + bilinear_patch() +
                         "ENDSCOPE /#10/\nHOLDER(#10);\n");
  const auto scoped = replaced(bytes, inserted(bytes, {0.25}));
  EXPECT_LT(scoped.find("#22=CARTESIAN_POINT"), scoped.find("ENDSCOPE"));
  std::erase(bytes, '\n');
  EXPECT_EQ(replaced(bytes, inserted(bytes, {0.25})).find('\n'), std::string::npos);
}

TEST(RefinedSurface, WhatStepCannotSayIsAnError) {
  const auto bytes = step_text(unit_square_points() + bilinear_patch());
  const auto file = parse_or_die(bytes);
  const auto what = [&](const Surface& surface, const std::string& id = "#10") {
    const brep::Replacement replacement{id, surface};
    const auto result = file.with_surfaces({&replacement, 1});
    EXPECT_FALSE(result);
    EXPECT_EQ(result.error().kind, ErrorKind::input);
    return result.error().message();
  };
  const auto s = surface_of(bytes);
  EXPECT_NE(what(inserted(bytes, {0.5, 0.5})).find("torn along a knot"), std::string::npos);
  EXPECT_NE(what(s, "#99").find("#99"), std::string::npos);
  const auto short_record =
      step_text(unit_square_points() + "#10=BEZIER_SURFACE('b',1,1,((#1,#2),(#3,#4)));\n");
  const brep::Replacement finer{"#10", inserted(short_record, {0.5})};
  EXPECT_NE(parse_or_die(short_record)
                .with_surfaces({&finer, 1})
                .error()
                .message()
                .find("it has 4 attributes"),
            std::string::npos);
  const brep::Replacement heavier{"#10", weighted(surface_of(short_record))};
  EXPECT_NE(parse_or_die(short_record)
                .with_surfaces({&heavier, 1})
                .error()
                .message()
                .find("it has 4 attributes"),
            std::string::npos);
  const auto with_weights = step_text(complex_surface);
  const brep::Replacement plain{"#10", s};
  EXPECT_NE(parse_or_die(with_weights).with_surfaces({&plain, 1}).error().message().find("weights"),
            std::string::npos);
  const brep::Replacement twice[] = {{"#10", s}, {"#10", s}};
  EXPECT_NE(file.with_surfaces(twice).error().message().find("twice"), std::string::npos);
}

}  // namespace
}  // namespace knead
