#include "bench/judge.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace knead::bench {
namespace {

using Sentences = std::vector<std::string>;

TEST(UnexpectedCounts, ThoseWithinTheShareAreFine) {
  EXPECT_EQ(unexpected_counts({{"a", 1000}, {"b", 2000}}, {{"a", 1030}, {"b", 1940}}, 0.03),
            Sentences{});
}

TEST(UnexpectedCounts, MoreAndFewerInstructionsAreNamed) {
  const Measured expected = {{"a", 1000}, {"b", 1000}, {"c", 1000}},
                 counted = {{"a", 1031}, {"b", 969}, {"c", 1000}};
  EXPECT_EQ(unexpected_counts(expected, counted, 0.03),
            (Sentences{"a: 1031 instructions instead of 1000, +3.1 %",
                       "b: 969 instructions instead of 1000, -3.1 %"}));
}

TEST(UnexpectedCounts, AKernelThatIsMissingOrNewIsNamed) {
  EXPECT_EQ(unexpected_counts({{"old", 5}}, {{"new", 6}}, 0.03),
            (Sentences{"old: not counted", "new: 6, and none expected"}));
}

TEST(UnexpectedCounts, ACountThatIsNoNumberIsNamed) {
  EXPECT_EQ(
      unexpected_counts({{"a", 5}}, {{"a", std::numeric_limits<double>::quiet_NaN()}}, 0.03).size(),
      1U);
}

TEST(SlowerInEveryRound, OneRoundThatDoesNotConfirmAcquits) {
  const Measured base[] = {{{"a", 10}, {"b", 10}}, {{"a", 10}, {"b", 10}}, {{"a", 10}, {"b", 10}}};
  const Measured head[] = {
      {{"a", 12}, {"b", 12}}, {{"a", 12}, {"b", 10.5}}, {{"a", 11.5}, {"b", 12}}};
  EXPECT_EQ(slower_in_every_round(base, head, 0.1), Sentences{"a"});
}

TEST(SlowerInEveryRound, TimesAreComparedWithTheirOwnRound) {
  // The machine is twice as slow in the second round, for both.
  const Measured base[] = {{{"a", 10}}, {{"a", 20}}};
  const Measured head[] = {{{"a", 10}}, {{"a", 20}}};
  EXPECT_EQ(slower_in_every_round(base, head, 0.1), Sentences{});
}

TEST(SlowerInEveryRound, ExactlyTheShareIsAllowedAndFasterNeverComplainedOf) {
  const Measured base[] = {{{"a", 100}, {"b", 100}}};
  const Measured head[] = {{{"a", 110}, {"b", 1}}};
  EXPECT_EQ(slower_in_every_round(base, head, 0.1), Sentences{});
}

TEST(SlowerInEveryRound, WhatOneSideLacksIsNotJudged) {
  const Measured base[] = {{{"gone", 1}}, {{"a", 1}}};
  const Measured head[] = {{{"new", 9}, {"a", 9}}, {{"new", 9}, {"a", 9}}};
  EXPECT_EQ(slower_in_every_round(base, head, 0.1), Sentences{});
  EXPECT_EQ(slower_in_every_round({}, head, 0.1), Sentences{});
}

}  // namespace
}  // namespace knead::bench
