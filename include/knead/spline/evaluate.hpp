#pragma once

#include <array>
#include <span>
#include <vector>

#include "knead/spline/basis.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// N parameter points of a D-variate spline, one per row.
template <int D>
using Parameters = Eigen::Matrix<double, Eigen::Dynamic, D, D == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

/// Derivative orders per direction: {1, 0} is ∂/∂u, {1, 1} is ∂²/∂u∂v.
template <int D>
using MultiIndex = std::array<int, D>;

/// All multi-indices a with |a| = a_0 + … <= order, by total order and then by descending first index: for D = 2 and
/// order 2 that is 00, 10, 01, 20, 11, 02.
template <int D>
[[nodiscard]] std::vector<MultiIndex<D>> multi_indices(int order);

/// Position of `a` in `multi_indices<D>(order)`; it does not depend on the order.
template <int D>
[[nodiscard]] int multi_index_position(MultiIndex<D> a);

/// A spline and its partial derivatives at N parameter points.
template <int D>
struct Evaluation {
  int order = 0;
  std::vector<Points> derivatives;  ///< ∂^a S for a in multi_indices<D>(order), each N × 3

  [[nodiscard]] const Points& at(MultiIndex<D> a) const {
    return derivatives[static_cast<std::size_t>(multi_index_position<D>(a))];
  }
  [[nodiscard]] const Points& points() const { return derivatives.front(); }
};

/// S and its partial derivatives up to total order `order` at scattered parameter points.
///
/// Polynomial: Σ N^(a)(u) P. Rational: quotient rule on the homogeneous numerator and denominator (The NURBS Book,
/// Eq. 4.20). At a knot the limit from `side` is taken in every direction; at the ends of the domain the limit from
/// inside. Cost: O((p + 1)^D) per point and derivative.
/// Errors: a parameter outside the domain or not finite; a denominator that is not positive (numerical).
template <int D>
[[nodiscard]] Expected<Evaluation<D>> evaluate(const Spline<D>& spline, const Parameters<D>& parameters, int order = 0,
                                               Side side = Side::right);

/// The same, bit for bit, on the grid of all combinations of the given parameters, last direction fastest: on a
/// surface, the value at (u_k, v_l) is row k · (number of v) + l. The net is contracted one direction at a time, so
/// that a grid costs about one (p + 1)-term sum per point. Errors as above; the parameter is named by direction and
/// index.
template <int D>
[[nodiscard]] Expected<Evaluation<D>> evaluate_grid(const Spline<D>& spline,
                                                    const std::array<std::span<const double>, D>& parameters,
                                                    int order = 0, Side side = Side::right);

/// The grid form for bases that were tabulated before (to `order` at least).
template <int D>
[[nodiscard]] Expected<Evaluation<D>> evaluate_grid(const Spline<D>& spline,
                                                    const std::array<const BasisTable*, D>& tables, int order = 0);

/// The form for repeated use: memory that `result` holds is used again (fresh pages cost more than the arithmetic on
/// large grids). After a failure the content of `result` is unspecified.
template <int D>
[[nodiscard]] Expected<void> evaluate_grid(const Spline<D>& spline, const std::array<const BasisTable*, D>& tables,
                                           int order, Evaluation<D>& result);

/// One point, S(u).
template <int D>
[[nodiscard]] Expected<Point> evaluate_point(const Spline<D>& spline, std::array<double, D> u);

}  // namespace knead
