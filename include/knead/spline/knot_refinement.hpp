#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "knead/spline/knot_vector.hpp"

namespace knead {

/// The knots with `inserted` added inside the domain, each entry once (repetitions and any order allowed).
///
/// Ends of an unclamped domain may be repeated too; the outermost functions are then left without support inside.
/// Errors, by the index in `inserted`: a knot that is not finite or outside the domain, or whose multiplicity would
/// exceed p + 1.
[[nodiscard]] Expected<KnotVector> with_knots(const KnotVector& knots, std::span<const double> inserted);

/// The same for periodic functions: the images of each inserted knot one period away replace knots outside the domain,
/// so that knot differences remain periodic. Knots that stay keep their bits; images are
/// rounded sums. Errors: as above; a clamped end; a knot at an end of the domain.
[[nodiscard]] Expected<KnotVector> with_periodic_knots(const KnotVector& knots, std::span<const double> inserted);

/// The knots of degree p + 1 whose functions span all those of degree p on the domain: every knot repeated once more.
///
/// The domain is unchanged, clamped ends stay clamped, and at an unclamped end the p + 1 outer knots nearest to it are
/// kept. Functions without support in the domain (unclamped ends with repeated knots) are dropped.
/// Errors: the degree would exceed `max_degree`.
[[nodiscard]] Expected<KnotVector> elevated_knots(const KnotVector& knots);

/// Clamped, with every knot inside the domain p + 1 times: each group of p + 1 functions is the Bernstein basis of one
/// span of positive length.
[[nodiscard]] KnotVector bezier_knots(const KnotVector& knots);

/// Midpoints of all spans of positive length that the interval meets in more than a point (for an interval without
/// length: that it touches), ascending. A span whose ends are adjacent doubles has none.
[[nodiscard]] std::vector<double> span_midpoints(const KnotVector& knots, Interval interval);

/// The linear map R from the coefficients of a spline in one direction to those of the same function on finer knots, of
/// the same degree or one higher: N_j = Σ_i R_ij Ñ_i on the domain, so c̃ = R c, and Gramians obey G = Rᵀ G̃ R.
///
/// Row i has the p + 1 entries of one span, by blossoming: c̃_i = f(y_{i+1}, …, y_{i+p}) with f the polar form of a
/// polynomial piece under Ñ_i, expanded by the Oslo recursion (Cohen, Lyche & Riesenfeld 1980); for degree p + 1 the
/// mean of f over the p + 1 ways to omit one of y_{i+1} … y_{i+p+1} (Prautzsch 1984). A row whose arguments are p
/// consecutive knots of the coarse vector is a unit row, exactly. Where the finer knots come from `with_knots`,
/// `with_periodic_knots`, `elevated_knots` or `bezier_knots` of clamped knots, every product of the recursion is
/// non-negative: entries are accurate to 4 (p + 1) ulp each, whatever the knots. Bézier rows that cut unclamped ends
/// extrapolate only knots outside the domain and are accurate relative to the largest entry.
/// Immutable.
class Refinement {
 public:
  /// Checks that the domain is the same bit for bit, the degree the same or one higher, and every knot inside the
  /// domain repeated as often as `from` needs (more by the increase in degree).
  /// Cost: O(n p²), and O(n p³) where the degree grows.
  [[nodiscard]] static Expected<Refinement> create(KnotVector from, KnotVector to);

  [[nodiscard]] const KnotVector& from() const { return from_; }
  [[nodiscard]] const KnotVector& to() const { return to_; }

  /// Entries R_ij for j = first(i) … first(i) + p, where p is the degree of `from`; all others are zero.
  [[nodiscard]] std::span<const double> row(int i) const {
    const auto width = static_cast<std::size_t>(from_.degree() + 1);
    return std::span(values_).subspan(static_cast<std::size_t>(i) * width, width);
  }
  [[nodiscard]] int first(int i) const { return first_[static_cast<std::size_t>(i)]; }
  /// The j of a row that is 1 at j and 0 elsewhere: that coefficient is copied bit for bit. −1 for other rows.
  [[nodiscard]] int copied(int i) const { return copied_[static_cast<std::size_t>(i)]; }

  /// Applies R along the middle of three indices, as in a tensor-product net with `inner` numbers per step of this
  /// direction: out[(o ñ + i) inner + c] = Σ_j R_ij in[(o n + j) inner + c], 0 <= o < outer. `in` holds outer · n ·
  /// inner numbers, `out` outer · ñ · inner; they must not overlap.
  void apply(const double* in, double* out, int outer, int inner) const;

  /// R as an ñ × n matrix without explicit zeros.
  [[nodiscard]] Eigen::SparseMatrix<double> matrix() const;

 private:
  Refinement(KnotVector from, KnotVector to) : from_(std::move(from)), to_(std::move(to)) {}

  KnotVector from_, to_;
  std::vector<int> first_, copied_;
  std::vector<double> values_;
};

}  // namespace knead
