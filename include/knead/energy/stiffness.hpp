#pragma once

#include <Eigen/SparseCore>
#include <memory>

#include "knead/energy/energy.hpp"
#include "knead/gramian/gramian.hpp"

namespace knead {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// A X of a symmetric matrix with all of its entries stored, for N × 3 coordinates. Cost: that of
/// reading A.
[[nodiscard]] Points symmetric_product(const SparseMatrix& a, const Points& x);
/// Aᵀ X of any matrix, whose columns are read as rows. Cost: likewise.
[[nodiscard]] Points transposed_product(const SparseMatrix& a, const Points& x);

/// The denominator of rational splines.
enum class RationalDenominator {
  exact,
  /// The thesis' approximation (§ 5.8): on each element its value at the middle. On a circle's
  /// knots it errs by 18 % of the largest entry for functions, 48 % for first and 52 % for second
  /// derivatives; for comparison only.
  constant,
};

inline constexpr double default_rational_tolerance = 1e-10;
inline constexpr int max_rational_gauss_points = 64;

/// How `Stiffness` is integrated.
struct StiffnessOptions {
  GramianMethod method = default_gramian_method;
  /// Rational splines: the largest error of an entry K_IJ, as a fraction of √(K_II K_JJ); > 0.
  /// Below 1e-14 rounding dominates. Diagonals are taken for the absolute values of the energy's
  /// coefficients.
  double rational_tolerance = default_rational_tolerance;
  /// Rational splines: Gauss points per span and direction without a bound of the error; 0: what
  /// the tolerance needs.
  int rational_gauss_points = 0;
  RationalDenominator denominator = RationalDenominator::exact;
};

/// The symmetric operator K that a quadratic energy defines on the control points: E(S) = Σ_xyz Pᵀ
/// K P (thesis Eqs. 4.14, 4.15; for `mass_energy` it is the mass matrix).
///
/// Polynomial splines: K = Σ_terms c · G^{a_0 b_0} ⊗ … ⊗ G^{a_{D−1} b_{D−1}}, exact up to rounding.
/// It is stored as those one-dimensional factors and can be applied without being assembled.
/// Rational splines: the derivatives are those of the rational basis, integrated to a tolerance:
/// every element gets the Gauss points that an error bound on Bernstein ellipses asks for (see
/// `rational_gramian`), and is cut where that is not enough. K is then stored assembled. Weights
/// are never ignored. Unknowns are numbered as control points: last direction fastest.
template <int D>
class Stiffness {
 public:
  /// Errors: a derivative order above 2, of rational splines a total order above 2 (usage); a
  /// rational denominator that is not positive, weights that differ too much for the tolerance
  /// (numerical).
  [[nodiscard]] static Expected<Stiffness> create(const Spline<D>& spline, const Energy<D>& energy,
                                                  const StiffnessOptions& options = {});

  /// For a polynomial spline the knots suffice.
  [[nodiscard]] static Expected<Stiffness> create(const std::array<KnotVector, D>& knots,
                                                  const Energy<D>& energy,
                                                  const StiffnessOptions& options = {});

  /// An operator on the control points of a spline that is assembled already, with the pattern of
  /// `assemble`.
  [[nodiscard]] static Stiffness of_matrix(const Spline<D>& spline, SparseMatrix matrix,
                                           double error_bound = 0);

  /// Rounding apart, no entry K_IJ errs by more than this fraction of √(K_II K_JJ). 0 for
  /// polynomial splines; infinite where options ask for what has no bound.
  [[nodiscard]] double error_bound() const { return error_bound_; }

  [[nodiscard]] int size() const { return size_; }

  /// K X for N × 3 coordinates. Nothing is assembled for polynomial splines. Cost for a surface: 6
  /// (2p + 1) N operations for every distinct pair of derivative orders in the first direction
  /// (three of `stretch_and_bend` without cross terms, five with them), in vectors. All instruction
  /// sets give the same bits.
  [[nodiscard]] Points apply(const Points& x) const;

  /// Σ_xyz Xᵀ K X.
  [[nodiscard]] double energy(const Points& x) const;

  /// K as a sparse matrix with every entry of the tensor-product band stored, zero or not, columns
  /// sorted: Π_d (n_d (2 p_d + 1) − p_d (p_d + 1)) entries, so that matrices of different energies
  /// share their pattern.
  [[nodiscard]] SparseMatrix assemble() const;

  /// Writes the values of K into a matrix that `assemble` made for the same net and degrees. Cost:
  /// about that of writing them.
  void refresh(SparseMatrix& matrix) const;

 private:
  struct Term {
    double coefficient;
    std::array<int, D> factor;  // index into factors_[d]
  };

  Stiffness() = default;

  std::array<int, D> net_{}, degree_{};
  int size_ = 0;
  std::array<std::vector<BandMatrix>, D>
      factors_;  // distinct one-dimensional Gramians per direction
  std::vector<Term> terms_;
  std::shared_ptr<const SparseMatrix> assembled_;  // rational splines
  double error_bound_ = 0;
};

}  // namespace knead
