#include "varying_by_impulses.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "knead/gramian/triple_gramian.hpp"

namespace knead::examples {
namespace {

struct Case {
  KnotVector knots, coefficient_knots;
  std::vector<double> coefficients;
};

Case random_case(int degree, std::mt19937& random, bool multiple) {
  std::uniform_real_distribution<double> spacing(0.5, 1.5), value(0.5, 3);
  std::vector<double> knots(static_cast<std::size_t>(degree + 1), 0.0);
  double u = 0;
  for (int k = 0; k < 5; ++k) {
    u += spacing(random);
    knots.insert(knots.end(), static_cast<std::size_t>(multiple && k == 2 ? degree : 1), u);
  }
  u += spacing(random);
  knots.insert(knots.end(), static_cast<std::size_t>(degree + 1), u);
  const auto coarse = *KnotVector::clamped_uniform(2, 6, 0, u);
  std::vector<double> c;
  for (int k = 0; k < coarse.count(); ++k) c.push_back(value(random));
  return {*KnotVector::create(degree, knots), coarse, c};
}

/// The largest error of any entry, of the largest entry.
double error_of(const Case& k, StepTimesImpulse reading) {
  const auto triple = *triple_gramian(k.coefficient_knots, k.knots, 0, 0);
  const BandMatrix exact = triple.contract(k.coefficients);
  double error = 0, largest = 0;
  for (int i = 0; i < k.knots.count(); ++i) {
    for (int j = std::max(0, i - k.knots.degree()); j <= i; ++j) {
      largest = std::max(largest, std::abs(exact(i, j)));
      error = std::max(error, std::abs(varying_by_impulses(k.knots, i, j, k.coefficient_knots,
                                                           k.coefficients, reading) -
                                       exact(i, j)));
    }
  }
  return error / largest;
}

TEST(VaryingByImpulses, IsTheTripleGramianWithTheMeanOfTheLimits) {
  std::mt19937 random(5);
  for (const auto& [degree, bound] : {std::pair{1, 1e-13}, {2, 1e-10}, {3, 1e-8}}) {
    for (const bool multiple : {false, true}) {
      for (int k = 0; k < 10; ++k) {
        EXPECT_LT(error_of(random_case(degree, random, multiple), StepTimesImpulse::mean), bound)
            << degree;
      }
    }
  }
}

TEST(VaryingByImpulses, IsWrongWithOneOfTheLimits) {
  std::mt19937 random(6);
  for (const int degree : {1, 2, 3}) {
    for (int k = 0; k < 5; ++k) {
      EXPECT_GT(error_of(random_case(degree, random, false), StepTimesImpulse::after), 0.1)
          << degree;
    }
  }
}

TEST(VaryingByImpulses, LosesDigitsAsTheDegreeGrowsWhereTripleGramiansDoNot) {
  std::mt19937 random(7);
  double before = 0;
  for (const int degree : {1, 3, 5}) {
    double error = 0;
    for (int k = 0; k < 5; ++k)
      error = std::max(error, error_of(random_case(degree, random, false), StepTimesImpulse::mean));
    EXPECT_GT(error, 10 * before) << degree;
    before = error;
  }
}

}  // namespace
}  // namespace knead::examples
