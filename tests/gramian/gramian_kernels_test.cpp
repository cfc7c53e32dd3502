// The recurrence and the Gauss kernels on every instruction set that this machine has.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>

#include "knead/gramian/gramian.hpp"
#include "support/knot_families.hpp"

namespace knead {
namespace {

/// Signed zeros count as equal, everything else must be the same bits.
bool same_bits(const BandMatrix& a, const BandMatrix& b) {
  for (int s = -a.half_bandwidth(); s <= a.half_bandwidth(); ++s) {
    for (std::size_t k = 0; k < a.diagonal(s).size(); ++k) {
      const double x = a.diagonal(s)[k], y = b.diagonal(s)[k];
      if (!(x == 0 && y == 0) && std::bit_cast<std::uint64_t>(x) != std::bit_cast<std::uint64_t>(y))
        return false;
    }
  }
  return true;
}

void expect_same_on_all(const KnotVector& knots, GramianMethod method) {
  GramianSet plain, other;
  recompute_gramians(knots, method, plain, InstructionSet::scalar);
  for (const InstructionSet set : available_instruction_sets()) {
    SCOPED_TRACE(std::string(name(set)) + ", " + std::string(name(method)));
    recompute_gramians(knots, method, other, set);
    EXPECT_TRUE(same_bits(plain.g00, other.g00)) << "G00";
    EXPECT_TRUE(same_bits(plain.g11, other.g11)) << "G11";
    EXPECT_TRUE(same_bits(plain.g22, other.g22)) << "G22";
    EXPECT_TRUE(same_bits(plain.g10, other.g10)) << "G10";
  }
}

TEST(GramianKernels, give_the_same_bits_on_every_instruction_set) {
  std::mt19937_64 random(20260101);
  for (const int p : testing::checked_degrees) {
    for (const auto& [name, knots] : testing::knot_families(p)) {
      SCOPED_TRACE(name);
      expect_same_on_all(knots, GramianMethod::recurrence);
      expect_same_on_all(knots, GramianMethod::gauss);
      expect_same_on_all(knots, GramianMethod::gauss_reduced);
    }
    for (int k = 0; k < 20; ++k)
      expect_same_on_all(testing::random_knots(random, p), GramianMethod::recurrence);
  }
}

TEST(GramianKernels, copy_rows_of_equal_spans_only_where_they_are_equal) {
  // Long runs of equal spans, some of them broken by another length or by a repeated knot at every
  // place of a vector.
  for (int p = 1; p <= 9; ++p) {
    for (int place = 60; place < 80; ++place) {
      std::vector<double> breaks;
      std::vector<int> multiplicity(150, 1);
      for (int k = 0; k < 150; ++k) breaks.push_back(k < place ? k : k + 0.5);
      if (place % 3 == 0) multiplicity[static_cast<std::size_t>(place)] = std::min(2, p + 1);
      const KnotVector knots = testing::clamped_knots(p, breaks, multiplicity);
      const GramianSet gauss = *gramians(knots, GramianMethod::gauss);
      for (const InstructionSet set : available_instruction_sets()) {
        GramianSet ours;
        recompute_gramians(knots, GramianMethod::recurrence, ours, set);
        EXPECT_LE((gauss.g00.dense() - ours.g00.dense()).cwiseAbs().maxCoeff(), 1e-14)
            << p << " " << place;
        EXPECT_LE((gauss.g10.dense() - ours.g10.dense()).cwiseAbs().maxCoeff(), 1e-14)
            << p << " " << place;
        EXPECT_LE((gauss.g22.dense() - ours.g22.dense()).cwiseAbs().maxCoeff(), 1e-12)
            << p << " " << place;
      }
    }
  }
}

TEST(GramianKernels, do_not_look_for_equal_spans_before_the_first_knot) {
  // Every span is equal, the ends included: only the number of rows ends the search.
  for (int p = 1; p <= 9; ++p) {
    for (int count = 30; count < 48; ++count) {
      std::vector<double> values;
      for (int k = 0; k < count + p + 1; ++k) values.push_back(k);
      const KnotVector knots = *KnotVector::create(p, values);
      const GramianSet gauss = *gramians(knots, GramianMethod::gauss);
      for (const InstructionSet set : available_instruction_sets()) {
        GramianSet ours;
        recompute_gramians(knots, GramianMethod::recurrence, ours, set);
        EXPECT_LE((gauss.g00.dense() - ours.g00.dense()).cwiseAbs().maxCoeff(), 1e-14)
            << p << " " << count;
        EXPECT_LE((gauss.g22.dense() - ours.g22.dense()).cwiseAbs().maxCoeff(), 1e-12)
            << p << " " << count;
      }
    }
  }
}

TEST(GramianKernels, write_nothing_but_the_band_into_storage_that_is_used_again) {
  const KnotVector large = testing::uniform_clamped(3, 40), small = testing::thesis_knots(3, 5);
  GramianSet set = *gramians(large);
  recompute_gramians(small, GramianMethod::recurrence, set);
  const GramianSet fresh = *gramians(small);
  EXPECT_TRUE(same_bits(fresh.g22, set.g22));
  const double* storage = set.g10.diagonal(0).data();
  recompute_gramians(small, GramianMethod::recurrence, set);
  EXPECT_EQ(set.g10.diagonal(0).data(), storage);
  EXPECT_TRUE(same_bits(fresh.g10, set.g10));
}

}  // namespace
}  // namespace knead
