#include "base/large_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace knead {
namespace {

TEST(LargeMemory, ReservedHoldsWhatWasThere) {
  for (const std::size_t count :
       {std::size_t{0}, std::size_t{1}, std::size_t{1} << 19U, std::size_t{3} << 20U}) {
    std::vector<double> items = {1, 2, 3};
    detail::reserve_large(items, count);
    EXPECT_GE(items.capacity(), count);
    EXPECT_EQ(items, (std::vector<double>{1, 2, 3}));
    items.resize(std::max<std::size_t>(count, 3), 7);
    EXPECT_EQ(items[2], 3);
    EXPECT_TRUE(std::all_of(items.begin() + 3, items.end(), [](double x) { return x == 7; }));
  }
}

TEST(LargeMemory, StringsStayEmpty) {
  std::string text;
  detail::reserve_large(text, std::size_t{20} << 20U);
  EXPECT_EQ(text, "");
  text.resize(std::size_t{20} << 20U, 'x');
  EXPECT_EQ(std::ranges::count(text, 'x'), std::ptrdiff_t{20} << 20U);
}

}  // namespace
}  // namespace knead
