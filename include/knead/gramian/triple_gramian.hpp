#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/gramian/band_matrix.hpp"
#include "knead/spline/knot_vector.hpp"

namespace knead {

/// T[k, i, j] = ∫ B_k N_i^(a) N_j^(b) du over the domain: what a Gramian becomes if its coefficient
/// is a spline Σ_k c_k B_k (thesis § 5.5). It depends only on the knots, so it remains valid when
/// the coefficient changes.
///
/// A coefficient of two directions, Σ_kl c_kl B_k(u) B_l(v), is contracted one direction after the
/// other (sum factorisation): ∫∫ c N_i N_j N_i' N_j' = Σ_k T_u[k, i, j] (Σ_l c_kl T_v[l, i', j']).
class TripleGramian {
 public:
  /// Number of functions N, half bandwidth in i and j, and number of coefficient functions B.
  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] int half_bandwidth() const { return degree_; }
  [[nodiscard]] int coefficient_count() const { return coefficient_count_; }

  /// T[k, i, j], zero where the three functions do not overlap.
  [[nodiscard]] double operator()(int k, int i, int j) const;

  /// The coefficient functions that overlap N_i and N_j, |i − j| <= half bandwidth: the first one
  /// and their integrals.
  struct Run {
    int first = 0;
    std::span<const double> values;
  };
  [[nodiscard]] Run run(int i, int j) const;

  /// Σ_k c_k T[k, ·, ·]: the Gramian weighted by the spline with coefficients c
  /// (coefficient_count() of them, asserted). Cost: O(n p (2 p + q)).
  [[nodiscard]] BandMatrix contract(std::span<const double> coefficients) const;

 private:
  friend Expected<TripleGramian> triple_gramian(const KnotVector& coefficient_knots,
                                                const KnotVector& knots, int a, int b);
  [[nodiscard]] std::size_t entry(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(2 * degree_ + 1) +
           static_cast<std::size_t>(j - i + degree_);
  }

  int size_ = 0, degree_ = 0, coefficient_count_ = 0;
  bool symmetric_ = false;
  std::vector<int> first_;           ///< by entry of the band, row by row
  std::vector<std::size_t> offset_;  ///< where the values of an entry begin; plus the end
  std::vector<double> values_;
};

/// The triple Gramian of coefficient functions B on `coefficient_knots` (any degree) and functions
/// N on `knots`, orders a, b >= 0 of the derivatives, which are taken span by span.
///
/// By Gauss quadrature, with enough points to be exact, on every piece of the common knots.
/// Accuracy: each T within 1e-14 of ∫|B_k N_i^(a) N_j^(b)| as far as a piece ends at knots of both;
/// sums of non-negative terms for a = b = 0. Errors: domains that differ (input); a negative order
/// (usage).
[[nodiscard]] Expected<TripleGramian> triple_gramian(const KnotVector& coefficient_knots,
                                                     const KnotVector& knots, int a, int b);

/// M_ij = ∫ N_i^(a) L_j^(b) du of the functions N on `rows` and L on `columns`, two knot vectors on
/// one domain: used to project a spline from one space to another. Rows × columns, with all entries
/// whose supports overlap inside the domain. Accuracy and errors as above.
[[nodiscard]] Expected<Eigen::SparseMatrix<double>> mixed_gramian(const KnotVector& rows, int a,
                                                                  const KnotVector& columns, int b);

}  // namespace knead
