// Edges that faces share, and how they are written after the faces have moved.

#include "brep/shared_edge.hpp"
#include "exchange/two_sheets.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "support/own_files.hpp"

namespace knead {
namespace {

using testing::parse_or_die;
using testing::two_sheets;
using testing::TwoSheets;

TEST(SharedEdge, ItsPointsHaveFeetOnAllOfItsSurfaces) {
  const TwoSheets sheets = two_sheets();
  const step::File file = parse_or_die(sheets.text);
  const auto edge = SharedEdge::create(file.model(), TwoSheets::name(sheets.edge));
  ASSERT_TRUE(edge) << edge.error().message();
  EXPECT_EQ(edge->surfaces(), (std::vector<std::string>{"#10", "#20"}));
  EXPECT_EQ(edge->vertices(),
            (std::array{TwoSheets::name(sheets.start), TwoSheets::name(sheets.end)}));
  EXPECT_EQ(edge->edges_at_vertices()[0].size(), 2U);
  EXPECT_GE(edge->samples().size(), 65U);
  EXPECT_LE(edge->gap(), 1e-15);
  for (const double t : {0.0, 0.1234, 0.7, 1.0}) {
    const auto sample = edge->at(t);
    ASSERT_EQ(sample.feet.size(), 2U);
    EXPECT_NEAR(sample.feet[0].x(), 1, 1e-12);
    EXPECT_NEAR(sample.feet[1].x(), 0, 1e-12);
    for (const auto& foot : sample.feet) EXPECT_NEAR(foot.y(), t, 1e-12);
  }
}

TEST(SharedEdge, AFootATurnOutsideComesBackAndOneBesideAnEndStaysThere) {
  const KnotVector u = *KnotVector::create(1, {2, 2, 6, 6});
  const Surface surface = *Surface::create({u, u}, Points::Random(4, 3));
  const auto at = [&](double foot) { return parameters_at_foot(surface, {foot, 0.5})[0]; };
  EXPECT_EQ(at(1.25), 3);
  EXPECT_EQ(at(-0.25), 5);
  EXPECT_EQ(at(1 + 1e-12), 6) << "by rounding, not by a turn";
  EXPECT_EQ(at(-1e-12), 2);
}

TEST(SharedEdge, AFaceOnAnotherSurfaceThanABSplineIsNamed) {
  const TwoSheets sheets = two_sheets(false, true);
  const auto edge =
      SharedEdge::create(parse_or_die(sheets.text).model(), TwoSheets::name(sheets.edge));
  ASSERT_FALSE(edge);
  EXPECT_NE(edge.error().message().find(TwoSheets::name(sheets.faces[1])), std::string::npos);
  EXPECT_NE(edge.error().message().find("#20 PLANE"), std::string::npos) << edge.error().message();
}

TEST(SharedEdge, ItsUncertaintyIsInTheUnitOfTheSurfaces) {
  TwoSheets sheets = two_sheets();
  sheets.text.insert(
      sheets.text.rfind("ENDSEC;"),
      "#901=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n"
      "#902=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.));\n"
      "#903=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(2.E-6),#902,'distance_accuracy_value','');"
      "\n"
      "#904=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#903))"
      "GLOBAL_UNIT_ASSIGNED_CONTEXT((#901))REPRESENTATION_CONTEXT('',''));\n");
  const auto edge =
      SharedEdge::create(parse_or_die(sheets.text).model(), TwoSheets::name(sheets.edge));
  ASSERT_TRUE(edge) << edge.error().message();
  EXPECT_DOUBLE_EQ(edge->uncertainty(), 2e-3) << "2e-6 m on surfaces in mm";
}

TEST(SharedEdge, AnEdgeThatThereIsNotIsAnError) {
  EXPECT_FALSE(SharedEdge::create(parse_or_die(two_sheets().text).model(), "#99999"));
}

/// Both surfaces on finer nets, and their common edge raised in its middle.
std::vector<std::shared_ptr<const Surface>> raised(const Source& source, bool ends) {
  std::vector<std::shared_ptr<const Surface>> result;
  for (const SourceSurface& s : source.surfaces()) {
    auto finer = *elevate_degree<2>(*s.surface, 1, 2);
    Points points = finer.control_points();
    const auto n = finer.net()[1];
    const int row = s.id == "#10" ? 1 : 0;
    for (int j = 0; j < n; ++j) {
      if (ends || (j > 0 && j + 1 < n)) points(row * n + j, 2) += 0.25;
    }
    result.push_back(std::make_shared<const Surface>(*finer.with_control_points(points)));
  }
  return result;
}

class Written : public ::testing::TestWithParam<bool> {};

TEST_P(Written, AnEdgeLiesOnItsMovedSurfaces) {
  for (const bool ends : {false, true}) {
    const TwoSheets sheets = two_sheets(GetParam());
    const std::string id = TwoSheets::name(sheets.edge);
    const auto source = open_source(sheets.text, "sheets.step");
    ASSERT_TRUE(source);
    const auto bytes = (*source)->save(raised(**source, ends), std::array{id});
    ASSERT_TRUE(bytes) << bytes.error().message();
    const step::File file = parse_or_die(*bytes);
    const auto edge = SharedEdge::create(file.model(), id);
    ASSERT_TRUE(edge) << edge.error().message();
    EXPECT_LE(edge->gap(), 1e-7);
    EXPECT_NEAR(edge->at(0.5 * edge->samples().back().parameter).point.z(), ends ? 0.25 : 0.1875,
                1e-7);
    // The same parameters as the record before: a line with steps of 2 counts half of its length.
    EXPECT_EQ(edge->samples().back().parameter, GetParam() ? 0.5 : 1.0);
    EXPECT_EQ(edge->vertex_points()[0], Point(1, 0, ends ? 0.25 : 0));
    const auto says = [&](const std::string& record) {
      return bytes->find(record) != std::string::npos;
    };
    EXPECT_EQ(says("#" + std::to_string(sheets.start) + "=VERTEX_POINT('',#3);"), !ends);
    EXPECT_EQ(says("GEOMETRIC_CURVE_SET"), GetParam());
    EXPECT_EQ(says("SURFACE_CURVE('',#"), GetParam());
    // What another record uses stays as it was.
    if (GetParam()) {
      EXPECT_NE(bytes->find(sheets.text.substr(sheets.text.find("SURFACE_CURVE"), 20)),
                std::string::npos);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Curves, Written, ::testing::Bool(), [](const auto& instance) {
  return instance.param ? "SharedSurfaceCurve" : "Line";
});

/// The sheets, whose common edge has a corner at this parameter of [0, 1], as a spline of degree 1
/// that is straight.
TwoSheets with_corner(double at) {
  TwoSheets sheets = two_sheets();
  const auto begin = sheets.text.find("#" + std::to_string(sheets.edge - 1) + "=LINE");
  const std::string c = testing::FaceBuilder::real(at);
  sheets.text.replace(
      begin, sheets.text.find(';', begin) - begin,
      "#41=CARTESIAN_POINT('',(1.,0.,0.));\n#42=CARTESIAN_POINT('',(1.," + c +
          ",0.));\n#43=CARTESIAN_POINT('',(1.,1.,0.));\n#" + std::to_string(sheets.edge - 1) +
          "=B_SPLINE_CURVE_WITH_KNOTS('',1,(#41,#42,#43),.UNSPECIFIED.,.F.,.F.,(2,1,2),(0.," + c +
          ",1.),.UNSPECIFIED.)");
  return sheets;
}

TEST(SharedEdge, ACornerBesideAnEvenDivisionOfTheParametersIsFollowed) {
  for (const double at : {std::nextafter(0.25, 0), 0.25, std::nextafter(0.25, 1), 0.5 - 1e-12,
                          0.75 + 1e-9, 0.875 + 1e-6, 0.4, 0.03, std::nextafter(1, 0)}) {
    const TwoSheets sheets = with_corner(at);
    const std::string id = TwoSheets::name(sheets.edge);
    const auto source = open_source(sheets.text, "sheets.step");
    ASSERT_TRUE(source);
    const auto bytes = (*source)->save(raised(**source, false), std::array{id});
    ASSERT_TRUE(bytes) << at << ": " << bytes.error().message();
    const auto edge = SharedEdge::create(parse_or_die(*bytes).model(), id);
    ASSERT_TRUE(edge) << edge.error().message();
    EXPECT_LE(edge->gap(), 1e-7) << at;
    EXPECT_NEAR(edge->at(0.5).point.z(), 0.1875, 1e-7) << at;
  }
}

TEST(SharedEdge, EdgesOfFourArcsFollow) {
  const auto source = open_source(*read_file(testing::samples() / "bonnet.step"), "bonnet.step");
  ASSERT_TRUE(source);
  for (const std::string id : {"#1017", "#1037"}) {
    const auto edge = SharedEdge::create(*(*source)->model(), id);
    ASSERT_TRUE(edge) << edge.error().message();
    EXPECT_FALSE(edge->corners().empty());
    std::vector<std::shared_ptr<const Surface>> moved;
    for (const SourceSurface& s : (*source)->surfaces()) {
      Points points = s.surface->control_points();
      points.col(2).array() += 10;
      const bool is_own = std::ranges::find(edge->surfaces(), s.id) != edge->surfaces().end();
      moved.push_back(is_own
                          ? std::make_shared<const Surface>(*s.surface->with_control_points(points))
                          : s.surface);
    }
    const auto bytes = (*source)->save(moved, std::array{id});
    ASSERT_TRUE(bytes) << bytes.error().message();
    const auto after = SharedEdge::create(parse_or_die(*bytes).model(), id);
    ASSERT_TRUE(after) << after.error().message();
    const double middle =
        0.5 * (edge->samples().front().parameter + edge->samples().back().parameter);
    EXPECT_NEAR(after->at(middle).point.z(), edge->at(middle).point.z() + 10, 1e-3);
    EXPECT_LE(after->gap(), edge->gap() + 1e-3);
  }
}

TEST(SharedEdge, OnlyTheRecordsOfWhatMovedAreWritten) {
  const TwoSheets sheets = two_sheets();
  const auto source = open_source(sheets.text, "sheets.step");
  ASSERT_TRUE(source);
  const auto bytes =
      (*source)->save(raised(**source, false),
                      std::array{TwoSheets::name(sheets.edge), TwoSheets::name(sheets.outer)});
  ASSERT_TRUE(bytes) << bytes.error().message();
  std::size_t begin = 0, lost = 0;
  for (std::size_t at = sheets.text.find(";\n"); at != std::string::npos;
       at = sheets.text.find(";\n", begin)) {
    const std::string record = sheets.text.substr(begin, at + 2 - begin);
    if (bytes->find(record) == std::string::npos) {
      ++lost;
      EXPECT_TRUE(record.find("B_SPLINE_SURFACE") != std::string::npos ||
                  record.starts_with(TwoSheets::name(sheets.edge) + "=EDGE_CURVE"))
          << record;
    }
    begin = at + 2;
  }
  EXPECT_EQ(lost, 3U);
}

TEST(SharedEdge, AnEdgeWhoseSurfacesHavePartedStaysWhereItWas) {
  const TwoSheets sheets = two_sheets();
  const auto source = open_source(sheets.text, "sheets.step");
  ASSERT_TRUE(source);
  auto surfaces = raised(**source, false);
  surfaces[1] = (*source)->surfaces()[1].surface;
  const auto bytes = (*source)->save(surfaces, std::array{TwoSheets::name(sheets.edge)});
  ASSERT_TRUE(bytes) << bytes.error().message();
  EXPECT_EQ(bytes->find("B_SPLINE_CURVE_WITH_KNOTS"), std::string::npos);
}

TEST(SharedEdge, WithoutAMoveTheBytesAreTheInput) {
  const TwoSheets sheets = two_sheets();
  const auto source = open_source(sheets.text, "sheets.step");
  std::vector<std::shared_ptr<const Surface>> same;
  for (const SourceSurface& s : (*source)->surfaces()) same.push_back(s.surface);
  EXPECT_EQ(*(*source)->save(same, std::array{TwoSheets::name(sheets.edge)}), sheets.text);
}

}  // namespace
}  // namespace knead
