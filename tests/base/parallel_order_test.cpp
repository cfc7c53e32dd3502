#include "base/parallel_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <stdexcept>
#include <vector>

#include "support/thread_counts.hpp"

namespace knead {
namespace {

using testing::with_threads;

/// Items whose children are 2k + 1 and 2k + 2, and what each finds its children to have summed up.
std::vector<long> sums(int items, const std::vector<int>& order, bool worth) {
  std::vector<std::array<int, 2>> children(static_cast<std::size_t>(items));
  for (int k = 0; k < items; ++k) children[static_cast<std::size_t>(k)] = {2 * k + 1, 2 * k + 2};
  const auto needs = [&](int k) {
    const int count = std::clamp(items - 2 * k - 1, 0, 2);
    return std::span(children[static_cast<std::size_t>(k)]).first(static_cast<std::size_t>(count));
  };
  std::vector<long> sum(static_cast<std::size_t>(items), 0);
  detail::parallel_in_order(order, sum.size(), worth, needs, [&](int k) {
    long all = k;
    for (const int child : needs(k)) all += sum[static_cast<std::size_t>(child)];
    sum[static_cast<std::size_t>(k)] += all;
  });
  return sum;
}

TEST(ParallelInOrder, DoesEveryItemOnceAfterWhatItNeeds) {
  constexpr int items = 500;
  std::vector<int> all(items);
  std::iota(all.rbegin(), all.rend(), 0);  // children first
  for (const int threads : testing::thread_counts) {
    for (const bool worth : {false, true}) {
      for (int round = 0; round < 20; ++round) {
        const auto sum = with_threads(threads, [&] { return sums(items, all, worth); });
        EXPECT_EQ(sum[0], items * (items - 1) / 2) << threads;
        EXPECT_EQ(sum[items - 1], items - 1) << threads;
      }
    }
  }
}

TEST(ParallelInOrder, DoesNotWaitForItemsThatAreNotThere) {
  const std::vector<int> some = {9, 4, 1,
                                 0};  // of 0 … 9, without 3, the other child of 1, and without 2
  for (const int threads : testing::thread_counts) {
    const auto sum = with_threads(threads, [&] { return sums(10, some, true); });
    EXPECT_EQ(sum, (std::vector<long>{14, 14, 0, 0, 13, 0, 0, 0, 0, 9})) << threads;
  }
  EXPECT_EQ(sums(3, {}, true), (std::vector<long>{0, 0, 0}));
}

TEST(ParallelInOrder, ThrowsWhatABodyThrowsAndBeginsNothingAfterIt) {
  std::vector<int> order(100);
  std::iota(order.begin(), order.end(), 0);
  for (const int threads : testing::thread_counts) {
    std::vector<int> before(100);
    for (int k = 0; k < 100; ++k) before[static_cast<std::size_t>(k)] = k - 1;
    std::vector<char> done(100, 0);
    const auto run = [&] {
      detail::parallel_in_order(
          order, order.size(), true,
          [&](int k) {
            return std::span(before).subspan(static_cast<std::size_t>(k), k > 0 ? 1 : 0);
          },
          [&](int k) {
            if (k == 40) throw std::runtime_error("forty");
            done[static_cast<std::size_t>(k)] = 1;
          });
      return 0;
    };
    EXPECT_THROW(with_threads(threads, run), std::runtime_error) << threads;
    EXPECT_EQ(std::ranges::count(done, 1), 40) << threads;
  }
}

TEST(ParallelInOrder, RunsInOneThreadWithinSharedWork) {
  std::vector<int> all = {6, 5, 4, 3, 2, 1, 0};
  std::vector<long> first(8, 0);
  with_threads(3, [&] {
    detail::parallel_for(8, 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (; begin < end; ++begin) first[static_cast<std::size_t>(begin)] = sums(7, all, true)[0];
    });
    return 0;
  });
  EXPECT_EQ(first, std::vector<long>(8, 21));
}

}  // namespace
}  // namespace knead
