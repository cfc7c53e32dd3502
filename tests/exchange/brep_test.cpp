#include <random>

#include "brep/face_point.hpp"
#include "brep/shared_edge.hpp"
#include "brep/tessellation/model_mesh.hpp"
#include "exchange/brep_square.hpp"
#include "exchange/mesh_measures.hpp"
#include "exchange/support.hpp"
#include "knead/brep/face_conversion.hpp"
#include "knead/brep/face_edges.hpp"
#include "knead/exchange/format.hpp"
#include "knead/spline/spline_refinement.hpp"

namespace knead {
namespace {

const std::string square = testing::brep_square;

std::shared_ptr<const Source> open_or_die(const std::string& bytes) {
  return testing::open_or_die(bytes, "test.brep");
}

TEST(Brep, AFaceStandsWhereItsLocationPutsIt) {
  const auto source = open_or_die(square);
  EXPECT_EQ(source->format(), "Open CASCADE");
  ASSERT_EQ(source->surfaces().size(), 1U);
  const SourceSurface& s = source->surfaces()[0];
  EXPECT_EQ(s.id, "#1");
  EXPECT_EQ(Point(s.surface->control_points().row(0).transpose()), Point(10, 0, 0));
  EXPECT_EQ(Point(s.surface->control_points().row(1).transpose()), Point(10, 1, 0)) << "v is fast";
  const auto region = visible_region(*source->model(), "#1");
  ASSERT_TRUE(region) << region.error().message();
  EXPECT_EQ(region->edges.size(), 4U);
}

TEST(Brep, WhatIsUsedAgainElsewhereStandsThereToo) {
  std::string text = square;
  text.replace(text.rfind("+1 1 "), 5, "+1 1 +1 0 +1 1 ");  // the last one where the first one is
  const auto source = open_or_die(text);
  ASSERT_EQ(source->surfaces().size(), 1U);
  EXPECT_EQ(Point(source->surfaces()[0].surface->control_points().row(0).transpose()),
            Point(10, 0, 0));
  const auto model = model_faces(*source->model(), 0.1);
  ASSERT_TRUE(model) << model.error().message();
  ASSERT_EQ(model->faces.size(), 2U);
  double sum = 0;
  for (const FaceMesh& mesh : model->faces) {
    EXPECT_NEAR(testing::area_of(mesh), 1, 1e-12);
    for (const Point& p : mesh.points) sum += p.x() / static_cast<double>(mesh.points.size());
  }
  EXPECT_NEAR(sum, 0.5 + 10.5, 1e-12);
  ASSERT_EQ(source->left_out().size(), 1U) << "its third use is where the first one is";
  EXPECT_EQ(source->left_out()[0].count, 1U);
}

/// Where a face with this location, made of a quarter turn about z (1) and 10 along x (2), has the
/// corner (0, 1, 0).
Point corner_at(const std::string& locations, int location) {
  std::string text = square;
  const std::string old = "Locations 1\n1\n1 0 0 10\n0 1 0 0\n0 0 1 0\n";
  text.replace(
      text.find(old), old.size(),
      "Locations 4\n1\n0 -1 0 0\n1 0 0 0\n0 0 1 0\n1\n1 0 0 10\n0 1 0 0\n0 0 1 0\n" + locations);
  text.replace(text.rfind("+1 1 "), 5, "+1 " + std::to_string(location) + " ");
  return open_or_die(text)->surfaces()[0].surface->control_points().row(1).transpose();
}

TEST(Brep, AProductOfLocationsAppliesTheFirstOfItsListFirst) {
  const std::string turned_then_shifted = "2  1 1 2 1 0\n", shifted_then_turned = "2  2 1 1 1 0\n";
  EXPECT_EQ(corner_at(turned_then_shifted + shifted_then_turned, 3), Point(9, 0, 0));
  EXPECT_EQ(corner_at(turned_then_shifted + shifted_then_turned, 4), Point(-1, 10, 0));
  EXPECT_EQ(corner_at("2  1 3 2 -2 0\n2  1 1 0\n", 3), Point(-19, 0, 0)) << "powers";
  EXPECT_EQ(corner_at("2  1 -1 2 1 0\n2  2 1 3 -1 0\n", 4), Point(-1, 0, 0))
      << "an inverse power of a product: 10 along x, back, and turned";
}

TEST(Brep, ALocationThatScalesScalesRadii) {
  for (const std::string surface :
       {"2 0 0 0 0 0 1 1 0 0 0 1 0 3 \n", "4 0 0 0 0 0 1 1 0 0 0 1 0 3 \n"}) {
    std::string text = square;
    const std::size_t begin = text.find("9 0 0 0 0 1 1"), end = text.find("\nTriangulations");
    text.replace(begin, end - begin, surface);
    const std::string place = "1 0 0 10\n0 1 0 0\n0 0 1 0\n";
    text.replace(text.find(place), place.size(), "2 0 0 10\n0 2 0 0\n0 0 2 0\n");
    const auto source = open_or_die(text);
    const auto others = brep::other_surfaces(*source->model());
    ASSERT_EQ(others.size(), 1U);
    const auto found = point_on_face(*source->model(), others[0].faces.at(0), Point(20, 0, 0));
    ASSERT_TRUE(found) << found.error().message();
    EXPECT_LT((found->point - Point(16, 0, 0)).norm(), 1e-12) << surface;
    ASSERT_TRUE(found->curvature);
    EXPECT_NEAR(std::max(std::abs((*found->curvature)[0]), std::abs((*found->curvature)[1])),
                1.0 / 6, 1e-12);
  }
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
  const auto after =
      source->save(std::vector{std::make_shared<const Surface>(*s.with_control_points(points))});
  ASSERT_TRUE(after) << after.error().message();
  EXPECT_EQ(*after, expected);
  EXPECT_EQ(open_or_die(*after)->surfaces()[0].surface->control_points(), points);
}

TEST(Brep, ARefinedSurfaceIsWrittenAnew) {
  const auto source = open_or_die(square);
  const Surface fine = *insert_knots<2>(
      *source->surfaces()[0].surface, {std::vector<double>{0.5}, std::vector<double>{0.25, 0.25}});
  const auto after = source->save(std::vector{std::make_shared<const Surface>(fine)});
  ASSERT_TRUE(after) << after.error().message();
  const auto again = open_or_die(*after);
  EXPECT_EQ(again->surfaces()[0].surface->control_points(), fine.control_points());
  for (int d = 0; d < 2; ++d) {
    EXPECT_TRUE(
        std::ranges::equal(again->surfaces()[0].surface->knots(d).knots(), fine.knots(d).knots()));
  }
  EXPECT_EQ(visible_region(*again->model(), "#1")->edges.size(), 4U);
}

TEST(Brep, AParameterOfOnesAndZerosIsNoFlag) {
  std::string text = square;
  text.replace(text.find("1  4 0 0 1\n0"), 12, "1  4 0 0 1\n2  1 1 0 0 1000000\n0");
  EXPECT_EQ(visible_region(*open_or_die(text)->model(), "#1")->edges.size(), 4U);
}

TEST(Brep, ErrorsNameTheLine) {
  const auto error = [](std::string_view from, std::string_view to) {
    std::string text = square;
    text.replace(text.find(from), from.size(), to);
    const auto source = open_source(text, "a.brep");
    return source ? std::string() : source.error().message();
  };
  EXPECT_NE(error("Polygon3D", "Polygons").find("a.brep:17: \"Polygon3D\" should stand here"),
            std::string::npos)
      << error("Polygon3D", "Polygons");
  EXPECT_NE(error("+10 0 -9", "+11 0 -9").find("shape"), std::string::npos);
  EXPECT_NE(error("+10 0 -9", "+1 0 -9").find("comes later"), std::string::npos);
  EXPECT_NE(error("1 0 0 10", "0 0 0 10").find("not invertible"), std::string::npos);
  EXPECT_NE(error("1 0 0 10", "1 0 0 1e60").find("too large"), std::string::npos);
  EXPECT_NE(error("Topology V1", "Topology V4").find("versions 1 to 3"), std::string::npos);
  // The file has one flat curve.
  EXPECT_NE(error("2  1 1 0 0 1", "2  2 1 0 0 1").find("number that can stand here"),
            std::string::npos);
  EXPECT_NE(error("2  1 1 0 0 1", "3  1 2CN 1 0 0 1").find("no such curve"), std::string::npos);
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

/// The square with its corners lifted by 1 and its middle by 0.6, and all of its edges following.
Expected<std::string> lifted(const Source& source, const std::vector<std::string>& edges) {
  Points points(9, 3);
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j)
      points.row(3 * i + j) << 10 + 0.5 * static_cast<double>(i), 0.5 * static_cast<double>(j),
          i == 1 || j == 1 ? 0.2 : 1;
  }
  const KnotVector knots = *KnotVector::create(2, {0, 0, 0, 1, 1, 1});
  return source.save(
      std::vector{std::make_shared<const Surface>(*Surface::create({knots, knots}, points))},
      edges);
}

TEST(Brep, EdgesFollowTheirFacesWithTheirVertices) {
  const auto source = open_or_die(square);
  const std::vector<std::string> edges = {"#6", "#7", "#8", "#9"};
  for (const std::string& id : edges) EXPECT_TRUE(source->can_move_edge(id));
  EXPECT_FALSE(source->can_move_edge("#1"));
  const auto bytes = lifted(*source, edges);
  ASSERT_TRUE(bytes) << bytes.error().message();
  const auto again = open_or_die(*bytes);
  for (const std::string& id : edges) {
    const auto edge = SharedEdge::create(*again->model(), id);
    ASSERT_TRUE(edge) << edge.error().message();
    EXPECT_LE(edge->gap(), 1e-6);
    for (const Point& p : edge->vertex_points()) EXPECT_EQ(p.z(), 1);
    EXPECT_NEAR(
        edge->at(0.5 * (edge->samples().front().parameter + edge->samples().back().parameter))
            .point.z(),
        0.6, 1e-6);
  }
  EXPECT_NE(bytes->find("Curves 4"), std::string::npos)
      << "they take the places of their old curves";
  EXPECT_EQ(bytes->find("\n6  1 1 0\n"), std::string::npos) << "the polygon of its old curve";
  EXPECT_EQ(bytes->substr(0, bytes->find("Curves")), square.substr(0, square.find("Curves")));
  EXPECT_EQ(bytes->substr(bytes->find("Wi\n"), 30), square.substr(square.find("Wi\n"), 30));
}

TEST(Brep, ACurveThatAnotherEdgeHasTooStays) {
  std::string text = square;
  text.replace(text.find("TShapes 10\n"), 11,
               "TShapes 11\nEd\n 1e-7 1 1 0\n1  2 0 0 1\n0\n\n0101000\n*\n");
  const auto bytes = lifted(*open_or_die(text), {"#7", "#8", "#9", "#10"});
  ASSERT_TRUE(bytes) << bytes.error().message();
  EXPECT_NE(bytes->find("Curves 5"), std::string::npos);
  EXPECT_NE(bytes->find("1 1 0 0 0 1 0 \n"), std::string::npos) << "the curve that both had";
  EXPECT_NE(bytes->find("\n1  5 0 0 1\n"), std::string::npos);
  const auto edge = SharedEdge::create(*open_or_die(*bytes)->model(), "#8");
  ASSERT_TRUE(edge) << edge.error().message();
  EXPECT_LE(edge->gap(), 1e-6);
}

TEST(Brep, AnEdgeInSeveralPlacesDoesNotFollow) {
  std::string text = square;
  // The wire has the edge again, elsewhere.
  text.replace(text.find("+6 0 +4 0 +3 0 +5 0 *"), 21, "+6 0 +4 0 +3 0 +5 0 +6 1 *");
  const auto can = open_or_die(text)->can_move_edge("#6");
  ASSERT_FALSE(can);
  EXPECT_NE(can.error().message().find("several places"), std::string::npos)
      << can.error().message();
}

TEST(Brep, WhatRepresentsAnEdgeIsReadInAnyOrder) {
  std::string text = square;
  text.replace(text.find("1  1 0 0 1\n2  1 1 0 0 1\n"), 24,
               "2  1 1 0 0 1\n4 C0 1 0 1 0\n1  1 0 0 1\n");
  const auto source = open_or_die(text);
  EXPECT_TRUE(SharedEdge::create(*source->model(), "#6"));
  EXPECT_TRUE(lifted(*source, {"#6", "#7", "#8", "#9"}));
  text = square;
  text.replace(text.find("2  1 1 0 0 1\n"), 13, "3  1 1CN 1 0 0 1\n");
  EXPECT_TRUE(SharedEdge::create(*open_or_die(text)->model(), "#6"));
}

TEST(Brep, TheToleranceOfAnEdgeGrowsByWhatItsCurvesAreApart) {
  std::string text = square;
  // In parameters the edge runs from (0, 0) to (1, 0), faster at first: at equal parameters it is
  // up to 0.25 away.
  text.replace(text.find("1 0 0 1 0 \n"), 11, "7 0 0  2 3 2  0 0 1 0 1 0 \n 0 3 1 3\n");
  const auto bytes = lifted(*open_or_die(text), {"#7", "#8", "#9"});
  ASSERT_TRUE(bytes) << bytes.error().message();
  const std::string edge = bytes->substr(bytes->find("Ed\n"), 40);
  // Before, it was 0.25 away; the surface that has moved is farther from the curve that stays.
  EXPECT_GT(std::stod(edge.substr(3)), 0.25) << edge;
  const std::string others = bytes->substr(bytes->find("Ed\n", bytes->find("Ed\n") + 1), 20);
  EXPECT_EQ(others.find("Ed\n 1e-7 1 1 0"), 0U) << others;
}

TEST(Brep, RoundingDoesNotChangeTheToleranceOfAHeldEdge) {
  std::string text = square;
  text.replace(text.find("1 0 0 1 0 \n"), 11,
               "7 0 0  2 3 2  0 0 1 0 1 0 \n 0 3 1 3\n");  // 0.25 away, as above
  for (const std::string tolerance : {"1e-7", "0.25"}) {
    std::string held = text;
    held.replace(held.find("Ed\n 1e-7") + 4, 4, tolerance);
    const auto source = open_or_die(held);
    const Surface& s = *source->surfaces()[0].surface;
    Points points = s.control_points();
    ASSERT_EQ(points(0, 1), 0);
    // The last bit of 10 across the edge's plane and along it: the points beside the edge move by
    // as much.
    points(0, 0) -= 1.8e-15;
    points(2, 0) += 1.8e-15;
    points(0, 2) = points(2, 2) = 1e-15;
    points(3, 2) = 0.5;
    const auto bytes =
        source->save(std::vector{std::make_shared<const Surface>(*s.with_control_points(points))});
    ASSERT_TRUE(bytes) << bytes.error().message();
    const std::string edge = bytes->substr(bytes->find("Ed\n"), 40);
    EXPECT_EQ(edge.find("Ed\n " + tolerance + " 1 1 0"), 0U) << edge;
  }
}

/// As DRAW's command `save` writes a shape, with its end behind it.
TEST(Brep, AFileOfDrawIsReadWithTheZeroAtItsEnd) {
  for (const std::string end : {"0\n", "\n0\n", "0"}) {
    const auto source = open_or_die(square + end);
    EXPECT_EQ(source->surfaces().size(), 1U);
    EXPECT_EQ(*source->save(std::vector{source->surfaces()[0].surface}), square + end);
  }
  std::string inches = square;  // in another place, turned
  inches.replace(inches.find("1 0 0 10\n0 1 0 0\n0 0 1 0\n"), 25,
                 "0 -25.4 0 0\n25.4 0 0 0\n0 0 25.4 0\n");
  EXPECT_EQ(open_or_die(inches + "0\n")->surfaces().size(), 1U);
  EXPECT_FALSE(open_source(square + "0 0\n", "a.brep"));
  EXPECT_FALSE(open_source(square + "1\n", "a.brep"));
}

TEST(Brep, AnEdgeWithCurvesAtDifferentParametersDoesNotFollow) {
  std::string text = square;
  text.replace(text.find(" 1e-7 1 1 0\n1  1"), 11, " 1e-7 0 0 0");
  const auto can = open_or_die(text)->can_move_edge("#6");
  ASSERT_FALSE(can);
  EXPECT_NE(can.error().message().find("SameParameter"), std::string::npos)
      << can.error().message();
}

}  // namespace
}  // namespace knead
