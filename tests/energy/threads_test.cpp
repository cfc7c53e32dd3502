#include <gtest/gtest.h>

#include "knead/energy/shell_energy.hpp"
#include "knead/energy/stiffness.hpp"
#include "support/surfaces.hpp"
#include "support/thread_counts.hpp"

namespace knead {
namespace {

using testing::with_threads;

template <int D>
std::array<KnotVector, D> sides(int degree, const std::array<int, D>& net) {
  std::vector<KnotVector> knots;
  for (const int count : net) knots.push_back(*KnotVector::clamped_uniform(degree, count));
  if constexpr (D == 2) {
    return {knots[0], knots[1]};
  } else {
    return {knots[0], knots[1], knots[2]};
  }
}

/// K assembled, refreshed and applied has the same bits with any number of threads.
template <int D>
void expect_same_bits(const Stiffness<D>& k) {
  const Points x = testing::random_points(k.size(), 3);
  const auto assembled = with_threads(1, [&] { return k.assemble(); });
  const auto applied = with_threads(1, [&] { return k.apply(x); });
  for (const int threads : testing::thread_counts) {
    SCOPED_TRACE(threads);
    const SparseMatrix again = with_threads(threads, [&] { return k.assemble(); });
    ASSERT_EQ(again.nonZeros(), assembled.nonZeros());
    EXPECT_TRUE(std::equal(again.outerIndexPtr(), again.outerIndexPtr() + again.cols() + 1,
                           assembled.outerIndexPtr()));
    EXPECT_TRUE(std::equal(again.innerIndexPtr(), again.innerIndexPtr() + again.nonZeros(),
                           assembled.innerIndexPtr()));
    EXPECT_TRUE(
        std::equal(again.valuePtr(), again.valuePtr() + again.nonZeros(), assembled.valuePtr()));
    SparseMatrix kept = assembled;
    kept.coeffs().setConstant(7);
    with_threads(threads, [&] {
      k.refresh(kept);
      return 0;
    });
    EXPECT_TRUE(
        std::equal(kept.valuePtr(), kept.valuePtr() + kept.nonZeros(), assembled.valuePtr()));
    EXPECT_EQ(with_threads(threads, [&] { return k.apply(x); }), applied);
  }
}

TEST(ThreadsOfStiffness, DoNotChangeBitsOfSurfaces) {
  const Energy<2> energy = stretch_and_bend<2>({{1, 0.3, 0.5}, {1e-3, 2e-3, 5e-4}});
  for (const int p : {2, 3, 5}) {
    expect_same_bits<2>(*Stiffness<2>::create(sides<2>(p, {90, 81}), energy));
    expect_same_bits<2>(*Stiffness<2>::create(sides<2>(p, {600, 13}), energy));
  }
}

TEST(ThreadsOfStiffness, DoNotChangeBitsOfVolumes) {
  expect_same_bits<3>(
      *Stiffness<3>::create(sides<3>(2, {40, 24, 22}), stretch_and_bend<3>(MaterialOf<3>{})));
}

TEST(ThreadsOfStiffness, DoNotChangeBitsOfSmallNets) {
  expect_same_bits<2>(
      *Stiffness<2>::create(sides<2>(3, {4, 5}), stretch_and_bend<2>({{1, 0, 1}, {1, 1, 1}})));
}

/// The second derivatives of a shell, too.
void expect_same_hessian(const Surface& rest) {
  const auto shell = ShellEnergy::create(rest, ShellMaterial{});
  ASSERT_TRUE(shell);
  const Points x = rest.control_points() + 0.01 * testing::random_points(rest.size(), 5);
  const ShellStress stress = shell->stress(x);
  const SparseMatrix expected = with_threads(1, [&] { return shell->hessian(x, stress); });
  EXPECT_GT(expected.norm(), 0);
  for (const int threads : testing::thread_counts) {
    const SparseMatrix found = with_threads(threads, [&] { return shell->hessian(x, stress); });
    EXPECT_TRUE(
        std::equal(found.valuePtr(), found.valuePtr() + found.nonZeros(), expected.valuePtr()))
        << threads;
  }
}

TEST(ThreadsOfShells, DoNotChangeBits) {
  for (const int p : {2, 3, 4}) {
    expect_same_hessian(
        testing::relief(testing::uniform_clamped(p, 15), testing::uniform_clamped(p, 14), 7));
  }
  expect_same_hessian(
      testing::relief(testing::uniform_clamped(3, 9), testing::uniform_clamped(2, 13), 8, 0.1, 3));
  expect_same_hessian(
      testing::relief(testing::uniform_clamped(3, 40), testing::uniform_clamped(2, 1), 9));
}

}  // namespace
}  // namespace knead
