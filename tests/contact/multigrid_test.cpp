// Multigrid over nested nets, beside a factor.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "active.hpp"
#include "contact/nested_nets.hpp"
#include "solve/constrained_cholesky.hpp"
#include "solve/multigrid.hpp"

namespace knead {
namespace {

using testing::box;
using testing::random_points;
using testing::rim;
using testing::sheet;

/// Spans of random length, the longest up to 20 times the shortest; every seventh knot is repeated
/// so often.
KnotVector uneven(int degree, int spans, unsigned seed, int repeated) {
  std::mt19937 random(seed);
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, 0.0);
  double at = 0;
  for (int k = 1; k < spans; ++k) {
    at += 0.05 + std::generate_canonical<double, 53>(random);
    knots.insert(knots.end(), k % 7 == 0 ? static_cast<std::size_t>(repeated) : 1, at);
  }
  knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, at + 0.5);
  for (double& x : knots) x /= at + 0.5;
  return *KnotVector::create(degree, knots);
}

struct System {
  SparseMatrix a;
  std::vector<SparseMatrix> prolongations;
};

/// K + λW of a sheet.
System system_of(const Surface& s, const Material& material, double lambda, int enough) {
  Energy<2> energy = stretch_and_bend<2>(material);
  for (EnergyTerm<2> term : mass_energy<2>()) {
    term.coefficient *= lambda;
    energy.push_back(term);
  }
  const DomainScaling<2> scaling;
  return {Stiffness<2>::create(s, energy)->assemble(),
          nested_prolongations<2>({&s, 1}, {&scaling, 1}, enough)};
}

Expected<ConstrainedMultigrid> iterated(const System& system, const ConstraintSpace& space) {
  const SparseMatrix a = system.a;
  return ConstrainedMultigrid::create(
      SparseMatrix(a), [a](const Points& x) { return symmetric_product(a, x); }, space,
      system.prolongations);
}

std::vector<bool> pinned(std::vector<bool> held, int every) {
  std::mt19937 random(7);
  for (std::size_t i = 0; i < held.size(); ++i)
    held[i] = held[i] || random() % static_cast<unsigned>(every) == 0;
  return held;
}

TEST(NestedNets, EverySpaceContainsTheNext) {
  const KnotVector u = uneven(3, 30, 1, 2), v = *KnotVector::clamped_uniform(2, 25);
  const Surface s = sheet(u, v);
  const DomainScaling<2> scaling;
  const auto prolongations = nested_prolongations<2>({&s, 1}, {&scaling, 1}, 60);
  ASSERT_GE(prolongations.size(), 2U);
  EXPECT_EQ(prolongations.front().rows(), s.size());
  for (std::size_t k = 0; k < prolongations.size(); ++k) {
    // Constants are in every space.
    const Eigen::VectorXd ones = prolongations[k] * Eigen::VectorXd::Ones(prolongations[k].cols());
    EXPECT_LE((ones.array() - 1).abs().maxCoeff(), 1e-13);
    if (k > 0) {
      EXPECT_EQ(prolongations[k].rows(), prolongations[k - 1].cols());
    }
  }
  // So are straight lines, whose coefficients are the Greville abscissae of any knots.
  Eigen::VectorXd line(s.size());
  for (int i = 0; i < s.size(); ++i) line[i] = s.control_points()(i, 0);
  Eigen::VectorXd nearest = line;
  for (const SparseMatrix& p : prolongations) {
    const Eigen::MatrixXd dense = p;
    const Eigen::VectorXd coarse = dense.colPivHouseholderQr().solve(nearest);
    EXPECT_LE((dense * coarse - nearest).cwiseAbs().maxCoeff(), 1e-12);
    nearest = coarse;
  }
}

TEST(NestedNets, KeepCreasesAndTheDirectionWithLongSpans) {
  const KnotVector creased = uneven(3, 40, 2, 3), coarse = *KnotVector::clamped_uniform(3, 8);
  const Surface s = sheet(creased, coarse);
  DomainScaling<2> scaling;
  const auto prolongations = nested_prolongations<2>({&s, 1}, {&scaling, 1}, 300);
  ASSERT_EQ(prolongations.size(), 1U);
  EXPECT_EQ(prolongations[0].cols() % coarse.count(), 0) << "the second direction is as before";
  // Of 39 inner knots the five of threefold multiplicity stay, of 34 simple ones half.
  EXPECT_EQ(prolongations[0].cols() / coarse.count(), 4 + 5 * 3 + 17);
}

TEST(NestedNets, AreNoneWhereNothingCanBeLeftOut) {
  const KnotVector torn = *KnotVector::create(1, {0, 0, 1, 1, 2, 2, 3, 3});
  const Surface s = sheet(torn, torn);
  const DomainScaling<2> scaling;
  EXPECT_TRUE(nested_prolongations<2>({&s, 1}, {&scaling, 1}, 4).empty());
}

TEST(Multigrid, CycleIsSymmetricAndPositive) {
  const Surface s = box<2>(3, 40);
  const System system = system_of(s, {}, 20, 200);
  const auto made = iterated(system, ConstraintSpace(pinned(rim(s, 2), 50)));
  ASSERT_TRUE(made) << made.error().message();
  const ConstraintSpace& space = made->space();
  const Points x = space.lumped(random_points(s.size(), 1)),
               y = space.lumped(random_points(s.size(), 2));
  const Points bx = made->precondition(x), by = made->precondition(y);
  const double xx = x.cwiseProduct(bx).sum(), yy = y.cwiseProduct(by).sum();
  EXPECT_GT(xx, 0);
  EXPECT_GT(yy, 0);
  EXPECT_NEAR(x.cwiseProduct(by).sum(), y.cwiseProduct(bx).sum(), 1e-6 * std::sqrt(xx * yy))
      << "single precision";
  for (int i = 0; i < s.size(); ++i) {
    if (space.is_determined(i)) {
      EXPECT_TRUE((bx.row(i).array() == 0).all());
    }
  }
}

/// How far the solution is from that of a factor, as a share of it, and how many iterations it
/// takes.
struct Compared {
  double off = 1;
  int iterations = 1000;
};

Compared compared(const System& system, const ConstraintSpace& space) {
  const auto made = iterated(system, space);
  if (!made) {
    ADD_FAILURE() << made.error().message();
    return {};
  }
  const auto factor = ConstrainedCholesky::factor(system.a, space);
  if (!factor) {
    ADD_FAILURE() << factor.error().message();
    return {};
  }
  const Points b = system.a * random_points(space.size(), 5), exact = factor->solve(b),
               found = made->solve(b);
  return {(found - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff(), made->iterations()};
}

TEST(Multigrid, SolvesWhatAFactorSolves) {
  // Of degree 1 only the mixed second derivative bends, which Jacobi's method hardly smooths.
  constexpr int held_limit[] = {60, 14, 14, 30, 50}, pinned_limit[] = {75, 14, 16, 40, 70};
  for (int degree = 1; degree <= 5; ++degree) {
    const Surface s = box<2>(degree, 40);
    const System system = system_of(s, {}, 20, 200);
    const Compared held = compared(system, ConstraintSpace(rim(s, 2)));
    EXPECT_LE(held.off, 1e-9) << degree;
    EXPECT_LE(held.iterations, held_limit[degree - 1]) << degree;
    const Compared pins = compared(system, ConstraintSpace(pinned(rim(s, 2), 50)));
    EXPECT_LE(pins.off, 1e-9) << degree;
    EXPECT_LE(pins.iterations, pinned_limit[degree - 1]) << degree;
    EXPECT_LE(compared(system, ConstraintSpace(s.size())).off, 1e-8) << degree << ", nothing held";
  }
}

TEST(Multigrid, NeedsHardlyMoreIterationsOnFinerNets) {
  int before = 12;
  for (const int net : {40, 80, 160}) {
    const Surface s = box<2>(3, net);
    const int found =
        compared(system_of(s, {}, 20, 500), ConstraintSpace(pinned(rim(s, 2), 50))).iterations;
    EXPECT_LE(found, before + 3) << net;
    before = found;
  }
}

TEST(Multigrid, TakesMembranesThinPlatesAndUnevenKnots) {
  Material membrane, plate;
  membrane.beta = {0, 0, 0};
  plate.alpha = {0, 0, 0};
  const Surface even = box<2>(3, 48);
  for (const Material& material : {membrane, plate}) {
    const Compared found =
        compared(system_of(even, material, 1e-3, 300), ConstraintSpace(rim(even, 2)));
    EXPECT_LE(found.off, 1e-8);
    EXPECT_LE(found.iterations, 25);
  }
  for (const int repeated : {1, 2}) {
    const Surface s = sheet(uneven(3, 40, 3, repeated), uneven(3, 36, 4, repeated));
    const Compared found = compared(system_of(s, {}, 20, 700), ConstraintSpace(rim(s, 2)));
    EXPECT_LE(found.off, 1e-8) << repeated;
  }
}

TEST(Multigrid, SolvesUnderTies) {
  const Surface s = box<2>(3, 36);
  std::vector<LinearConstraint> ties;
  for (int j = 2; j < 34; ++j) {  // a row is the mean of its neighbours
    ties.push_back({"tie", {{10 * 36 + j, 1.0}, {9 * 36 + j, -0.5}, {11 * 36 + j, -0.5}}});
  }
  const auto space = ConstraintSpace::create(s.size(), ties, rim(s, 2));
  ASSERT_TRUE(space && space->tied());
  EXPECT_LE(compared(system_of(s, {}, 20, 400), *space).off, 1e-9);
}

TEST(Multigrid, IsNotMadeForCoupledCoordinates) {
  const Surface s = box<2>(3, 20);
  const std::vector<LinearConstraint> plane = {
      {"plane", {{210, 1.0}}, Point::Zero(), Point(1, 1, 0)}};
  const auto space = ConstraintSpace::create(s.size(), plane, rim(s, 2));
  ASSERT_TRUE(space && space->coupled());
  EXPECT_FALSE(iterated(system_of(s, {}, 20, 200), *space));
}

}  // namespace
}  // namespace knead
