// How faces meet at edges, beside what Open CASCADE's evaluation and feet say of the same edges.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "exchange/support.hpp"
#include "knead/brep/edge_measures.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "oracle/occt_meetings.hpp"
#include "support/own_files.hpp"

namespace knead::oracle {
namespace {

constexpr double same_gap = 0.05, negligible_gap = 1e-7, same_angle = 0.01;
constexpr double same_bend = 0.01, counted_bend = 1e-2;  // of the curvature; over the size
constexpr double same_place = 1e-5;                      // of the size

Point point_of(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

double apart(const brep::EdgeMeasures& edge, const OcctMeeting& other, double unit) {
  const Point start = unit * point_of(edge.start), end = unit * point_of(edge.end);
  const double ends = std::min(std::max((start - other.start).norm(), (end - other.end).norm()),
                               std::max((start - other.end).norm(), (end - other.start).norm()));
  return std::max(ends, (unit * point_of(edge.middle) - other.middle).norm());
}

/// The edges of a file as Knead measures them, and its faces as Open CASCADE reads them.
class EdgesBeside : public testing::FileTest {
 protected:
  void SetUp() override {
    testing::FileTest::SetUp();
    if (IsSkipped()) return;
    const auto bytes = *read_file(path_);
    if (bytes.find("&SCOPE") != std::string::npos) GTEST_SKIP() << "Open CASCADE may abort on it";
    model_ = testing::open_or_die(bytes, path_.string())->model();
    occt_ = OcctFaces::read(path_);
    if (!model_ || !occt_) GTEST_SKIP() << "one of both reads no faces of it";
    const auto measured = brep::measure_edges(*model_);
    ASSERT_TRUE(measured) << measured.error().message();
    measured_ = *measured;
    unit_ = millimetres_of(model_->length_unit()).value_or(1);
  }
  std::shared_ptr<const brep::Model> model_;
  std::optional<OcctFaces> occt_;
  brep::ModelMeasures measured_;
  double unit_ = 1;  ///< mm
};

TEST_P(EdgesBeside, OpenCascadeHaveTheSameGapsAnglesAndCurvatures) {
  const auto others = occt_->meetings();
  const double size = unit_ * measured_.size;
  int compared = 0, two = 0, bent = 0;
  double gaps = 0, angles = 0, bends = 0;
  for (const brep::EdgeMeasures& edge : measured_.edges) {
    const bool joint = edge.id.find('+') != std::string::npos;  // of two edges of the file
    if (edge.faces.size() != 2 || !edge.angle || others.empty() || joint) continue;
    ++two;
    const auto same = std::ranges::min_element(
        others, {}, [&](const OcctMeeting& o) { return apart(edge, o, unit_); });
    // Where it makes other edges of these, as when it splits them, there is nothing to compare.
    if (apart(edge, *same, unit_) > same_place * size) continue;
    ++compared;
    // A largest value may be between its 201 points: there it must be the same.
    const auto compare = [&](const std::optional<brep::EdgeFigure>& figure, double in,
                             double OcctFigures::*which, double share, double floor) {
      const double there = same->at(unit_ * point_of(figure->at.point)).*which;
      const double other = std::max(same->largest.*which, there), value = in * figure->value;
      EXPECT_NEAR(value, other, std::max(share * other, floor)) << edge.id;
      return std::abs(value - other);
    };
    const double floor = negligible_gap * size;
    gaps = std::max({gaps, compare(edge.gap, unit_, &OcctFigures::gap, same_gap, floor),
                     compare(edge.off_curve, unit_, &OcctFigures::off_curve, same_gap, floor)});
    if (same->at(unit_ * point_of(edge.angle->at.point)).angle < 0) continue;  // beside a pole
    angles = std::max(angles, compare(edge.angle, 1, &OcctFigures::angle, 0, same_angle));
    if (!edge.curvature || edge.curvature->value < counted_bend / measured_.size) continue;
    const auto [a, b] = same->at(unit_ * point_of(edge.curvature->at.point)).curvatures;
    if (!(std::isfinite(a) && std::isfinite(b))) continue;
    const double value = edge.curvature->value / unit_, other = std::abs(a - b);
    EXPECT_NEAR(value, other, same_bend * std::max(std::abs(a), std::abs(b))) << edge.id;
    bends = std::max(bends, std::abs(value - other) / std::max(std::abs(a), std::abs(b)));
    ++bent;
  }
  fmt::print(
      "{}: {} of {} edges of two faces compared; gaps within {:.2g} mm, angles within "
      "{:.2g} degrees; {} differences in curvature within {:.2g} % of the larger curvature\n",
      GetParam(), compared, two, gaps, angles, bent, 100 * bends);
  EXPECT_GE(2 * compared, others.empty() ? 0 : two) << "of the edges of two faces";
}

/// Whatever edges Open CASCADE makes of the file: at the places where Knead finds the gaps.
TEST_P(EdgesBeside, OpenCascadeHaveTheSameGapsAtTheirPlaces) {
  const double floor = negligible_gap * unit_ * measured_.size;
  std::map<std::string, std::string> surface_of;
  for (const brep::Face& face : model_->faces) {
    if (const brep::SplineSurface* surface = model_->spline_under(face))
      surface_of[face.id] = surface->id;
  }
  int compared = 0;
  double largest = 0, worst = 0;
  for (const brep::EdgeMeasures& edge : measured_.edges) {
    if (edge.faces.size() != 2 || !edge.gap || unit_ * edge.gap->value < floor) continue;
    const auto a = surface_of.find(edge.faces[0]), b = surface_of.find(edge.faces[1]);
    if (a == surface_of.end() || b == surface_of.end()) continue;
    const auto other = occt_->gap_at(unit_ * point_of(edge.gap->at.point), a->second, b->second);
    if (!other) continue;
    ++compared;
    const double value = unit_ * edge.gap->value;
    EXPECT_NEAR(value, *other, std::max(same_gap * *other, floor)) << edge.id;
    largest = std::max(largest, value);
    worst = std::max(worst, std::abs(value - *other));
  }
  fmt::print("{}: {} gaps up to {:.4g} mm, the same within {:.2g} mm\n", GetParam(), compared,
             largest, worst);
}

INSTANTIATE_TEST_SUITE_P(Step, EdgesBeside, ::testing::ValuesIn(testing::step_files()),
                         testing::file_test_name);
INSTANTIATE_TEST_SUITE_P(Iges, EdgesBeside, ::testing::ValuesIn(testing::iges_files()),
                         testing::file_test_name);

}  // namespace
}  // namespace knead::oracle
