#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "figures/thesis_knots.hpp"
#include "knead/spline/knot_vector.hpp"

/// Families of knot vectors, so that every algorithm meets every kind of input: `knot_families(p)`
/// is all of them, and each family stands alone too. `random_knots` draws one of any kind.
namespace knead::testing {

/// Every degree of the kernels, and some above: for what is slow to check.
inline const std::vector<int> checked_degrees = {1,  2,  3,  4,  5,  6,  7,  8,  9,
                                                 10, 11, 12, 13, 14, 15, 16, 20, 25};

struct NamedKnots {
  std::string name;
  KnotVector knots;

  /// No short spans beside long ones: what a method must manage that loses digits as spans shrink.
  [[nodiscard]] bool ordinary() const {
    return name.find("cluster") == name.npos && name.find("tenfold") == name.npos &&
           name.find("thesis") == name.npos;
  }
};

inline KnotVector make_knots(int degree, std::vector<double> knots) {
  auto made = KnotVector::create(degree, std::move(knots));
  if (!made) ADD_FAILURE() << made.error().message();
  return std::move(*made);
}

/// Clamped: first and last break p + 1 times, break k in between `multiplicity[k]` times (once
/// where it is empty).
inline KnotVector clamped_knots(int degree, const std::vector<double>& breaks,
                                std::vector<int> multiplicity = {}) {
  multiplicity.resize(breaks.size(), 1);
  multiplicity.front() = multiplicity.back() = degree + 1;
  std::vector<double> knots;
  for (std::size_t k = 0; k < breaks.size(); ++k) {
    knots.insert(knots.end(), static_cast<std::size_t>(multiplicity[k]), breaks[k]);
  }
  return make_knots(degree, std::move(knots));
}

/// Breaks 0, l_0, l_0 + l_1, …
inline std::vector<double> breaks_of(const std::vector<double>& lengths, double start = 0) {
  std::vector<double> breaks{start};
  for (const double length : lengths) breaks.push_back(breaks.back() + length);
  return breaks;
}

inline KnotVector uniform_clamped(int degree, int spans) {
  return clamped_knots(degree,
                       breaks_of(std::vector<double>(static_cast<std::size_t>(spans), 1.0)));
}

/// Knots 0, 1, 2, …: not clamped, domain of `spans` spans.
inline KnotVector uniform_unclamped(int degree, int spans) {
  std::vector<double> knots(static_cast<std::size_t>(spans + 2 * degree + 1));
  for (std::size_t i = 0; i < knots.size(); ++i) knots[i] = static_cast<double>(i);
  return make_knots(degree, std::move(knots));
}

/// Knot differences repeat with the period of the domain: the first and the last p functions join
/// smoothly.
inline KnotVector periodic(int degree, const std::vector<double>& lengths) {
  const int count = static_cast<int>(lengths.size());
  std::vector<double> knots{0};
  for (int k = 0; k < count + 2 * degree; ++k) {
    knots.push_back(knots.back() +
                    lengths[static_cast<std::size_t>(((k - degree) % count + count) % count)]);
  }
  return make_knots(degree, std::move(knots));
}

using figures::thesis_knots;  // 0 … 13 with 7 replaced by 6 + 10^-r

inline std::vector<NamedKnots> knot_families(int p) {
  std::vector<NamedKnots> families;
  const auto add = [&](std::string name, KnotVector knots) {
    families.push_back({"p=" + std::to_string(p) + " " + std::move(name), std::move(knots)});
  };
  add("one span", clamped_knots(p, {0, 1}));
  add("one short span far away", clamped_knots(p, {1e6, 1e6 + 1e-4}));
  add("uniform", uniform_clamped(p, 9));
  add("uniform unclamped", uniform_unclamped(p, 7));
  add("periodic", periodic(p, {1, 0.5, 2, 0.25, 3}));
  add("periodic with fewer spans than the degree", periodic(p, {1, 0.5}));
  add("negative", clamped_knots(p, {-3, -2.5, -1, -0.125, 0, 0.75}));

  std::vector<double> growing, shrinking;
  for (int k = 0; k < 8; ++k)
    growing.push_back(std::pow(10.0, k - 4)), shrinking.push_back(std::pow(10.0, 4 - k));
  add("spans growing tenfold", clamped_knots(p, breaks_of(growing)));
  add("spans shrinking tenfold", clamped_knots(p, breaks_of(shrinking)));

  for (int r = 0; r <= 10; ++r) add("thesis r=" + std::to_string(r), thesis_knots(p, r));
  for (const double gap : {1e-8, 1e-13}) {
    std::vector<double> breaks{0, 1, 2};
    for (int k = 1; k <= std::min(p, 5); ++k) breaks.push_back(2 + k * gap);
    breaks.insert(breaks.end(), {3, 4});
    add(gap > 1e-10 ? "cluster of 1e-8" : "cluster of 1e-13", clamped_knots(p, breaks));
  }
  {
    std::vector<double> breaks;
    for (int k = 0; k < 9; ++k) breaks.push_back(1e6 + 0.37 * k);
    add("around 1e6", clamped_knots(p, breaks));
  }
  for (int m = 2; m <= p + 1; ++m) {
    const std::string times = " of multiplicity " + std::to_string(m);
    add("one knot" + times, clamped_knots(p, {0, 1, 2.5, 3, 4.5, 5}, {0, 1, 1, m, 1, 0}));
    add("neighbouring knots" + times, clamped_knots(p, {0, 1, 2.5, 3, 4.5, 5}, {0, 1, m, m, m, 0}));
    add("all knots" + times, clamped_knots(p, {0, 1, 1.25, 3}, {0, m, m, 0}));
  }
  {
    // Not clamped, with repetitions inside, at one end of the domain and outside of it.
    std::vector<double> knots;
    for (int i = 0; i <= 2 * p + 7; ++i)
      knots.push_back(std::floor(i / 2.0) + (i % 3 == 0 ? 0 : 0.25));
    std::ranges::sort(knots);
    add("unclamped with repetitions", make_knots(p, knots));
    if (p >= 2) {
      std::vector<double> half(static_cast<std::size_t>(p),
                               0.0);  // multiplicity p at the start: not quite clamped
      for (int i = 0; i <= p + 4; ++i) half.push_back(1 + i * i / 4.0);
      add("almost clamped at the start", make_knots(p, half));
    }
  }
  {
    std::vector<double> knots(static_cast<std::size_t>(p + 1), 0.0);
    for (int i = 1; i <= p + 4; ++i) knots.push_back(i * 0.7);
    add("clamped at the start only", make_knots(p, knots));
  }
  return families;
}

/// A random knot vector: spans uniform, exponential, log-uniform over ten decades, or clustered;
/// multiplicities mostly 1 and up to p + 1; ends clamped or not.
inline KnotVector random_knots(std::mt19937_64& random, int p) {
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  const auto integer = [&](int a, int b) {
    return std::uniform_int_distribution<int>(a, b)(random);
  };
  const int kind = integer(0, 4), spans = integer(1, 12), repeats = integer(0, 3);
  double u = integer(0, 5) == 0 ? uniform(-1e6, 1e6) : uniform(-2, 2);
  const auto length = [&] {
    switch (kind) {
      case 0:
        return uniform(0.5, 1.5);
      case 1:
        return -std::log(uniform(1e-12, 1));
      case 2:
        return std::pow(10.0, uniform(-5, 5));
      case 3:
        return integer(0, 1) == 0 ? uniform(0.5, 1.5) : 1e-8 * uniform(0.5, 1.5);
      default:
        return static_cast<double>(integer(1, 3));
    }
  };
  const auto next = [&](double from) {
    const double to = from + length();
    return to > from ? to : std::nextafter(from, from + 1e9);  // a step lost in rounding is one ulp
  };
  const bool clamped_start = integer(0, 3) != 0, clamped_end = integer(0, 3) != 0;
  std::vector<double> knots(clamped_start ? static_cast<std::size_t>(p + 1) : 1, u);
  if (!clamped_start) {
    for (int i = 0; i < p; ++i) knots.push_back(u = next(u));
  }
  for (int k = 1; k < spans; ++k) {
    u = next(u);
    knots.insert(
        knots.end(),
        static_cast<std::size_t>(repeats == 0 && integer(0, 2) == 0 ? integer(1, p + 1) : 1), u);
  }
  u = next(u);
  knots.insert(knots.end(), clamped_end ? static_cast<std::size_t>(p + 1) : 1, u);
  if (!clamped_end) {
    for (int i = 0; i < p; ++i) knots.push_back(u = next(u));
  }
  return make_knots(p, std::move(knots));
}

}  // namespace knead::testing
