#include "figures/roofline.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "knead/energy/stiffness.hpp"

namespace knead::figures {
namespace {

const RooflineKernel& kernel(const std::vector<RooflineKernel>& all, const std::string& name) {
  const auto found = std::ranges::find(all, name, &RooflineKernel::name);
  EXPECT_NE(found, all.end()) << name;
  return *found;
}

TEST(Roofline, CountsWhatIsWrittenAndRead) {
  const auto all = roofline_kernels(10, 12);
  EXPECT_EQ(kernel(all, "points on a grid").bytes, 100 * 24);
  EXPECT_EQ(kernel(all, "and first derivatives").bytes, 100 * 72);
  // K of 12 × 12 cubic functions: 12 · 7 − 12 entries in each direction.
  EXPECT_EQ(kernel(all, "K refreshed").bytes, 72 * 72 * 8);
  EXPECT_EQ(kernel(all, "K assembled times three columns").bytes, 72 * 72 * 12 + 144 * 48);
  EXPECT_EQ(kernel(all, "K applied, not assembled").bytes, 144 * 48);
}

TEST(Roofline, CountsTheOperationsOfLoops) {
  const auto all = roofline_kernels(10, 12);
  // A multiplication and an addition per entry and column.
  EXPECT_EQ(kernel(all, "K assembled times three columns").operations, 72 * 72 * 6);
  // At every u the 32 × 3 numbers of four lines, then four terms for every coordinate of a point: 7
  // operations each.
  EXPECT_EQ(kernel(all, "points on a grid").operations, 10 * 96 * 7 + 100 * 3 * 7);
}

TEST(Roofline, EveryKernelRuns) {
  for (const RooflineKernel& k : roofline_kernels(10, 12)) {
    EXPECT_GT(k.operations, 0) << k.name;
    k.run();
  }
}

}  // namespace
}  // namespace knead::figures
