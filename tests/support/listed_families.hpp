#pragma once

#include <array>

#include "support/knot_families.hpp"

/// Random knot vectors of one named family each, for statements that hold family by family.
namespace knead::testing {

inline constexpr std::array listed_families = {
    "uniform",         "random",           "growing tenfold", "shrinking tenfold", "thesis",
    "cluster of 1e-8", "cluster of 1e-13", "knots near 1e6",  "one repeated knot", "repeated knots",
    "one span",        "unclamped"};

/// A random member of `listed_families[family]`, all its numbers drawn from `random`.
inline KnotVector random_member(std::mt19937_64& random, int p, std::size_t family) {
  const auto real = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  const auto integer = [&](int a, int b) {
    return std::uniform_int_distribution<int>(a, b)(random);
  };
  const std::string name = listed_families.at(family);
  const int spans = integer(2, 12);
  std::vector<double> lengths;
  for (int k = 0; k < spans; ++k)
    lengths.push_back(-std::log(real(1e-6, 1)));  // exponential: short beside long

  if (name == "uniform") {
    const double h = std::pow(10.0, real(-3, 3));
    std::fill(lengths.begin(), lengths.end(), h);
    return clamped_knots(p, breaks_of(lengths, integer(-5, 5) * h));
  }
  if (name == "growing tenfold" || name == "shrinking tenfold") {
    double length = std::pow(10.0, real(-8, -2));
    for (double& l : lengths) l = length *= 10;
    if (name == "shrinking tenfold") std::ranges::reverse(lengths);
    return clamped_knots(p, breaks_of(lengths));
  }
  if (name == "thesis") return thesis_knots(p, integer(0, 10), real(0.1, 10));
  if (name.starts_with("cluster")) {
    const double gap = name == "cluster of 1e-8" ? 1e-8 : 1e-13;
    std::vector<double> around;
    const int at = integer(1, spans), size = integer(2, p + 2);
    for (int k = 0; k < spans; ++k) {
      if (k + 1 == at)
        around.insert(around.end(), static_cast<std::size_t>(size), gap * real(0.5, 1.5));
      around.push_back(lengths[static_cast<std::size_t>(k)]);
    }
    return clamped_knots(p, breaks_of(around, real(-0.5, 0.5)));
  }
  if (name == "knots near 1e6")
    return clamped_knots(p, breaks_of(lengths, integer(0, 1) == 0 ? 1e6 : -1e6));
  if (name == "one repeated knot" || name == "repeated knots") {
    std::vector<int> multiplicity(lengths.size() + 1, 1);
    if (name == "one repeated knot") {
      multiplicity[static_cast<std::size_t>(integer(1, spans - 1))] = integer(2, p + 1);
    } else {
      for (int& m : multiplicity) m = integer(1, p + 1);
    }
    return clamped_knots(p, breaks_of(lengths), multiplicity);
  }
  if (name == "one span") {
    const double start = real(-1, 1) * std::pow(10.0, integer(-3, 6));
    return clamped_knots(p, {start, start + std::pow(10.0, real(-6, 6))});
  }
  if (name == "unclamped") {
    for (int k = 0; k < 2 * p; ++k)
      lengths.push_back(integer(0, 5) == 0 ? 0 : -std::log(real(1e-6, 1)));
    std::ranges::shuffle(lengths, random);
    lengths[static_cast<std::size_t>(p)] = 1;  // the domain is not empty
    std::vector<double> knots = breaks_of(lengths);
    int run = 1;  // no knot more often than p + 1 times
    for (std::size_t k = 1; k < knots.size(); ++k) {
      run = knots[k] == knots[k - 1] ? run + 1 : 1;
      if (run <= p + 1) continue;
      for (std::size_t l = k; l < knots.size(); ++l) knots[l] += 0.5;
      run = 1;
    }
    return make_knots(p, std::move(knots));
  }
  return clamped_knots(p, breaks_of(lengths, real(-2, 2)));  // random
}

}  // namespace knead::testing
