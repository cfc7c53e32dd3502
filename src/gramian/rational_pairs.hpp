#pragma once

#include <span>
#include <vector>

#include "knead/gramian/band_matrix.hpp"
#include "rational_elements.hpp"
#include "rational_rule.hpp"
#include "simd/rational_kernels.hpp"

namespace knead::detail {

/// ∂^a R_I ∂^b R_J at Gauss points, summed over the pairs of functions of a piece.
template <int D>
class PairSums {
 public:
  PairSums(MultiIndex<D> a, MultiIndex<D> b, std::size_t functions)
      : a_(static_cast<std::size_t>(multi_index_position<D>(a)) * functions),
        b_(static_cast<std::size_t>(multi_index_position<D>(b)) * functions),
        functions_(functions),
        lower_(functions * functions),
        upper_(a == b ? 0 : functions * functions) {}

  void clear() {
    std::ranges::fill(lower_, 0.0);
    std::ranges::fill(upper_, 0.0);
  }
  [[nodiscard]] double operator()(std::size_t i, std::size_t j) const {
    return i >= j || a_ == b_ ? lower_[std::max(i, j) + std::min(i, j) * functions_]
                              : upper_[j + i * functions_];
  }

  /// Adds the rule with these points. False: the denominator is not positive.
  [[nodiscard]] bool add_rule(const RationalPiece<D>& piece, const std::array<int, D>& points) {
    RationalLine<D> line{{}, {}};
    for (std::size_t d = 0; d < D; ++d) {
      points_[d].tabulate(piece.axis(d), points[d], d + 1 == D);
      line.points[d] = &points_[d];
    }
    values_.resize(RationalPiece<D>::orders * functions_ * line.size());
    for (;;) {
      if (!piece.evaluate(line, RationalPiece<D>::orders, values_.data())) return false;
      add_line(line);
      if (!line.next()) return true;
    }
  }

 private:
  void add_line(const RationalLine<D>& line) {
    const std::size_t n = line.size();
    const auto points = static_cast<std::ptrdiff_t>(n),
               functions = static_cast<std::ptrdiff_t>(functions_);
    const double outer = line.outer_weight();
    factors_.resize(n);
    for (std::size_t g = 0; g < n; ++g) factors_[g] = outer * line.points[D - 1]->weights[g];
    weighted_.resize(functions_ * n);
    const double* second = values_.data() + b_ * n;
    kernels_.scale(factors_.data(), values_.data() + a_ * n, functions, points, points,
                   weighted_.data());
    kernels_.lower_products(weighted_.data(), second, points, points, functions, lower_.data());
    if (a_ != b_)
      kernels_.lower_products(second, weighted_.data(), points, points, functions, upper_.data());
  }

  std::size_t a_, b_, functions_;
  std::array<RationalPoints, D> points_;
  std::vector<double, CacheLineAllocator<double>> values_,
      weighted_;  // vectors do not straddle cache lines
  std::vector<double> factors_;
  /// The sum of functions i >= j at [i + j functions], of i < j at [j + i functions]; for equal
  /// orders both are lower_.
  std::vector<double> lower_, upper_;
  const RationalKernels& kernels_ = rational_kernels();
};

/// The rule that keeps the error of every pair within a bound.
template <int D>
class PairRule {
 public:
  PairRule(MultiIndex<D> a, MultiIndex<D> b, std::size_t functions)
      : a_(a),
        b_(b),
        functions_(functions),
        rule_(RationalPiece<D>::orders),
        sums_(a, b, functions) {}

  /// The sums over one element. False: no halving gave the denominator a positive bound.
  [[nodiscard]] bool integrate(const RationalPiece<D>& piece, double allowed) {
    sums_.clear();
    error_ = 0;
    return rule_.integrate(
        piece, allowed,
        [&](const double* bounds, std::size_t, double) {
          return largest(bounds, a_) * largest(bounds, b_);
        },
        [&](const RationalPiece<D>& part, const std::array<int, D>& points, double error) {
          error_ += error;
          return sums_.add_rule(part, points);
        });
  }
  [[nodiscard]] const PairSums<D>& sums() const { return sums_; }
  [[nodiscard]] double error() const { return error_; }
  [[nodiscard]] int pieces() const { return rule_.pieces(); }
  [[nodiscard]] int largest_points() const { return rule_.largest_points(); }

 private:
  [[nodiscard]] double largest(const double* bounds, MultiIndex<D> order) const {
    const double* from =
        bounds + static_cast<std::size_t>(multi_index_position<D>(order)) * functions_;
    return *std::max_element(from, from + functions_);
  }

  MultiIndex<D> a_, b_;
  std::size_t functions_;
  RationalRule<D> rule_;
  PairSums<D> sums_;
  double error_ = 0;
};

/// G^oo_II of all functions, to a thousandth of the largest or so. `count`: how many functions.
template <int D>
[[nodiscard]] std::vector<double> diagonal_of_pairs(RationalElements<D>& elements,
                                                    std::size_t count, MultiIndex<D> order) {
  std::vector<double> diagonal(count, 0.0);
  const auto add = [&](const PairSums<D>& local) {
    for (std::size_t k = 0; k < elements.functions(); ++k) {
      diagonal[static_cast<std::size_t>(elements.rows()[k])] += local(k, k);
    }
  };
  PairSums<D> local(order, order, elements.functions());
  elements.for_each([&](const RationalPiece<D>& piece) {
    std::array<int, D> points;
    for (std::size_t d = 0; d < D; ++d) points[d] = std::max(8, piece.axis(d).degree() + 2);
    local.clear();
    if (!local.add_rule(piece, points)) return false;
    add(local);
    return true;
  });
  // A few points see nothing of a peak between them.
  const double rough = *std::ranges::max_element(diagonal);
  if (!(rough > 0)) return diagonal;
  std::ranges::fill(diagonal, 0.0);
  PairRule<D> rule(order, order, elements.functions());
  elements.for_each([&](const RationalPiece<D>& piece) {
    if (!rule.integrate(piece, 1e-3 * rough / static_cast<double>(elements.functions())))
      return false;
    add(rule.sums());
    return true;
  });
  return diagonal;
}

/// max_I √(G^aa_II G^bb_II): the size to which a tolerance is relative.
template <int D>
[[nodiscard]] double size_of_pairs(RationalElements<D>& elements, std::size_t count,
                                   MultiIndex<D> a, MultiIndex<D> b) {
  const std::vector<double> first = diagonal_of_pairs<D>(elements, count, a),
                            second = a == b ? first : diagonal_of_pairs<D>(elements, count, b);
  double largest = 0;
  for (std::size_t k = 0; k < count; ++k)
    largest = std::max(largest, std::sqrt(first[k] * second[k]));
  return largest;
}

/// Errors of the public functions.
[[nodiscard]] Expected<void> check_rational(std::span<const double> weights, int count,
                                            std::array<int, 2> a, std::array<int, 2> b,
                                            double tolerance);
[[nodiscard]] std::unexpected<Error> no_lower_bound();

}  // namespace knead::detail
