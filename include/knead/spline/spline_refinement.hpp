#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <span>
#include <vector>

#include "knead/spline/knot_vector.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// The knots with `inserted` added inside the domain, each entry once (repetitions and any order
/// allowed).
///
/// Ends of an unclamped domain may be repeated too; the outermost functions are then left without
/// support inside. Errors, by the index in `inserted`: a knot that is not finite or outside the
/// domain, or whose multiplicity would exceed p + 1.
[[nodiscard]] Expected<KnotVector> with_knots(const KnotVector& knots,
                                              std::span<const double> inserted);

/// The same for periodic functions: the images of each inserted knot one period away replace knots
/// outside the domain, so that knot differences remain periodic. Knots that stay keep their bits;
/// images are rounded sums. Errors: as above; a clamped end; a knot at an end of the domain.
[[nodiscard]] Expected<KnotVector> with_periodic_knots(const KnotVector& knots,
                                                       std::span<const double> inserted);

/// The knots of degree p + 1 whose functions span all those of degree p on the domain: every knot
/// repeated once more.
///
/// The domain is unchanged, clamped ends stay clamped, and at an unclamped end the p + 1 outer
/// knots nearest to it are kept. Functions without support in the domain (unclamped ends with
/// repeated knots) are dropped. Errors: the degree would exceed `max_degree`.
[[nodiscard]] Expected<KnotVector> elevated_knots(const KnotVector& knots);

/// Clamped, with every knot inside the domain p + 1 times: each group of p + 1 functions is the
/// Bernstein basis of one span of positive length.
[[nodiscard]] KnotVector bezier_knots(const KnotVector& knots);

/// Midpoints of all spans of positive length that the interval meets in more than a point (for an
/// interval without length: that it touches), ascending. A span whose ends are adjacent doubles has
/// none.
[[nodiscard]] std::vector<double> span_midpoints(const KnotVector& knots, Interval interval);

/// The linear map R from the coefficients of a spline in one direction to those of the same
/// function on finer knots, of the same degree or one higher: N_j = Σ_i R_ij Ñ_i on the domain, so
/// c̃ = R c, and Gramians obey G = Rᵀ G̃ R.
///
/// Row i has the p + 1 entries of one span, by blossoming: c̃_i = f(y_{i+1}, …, y_{i+p}) with f the
/// polar form of a polynomial piece under Ñ_i, expanded by the Oslo recursion (Cohen, Lyche &
/// Riesenfeld 1980); for degree p + 1 the mean of f over the p + 1 ways to omit one of y_{i+1} …
/// y_{i+p+1} (Prautzsch 1984). A row whose arguments are p consecutive knots of the coarse vector
/// is a unit row, exactly. Where the finer knots come from `with_knots`, `with_periodic_knots`,
/// `elevated_knots` or `bezier_knots` of clamped knots, every product of the recursion is
/// non-negative: entries are accurate to 4 (p + 1) ulp each, whatever the knots. Bézier rows that
/// cut unclamped ends extrapolate only knots outside the domain and are accurate relative to the
/// largest entry. Immutable.
class Refinement {
 public:
  /// Checks that the domain is the same bit for bit, the degree the same or one higher, and every
  /// knot inside the domain repeated as often as `from` needs (more by the increase in degree).
  /// Cost: O(n p²), and O(n p³) where the degree grows.
  [[nodiscard]] static Expected<Refinement> create(KnotVector from, KnotVector to);

  [[nodiscard]] const KnotVector& from() const { return from_; }
  [[nodiscard]] const KnotVector& to() const { return to_; }

  /// Entries R_ij for j = first(i) … first(i) + p, where p is the degree of `from`; all others are
  /// zero.
  [[nodiscard]] std::span<const double> row(int i) const {
    const auto width = static_cast<std::size_t>(from_.degree() + 1);
    return std::span(values_).subspan(static_cast<std::size_t>(i) * width, width);
  }
  [[nodiscard]] int first(int i) const { return first_[static_cast<std::size_t>(i)]; }
  /// The j of a row that is 1 at j and 0 elsewhere: that coefficient is copied bit for bit. −1 for
  /// other rows.
  [[nodiscard]] int copied(int i) const { return copied_[static_cast<std::size_t>(i)]; }

  /// Applies R along the middle of three indices, as in a tensor-product net with `inner` numbers
  /// per step of this direction: out[(o ñ + i) inner + c] = Σ_j R_ij in[(o n + j) inner + c], 0 <=
  /// o < outer. `in` holds outer · n · inner numbers, `out` outer · ñ · inner; they must not
  /// overlap.
  void apply(const double* in, double* out, int outer, int inner) const;

  /// R as an ñ × n matrix without explicit zeros.
  [[nodiscard]] Eigen::SparseMatrix<double> matrix() const;

 private:
  Refinement(KnotVector from, KnotVector to) : from_(std::move(from)), to_(std::move(to)) {}

  KnotVector from_, to_;
  std::vector<int> first_, copied_;
  std::vector<double> values_;
};

/// The same function on finer knots in one direction.
///
/// c̃ = R c along that direction; with weights on homogeneous coordinates, w̃ = R w,
/// P̃ = R (w P) / w̃. Neither shape nor parametrisation change, up to rounding: with positive
/// weights points move by less than 24 (p + 1) ulp of the largest coordinate of the net, evaluation
/// before and after included, whatever the ratio of the weights. Control points and weights of
/// `Refinement::copied` rows keep their bits. A displacement or a rest shape on the same net is
/// refined as a spline of its own: `refined(*spline.with_control_points(displacement), …)`. Cost:
/// O(size p). Errors: `refinement.from()` is not the knot vector of that direction (usage); a
/// weight becomes zero (numerical).
template <int D>
[[nodiscard]] Expected<Spline<D>> refined(const Spline<D>& spline, int direction,
                                          const Refinement& refinement);

/// The same function with all of these knots inserted, per direction (`with_knots`; *The NURBS
/// Book*, 5.3).
template <int D>
[[nodiscard]] Expected<Spline<D>> insert_knots(const Spline<D>& spline,
                                               const std::array<std::vector<double>, D>& inserted);

/// The same function with the degree of one direction raised `times` times (`elevated_knots`; *The
/// NURBS Book*, 5.5). Continuity is unchanged: every knot is repeated as many times more. Errors:
/// degree above `max_degree`.
template <int D>
[[nodiscard]] Expected<Spline<D>> elevate_degree(const Spline<D>& spline, int direction,
                                                 int times = 1);

/// The same function with every span that meets the box `region` in more than its boundary halved,
/// in each direction
/// (`span_midpoints`); a side without length selects the spans it touches. As the net is a tensor
/// product, the halved spans run through the whole surface. Errors: a side that is not finite,
/// decreases or misses the domain.
template <int D>
[[nodiscard]] Expected<Spline<D>> refine_region(const Spline<D>& spline,
                                                const std::array<Interval, D>& region);

/// The same function in Bézier pieces (`bezier_knots`): piece k of a direction, over the k-th span
/// of positive length, has the control points k (p + 1) … k (p + 1) + p.
template <int D>
[[nodiscard]] Expected<Spline<D>> bezier_pieces(const Spline<D>& spline);

/// The same function on its domain with clamped ends, which every program reads: the ends of the
/// domain become knots of multiplicity p + 1, and what lies outside is left out. Errors: those of
/// `insert_knots`.
[[nodiscard]] Expected<Surface> with_clamped_ends(const Surface& surface);
/// A spline on fewer knots.
template <int D>
struct KnotRemoval {
  Spline<D> spline;
  std::vector<Points> companions;  ///< on the new net, in the order they were given
  std::vector<double>
      removed;  ///< knots that were removed, ascending, repeated if removed more than once
  /// Bound on the movement of any point of the spline or a companion, in units of the coordinates;
  /// zero if nothing was removed.
  double error_bound = 0;
};

/// Removes knots strictly inside the domain of one direction while no point S(u) moves by more than
/// `tolerance`.
///
/// Greedy: the knot whose removal needs the smallest change goes first. The coefficients possible
/// without one knot are those c̃ with ℓᵀ c̃ = 0 for a single vector ℓ of alternating signs (a
/// jump of a derivative); the smallest change in the maximum norm is ℓᵀc sign(ℓ_i) w_i / Σ |ℓ_i|
/// w_i, which is used (w_i the weights, 1 without). The first and last rows of the net stay bit for
/// bit, and so do all rows unaffected by removed knots. Cf. Lyche & Mørken 1987, *The NURBS
/// Book* 5.4.
///
/// The bound is certified against the given spline, not accumulated: the result is refined back
/// (`Refinement`) and compared coefficient by coefficient, |S − S̃| <= max_i |P_i − P̃_i|; with
/// weights max_i (w̃_i |P_i − P̃_i| + |w_i − w̃_i| r_i) / w_i, where r_i is the largest distance of
/// P_i from the box of the new net. It includes an allowance for rounding of 16 (p + 2) ulp of the
/// largest coordinate, so a tolerance below that removes nothing. Not promised: that no other
/// choice removes more knots.
///
/// \param companions control points on the same net (a rest shape, a displacement) that must keep
/// their shapes to the
///                   same tolerance; with the weights of the spline where it has them.
/// Cost: O(size p) for each interior knot and knot removed.
/// Errors (input): the tolerance is negative or not finite; a companion does not fit the net or is
/// not finite; a weight that is not positive.
template <int D>
[[nodiscard]] Expected<KnotRemoval<D>> remove_knots(const Spline<D>& spline, int direction,
                                                    double tolerance,
                                                    std::span<const Points> companions = {});

}  // namespace knead
