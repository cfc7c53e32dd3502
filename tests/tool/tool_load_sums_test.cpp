// Sums over the points of contacts made direction by direction, and points that are leapt over.

#include <gtest/gtest.h>

#include <Eigen/SparseCore>
#include <vector>

#include "contact/active.hpp"
#include "contact/patch_potential.hpp"
#include "sculpt/lattice.hpp"
#include "support/surfaces.hpp"
#include "support/tools.hpp"

namespace knead {
namespace {

ModelTool round_tool(const Point& centre, double radius, ToolMode mode = ToolMode::collision) {
  return {{"ball", testing::sphere_at(centre, radius), mode, 10, 0.1}, Point::Zero(), 1};
}

template <int D>
PotentialState potential_at(const ToolLoad<D>& load, const Points& x,
                            const std::vector<ModelTool>& tools,
                            const DisplacementLimit* limit = nullptr) {
  PotentialState state;
  state.force = Points::Zero(x.rows(), 3);
  load.evaluate(x, 0, 0, {.tools = tools, .friction = nullptr, .limit = limit}, state);
  return state;
}

/// The Hessian applied point by point, by its entries.
template <int D>
Points by_entries(const ToolLoad<D>& load, const PotentialState& state, const Points& v) {
  Points result = Points::Zero(v.rows(), 3);
  load.each_hessian_block(state.contacts, 0,
                          [&](std::span<const int> points, const Eigen::MatrixXd& block) {
                            for (Eigen::Index i = 0; i < block.rows(); ++i) {
                              for (Eigen::Index j = 0; j < block.cols(); ++j) {
                                const int row = points[static_cast<std::size_t>(i / 3)],
                                          column = points[static_cast<std::size_t>(j / 3)];
                                result(row, i % 3) += block(i, j) * v(column, j % 3);
                              }
                            }
                          });
  return result;
}

template <int D>
void expect_sums(const Spline<D>& spline, const ModelTool& tool) {
  const auto load = ToolLoad<D>::create(spline, DomainScaling<D>{}, 0.2);
  ASSERT_TRUE(load);
  const Points x = spline.control_points(), v = testing::random_points(x.rows(), 7);
  PotentialState state = potential_at(*load, x, {tool});
  ASSERT_GT(state.contacts.size(), 10U);
  const Points expected = by_entries(*load, state, v);
  Points sum = Points::Zero(x.rows(), 3);
  load->apply_hessian(state.contacts, 0, v, sum);
  EXPECT_LE((sum - expected).norm(), 1e-13 * expected.norm());
  // In any order.
  for (std::size_t k = 0; k + 1 < state.contacts.size(); k += 3)
    std::swap(state.contacts[k], state.contacts.back());
  sum.setZero();
  load->apply_hessian(state.contacts, 0, v, sum);
  EXPECT_LE((sum - expected).norm(), 1e-13 * expected.norm());
  // The force of contacts is that of their potential.
  constexpr double h = 1e-6;
  const double slope = (potential_at(*load, x + h * v, {tool}).potential -
                        potential_at(*load, x - h * v, {tool}).potential) /
                       (2 * h);
  EXPECT_NEAR(-state.force.cwiseProduct(v).sum(), slope, 1e-4 * std::abs(slope));
}

TEST(ToolLoadSums, AreThoseOfEveryPointAlone) {
  expect_sums(testing::box<1>(3, 7), round_tool({0.5, 0, 0}, 0.3));
  expect_sums(testing::relief(testing::uniform_clamped(3, 3), testing::uniform_clamped(2, 4), 1),
              round_tool({0.6, 0.4, 0.15}, 0.3, ToolMode::proximity));
  expect_sums(
      testing::relief(testing::uniform_clamped(2, 3), testing::uniform_clamped(4, 2), 2, 0.1, 5),
      round_tool({0.6, 0.4, 0.15}, 0.3));
  expect_sums(testing::box<3>(3, 5), round_tool({0.4, 0.5, 0.6}, 0.2));
}

TEST(ToolLoadSums, MeasureTheLimitFromTheOriginal) {
  const Surface s =
      testing::relief(testing::uniform_clamped(2, 3), testing::uniform_clamped(2, 3), 2, 0.1, 5);
  const auto load = ToolLoad<2>::create(s, DomainScaling<2>{}, 1);
  ASSERT_TRUE(load);
  const Points x = s.control_points();
  const DisplacementLimit limit{0.01, 100, x.rowwise() + Eigen::RowVector3d(0, 0, 0.03)};
  // Everything is 0.03 away: over the domain of area 9 the potential is k/2 0.02², and the force k
  // 0.02.
  const PotentialState state = potential_at(*load, x, {}, &limit);
  EXPECT_NEAR(state.potential, 9 * 0.5 * 100 * 0.02 * 0.02, 1e-12);
  EXPECT_NEAR((state.force.colwise().sum() - Eigen::RowVector3d(0, 0, 18)).norm(), 0, 1e-12);
}

TEST(ToolLoadSums, LeapOverWhatATubeCannotReach) {
  const auto block =
      Lattice::create({Point(0, 0, -0.5), Point(1, 1, 0.5)}, 0.05, {3, 3, 3}, {6, 6, 6});
  ASSERT_TRUE(block);
  const Points& x = block->rest().control_points();
  auto torus = PlacedShape::create(TorusShape{0.4, 0.04},
                                   {Eigen::Quaterniond::Identity(), Point(0.5, 0.5, 0), {1, 1, 1}});
  ASSERT_TRUE(torus);
  const ModelTool tool({"ring", std::move(*torus), ToolMode::collision, 10, 1}, Point::Zero(), 1);
  const auto load = ToolLoad<3>::create(block->rest(), DomainScaling<3>{}, 0.04);
  ASSERT_TRUE(load);
  const PotentialState state = potential_at(*load, x, {tool});
  ASSERT_GT(state.contacts.size(), 10000U);
  EXPECT_LT(state.visited, load->points() / 10) << state.contacts.size();
  // A tube at rest in the block is entered as deep as it is thick; the deepest samples are soon
  // known.
  const Penetration entry = load->deepest_entry(x, 0, tool);
  EXPECT_NEAR(entry.depth, 0.04, 1e-4);
  EXPECT_LT(entry.visited, load->points() / 20);
}

TEST(ToolLoadSums, LeapOverNoContactOfACurvedShape) {
  // All points of a wavy block, with and without a tool without bounds beside it, which makes leaps
  // short.
  const auto block =
      Lattice::create({Point(0, 0, -0.5), Point(1, 1, 0.5)}, 0.05, {3, 2, 4}, {5, 4, 6});
  ASSERT_TRUE(block);
  const auto load = ToolLoad<3>::create(block->rest(), DomainScaling<3>{}, 0.08);
  ASSERT_TRUE(load);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Points x =
        block->rest().control_points() + 0.1 * testing::random_points(block->rest().size(), seed);
    const ModelTool tool = round_tool({0.5, 0.4, 0.1}, 0.2);
    const DisplacementLimit everywhere{1e3, 1, x};  // never reached
    DisplacementLimit visits{
        1e-3, 0, x.rowwise() + Eigen::RowVector3d(0, 0, 1)};  // reached everywhere, without force
    const PotentialState leaping = potential_at(*load, x, {tool}, &everywhere);
    const PotentialState visiting = potential_at(*load, x, {tool}, &visits);
    EXPECT_EQ(visiting.visited, load->points());
    EXPECT_LT(leaping.visited, load->points() / 4);
    long long contacts = 0;
    for (const ContactPoint& c : visiting.contacts) contacts += c.hessian.norm() > 0 ? 1 : 0;
    EXPECT_EQ(static_cast<long long>(leaping.contacts.size()), contacts);
    EXPECT_NEAR(leaping.potential, visiting.potential, 1e-13 * leaping.potential);
  }
}

/// What is found where all points are visited, because a limit without force is exceeded at all of
/// them.
template <int D>
void expect_every_contact_found(const Spline<D>& spline, const ModelTool& tool, double detail) {
  const auto load = ToolLoad<D>::create(spline, DomainScaling<D>{}, detail);
  ASSERT_TRUE(load);
  const Points x = spline.control_points();
  const DisplacementLimit visits{1e-3, 0, x.rowwise() + Eigen::RowVector3d(0, 0, 1)};
  const PotentialState found = potential_at(*load, x, {tool}),
                       all = potential_at(*load, x, {tool}, &visits);
  ASSERT_EQ(all.visited, load->points());
  EXPECT_LT(found.visited, load->points());
  long long contacts = 0;
  for (const ContactPoint& c : all.contacts) contacts += c.hessian.norm() > 0 ? 1 : 0;
  ASSERT_GT(contacts, 0);
  EXPECT_EQ(static_cast<long long>(found.contacts.size()), contacts);
  EXPECT_NEAR(found.potential, all.potential, 1e-13 * std::abs(all.potential));
  EXPECT_LE((found.force - all.force).norm(), 1e-13 * all.force.norm());
  EXPECT_EQ(found.entry, all.entry);
}

TEST(ToolLoadSums, FindEveryContactAmongRowsOfAnyLength) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.4, Point(1, 2, 3).normalized()));
  for (const int degree : {1, 3, 5}) {
    for (const int spans : {1, 7}) {
      const KnotVector u = testing::uniform_clamped(degree, spans),
                       v = testing::uniform_clamped(3, spans);
      for (const double spread : {1.0, 100.0}) {
        for (const Surface& s :
             {testing::relief(u, v, 3, 0.05, spread), testing::relief(v, u, 4, 0.05, spread)}) {
          SCOPED_TRACE(::testing::Message() << degree << " " << spans << " " << spread);
          const Point at = s.control_points().colwise().mean();
          const auto box =
              PlacedShape::create(BoxShape{{0.1, 0.2, 0.15}, 0.01}, {turn, at, {1, 1, 1}});
          ASSERT_TRUE(box);
          for (const auto mode : {ToolMode::collision, ToolMode::proximity}) {
            expect_every_contact_found(s, round_tool(at, 0.1, mode), 0.03);
            expect_every_contact_found(s, round_tool(at + Point(0, 0, 0.1), 0.25, mode), 0.1);
            expect_every_contact_found(
                s, ModelTool{{"box", *box, mode, 10, 0.05}, Point::Zero(), 1}, 0.1);
          }
        }
      }
    }
  }
  const ModelTool ball = round_tool({0.5, 0, 0}, 0.03);
  expect_every_contact_found(testing::box<1>(3, 7), ball, 0.03);
  expect_every_contact_found(testing::box<1>(2, 3), ball, 0.01);
  expect_every_contact_found(testing::box<3>(2, 3), round_tool({0.5, 0.4, 0.3}, 0.1), 0.1);
}

TEST(ToolLoadSums, TellWhatActsBeyondSomeElements) {
  const Surface s = testing::box<2>(3, 20);
  auto load = ToolGrids<2>::create(s, DomainScaling<2>{}, 0.15);
  ASSERT_TRUE(load);
  const std::vector<ToolGrids<2>> loads = {*load};
  const std::vector<int> rows = {0, s.size()};
  const PatchPotential<2> potential(loads, rows, {round_tool({0.5, 0.4, 0.1}, 0.15)});
  const Points x = s.control_points();
  const PotentialState state = potential.evaluate(x);
  ASSERT_GT(state.contacts.size(), 10U);
  std::vector<char> marks(static_cast<std::size_t>(s.size()), 0);
  potential.mark(state, marks);
  const WatchedElements all = potential.watch(marks);
  EXPECT_FALSE(potential.acts_beyond(all, x));
  EXPECT_EQ(potential.evaluate(x, &all).force, state.force);
  EXPECT_TRUE(potential.acts_beyond({{}, {{}}}, x));
  int counted = 0;
  for (std::size_t k = 0; k < all.elements[0].size(); ++k) {
    WatchedElements others = all;
    others.elements[0].erase(others.elements[0].begin() + static_cast<std::ptrdiff_t>(k));
    const WatchedElements alone{all.rows, {{all.elements[0][k]}}};
    const bool acts = !potential.evaluate(x, &alone).contacts.empty();
    EXPECT_EQ(potential.acts_beyond(others, x), acts) << k;
    counted += acts ? 1 : 0;
  }
  EXPECT_GT(counted, 10);
}

TEST(ToolLoadSums, RefuseALimitThatForcesExceedAfterOneRound) {
  const Surface s = testing::uniform_sheet(3, 6, 6);
  ActiveSettings<2> settings;
  settings.held = testing::rim(s, 1);
  const auto model = testing::active<2>(s, settings);
  ActiveLoads loads;
  loads.limit = 0.05;
  PointForce force;
  force.terms = {{14, 1.0}};
  force.to = s.control_points().row(14).transpose() + Point(0, 0, 5);
  force.strength = 1e10;
  loads.points.push_back(force);
  const auto step = model.step(ActiveState{s.control_points()}, {}, loads);
  ASSERT_TRUE(step) << step.error().message();
  EXPECT_FALSE(step->converged);
  EXPECT_NE(step->note.find("limit"), std::string::npos) << step->note;
  EXPECT_LT(step->solves, 2000);
}

}  // namespace
}  // namespace knead
