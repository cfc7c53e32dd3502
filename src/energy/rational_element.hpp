#pragma once

#include <Eigen/Dense>
#include <array>
#include <span>
#include <vector>

#include "gramian/rational_piece.hpp"
#include "knead/energy/material_field.hpp"
#include "knead/gramian/band_matrix.hpp"

namespace knead {

/// What the terms of an energy ask of the rational functions R: the matrix C of Σ_ab C_ab ∂^a R_I
/// ∂^b R_J over the derivatives that occur.
template <int D>
class RationalCoefficients {
 public:
  /// One coefficient that varies.
  struct Varying {
    const SplineField<D>* field;
    int a, b;  ///< positions in `used`
    double factor;
    double largest = 0;          ///< |coefficient| of the field on an element
    std::vector<double> values;  ///< at the points of a piece
  };

  /// The energy must outlive it. Total orders up to 2.
  explicit RationalCoefficients(const FieldEnergy<D>& energy);

  /// Which derivatives occur, as positions in `multi_indices`.
  [[nodiscard]] const std::vector<std::size_t>& used() const { return used_; }
  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(used_.size()); }
  /// Their highest total order.
  [[nodiscard]] int order() const { return order_; }
  /// C is diagonal and nowhere negative.
  [[nodiscard]] bool sum_of_squares() const { return sum_of_squares_; }
  [[nodiscard]] const std::vector<Varying>& varying() const { return varying_; }

  /// Finds the largest coefficient of every field on a part of the domain that none of their knots
  /// cuts.
  void enter(const std::array<const detail::RationalAxis*, D>& axes);

  /// The fields at all combinations of parameters.
  [[nodiscard]] Expected<void> sample(const std::array<std::vector<double>, D>& parameters);

  /// C_ab at n of the points sampled, from point k on. False: 0 at all of them.
  [[nodiscard]] bool at(int a, int b, std::size_t k, std::span<double> out) const;

  /// Σ_b of bounds of |C_ab| on the part entered, for one parameter on a Bernstein ellipse. A
  /// polynomial of degree q that is at most M on an interval is at most M ρ^q on the ellipse (S. N.
  /// Bernstein).
  void row_sums(std::size_t direction, double rho, Eigen::VectorXd& sums) const;

 private:
  [[nodiscard]] int position(const MultiIndex<D>& order) const;

  std::vector<std::size_t> used_;
  Eigen::MatrixXd constant_;
  std::vector<Varying> varying_;
  bool sum_of_squares_ = true;
  int order_ = 0;
};

/// ∫ Σ_ab C_ab ∂^a R_I ∂^b R_J over one element, by Gauss points, piece after piece.
template <int D>
class RationalElement {
 public:
  RationalElement(RationalCoefficients<D>& coefficients, std::size_t functions);

  void clear();
  /// The sums so far: the lower triangle for C, and the diagonal for |C|.
  [[nodiscard]] const Eigen::MatrixXd& block() const { return block_; }
  [[nodiscard]] const Eigen::VectorXd& diagonal() const { return diagonal_; }

  /// Adds the rule with these points; the diagonal alone unless `whole`. A positive `constant`
  /// stands for the denominator. Error: the denominator is not positive. Cost for a surface of
  /// degree p: about 5 (p + 1)⁴ operations per point for stretch or bend.
  [[nodiscard]] Expected<void> add(const detail::RationalPiece<D>& piece,
                                   const std::array<int, D>& points, bool whole,
                                   double constant = 0);

 private:
  [[nodiscard]] Expected<void> tabulate(const detail::RationalPiece<D>& piece,
                                        const std::array<int, D>& points);
  void add_diagonal(const detail::RationalLine<D>& line, std::size_t k);
  void add_squares(const detail::RationalLine<D>& line, std::size_t k);
  void add_products(const detail::RationalLine<D>& line, std::size_t k);
  void flush();
  /// The next n rows of `left_` or `right_`, to be filled.
  [[nodiscard]] auto next_rows(std::vector<double, CacheLineAllocator<double>>& columns,
                               Eigen::Index n) const {
    return Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>(
        columns.data() + filled_, n, functions_, Eigen::OuterStride<>(rows_));
  }
  /// Derivative `a` of those used, along a line: function after function.
  [[nodiscard]] const double* derivative(int a) const {
    const std::size_t size = static_cast<std::size_t>(functions_) * factor_.size();
    return values_.data() + coefficients_.used()[static_cast<std::size_t>(a)] * size;
  }

  RationalCoefficients<D>& coefficients_;
  Eigen::Index functions_;
  std::array<detail::RationalPoints, D> points_;
  std::vector<double, CacheLineAllocator<double>> values_;
  std::vector<double> factor_;
  /// A column of `rows_` for each function, vectors of which do not straddle cache lines:
  /// derivatives along lines; those times weight and C. Of a sum of squares, derivatives times the
  /// root of both.
  Eigen::Index rows_;
  std::vector<double, CacheLineAllocator<double>> left_, right_;
  Eigen::Index filled_ = 0;  ///< rows of these
  Eigen::MatrixXd block_;
  Eigen::VectorXd diagonal_;
};

}  // namespace knead
