#include "knead/base/instruction_set.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace knead {
namespace {

TEST(InstructionSet, HoldsAtLeastThePortableOnesSlowestFirst) {
  const auto& sets = available_instruction_sets();
  ASSERT_GE(sets.size(), 2u);
  EXPECT_EQ(sets.front(), InstructionSet::scalar);
  EXPECT_EQ(sets[1], InstructionSet::vector128);
  EXPECT_TRUE(std::ranges::is_sorted(sets));
}

TEST(InstructionSet, TheFastestIsTheDefaultUnlessTheEnvironmentNamesOne) {
  const auto& sets = available_instruction_sets();
  const char* wanted = std::getenv("KNEAD_INSTRUCTION_SET");
  const auto named =
      std::ranges::find(sets, std::string_view(wanted != nullptr ? wanted : ""), name);
  EXPECT_EQ(best_instruction_set(), named != sets.end() ? *named : sets.back());
}

}  // namespace
}  // namespace knead
