// Steps under limits, whose springs are so stiff that directions of Newton's iteration take a
// factor.
#include "contact/contact_factor.hpp"

#include <gtest/gtest.h>

#include <array>
#include <tuple>

#include "active.hpp"
#include "knead/spline/extremum.hpp"

namespace knead {
namespace {

using testing::active;
using testing::box;
using testing::rim;

constexpr double limit_of_sheet = 0.005;

struct PressedSheet {
  Surface surface;
  ActiveSettings<2> settings;

  explicit PressedSheet(int net) : surface(box<2>(3, net)) {
    settings.evolution = Evolution::stationary;
    settings.held = rim(surface, 1);
  }

  /// Two steps under pressure, which presses most of the sheet against the limit.
  [[nodiscard]] ActiveStep pressed(double pressure) const {
    const ActiveSpline<2> model = active<2>(surface, settings);
    ActiveLoads loads;
    loads.limit = limit_of_sheet;
    loads.pressure = pressure;
    auto first = model.step({surface.control_points()}, {}, loads);
    EXPECT_TRUE(first && first->converged);
    auto second = model.step({first->control_points}, {}, loads);
    EXPECT_TRUE(second);
    return std::move(*second);
  }

  [[nodiscard]] double way(const Points& points) const {
    return largest_norm(*surface.with_control_points(points - surface.control_points())).value;
  }
};

void expect_held_at_limit(const ActiveStep& step, double way) {
  EXPECT_TRUE(step.converged) << step.note;
  EXPECT_TRUE(step.limited);
  EXPECT_LE(way, limit_of_sheet * (1 + 1e-6));
  EXPECT_GT(way, limit_of_sheet * (1 - 1e-4));
}

TEST(StepUnderALimit, ConvergesWhereMostOfASheetReachesIt) {
  for (const int net : {12, 16, 24}) {
    const PressedSheet sheet(net);
    const ActiveStep step = sheet.pressed(20);
    expect_held_at_limit(step, sheet.way(step.control_points));
    EXPECT_LE(step.residual, 1e-10);
  }
}

TEST(StepUnderALimit, DoesNotDependOnTheLastBits) {
  const PressedSheet sheet(12);
  const Points x = sheet.pressed(20).control_points;
  for (const double share : {-2e-15, 1e-15, 5e-15}) {
    EXPECT_LE((sheet.pressed(20 * (1 + share)).control_points - x).cwiseAbs().maxCoeff(),
              1e-11 * limit_of_sheet);
  }
  EXPECT_EQ(sheet.pressed(20).control_points, x);
}

TEST(StepUnderALimit, ConvergesUnderAToolAndOnAnObliquePlane) {
  PressedSheet sheet(14);
  sheet.settings.evolution = Evolution::acm;
  sheet.settings.lambda = 0.5;
  sheet.settings.detail = 0.3;
  const Point normal = Point(2, 1, 0.5).normalized();
  for (int i = 0; i < 14; ++i) {  // one side slides in an oblique plane
    sheet.settings.held[static_cast<std::size_t>(i)] = false;
    sheet.settings.constraints.push_back({"plane", {{i, 1.0}}, Point::Zero(), normal});
  }
  const ActiveSpline<2> model = active<2>(sheet.surface, sheet.settings);
  Tool ball = {"ball", testing::sphere_at(Point(0.3, 0.45, 0.28), 0.3), ToolMode::collision, 1e4,
               1};
  ActiveLoads loads;
  loads.limit = limit_of_sheet;
  loads.pressure = -5;
  auto step = model.step({sheet.surface.control_points()}, {&ball, 1}, loads);
  ASSERT_TRUE(step);
  expect_held_at_limit(*step, sheet.way(step->control_points));
  EXPECT_LE(step->violation, 1e-12);
  const Points way = step->control_points - sheet.surface.control_points();
  EXPECT_GT(way.topRows(14).rowwise().norm().maxCoeff(), 0.1 * limit_of_sheet) << "the side slides";
}

TEST(CoordinateSum, AddsBlocksAndGrowsWhereTheyNeedIt) {
  SparseMatrix a(4, 4);
  for (int i = 0; i < 4; ++i) a.insert(i, i) = i + 1;
  a.insert(0, 1) = a.insert(1, 0) = 0.5;
  a.makeCompressed();
  CoordinateSum sum(with_coordinate_blocks(a));
  const Eigen::MatrixXd base = sum.sum();
  EXPECT_EQ(base(0, 3), 0.5);
  EXPECT_EQ(base(0, 4), 0);
  EXPECT_TRUE(sum.renewed());
  const Eigen::MatrixXd half = Eigen::MatrixXd::Random(6, 6), block = half + half.transpose();
  const auto with = [&](int p, int q) {
    Eigen::MatrixXd expected = base;
    const int at[2] = {p, q};
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j)
        expected(3 * at[i / 3] + i % 3, 3 * at[j / 3] + j % 3) += block(i, j);
    }
    return expected;
  };
  for (const auto& [p, q, grows] :
       {std::tuple(0, 1, false), std::tuple(3, 1, true), std::tuple(1, 3, false)}) {
    sum.clear();
    sum.add(std::array{p, q}, block);
    EXPECT_EQ(sum.renewed(), grows);
    EXPECT_EQ(Eigen::MatrixXd(sum.sum()), with(p, q));
  }
}

}  // namespace
}  // namespace knead
