#include "contact/plastic_history.hpp"

#include <gtest/gtest.h>

#include "active.hpp"
#include "groove.hpp"
#include "sculpt/tool_path.hpp"
#include "spline/interpolation/site_values.hpp"

namespace knead {
namespace {

constexpr double size = 200, radius = 20, depth = 8, locality = 0.25 * radius;

/// A sheet of clay and a ball that is led over it.
struct ClaySheet {
  Surface flat = testing::uniform_sheet(3, 64, 64, size, size);
  SiteValues<2> values = *SiteValues<2>::create(flat, Sites::chebyshev);
  Locality bed = locality_of(1e-3, locality / size);
  ActiveSurface model = testing::active<2>(flat, settings());
  int places = 0;

  [[nodiscard]] ActiveSettings<2> settings() const {
    ActiveSettings<2> s;
    s.material.alpha = {bed.tension, 0, bed.tension};
    s.material.beta = {1e-3, 1e-3, 1e-3};
    s.lambda = bed.lambda;
    s.held = testing::rim(flat, 1);
    s.detail = radius;
    return s;
  }

  /// What stays of `before` after a stroke whose path has these pieces.
  Surface stroke(const Surface& before, const Point& from, const Point& to, int events,
                 const Plasticity& plasticity = {}) {
    std::vector<Tool> tools = {
        {"ball", testing::sphere_at(from, radius), ToolMode::collision, 300 * bed.lambda, 1}};
    ToolPath path(radius / 8);
    std::vector<Point> centres;
    for (int k = 0; k <= events; ++k)
      path.go_to(from + (to - from) * k / events + Point(0, 0, radius - depth), centres);
    path.finish(centres);
    Points history = Points::Zero(before.size(), 3), last, older;
    for (const Point& centre : centres) {
      testing::move_to(tools[0], centre);
      ActiveState state{before.control_points(), before.control_points()};
      state.balanced = true;
      if (older.rows() > 0) state.guess = 2 * last - older;
      const auto step = model.step(state, tools);
      if (!step || !step->converged) {
        ADD_FAILURE() << (step ? step->note : step.error().message());
        return before;
      }
      older = last;
      last = step->control_points - before.control_points();
      remember(history, values.values(last));
    }
    places += static_cast<int>(centres.size());
    const Points stays = values.coefficients(staying(history, plasticity));
    return *before.with_control_points(before.control_points() + model.allowed(stays));
  }
};

TEST(PlasticHistory, TheDeepestPlaceIsRememberedWhateverTheOrder) {
  Points a = Points::Zero(2, 3), b = a;
  Points u(2, 3), v(2, 3);
  u << 0, 0, -2, 1, 0, 0;
  v << 0, 1, 0, 0, 3, 0;
  remember(a, u);
  remember(a, v);
  remember(b, v);
  remember(b, u);
  EXPECT_EQ(a, b);
  EXPECT_EQ(a.row(0), u.row(0));
  EXPECT_EQ(a.row(1), v.row(1));
  remember(a, u);
  EXPECT_EQ(a, b);
}

TEST(PlasticHistory, AShareStaysOfWhatIsBeyondTheYield) {
  Points m(3, 3);
  m << 0, 0, -3, 0.6, 0.8, 0, 0, 0, 0;
  EXPECT_EQ(staying(m, {1, 0}), m);
  EXPECT_EQ(staying(m, {0.5, 0}), 0.5 * m);
  const Points left = staying(m, {0.5, 1});
  EXPECT_NEAR(left(0, 2), -1, 1e-15);
  EXPECT_LT(left.bottomRows(2).norm(), 1e-15);
}

// Figures of docs/clay.md: a ball of radius 20 led at depth 8 over a sheet of 200, bicubic, 64
// × 64.
TEST(PlasticHistory, AStrokeLeavesItsGroove) {
  ClaySheet clay;
  const double chord = 2 * std::sqrt(radius * radius - (radius - depth / 2) * (radius - depth / 2));
  for (const auto& [from, to] :
       {std::pair{Point(25, 97, 0), Point(175, 97, 0)}, {{47, 47, 0}, {153, 153, 0}}}) {
    const Surface once = clay.stroke(clay.flat, from, to, 8);
    const testing::Groove g = testing::groove_of(once, clay.flat, from, to, radius, depth);
    EXPECT_GT(g.shallowest, 0.92 * depth);
    EXPECT_LT(g.lowest, 1.001 * depth) << "deeper than the tool went";
    EXPECT_LT(g.width, 1.25 * chord);
    EXPECT_LT(g.beyond, 0.01 * depth);
    EXPECT_LT(g.rim, 0.02 * depth);
    EXPECT_LT(g.ripple, 0.02 * depth);
    EXPECT_LT(g.deepest - g.shallowest, 0.02 * depth) << "ripples along the bottom";

    const Surface twice = clay.stroke(once, from, to, 8);
    const double change =
        (twice.control_points() - once.control_points()).rowwise().norm().maxCoeff();
    EXPECT_LT(change, 0.05 * depth);
    EXPECT_LT(testing::groove_of(twice, clay.flat, from, to, radius, depth).lowest, 1.01 * depth);
  }
}

TEST(PlasticHistory, TheNumberOfEventsDoesNotMatter) {
  ClaySheet clay;
  const Point from(60, 97, 0), to(140, 110, 0);
  const Surface few = clay.stroke(clay.flat, from, to, 8),
                many = clay.stroke(clay.flat, from, to, 480);
  EXPECT_LT((few.control_points() - many.control_points()).rowwise().norm().maxCoeff(),
            1e-6 * size);
}

TEST(PlasticHistory, HeldPointsStayAndHalfTheShareIsHalfTheGroove) {
  ClaySheet clay;
  const Point from(5, 97, 0), to(60, 97, 0);  // over the held rim
  const Surface all = clay.stroke(clay.flat, from, to, 2),
                half = clay.stroke(clay.flat, from, to, 2, {0.5, 0});
  const std::vector<bool> rim = testing::rim(clay.flat, 1);
  for (int i = 0; i < clay.flat.size(); ++i) {
    if (rim[static_cast<std::size_t>(i)]) {
      EXPECT_EQ(all.control_points().row(i), clay.flat.control_points().row(i));
    }
  }
  const Points m = all.control_points() - clay.flat.control_points();
  const Points n = half.control_points() - clay.flat.control_points();
  EXPECT_LT((n - 0.5 * m).cwiseAbs().maxCoeff(), 1e-12 * size);
}

}  // namespace
}  // namespace knead
