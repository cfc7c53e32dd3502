#include "solve/constrained_cholesky.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <limits>

#include "solve/panels.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

using testing::random_points;

struct Problem {
  Surface surface;
  SparseMatrix k, mass;

  explicit Problem(Surface s, const Material& material = {}) : surface(std::move(s)) {
    k = Stiffness<2>::create(surface, stretch_and_bend(material))->assemble();
    mass = Stiffness<2>::create(surface, mass_energy<2>())->assemble();
  }
};

TEST(SparseCholesky, SolvesToTheAccuracyOfADenseFactorisation) {
  const Problem p(
      testing::relief(testing::uniform_clamped(3, 6), testing::uniform_clamped(2, 7), 1));
  const SparseMatrix a = p.k + p.mass;
  const auto cholesky = SparseCholesky::factor(a);
  ASSERT_TRUE(cholesky);
  const Points x = random_points(a.rows(), 2), b = a * x;
  EXPECT_LE((cholesky->solve(b) - x).norm(), 1e-12 * x.norm());
  // Backward error: what a stable solver promises whatever the condition number.
  EXPECT_LE((a * cholesky->solve(b) - b).norm(), 1e-14 * Eigen::MatrixXd(a).norm() * x.norm());
}

TEST(SparseCholesky, OneColumnIsSolvedAsThreeAre) {
  const Problem p(
      testing::relief(testing::uniform_clamped(3, 14), testing::uniform_clamped(3, 11), 1));
  const auto cholesky = SparseCholesky::factor(p.k + p.mass);
  ASSERT_TRUE(cholesky);
  const Points b = random_points(p.surface.size(), 2), x = cholesky->solve(b);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(cholesky->solve(Eigen::VectorXd(b.col(c))), x.col(c));
}

TEST(Panels, AreTheFactorOfTheMatrix) {
  // Whatever the order, and with panels of all widths: L y = b and Lᵀ x = y by Eigen's own factor.
  for (const int p : {1, 2, 3, 5}) {
    const Problem problem(
        testing::relief(testing::uniform_clamped(p, 9), testing::uniform_clamped(p, 11), 1));
    SparseMatrix a = problem.k + problem.mass;
    const Eigen::SimplicialLLT<SparseMatrix> llt(a);
    const SparseMatrix lower = llt.matrixL();
    SparseMatrix ordered;
    ordered = a.twistedBy(llt.permutationP());
    const auto panels = Panels::factor(ordered.triangularView<Eigen::Lower>());
    ASSERT_TRUE(panels) << p;
    const Eigen::VectorXd b = random_points(a.rows(), 2).col(0);
    Eigen::VectorXd y = b;
    panels->forward<1>(y.data(), panels->all());
    EXPECT_LE((lower * y - b).norm(), 1e-13 * Eigen::MatrixXd(lower).norm() * y.norm()) << p;
    Eigen::VectorXd x = y;
    panels->backward<1>(x.data(), panels->all());
    EXPECT_LE((lower.transpose() * x - y).norm(), 1e-13 * Eigen::MatrixXd(lower).norm() * x.norm())
        << p;
    EXPECT_LE((ordered * x - b).norm(), 1e-14 * Eigen::MatrixXd(a).norm() * x.norm()) << p;
  }
}

TEST(Panels, GiveTheSameBitsByEveryInstructionSet) {
  const Problem p(
      testing::relief(testing::uniform_clamped(3, 14), testing::uniform_clamped(2, 11), 1));
  const SparseMatrix a = p.k + p.mass, lower = a.triangularView<Eigen::Lower>();
  const auto reference = Panels::factor(lower, InstructionSet::vector128);
  ASSERT_TRUE(reference);
  using Four = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;
  Four b(lower.rows(), 4);
  b << random_points(lower.rows(), 2), random_points(lower.rows(), 3).col(0);
  Four expected = b;
  reference->forward<4>(expected.data(), reference->all());
  reference->backward<4>(expected.data(), reference->all());
  EXPECT_LE((a * expected - b).norm(), 1e-12 * b.norm());
  Eigen::VectorXd one = b.col(1);
  reference->forward<1>(one.data(), reference->all());
  reference->backward<1>(one.data(), reference->all());
  EXPECT_EQ(one, expected.col(1));
  for (const InstructionSet set : available_instruction_sets()) {
    const auto panels = Panels::factor(lower, set);
    ASSERT_TRUE(panels) << name(set);
    Four x = b;
    panels->forward<4>(x.data(), panels->all());
    panels->backward<4>(x.data(), panels->all());
    EXPECT_EQ(x, expected) << name(set);
  }
}

TEST(SparseCholesky, RefusesWhatIsNotPositiveDefinite) {
  SparseMatrix a(2, 2);
  a.insert(0, 0) = 1;
  a.insert(1, 1) = -1;
  auto failed = SparseCholesky::factor(a);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().kind, ErrorKind::numerical);
  a.coeffRef(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(SparseCholesky::factor(a));
}

/// Some held points and some constraints on the others.
ConstraintSpace some_space(const Surface& s) {
  std::vector<bool> held(static_cast<std::size_t>(s.size()));
  for (std::size_t i = 0; i < held.size(); i += 3) held[i] = true;
  const std::vector<LinearConstraint> constraints = {{"a", {{1, 1}, {2, -1}, {4, 0.5}}},
                                                     {"b", {{5, 1}, {1, 1}}}};
  return *ConstraintSpace::create(s.size(), constraints, held);
}

TEST(ConstrainedCholesky, SolvesOnTheFreeUnknownsAlone) {
  const Problem p(
      testing::relief(testing::uniform_clamped(3, 5), testing::uniform_clamped(3, 4), 3));
  const SparseMatrix a = p.k + p.mass;
  const auto system = ConstrainedCholesky::factor(a, some_space(p.surface));
  ASSERT_TRUE(system);
  const Points b = random_points(p.surface.size(), 4), x = system->solve(b);
  for (int i = 0; i < x.rows(); i += 3) EXPECT_EQ(x.row(i).norm(), 0);
  EXPECT_LT(system->space().violation(x), 1e-13);
  EXPECT_LE(system->space().reduce(b - a * x).norm(), 1e-12 * Eigen::MatrixXd(a).norm() * x.norm());
}

TEST(ConstrainedCholesky, CoupledCoordinatesGiveTheSameSolutionWhereNothingCouplesThem) {
  const Problem p(
      testing::relief(testing::uniform_clamped(2, 5), testing::uniform_clamped(3, 4), 3));
  const SparseMatrix a = p.k + p.mass;
  std::vector<LinearConstraint> constraints = {{"a", {{1, 1}, {2, -1}, {4, 0.5}}}};
  const auto simple =
      ConstrainedCholesky::factor(a, *ConstraintSpace::create(p.surface.size(), constraints));
  std::vector<LinearConstraint> axes;
  for (int k = 0; k < 3; ++k)
    axes.push_back({"a", constraints[0].terms, Point::Zero(), Point(Point::Unit(k))});
  const auto coupled =
      ConstrainedCholesky::factor(a, *ConstraintSpace::create(p.surface.size(), axes));
  ASSERT_TRUE(simple && coupled);
  EXPECT_TRUE(coupled->space().coupled());
  const Points b = random_points(p.surface.size(), 4), x = simple->solve(b);
  EXPECT_LE((coupled->solve(b) - x).norm(), 1e-11 * x.norm());
}

/// Right sides that are zero but at a few points: the subset of the factor that they touch gives
/// the solution there, and from there everywhere, to the bits of the whole solve.
TEST(ConstrainedCholesky, APartOfTheFactorGivesTheBitsOfTheWhole) {
  const Problem p(
      testing::relief(testing::uniform_clamped(3, 17), testing::uniform_clamped(2, 13), 5));
  const SparseMatrix a = p.k + p.mass;
  const int size = p.surface.size();
  std::vector<LinearConstraint> axes;
  for (int k = 0; k < 3; ++k)
    axes.push_back({"a", {{40, 1}, {41, -1}, {90, 0.5}}, Point::Zero(), Point(Point::Unit(k))});
  const std::vector<std::vector<int>> choices = {
      {41, 90, 3}, {0}, {}, {220, 12, 13, 14, 1, 40, 41, 42, 100}};
  for (const ConstraintSpace& space :
       {ConstraintSpace(size), some_space(p.surface), *ConstraintSpace::create(size, axes)}) {
    const auto system = ConstrainedCholesky::factor(a, space);
    ASSERT_TRUE(system);
    for (const std::vector<int>& points : choices) {
      const auto subset = system->subset(points);
      const Points here = random_points(static_cast<int>(points.size()), 6);
      Points b = Points::Zero(size, 3);
      for (std::size_t k = 0; k < points.size(); ++k)
        b.row(points[k]) = here.row(static_cast<Eigen::Index>(k));
      const Points x = system->solve(b), within = system->solve_within(subset, here);
      const Points everywhere = random_points(size, 8);
      const auto half = system->forward(everywhere);
      EXPECT_EQ(system->backward(half, 0, subset, here), x);
      const Points whole = system->solve(everywhere);
      EXPECT_EQ(system->backward(half, 1, subset, Points::Zero(here.rows(), 3)), whole);
      const double squared = everywhere.cwiseProduct(whole).sum();
      EXPECT_NEAR(half.squared_norm, squared, 1e-12 * squared);
      const Points second_within = system->backward_within(subset, half);
      for (std::size_t k = 0; k < points.size(); ++k) {
        EXPECT_EQ(within.row(static_cast<Eigen::Index>(k)), x.row(points[k])) << points[k];
        EXPECT_EQ(second_within.row(static_cast<Eigen::Index>(k)), whole.row(points[k]))
            << points[k];
      }
    }
  }
}

TEST(ConstrainedCholesky, WithEverythingHeldNothingMoves) {
  const Problem p(testing::uniform_sheet(2, 4, 4));
  const auto system =
      ConstrainedCholesky::factor(p.k, ConstraintSpace(std::vector<bool>(16, true)));
  ASSERT_TRUE(system);
  EXPECT_EQ(system->solve(random_points(16, 2)).norm(), 0);
}

TEST(ConstrainedCholesky, RefusesASingularSystem) {
  const SparseMatrix zero(16, 16);
  EXPECT_EQ(ConstrainedCholesky::factor(zero, ConstraintSpace(16)).error().kind,
            ErrorKind::numerical);
  const Problem p(testing::uniform_sheet(3, 8, 8));  // constants cost nothing
  EXPECT_FALSE(ConstrainedCholesky::factor(p.k, ConstraintSpace(p.surface.size())));
}

TEST(ConstrainedCholesky, OfCoordinatesSolvesInTheirSpace) {
  const Problem p(
      testing::relief(testing::uniform_clamped(3, 5), testing::uniform_clamped(2, 6), 1));
  const int n = p.surface.size();
  const std::vector<LinearConstraint> constraints{
      {"equal", {{7, 1.0}, {8, -1.0}}, {}, Point(1, 2, 3)},
      {"together", {{20, 0.5}, {21, 0.25}, {30, -0.75}}}};
  std::vector<bool> held(static_cast<std::size_t>(n), false);
  held[0] = held[11] = true;
  const auto space = ConstraintSpace::create(n, constraints, held, true);
  ASSERT_TRUE(space);
  ASSERT_TRUE(space->coupled());
  // Coordinates that depend on each other: a symmetric block of its own at every entry.
  const SparseMatrix scalar = p.k + p.mass;
  std::vector<Eigen::Triplet<double>> entries;
  const Eigen::Matrix3d block{{2, 0.5, 0.1}, {0.5, 3, -0.2}, {0.1, -0.2, 1}};
  for (int j = 0; j < scalar.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(scalar, j); it; ++it) {
      for (int c = 0; c < 3; ++c) {
        for (int e = 0; e < 3; ++e)
          entries.emplace_back(3 * it.row() + c, 3 * j + e, block(c, e) * it.value());
      }
    }
  }
  SparseMatrix a(3 * n, 3 * n);
  a.setFromTriplets(entries.begin(), entries.end());
  const CoordinateRestriction restriction(*space, a);
  const auto inverse = ConstrainedCholesky::factor(a, *space, restriction);
  ASSERT_TRUE(inverse) << inverse.error().message();
  const Points x = space->expand(Eigen::VectorXd(random_points(space->free_count(), 3).col(0)));
  const Eigen::VectorXd b = a * Eigen::Map<const Eigen::VectorXd>(x.data(), x.size());
  EXPECT_LT((inverse->solve(Eigen::Map<const Points>(b.data(), n, 3)) - x).norm(),
            1e-11 * x.norm());
}

/// Entries everywhere: I + e eᵀ/n.
SparseMatrix full_matrix(int size) {
  return (Eigen::MatrixXd::Identity(size, size) + Eigen::MatrixXd::Constant(size, size, 1.0 / size))
      .sparseView();
}

// The products of all pairs of terms, 6 · 10⁹ of them, would fill 90 GB.
TEST(ConstrainedCholesky, SolvesWhereDependentPointsHaveManyTerms) {
  constexpr int n = 320, dependents = 100;
  const Points shares = random_points(dependents * (n - dependents), 2);
  std::vector<LinearConstraint> constraints;
  for (int k = 0; k < dependents; ++k) {
    LinearConstraint sum{"sum", {{k, 1.0}}};
    for (int j = dependents; j < n; ++j)
      sum.terms.emplace_back(j, shares(k * (n - dependents) + j - dependents, 0));
    constraints.push_back(std::move(sum));
  }
  constraints.push_back({"in a plane", {{n - 1, 1.0}}, {}, Point(1, 2, 3)});
  const auto space = ConstraintSpace::create(n, constraints, std::vector<bool>(n, false), true);
  ASSERT_TRUE(space);
  ASSERT_TRUE(space->coupled());
  const SparseMatrix a = full_matrix(3 * n);
  const CoordinateRestriction restriction(*space, a);
  const auto inverse = ConstrainedCholesky::factor(a, *space, restriction);
  ASSERT_TRUE(inverse) << inverse.error().message();
  const Points x = space->expand(Eigen::VectorXd(random_points(space->free_count(), 3).col(0)));
  const Eigen::VectorXd b = a * Eigen::Map<const Eigen::VectorXd>(x.data(), x.size());
  EXPECT_LT((inverse->solve(Eigen::Map<const Points>(b.data(), n, 3)) - x).norm(), 1e-9 * x.norm());
}

}  // namespace
}  // namespace knead
