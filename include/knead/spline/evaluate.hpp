#pragma once

#include <array>
#include <span>
#include <vector>

#include "knead/spline/basis.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// N parameter points of a D-variate spline, one per row.
template <int D>
using Parameters =
    Eigen::Matrix<double, Eigen::Dynamic, D, D == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

/// Derivative orders per direction: {1, 0} is ∂/∂u, {1, 1} is ∂²/∂u∂v.
template <int D>
using MultiIndex = std::array<int, D>;

/// All multi-indices a with |a| = a_0 + … <= order, by total order and then by descending first
/// index: for D = 2 and order 2 that is 00, 10, 01, 20, 11, 02.
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
/// Polynomial: Σ N^(a)(u) P. Rational: quotient rule on the homogeneous numerator and denominator
/// (The NURBS Book, Eq. 4.20). At a knot the limit from `side` is taken in every direction; at the
/// ends of the domain the limit from inside. Cost: O((p + 1)^D) per point and derivative. Errors: a
/// parameter outside the domain or not finite; a denominator that is not positive (numerical).
template <int D>
[[nodiscard]] Expected<Evaluation<D>> evaluate(const Spline<D>& spline,
                                               const Parameters<D>& parameters, int order = 0,
                                               Side side = Side::right);

/// The same, bit for bit, on the grid of all combinations of the given parameters, last direction
/// fastest: on a surface, the value at (u_k, v_l) is row k · (number of v) + l. The net is
/// contracted one direction at a time, so that a grid costs about one (p + 1)-term sum per point.
/// Errors as above; the parameter is named by direction and index.
template <int D>
[[nodiscard]] Expected<Evaluation<D>> evaluate_grid(
    const Spline<D>& spline, const std::array<std::span<const double>, D>& parameters,
    int order = 0, Side side = Side::right);

/// The grid form for bases that were tabulated before (to `order` at least).
template <int D>
[[nodiscard]] Expected<Evaluation<D>> evaluate_grid(const Spline<D>& spline,
                                                    const std::array<const BasisTable*, D>& tables,
                                                    int order = 0);

/// The form for repeated use: memory that `result` holds is used again (fresh pages cost more than
/// the arithmetic on large grids). After a failure the content of `result` is unspecified.
template <int D>
[[nodiscard]] Expected<void> evaluate_grid(const Spline<D>& spline,
                                           const std::array<const BasisTable*, D>& tables,
                                           int order, Evaluation<D>& result);

/// One point, S(u).
template <int D>
[[nodiscard]] Expected<Point> evaluate_point(const Spline<D>& spline, std::array<double, D> u);

/// `evaluate` for bases that were tabulated before (to `order` at least): point k is row k of every
/// table, all of one size. Memory that `result` holds is used again. After a failure the content of
/// `result` is unspecified. Errors: a denominator that is not positive (numerical).
template <int D>
[[nodiscard]] Expected<void> evaluate(const Spline<D>& spline,
                                      const std::array<const BasisTable*, D>& tables, int order,
                                      Evaluation<D>& result);

/// The basis functions at parameters that stay while control points change: evaluation without
/// tabulating them anew. The same bits as `evaluate` and `evaluate_grid`. Immutable, independent of
/// the spline it was made for.
template <int D>
class Evaluator {
 public:
  /// On the grid of all combinations of the given parameters, last direction fastest, to
  /// derivatives of total order `order`. At a knot the limit from `side`. Errors: a parameter
  /// outside the domain or not finite, named by direction and index (input); a negative order
  /// (usage). Cost: O(p²) per parameter of each direction.
  [[nodiscard]] static Expected<Evaluator> on_grid(
      const std::array<KnotVector, D>& knots,
      const std::array<std::span<const double>, D>& parameters, int order = 0,
      Side side = Side::right);

  /// At scattered points. Likewise; cost: O(D p²) per point, about as much as evaluating points
  /// once.
  [[nodiscard]] static Expected<Evaluator> at_points(const std::array<KnotVector, D>& knots,
                                                     const Parameters<D>& parameters, int order = 0,
                                                     Side side = Side::right);

  [[nodiscard]] int order() const { return tables_[0].order; }
  /// Number of points.
  [[nodiscard]] Eigen::Index size() const;

  /// S and its derivatives for a spline with these knots, rational or not. Memory that `result`
  /// holds is used again; after a failure its content is unspecified. Errors: other knots (usage);
  /// a denominator that is not positive (numerical).
  [[nodiscard]] Expected<void> evaluate(const Spline<D>& spline, Evaluation<D>& result) const;
  [[nodiscard]] Expected<Evaluation<D>> evaluate(const Spline<D>& spline) const;

 private:
  Evaluator(std::array<KnotVector, D> knots, std::array<BasisTable, D> tables, bool grid)
      : knots_(std::move(knots)), tables_(std::move(tables)), grid_(grid) {}
  [[nodiscard]] static Expected<Evaluator> create(
      const std::array<KnotVector, D>& knots,
      const std::array<std::span<const double>, D>& parameters, int order, Side side, bool grid);

  std::array<KnotVector, D> knots_;
  std::array<BasisTable, D> tables_;
  bool grid_;
};

/// Unit normals of a surface from its first derivatives,
///   n = S_u × S_v / |S_u × S_v|      (do Carmo, Differential Geometry of Curves and Surfaces, 2.4;
///   The NURBS Book, 3.5),
/// one per row of an evaluation of order 1 at least; those of rational surfaces too, whose
/// derivatives these are.
///
/// Where the derivatives span no plane the normal is (0, 0, 0), never a neighbour's or a limit's:
/// where
///   |S_u × S_v| <= 1e-9 (|S_u|² + |S_v|²),
/// as at poles, where an edge is one point; at cusps; and where S_u and S_v are parallel. This
/// depends on the units of the parameters: directions whose speeds differ by more than 1e9 have no
/// normals. Accuracy elsewhere: 4 ulp of 1 times |S_u| |S_v| / |S_u × S_v| beside what the
/// derivatives err by. Speeds from 1e-75 to 1e75. Requires: order >= 1 (asserted). Memory that
/// `result` holds is used again. Uses several threads where it pays.
void unit_normals(const Evaluation<2>& evaluation, Points& result);
[[nodiscard]] Points unit_normals(const Evaluation<2>& evaluation);

/// The same of a surface at scattered parameter points. At a knot the derivatives are limits from
/// `side`. Errors: as of `evaluate`. `Evaluator` keeps the basis where the net changes from call to
/// call.
[[nodiscard]] Expected<Points> unit_normals(const Surface& surface, const Parameters<2>& parameters,
                                            Side side = Side::right);

/// And on a grid, last direction fastest, bit for bit as at scattered points. Errors: as of
/// `evaluate_grid`.
[[nodiscard]] Expected<Points> unit_normals_on_grid(
    const Surface& surface, const std::array<std::span<const double>, 2>& parameters,
    Side side = Side::right);

/// Memory of the caller for an evaluation of N points: one part for each of
/// `multi_indices<D>(order)`, 3 N numbers, x, y, z point after point; parts do not overlap.
/// Requires: as many parts, of this size (asserted).
using DerivativeMemory = std::span<const std::span<double>>;

/// `evaluate` into memory of the caller, with nothing copied: for bases that were tabulated before
/// (to `order` at least), point k is row k of every table, all of one size. After a failure the
/// content is unspecified. Errors: a denominator that is not positive (numerical).
template <int D>
[[nodiscard]] Expected<void> evaluate_into(const Spline<D>& spline,
                                           const std::array<const BasisTable*, D>& tables,
                                           int order, DerivativeMemory out);

/// `evaluate_grid` into memory of the caller, likewise.
template <int D>
[[nodiscard]] Expected<void> evaluate_grid_into(const Spline<D>& spline,
                                                const std::array<const BasisTable*, D>& tables,
                                                int order, DerivativeMemory out);

}  // namespace knead
