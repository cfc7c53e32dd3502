#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "exchange/support.hpp"

namespace knead {
namespace {

using testing::bilinear_patch;
using testing::parse_or_die;
using testing::step_text;
using testing::unit_square_points;

// Points #1 … #n at (k, k², 0).
std::string points(int n) {
  std::string text;
  for (int k = 1; k <= n; ++k) {
    text += "#" + std::to_string(k) + "=CARTESIAN_POINT('',(" + std::to_string(k) + ".," +
            std::to_string(k * k) + ".,0.));\n";
  }
  return text;
}

std::string net(int rows, int columns) {
  std::string text = "(";
  for (int i = 0; i < rows; ++i) {
    text += i == 0 ? "(" : ",(";
    for (int j = 0; j < columns; ++j)
      text += (j == 0 ? "#" : ",#") + std::to_string(i * columns + j + 1);
    text += ")";
  }
  return text + ")";
}

std::vector<double> knots_of(const step::File& file, int direction) {
  const auto span = file.surfaces().at(0).surface.knots(direction).knots();
  return {span.begin(), span.end()};
}

Error reason(const std::string& data) {
  const auto file = parse_or_die(step_text(data));
  EXPECT_TRUE(file.surfaces().empty());
  return file.model().unreadable.empty() ? Error{} : file.model().unreadable[0].reason;
}

TEST(StepSurfaces, TheOuterListIsU) {
  const auto file = parse_or_die(step_text(points(6) + "#10=BEZIER_SURFACE('b',2,1," + net(3, 2) +
                                           ",.UNSPECIFIED.,.F.,.F.,.U.);\n"));
  ASSERT_EQ(file.surfaces().size(), 1U);
  const auto& surface = file.surfaces()[0];
  EXPECT_EQ(surface.id, "#10");
  EXPECT_EQ(surface.name, "b");
  EXPECT_EQ(surface.surface.net(), (std::array<int, 2>{3, 2}));
  EXPECT_FALSE(surface.surface.rational());
  for (int k = 0; k < 6; ++k) EXPECT_EQ(surface.surface.control_points()(k, 0), k + 1);
}

TEST(StepSurfaces, ImpliedKnotsAreThoseOfTheStandard) {
  const auto bezier = parse_or_die(step_text(points(10) + "#20=BEZIER_SURFACE('',2,1," + net(5, 2) +
                                             ",.UNSPECIFIED.,.F.,.F.,.U.);\n"));
  EXPECT_EQ(knots_of(bezier, 0), (std::vector<double>{0, 0, 0, 1, 1, 2, 2, 2}));
  EXPECT_EQ(knots_of(bezier, 1), (std::vector<double>{0, 0, 1, 1}));
  const auto quasi = parse_or_die(step_text(points(10) + "#20=QUASI_UNIFORM_SURFACE('',2,1," +
                                            net(5, 2) + ",.UNSPECIFIED.,.F.,.F.,.U.);\n"));
  EXPECT_EQ(knots_of(quasi, 0), (std::vector<double>{0, 0, 0, 1, 2, 3, 3, 3}));
  const auto uniform = parse_or_die(step_text(points(10) + "#20=UNIFORM_SURFACE('',2,1," +
                                              net(5, 2) + ",.UNSPECIFIED.,.F.,.F.,.U.);\n"));
  EXPECT_EQ(knots_of(uniform, 0), (std::vector<double>{-2, -1, 0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(knots_of(uniform, 1), (std::vector<double>{-1, 0, 1, 2}));
  EXPECT_EQ(uniform.surfaces()[0].surface.knots(0).domain().upper, 3);
}

TEST(StepSurfaces, ComplexInstancesInAnyOrderOfTheirParts) {
  const std::string knots[] = {
      "B_SPLINE_SURFACE_WITH_KNOTS((2,2),(2,2),(0.,1.),(0.,1.),.UNSPECIFIED.)", "BEZIER_SURFACE()",
      "QUASI_UNIFORM_SURFACE()"};
  for (const auto& form : knots) {
    const auto file = parse_or_die(step_text(
        unit_square_points() + "#10=(" + form +
        "BOUNDED_SURFACE()B_SPLINE_SURFACE(1,1,((#1,#2),(#3,#4)),.UNSPECIFIED.,.F.,.F.,.F.)"
        "GEOMETRIC_REPRESENTATION_ITEM()"
        "RATIONAL_B_SPLINE_SURFACE(((1.,-2.),(0.5,0.)))REPRESENTATION_ITEM('r')SURFACE());\n"));
    ASSERT_EQ(file.surfaces().size(), 1U) << form;
    const auto& surface = file.surfaces()[0];
    EXPECT_EQ(surface.name, "r");
    EXPECT_EQ(
        std::vector<double>(surface.surface.weights().begin(), surface.surface.weights().end()),
        (std::vector<double>{1, -2, 0.5, 0}))
        << "negative and zero weights are kept";
    EXPECT_EQ(knots_of(file, 0), (std::vector<double>{0, 0, 1, 1}));
  }
}

TEST(StepSurfaces, EqualKnotsListedApartAddUp) {
  const auto file = parse_or_die(step_text(
      points(10) + "#20=B_SPLINE_SURFACE_WITH_KNOTS('',2,1," + net(5, 2) +
      ",.UNSPECIFIED.,.F.,.F.,.F.,(3,1,1,3),(2,2),(0.,0.5,0.5,1.),(0.,1.),.UNSPECIFIED.);\n"));
  EXPECT_EQ(knots_of(file, 0), (std::vector<double>{0, 0, 0, 0.5, 0.5, 1, 1, 1}));
}

TEST(StepSurfaces, AnUnreadableSurfaceSaysWhyAndLeavesTheRestUsable) {
  const auto with_knots = [](const std::string& degrees, const std::string& knots) {
    return unit_square_points() + "#20=B_SPLINE_SURFACE_WITH_KNOTS(''," + degrees +
           ",((#1,#2),(#3,#4)),.UNSPECIFIED.,.F.,.F.,.F.," + knots + ",.UNSPECIFIED.);\n";
  };
  const struct {
    std::string data;
    const char* what;
  } cases[] = {
      {with_knots("26,1", "(2,2),(2,2),(0.,1.),(0.,1.)"), "degrees are 26 x 1"},
      {with_knots("1.,1", "(2,2),(2,2),(0.,1.),(0.,1.)"), "not integers"},
      {with_knots("1,1", "(2,1),(2,2),(0.,1.),(0.,1.)"), "multiplicities add up to 3"},
      {with_knots("1,1", "(3,1),(2,2),(0.,1.),(0.,1.)"), "u knots"},
      {with_knots("1,1", "(2,2),(2,2),(1.,0.),(0.,1.)"), "u knots"},
      {with_knots("1,1", "(2,2),(2,2),(0.,1.),(0.,1.E999)"), "v knot 1"},
      {with_knots("1,1", "(2,2),(-2,2),(0.,1.),(0.,1.)"), "v knot 0 is not a positive"},
      {with_knots("1,1", "(2,99999999999),(2,2),(0.,1.),(0.,1.)"), "u knot 1 is not a positive"},
      {with_knots("1,1", "(2,2),(2,2),(0.),(0.,1.)"), "1 u knots with 2"},
      {with_knots("1,1", "$,(2,2),(0.,1.),(0.,1.)"), "not a list"},
      {unit_square_points() +
           "#20=B_SPLINE_SURFACE('',1,1,((#1,#2),(#3,#4)),.UNSPECIFIED.,.F.,.F.,.F.);\n",
       "no knots"},
      {unit_square_points() +
           "#20=BEZIER_SURFACE('',1,1,((#1,#2),(#3)),.UNSPECIFIED.,.F.,.F.,.F.);\n",
       "row 1"},
      {unit_square_points() +
           "#20=BEZIER_SURFACE('',1,1,((#1,#2),(#3,$)),.UNSPECIFIED.,.F.,.F.,.F.);\n",
       "does not refer"},
      {unit_square_points() + "#20=BEZIER_SURFACE('',1,1,(),.UNSPECIFIED.,.F.,.F.,.F.);\n",
       "empty"},
      {unit_square_points() + "#20=BEZIER_SURFACE('');\n", "lacks"},
      {points(8) + "#20=BEZIER_SURFACE('',2,1," + net(4, 2) + ",.UNSPECIFIED.,.F.,.F.,.F.);\n",
       "whole Bezier"},
  };
  for (const auto& c : cases) {
    const auto error = reason(c.data);
    EXPECT_NE(error.what.find(c.what), std::string::npos) << c.data << error.message();
    EXPECT_TRUE(error.where.starts_with("#20 ")) << error.message();
    EXPECT_GT(error.line, 8) << error.message();
  }
  const auto point = reason(
      "#1=CARTESIAN_POINT('',(0.,0.));\n#2=CARTESIAN_POINT('',(0.,1.,0.));\n#3=DIRECTION('',(1.,0.,"
      "0.));\n"
      "#4=CARTESIAN_POINT('',(1.,1.,0.));\n" +
      bilinear_patch());
  EXPECT_EQ(point.where, "#1 CARTESIAN_POINT");
  EXPECT_EQ(point.line, 8);
  const auto mixed = parse_or_die(
      step_text(unit_square_points() + bilinear_patch() + "#20=BEZIER_SURFACE('');\n"));
  EXPECT_EQ(mixed.surfaces().size(), 1U);
  EXPECT_EQ(mixed.model().unreadable.size(), 1U);
}

TEST(StepSurfaces, ClosedMeansThatTheBoundaryIsocurvesAreTheSame) {
  EXPECT_EQ(parse_or_die(step_text(unit_square_points() + bilinear_patch())).surfaces()[0].closed,
            (std::array<bool, 2>{false, false}));
  // A prism over a triangle, closed in u by the same points or by equal ones.
  const auto prism = [](const std::string& last) {
    return parse_or_die(
               step_text(points(7) +
                         "#8=CARTESIAN_POINT('',(1.,1.,0.));\n#9=CARTESIAN_POINT('',(2.,4.,0.));\n"
                         "#20=B_SPLINE_SURFACE_WITH_KNOTS('',1,1,((#1,#2),(#3,#4),(#5,#6),(" +
                         last +
                         ")),.UNSPECIFIED.,.F.,.F.,.F.,(2,1,1,2),(2,2),(0.,1.,2.,3.),(0.,1.),."
                         "UNSPECIFIED.);\n"))
        .surfaces()[0]
        .closed;
  };
  EXPECT_EQ(prism("#1,#2"), (std::array<bool, 2>{true, false}));
  EXPECT_EQ(prism("#8,#9"), (std::array<bool, 2>{true, false}));
  EXPECT_EQ(prism("#8,#7"), (std::array<bool, 2>{false, false}));
  // A net collapsed along v is not closed in v, though all its isocurves along u agree.
  EXPECT_EQ(parse_or_die(step_text(unit_square_points() + bilinear_patch("((#1,#1),(#3,#3))")))
                .surfaces()[0]
                .closed,
            (std::array<bool, 2>{false, false}));
  // An unclamped periodic one: the first p control points are the last again.
  const auto periodic =
      parse_or_die(step_text(points(6) + "#20=UNIFORM_SURFACE('',2,1,((#1,#2),(#3,#4),(#5,#6),(#1,#"
                                         "2),(#3,#4)),.UNSPECIFIED.,.T.,.F.,.F.);\n"));
  EXPECT_EQ(periodic.surfaces()[0].closed, (std::array<bool, 2>{true, false}));
}

// Figures established with another reader.
TEST(StepSurfaces, ForeignFilesHaveTheSurfacesThatTheirIndexLists) {
  KNEAD_NEEDS(testing::foreign_cad("INDEX.csv"));
  std::ifstream index(testing::foreign_cad("INDEX.csv"));
  int files = 0;
  for (std::string line; std::getline(index, line);) {
    const auto name = line.substr(0, line.find(','));
    if (!name.ends_with(".stp") && !name.ends_with(".step")) continue;
    // The columns wanted stand behind one with quoted commas: count from `format` on.
    const auto format = line.find(",STEP ");
    ASSERT_NE(format, std::string::npos);
    std::istringstream rest(line.substr(format + 1));
    std::vector<std::string> columns;
    for (std::string cell; std::getline(rest, cell, ',');) {
      while (cell.starts_with('"') && !cell.ends_with('"')) {
        std::string more;
        std::getline(rest, more, ',');
        cell += "," + more;
      }
      columns.push_back(cell);
    }
    const auto file = step::File::read(testing::foreign_cad(name));
    ASSERT_TRUE(file) << file.error().message();
    EXPECT_EQ(std::to_string(file->surfaces().size()), columns[2]) << name;
    EXPECT_TRUE(file->model().unreadable.empty()) << name;
    if (columns[4].empty()) continue;
    const auto largest = std::max_element(
        file->surfaces().begin(), file->surfaces().end(),
        [](const auto& a, const auto& b) { return a.surface.size() < b.surface.size(); });
    const auto net = largest->surface.net();
    EXPECT_EQ(std::to_string(net[0]) + "x" + std::to_string(net[1]), columns[5]) << name;
    EXPECT_EQ(std::to_string(largest->surface.knots(0).degree()) + "x" +
                  std::to_string(largest->surface.knots(1).degree()),
              columns[4])
        << name;
    ++files;
  }
  EXPECT_GT(files, 10);
}

}  // namespace
}  // namespace knead
