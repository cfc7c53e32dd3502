#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "energy/simd/shell_kernels.hpp"
#include "knead/energy/shell_energy.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

using detail::ShellBlockShape;
using detail::ShellKernels;

std::vector<double> random_numbers(std::ptrdiff_t count, unsigned seed, double from, double to) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> number(from, to);
  std::vector<double> result(static_cast<std::size_t>(ShellBlockShape::lanes * count));
  for (double& r : result) r = number(engine);
  return result;
}

/// All that the kernels of one set give for a block of random elements.
std::vector<double> results_of(const ShellKernels& kernels, const ShellBlockShape& shape) {
  const auto u = random_numbers(3 * shape.points[0] * shape.functions[0], 1, -1, 1);
  const auto v = random_numbers(3 * shape.points[1] * shape.functions[1], 2, -1, 1);
  const auto rest = random_numbers(ShellBlockShape::rest_numbers * shape.gauss(), 3, 0.1, 1);
  const auto quotient =
      random_numbers(ShellBlockShape::quotient_numbers * shape.gauss(), 4, 0.1, 1);
  const auto x = random_numbers(3 * shape.local(), 5, -1, 1);
  std::vector<double> work(static_cast<std::size_t>(shape.work()));
  auto parts = random_numbers(2, 6, 0, 1), force = random_numbers(3 * shape.local(), 7, 0, 1);
  auto stress = random_numbers(6 * shape.gauss(), 8, 0, 1);
  auto hessian =
      random_numbers(9 * shape.functions[0] * shape.functions[0] * shape.pairs(), 9, 0, 1);
  const detail::ShellBlockData data{
      {u.data(), v.data()}, rest.data(), shape.rational ? quotient.data() : nullptr};
  kernels.forces(shape, data, x.data(), work.data(), parts.data(), force.data(), stress.data());
  kernels.hessian(shape, data, x.data(), stress.data(), work.data(), hessian.data());
  for (const auto& part : {force, stress, hessian})
    parts.insert(parts.end(), part.begin(), part.end());
  return parts;
}

TEST(ShellKernels, AllInstructionSetsGiveTheSameBits) {
  if (detail::avx2_shell_kernels == nullptr || best_instruction_set() < InstructionSet::avx2) {
    GTEST_SKIP() << "this machine has no AVX2";
  }
  for (const bool rational : {false, true}) {
    for (const ShellBlockShape& shape :
         {ShellBlockShape{{4, 4}, {4, 4}, rational}, ShellBlockShape{{3, 6}, {2, 5}, rational}}) {
      EXPECT_EQ(results_of(*detail::avx2_shell_kernels, shape),
                results_of(*detail::vector128_shell_kernels, shape));
    }
  }
}

TEST(ShellEnergy, AtRestIsZeroToTheLastBit) {
  for (const Surface& rest :
       {testing::relief(testing::uniform_clamped(3, 6), testing::uniform_clamped(2, 5), 1),
        testing::relief(testing::uniform_clamped(2, 3), testing::uniform_clamped(4, 3), 2, 0.1,
                        3)}) {
    const auto shell = ShellEnergy::create(rest, {3, 0.3, 0.05, 1});
    ASSERT_TRUE(shell);
    EXPECT_EQ(shell->energy(rest.control_points()).sum(), 0);
    EXPECT_EQ(shell->gradient(rest.control_points()).norm(), 0);
    EXPECT_EQ(shell->stress(rest.control_points()).norm(), 0);
  }
}

}  // namespace
}  // namespace knead
