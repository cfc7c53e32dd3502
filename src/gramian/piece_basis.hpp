#pragma once

#include <vector>

#include "knead/spline/knot_vector.hpp"
#include "simd/piece_kernels.hpp"
#include "unit_gauss.hpp"

namespace knead::detail {

static_assert(max_piece_degree == max_degree);

[[nodiscard]] constexpr std::ptrdiff_t padded_for_pieces(std::ptrdiff_t n) {
  return (n + PieceKernels::step - 1) / PieceKernels::step * PieceKernels::step;
}

/// The Gauss points of a piece, as many as the kernels want: the last ones are repetitions, which
/// nothing reads.
struct PiecePoints {
  std::vector<double> t, complement, weights;
  std::ptrdiff_t count;  ///< without repetitions

  explicit PiecePoints(int points) : count(points) {
    const UnitGaussRule<double> rule = unit_gauss<double>(points);
    const auto size = static_cast<std::size_t>(padded_for_pieces(points));
    t.assign(rule.t.begin(), rule.t.end());
    complement.assign(rule.complement.begin(), rule.complement.end());
    weights.assign(rule.weights.begin(), rule.weights.end());
    t.resize(size, t.back());
    complement.resize(size, complement.back());
    weights.resize(size, 0.0);
  }
  [[nodiscard]] std::ptrdiff_t padded() const { return static_cast<std::ptrdiff_t>(t.size()); }
};

/// One derivative of the functions of a knot vector at the Gauss points of one piece after the
/// other. Like `span_basis`, with reciprocals of distances that are made once for all pieces.
class PieceBasis {
 public:
  /// Knots, points and kernels must outlive it.
  PieceBasis(const KnotVector& knots, int order, const PiecePoints& points,
             const PieceKernels& kernels)
      : knots_(knots),
        points_(points),
        kernels_(kernels),
        order_(order),
        width_(padded_for_pieces(functions())) {
    const auto p = static_cast<std::size_t>(knots.degree());
    const std::span<const double> x = knots.knots();
    left_.resize(p + 1);
    right_.resize(p + 1);
    values_.resize((p + 1) * points.t.size());
    by_points_.resize(static_cast<std::size_t>(width_) * points.t.size());
    if (order > knots.degree()) return;  // zero everywhere
    reciprocal_.resize(p * x.size());
    for (std::size_t q = 1; q <= p; ++q) {
      double* row = reciprocal_.data() + (q - 1) * x.size();
      for (std::size_t i = 0; i + q < x.size(); ++i) {
        const double distance = x[i + q] - x[i];
        row[i] = distance > 0 ? 1 / distance : 0;  // no span lies in an empty support
      }
    }
  }

  /// Functions span − p … span at the points of [lower, upper], a part of that span.
  void enter(int span, double lower, double upper) {
    const int p = knots_.degree();
    if (order_ > p) return;
    for (int q = 1; q <= p; ++q) {
      left_[static_cast<std::size_t>(q)] = lower - knots_[span + 1 - q];
      right_[static_cast<std::size_t>(q)] = knots_[span + q] - upper;
    }
    // Function r of degree q − 1 on the span begins at knot span + 1 − q + r: one less in every
    // row.
    const auto knots = static_cast<std::ptrdiff_t>(knots_.knots().size());
    kernels_.basis(
        {left_.data(), right_.data(), reciprocal_.data() + span, knots - 1, upper - lower}, p,
        order_, points_.t.data(), points_.complement.data(), points_.padded(), values_.data());
  }

  [[nodiscard]] int functions() const { return knots_.degree() + 1; }
  /// Function by function.
  [[nodiscard]] const double* values() const { return values_.data(); }
  /// Point by point, `width()` numbers each, the last of them zeros.
  [[nodiscard]] const double* by_points() {
    for (std::ptrdiff_t r = 0; r < functions(); ++r) {
      const double* from = values_.data() + r * points_.padded();
      for (std::ptrdiff_t g = 0; g < points_.count; ++g)
        by_points_[static_cast<std::size_t>(g * width_ + r)] = from[g];
    }
    return by_points_.data();
  }
  [[nodiscard]] std::ptrdiff_t width() const { return width_; }

 private:
  const KnotVector& knots_;
  const PiecePoints& points_;
  const PieceKernels& kernels_;
  int order_;
  std::ptrdiff_t width_;
  std::vector<double>
      reciprocal_;  ///< of the support of function i of degree q − 1 at [(q − 1) knots + i]
  std::vector<double> left_, right_, values_, by_points_;
};

}  // namespace knead::detail
