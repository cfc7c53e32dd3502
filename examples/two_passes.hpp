#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <array>
#include <memory>
#include <string>

#include "knead/energy/energy.hpp"

namespace knead::examples {

/// Σ_kl c_kl G_kk ⊗ G_ll: an energy whose terms have the same order of derivatives on both sides in
/// each direction, 0 to 2.
using ProductTerms = Eigen::Matrix3d;

/// Error (input): a term that is not of this kind, such as that of α12.
[[nodiscard]] Expected<ProductTerms> product_terms(const Energy<2>& energy);

/// The thesis' question of § 7.3.1: with control points as a matrix X, K = A ⊗ B makes K vec(X) =
/// vec(D) the equation A X B = D, which two passes of one-dimensional solves answer, A Y = D along
/// the columns and X B = Y along the rows.
///
/// It applies where the sum is one product: where the matrix c_kl has rank 1, so with a mass term
/// λ, α11 and α22 only together with 2 β12 = α11 α22 / λ, and bending never beside stretch of the
/// same direction. `held` control points on either side of each direction are 0. Cost: O(p² (m +
/// n)) once, O(p m n) per solve.
class TwoPasses {
 public:
  /// Errors (input): the energy is no single product; a factor is not positive definite.
  [[nodiscard]] static Expected<TwoPasses> create(const std::array<KnotVector, 2>& knots,
                                                  const Energy<2>& energy, int held = 0);
  /// X of the free control points for D, one row each, the second direction fast.
  [[nodiscard]] Points solve(const Points& d) const;

 private:
  using Factor =
      Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>>;
  std::array<std::shared_ptr<const Factor>, 2> factors_;
  std::array<Eigen::Index, 2> size_ = {};
};

/// The wider class that the eigenvectors of one pair of Gramians per direction diagonalise (R. E.
/// Lynch, J. R. Rice and D. H. Thomas, *Direct solution of partial difference equations by tensor
/// product methods*, Numer. Math. 6 (1964)): besides G00 at most one of G11 and G22 in each
/// direction. Stretch with twist (β12), or bending of both directions without stretch and twist,
/// with any mass. Cost: O(m³ + n³) once, O(m n (m + n)) per solve.
class FastDiagonalisation {
 public:
  /// Errors (input): both G11 and G22 stand in one direction; not positive definite.
  [[nodiscard]] static Expected<FastDiagonalisation> create(const std::array<KnotVector, 2>& knots,
                                                            const Energy<2>& energy, int held = 0);
  [[nodiscard]] Points solve(const Points& d) const;

 private:
  std::array<Eigen::MatrixXd, 2> vectors_;
  Eigen::MatrixXd divisors_;
};

/// K of all free control points as one sparse matrix: the vectorised system.
[[nodiscard]] Eigen::SparseMatrix<double> vectorised(const std::array<KnotVector, 2>& knots,
                                                     const Energy<2>& energy, int held = 0);

}  // namespace knead::examples
