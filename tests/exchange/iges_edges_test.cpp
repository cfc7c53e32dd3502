// Edges of IGES files: where faces meet, and how edges that have moved are written.

#include <algorithm>
#include <set>
#include <sstream>

#include "brep/shared_edge.hpp"
#include "exchange/iges_builder.hpp"
#include "exchange/support.hpp"
#include "knead/exchange/format.hpp"

namespace knead {
namespace {

using testing::IgesBuilder;
using testing::plate;
using testing::two_plates;
using testing::TwoPlates;

std::shared_ptr<const Source> open(const std::string& bytes) {
  return testing::open_or_die(bytes, "plates.igs");
}

/// Lifts what lies on x = 4 to these heights, from y = 0 to y = 2.
std::vector<std::shared_ptr<const Surface>> lifted(const Source& source, double low, double high) {
  std::vector<std::shared_ptr<const Surface>> result;
  for (const SourceSurface& s : source.surfaces()) {
    Points points = s.surface->control_points();
    for (Eigen::Index k = 0; k < points.rows(); ++k) {
      if (points(k, 0) == 4) points(k, 2) = points(k, 1) == 0 ? low : high;
    }
    result.push_back(std::make_shared<const Surface>(*s.surface->with_control_points(points)));
  }
  return result;
}

std::multiset<std::string> lines_of(const std::string& text, char section) {
  std::multiset<std::string> result;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.size() == 80 && line[72] == section) result.insert(line.substr(0, 64));
  }
  return result;
}

TEST(IgesEdges, FacesMeetAlongTheCurvesThatBothHaveThere) {
  for (const bool shared : {true, false}) {
    const TwoPlates plates = two_plates(shared);
    const auto source = open(plates.text);
    const auto edge = SharedEdge::create(*source->model(), plates.edge);
    ASSERT_TRUE(edge) << edge.error().message();
    EXPECT_EQ(edge->surfaces(), (std::vector{plates.left, plates.right}));
    EXPECT_TRUE(source->can_move_edge(plates.edge));
  }
}

TEST(IgesEdges, FacesThatAreApartByMoreThanTheResolutionDoNotMeet) {
  for (const auto& [apart, surfaces] : {std::pair(1e-6, 2U), std::pair(1e-4, 1U)}) {
    const TwoPlates plates = two_plates(false, apart);
    const auto edge = SharedEdge::create(*open(plates.text)->model(), plates.edge);
    ASSERT_TRUE(edge) << edge.error().message();
    EXPECT_EQ(edge->surfaces().size(), surfaces) << apart;
  }
}

TEST(IgesEdges, EdgesThatMoveAreWrittenWithEveryCurveAlongThem) {
  for (const bool shared : {true, false}) {
    const TwoPlates plates = two_plates(shared);
    const auto source = open(plates.text);
    // Both ends stay, so that no other edge has to follow: at y = 1 the edge is 0.25 high.
    std::vector<std::shared_ptr<const Surface>> surfaces;
    for (const SourceSurface& s : source->surfaces()) {
      const KnotVector quadratic = *KnotVector::create(2, {0, 0, 0, 1, 1, 1});
      const Points& p = s.surface->control_points();
      Points points(9, 3);
      for (Eigen::Index i = 0; i < 3; ++i) {
        points.row(3 * i) = p.row(2 * i);
        points.row(3 * i + 1) = 0.5 * (p.row(2 * i) + p.row(2 * i + 1));
        points.row(3 * i + 2) = p.row(2 * i + 1);
        if (points(3 * i, 0) == 4) points(3 * i + 1, 2) = 0.5;
      }
      surfaces.push_back(std::make_shared<const Surface>(
          *Surface::create({s.surface->knots(0), quadratic}, std::move(points))));
    }
    const std::vector<std::string> followed = {plates.edge};
    const auto bytes = source->save(surfaces, followed);
    ASSERT_TRUE(bytes) << bytes.error().message();
    const auto again = open(*bytes);
    const auto edge = SharedEdge::create(*again->model(), plates.edge);
    ASSERT_TRUE(edge) << edge.error().message();
    EXPECT_EQ(edge->surfaces().size(), 2U) << "they still meet";
    EXPECT_LE(edge->gap(), 1e-6);
    EXPECT_NEAR(
        edge->at(0.5 * (edge->samples().front().parameter + edge->samples().back().parameter))
            .point.z(),
        0.25, 1e-6);
    // Of the directory types change, of the parameters those of the surfaces and the curves along
    // the edge.
    const auto before = lines_of(plates.text, 'P'), after = lines_of(*bytes, 'P');
    std::size_t kept = 0, curves = 0;
    for (const std::string& line : before) kept += after.contains(line) ? 1 : 0;
    for (const std::string& line : after) curves += line.starts_with("126,") ? 1 : 0;
    EXPECT_EQ(curves, static_cast<std::size_t>(plates.curves));
    EXPECT_EQ(lines_of(*bytes, 'D').size(), lines_of(plates.text, 'D').size());
    for (const std::string& line : before) {
      const bool is_own = !line.starts_with("110,") && !line.starts_with("102,") &&
                          !line.starts_with("14") && !line.starts_with("50") &&
                          !line.starts_with("124,");
      const bool along = line.starts_with("110,4.,0.,0.,4.,2.,0.;") ||
                         line.starts_with("110,4,2.,0.,4,0.,0.;") ||
                         line.starts_with("110,4,0.,0.,4,2.,0.;");
      EXPECT_TRUE(is_own || along || after.contains(line)) << line << " is lost";
    }
    EXPECT_GT(kept, 8U);
  }
}

TEST(IgesEdges, VerticesMoveInTheirLists) {
  const TwoPlates plates = two_plates(true);
  const auto source = open(plates.text);
  const std::vector<std::string> followed = {plates.edge};
  const auto bytes = source->save(lifted(*source, 0.25, 0.5), followed);
  ASSERT_TRUE(bytes) << bytes.error().message();
  const auto again = open(*bytes);
  const auto edge = SharedEdge::create(*again->model(), plates.edge);
  ASSERT_TRUE(edge) << edge.error().message();
  EXPECT_EQ(edge->vertex_points()[0], Point(4, 0, 0.25));
  EXPECT_EQ(edge->vertex_points()[1], Point(4, 2, 0.5));
  EXPECT_LE(edge->gap(), 1e-6);
}

TEST(IgesEdges, WhatDoesNotMoveKeepsItsBytes) {
  for (const bool shared : {true, false}) {
    const TwoPlates plates = two_plates(shared);
    const auto source = open(plates.text);
    std::vector<std::shared_ptr<const Surface>> surfaces;
    for (const SourceSurface& s : source->surfaces())
      surfaces.push_back(std::make_shared<const Surface>(*s.surface));
    const std::vector<std::string> followed = {plates.edge};
    EXPECT_EQ(source->save(surfaces, followed), plates.text);
  }
}

TEST(IgesEdges, ACurveThatMakesASurfaceTooIsRefused) {
  IgesBuilder b;
  const int surface = b.add(128, plate());
  std::vector<int> sides;
  const char* corners[] = {"0.,0.,0.", "4.,0.,0.", "4.,2.,0.", "0.,2.,0."};
  for (int k = 0; k < 4; ++k)
    sides.push_back(b.add(110, fmt::format("{},{}", corners[k], corners[(k + 1) % 4])));
  const int loop = b.add(102, fmt::format("4,{},{},{},{}", sides[0], sides[1], sides[2], sides[3]));
  b.add(144,
        fmt::format("{},1,0,{}", surface, b.add(142, fmt::format("1,{},0,{},2", surface, loop))));
  const int tabulated = b.add(122, fmt::format("{},4.,0.,1.", sides[1]));
  const auto can = open(b.text())->can_move_edge(fmt::format("#{}", sides[1]));
  ASSERT_FALSE(can);
  EXPECT_NE(can.error().message().find(fmt::format("D{}", tabulated)), std::string::npos)
      << can.error().message();
  EXPECT_TRUE(open(b.text())->can_move_edge(fmt::format("#{}", sides[0])));
}

}  // namespace
}  // namespace knead
