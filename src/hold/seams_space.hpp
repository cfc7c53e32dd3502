#pragma once

#include <Eigen/SparseCore>
#include <optional>
#include <vector>

#include "knead/hold/seams.hpp"

namespace knead::seams {

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// A knot strictly inside the domain, at t in (0, 1), and its multiplicity.
struct InnerKnot {
  double t = 0;
  int multiplicity = 0;
};

/// t = (x − lower)/length of all knots, ascending; 1 − t where `reversed`. Ends of the domain
/// become 0 and 1 exactly.
[[nodiscard]] std::vector<double> normalised_knots(const KnotVector& knots, bool reversed);
[[nodiscard]] std::vector<InnerKnot> inner_knots(std::span<const double> normalised);

/// Pairs (index in a, index in b) of knots that are the same, ascending: nearest ones within
/// `agreement`, one to one.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> matching_knots(
    std::span<const InnerKnot> a, std::span<const InnerKnot> b, double agreement);

/// Two univariate spline spaces embedded in a finer one: the higher degree, all knots.
///
/// Two splines agree along a seam exactly if their coefficients on a space that contains both do:
/// finitely many linear conditions, with no sampling between which they could part.
struct CommonSpace {
  RowMatrix from_a,
      from_b;  ///< coefficients on the common space from those of a, of b (b in its own order)
  /// Rows k of from_a E_a = from_b E_b that imply all others: all of them if the degrees agree.
  std::vector<Eigen::Index> independent;
  bool same = false;    ///< a, b and the common space are identical
  double mismatch = 0;  ///< largest distance of knots that count as the same
};

/// None if normalised knots cannot be distinguished (spans of less than an ulp of the domain), or
/// embedding the spaces loses all digits.
[[nodiscard]] std::optional<CommonSpace> common_space(const KnotVector& a, const KnotVector& b,
                                                      bool reversed, double agreement);

/// The linear forms of an edge: numerator coefficients along it in terms of the patch's control
/// points.
struct EdgeForms {
  RowMatrix value, derivative;  ///< E_j = Σ_i N_i(end) w_ij X_ij; the same with the inward N_i'
  Eigen::VectorXd weight, weight_derivative;  ///< row sums: the same of 1
};
[[nodiscard]] EdgeForms edge_forms(const Surface& surface, SurfaceEdge edge);

}  // namespace knead::seams
