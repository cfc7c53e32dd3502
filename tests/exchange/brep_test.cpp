#include <random>

#include "exchange/brep_square.hpp"
#include "exchange/support.hpp"
#include "knead/exchange/face_edges.hpp"
#include "knead/exchange/format.hpp"
#include "knead/spline/spline_refinement.hpp"

namespace knead {
namespace {

const std::string square = testing::brep_square;

std::shared_ptr<const Source> open_or_die(const std::string& bytes) { return testing::open_or_die(bytes, "test.brep"); }

TEST(Brep, AFaceStandsWhereItsLocationPutsIt) {
  const auto source = open_or_die(square);
  EXPECT_EQ(source->format(), "Open CASCADE");
  ASSERT_EQ(source->surfaces().size(), 1U);
  const SourceSurface& s = source->surfaces()[0];
  EXPECT_EQ(s.id, "#1");
  EXPECT_EQ(Point(s.surface->control_points().row(0).transpose()), Point(10, 0, 0));
  EXPECT_EQ(Point(s.surface->control_points().row(1).transpose()), Point(10, 1, 0)) << "v is fast";
  const auto region = visible_region(*source->step_file(), "#1");
  ASSERT_TRUE(region) << region.error().message();
  EXPECT_EQ(region->edges.size(), 4U);
}

TEST(Brep, WhatIsMovedIsWrittenInTheCoordinatesOfTheFile) {
  const auto source = open_or_die(square);
  const Surface& s = *source->surfaces()[0].surface;
  EXPECT_EQ(*source->save(std::vector{source->surfaces()[0].surface}), square);
  Points points = s.control_points();
  points.row(3) << 11, 1, 0.5;
  std::string expected = square;
  expected.replace(expected.find("1 1 0  \n0 2"), 5, "1 1 0.5");
  expected.replace(expected.find("2  1\n0101000"), 4, "");  // its triangles
  const auto after = source->save(std::vector{std::make_shared<const Surface>(*s.with_control_points(points))});
  ASSERT_TRUE(after) << after.error().message();
  EXPECT_EQ(*after, expected);
  EXPECT_EQ(open_or_die(*after)->surfaces()[0].surface->control_points(), points);
}

TEST(Brep, ARefinedSurfaceIsWrittenAnew) {
  const auto source = open_or_die(square);
  const Surface fine =
      *insert_knots<2>(*source->surfaces()[0].surface, {std::vector<double>{0.5}, std::vector<double>{0.25, 0.25}});
  const auto after = source->save(std::vector{std::make_shared<const Surface>(fine)});
  ASSERT_TRUE(after) << after.error().message();
  const auto again = open_or_die(*after);
  EXPECT_EQ(again->surfaces()[0].surface->control_points(), fine.control_points());
  for (int d = 0; d < 2; ++d) {
    EXPECT_TRUE(std::ranges::equal(again->surfaces()[0].surface->knots(d).knots(), fine.knots(d).knots()));
  }
  EXPECT_EQ(visible_region(*again->step_file(), "#1")->edges.size(), 4U);
}

TEST(Brep, AParameterOfOnesAndZerosIsNoFlag) {
  std::string text = square;
  text.replace(text.find("1  4 0 0 1\n0"), 12, "1  4 0 0 1\n2  1 1 0 0 1000000\n0");
  EXPECT_EQ(visible_region(*open_or_die(text)->step_file(), "#1")->edges.size(), 4U);
}

TEST(Brep, ErrorsNameTheLine) {
  const auto error = [](std::string_view from, std::string_view to) {
    std::string text = square;
    text.replace(text.find(from), from.size(), to);
    const auto source = open_source(text, "a.brep");
    return source ? std::string() : source.error().message();
  };
  EXPECT_NE(error("Polygon3D", "Polygons").find("a.brep:17: \"Polygon3D\" should stand here"), std::string::npos)
      << error("Polygon3D", "Polygons");
  EXPECT_NE(error("+10 0 -9", "+11 0 -9").find("shape"), std::string::npos);
  EXPECT_NE(error("+10 0 -9", "+1 0 -9").find("comes later"), std::string::npos);
  EXPECT_NE(error("1 0 0 10", "0 0 0 10").find("not invertible"), std::string::npos);
  EXPECT_NE(error("Topology V1", "Topology V4").find("versions 1 to 3"), std::string::npos);
}

TEST(Brep, DamagedIsAnErrorOrAFile) {
  std::mt19937 random(11);
  for (int k = 0; k < 1000; ++k) {
    std::string damaged = square;
    if (k % 5 == 0) {
      damaged.resize(random() % square.size());
    } else {
      for (int n = 0; n < 2; ++n) damaged[random() % square.size()] = "0 9-+*V\n2e"[random() % 10];
    }
    const auto source = open_source(damaged, "a.brep");
    EXPECT_TRUE(source || !source.error().what.empty());
  }
}

}  // namespace
}  // namespace knead
