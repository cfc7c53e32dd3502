#include <gtest/gtest.h>

#include "hold/constrained.hpp"

namespace knead {
namespace {

using namespace testing;
using State = SmoothLine::State;

std::vector<SmoothLine> smooth(const Surface& s, ConstraintList& list,
                               const SmoothOptions& options = {}) {
  auto lines = keep_smooth(s, options, list);
  if (!lines) ADD_FAILURE() << lines.error().message();
  return lines ? *lines : std::vector<SmoothLine>{};
}

void expect_no_crease(const Surface& s, const std::string& name, double tolerance, int seeds = 10) {
  ConstraintList list(s.size());
  const auto lines = smooth(s, list);
  double rest = 0;
  for (const SmoothLine& line : lines) rest = std::max(rest, line.angle);
  for (int seed = 1; seed <= seeds; ++seed) {
    const Surface after = moved(s, 0.15 * random_member(s, list, static_cast<unsigned>(seed)));
    for (const SmoothLine& line : lines) {
      EXPECT_LT(crease(after, line.direction, line.knot), tolerance) << name << ", seed " << seed;
    }
  }
}

/// A surface that is smooth across c = 1 with derivatives in the ratio λ: the knots of a smooth one
/// inserted p times there, one side then stretched about the line by the knots.
Surface stretched(int p, int q, double ratio, int multiplicity, double spread, bool in_v) {
  // Two Bézier pieces in u; the first ring right of the line mirrors the left one with the ratio of
  // the spans and λ.
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> value(-1, 1);
  const KnotVector u = clamped_knots(p, {0, 1, 3}, {0, multiplicity, 0}), v = uniform_clamped(q, 3);
  const int m = u.count(), n = v.count(), left = p, right = multiplicity == p ? p : p + 1;
  Points points(m * n, 3);
  std::vector<double> row_weight, column_weight, weights;
  for (int i = 0; i < m; ++i) row_weight.push_back(std::pow(spread, value(random)));
  for (int j = 0; j < n; ++j) column_weight.push_back(std::pow(spread, value(random)));
  row_weight[static_cast<std::size_t>(right)] = row_weight[static_cast<std::size_t>(left)];
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      const int k = i * n + j;
      points.row(k) << i + 0.2 * value(random), j + 0.2 * value(random), 0.3 * value(random);
      if (i == right) points.row(k) = points.row(left * n + j);
      if (i == right + 1) {
        // w_{R+1} (P_{R+1} − P_R)/h⁺ = λ w_{L−1} (P_L − P_{L−1})/h⁻ with spans 2 and 1.
        const double factor = ratio * 2 * row_weight[static_cast<std::size_t>(left - 1)] /
                              row_weight[static_cast<std::size_t>(i)];
        points.row(k) = points.row(right * n + j) +
                        factor * (points.row(left * n + j) - points.row((left - 1) * n + j));
      }
    }
  }
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j)
      weights.push_back(row_weight[static_cast<std::size_t>(i)] *
                        column_weight[static_cast<std::size_t>(j)]);
  }
  if (spread == 1) weights.clear();
  if (!in_v) return make_surface(u, v, points, weights);
  Points turned(m * n, 3);
  std::vector<double> turned_weights(weights.size());
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      turned.row(j * m + i) = points.row(i * n + j);
      if (!weights.empty())
        turned_weights[static_cast<std::size_t>(j * m + i)] =
            weights[static_cast<std::size_t>(i * n + j)];
    }
  }
  return make_surface(v, u, turned, turned_weights);
}

TEST(KeepSmooth, CylinderOfACadSystemShowsNoCrease) {
  const Surface s = cylinder();
  ConstraintList list(s.size());
  const auto lines = smooth(s, list);
  ASSERT_EQ(lines.size(), 3u);
  for (const SmoothLine& line : lines) {
    EXPECT_EQ(line.state, State::coupled);
    EXPECT_EQ(line.multiplicity, 2);
    EXPECT_EQ(line.constraints, 2);
    EXPECT_NEAR(line.ratio, 1, 1e-14);
    EXPECT_LT(line.angle, 1e-14);
  }
  EXPECT_EQ(space_of(s, list).free_count(), 18 - 6);
  expect_no_crease(s, "cylinder", 1e-12, 50);
  // Without, random displacements do crease: the test can fail.
  EXPECT_GT(crease(moved(s, 0.15 * random_points(s.size(), 3)), 0, 1), 1e-3);
}

TEST(KeepSmooth, SphereShowsNoCrease) {
  const Surface s = sphere();
  ConstraintList list(s.size());
  const auto lines = smooth(s, list);
  ASSERT_EQ(lines.size(), 4u);
  for (const SmoothLine& line : lines) EXPECT_EQ(line.state, State::coupled);
  expect_no_crease(s, "sphere", 1e-11);
}

TEST(KeepSmooth, HoldsAnyRatioOfDerivativesAnyProportionalWeightsBothMultiplicities) {
  for (const auto& [p, q] : {std::pair{2, 1}, {2, 3}, {3, 2}, {5, 3}}) {
    for (const double ratio : {1.0, 0.2, 7.0}) {
      for (const double spread : {1.0, 1.5, 10.0}) {
        for (const int multiplicity : {p, p + 1}) {
          for (const bool in_v : {false, true}) {
            const Surface s = stretched(p, q, ratio, multiplicity, spread, in_v);
            const std::string name = "p=" + std::to_string(p) + " ratio " + std::to_string(ratio) +
                                     " spread " + std::to_string(spread) + " multiplicity " +
                                     std::to_string(multiplicity);
            ConstraintList list(s.size());
            const auto lines = smooth(s, list);
            ASSERT_EQ(lines.size(), q == 1 ? 3u : 1u) << name;
            const SmoothLine& line = lines[q == 1 && in_v ? 2 : 0];
            ASSERT_EQ(line.state, State::coupled) << name;
            EXPECT_NEAR(line.ratio, ratio, 1e-9 * ratio) << name;
            const int d = in_v ? 1 : 0;
            for (unsigned seed = 1; seed <= 5; ++seed) {
              const Points x = random_member(s, list, seed);
              EXPECT_LT(crease(moved(s, 0.1 * x), d, 1), 1e-9) << name;
              const Surface f = field(s, x);
              EXPECT_LT((on_line(f, d, 1, 0, Side::left) - on_line(f, d, 1, 0, Side::right))
                            .cwiseAbs()
                            .maxCoeff(),
                        1e-12)
                  << name;
            }
          }
        }
      }
    }
  }
}

TEST(KeepSmooth, LeavesCreasesAndTearsAsTheyAre) {
  const Surface s = stretched(3, 2, 1, 3, 1, false);
  Points points = s.control_points();
  const int n = s.net()[1];
  points.row(4 * n + 1)[2] += 0.5;  // the ring right of the line leaves the tangent plane
  const Surface creased = *s.with_control_points(points);
  ConstraintList list(s.size());
  const auto lines = smooth(creased, list);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].state, State::crease);
  EXPECT_GT(lines[0].angle, 0.1);
  EXPECT_TRUE(list.constraints.empty());

  const Surface joined = stretched(3, 2, 1, 4, 1, false);
  points = joined.control_points();
  points.row(5 * n + 1)[2] += 0.5;
  ConstraintList no_tear(joined.size());
  const auto creased_lines = smooth(*joined.with_control_points(points), no_tear);
  EXPECT_EQ(creased_lines[0].state, State::crease);
  EXPECT_EQ(creased_lines[0].constraints, n);  // may bend, must not tear
  points.row(4 * n + 1)[2] += 0.01;
  ConstraintList torn(joined.size());
  EXPECT_EQ(smooth(*joined.with_control_points(points), torn)[0].state, State::torn);
  EXPECT_TRUE(torn.constraints.empty());
}

TEST(KeepSmooth, LeavesLinesThatOnlyACreaseCanBend) {
  const Surface s = uniform_sheet(1, 5, 4);
  ConstraintList list(s.size());
  const auto lines = smooth(s, list);
  ASSERT_EQ(lines.size(), 5u);
  for (const SmoothLine& line : lines) EXPECT_EQ(line.state, State::linear);
  EXPECT_TRUE(list.constraints.empty());
}

TEST(KeepSmooth, AsksNothingWhereTheBasisIsSmooth) {
  const Surface s =
      relief(clamped_knots(3, {0, 1, 2, 3}, {4, 1, 2, 4}), uniform_unclamped(2, 5), 3);
  ConstraintList list(s.size());
  EXPECT_TRUE(smooth(s, list).empty());
  EXPECT_TRUE(list.constraints.empty());
}

TEST(KeepSmooth, IsKeptAtSamplesWhereTheRatioOrTheWeightsVary) {
  int sampled = 0;
  const Surface base = stretched(3, 3, 1, 3, 1, false);
  const int n = base.net()[1];
  for (int kind = 0; kind < 3; ++kind) {
    Points points = base.control_points();
    std::vector<double> weights;
    // On a plane every net is tangent-continuous, whatever its derivatives and weights are.
    points.col(2).setZero();
    if (kind == 1) {
      for (int j = 0; j < n; ++j) points(4 * n + j, 0) += 0.15 * j;  // λ varies
    }
    if (kind == 2) {
      for (int k = 0; k < base.size(); ++k) weights.push_back(1 + 0.3 * ((k * 7) % 5));  // κ varies
    }
    const Surface s = make_surface(base.knots(0), base.knots(1), points, weights);
    ConstraintList list(s.size());
    const auto lines = smooth(s, list);
    ASSERT_EQ(lines.size(), 1u);
    if (kind > 0) {
      EXPECT_EQ(lines[0].state, State::sampled) << kind;
      RecordProperty("conditions for kind " + std::to_string(kind), lines[0].constraints);
      ++sampled;
    }
    int moves = 0;
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const Points x = random_member(s, list, seed);
      moves += x.middleRows(3 * n, n).norm() > 1e-3;
      EXPECT_LT(crease(moved(s, 0.1 * x), 0, 1, 301), 1e-6) << kind;
    }
    EXPECT_EQ(moves, 5) << "the line still moves, kind " << kind;
  }
  EXPECT_EQ(sampled, 2);
}

}  // namespace
}  // namespace knead
