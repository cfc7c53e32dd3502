#pragma once

#include <array>
#include <string>
#include <vector>

#include "gramian/operation_count.hpp"
#include "knead/spline/knot_vector.hpp"

namespace knead::figures {

enum class ThesisMethod { gaussian, analytic };  ///< Algs. 5.1 and 5.5

/// The triangle of values (thesis Figs. 5.8, 5.26) once per sample for all its uses, or once for
/// each.
enum class Reuse { all_in_one, none };

/// The cost of a run of one of the thesis' algorithms, counted while it runs on counting numbers.
struct Work {
  long spans = 0;
  long samples = 0;           ///< points at which basis functions are evaluated
  long evaluations = 0;       ///< functions for which a triangle of values was computed
  OperationCount recursions;  ///< in the triangles and the differences of derivatives
  OperationCount operations;  ///< in all

  friend Work operator-(const Work& a, const Work& b) {
    return {a.spans - b.spans, a.samples - b.samples, a.evaluations - b.evaluations,
            a.recursions - b.recursions, a.operations - b.operations};
  }
};

struct ThesisGramians {
  Work work;
  /// G00, G11, G22, G10: entry (i, i + s) at [term][i (p + 1) + s], s = 0 … p.
  std::array<std::vector<double>, 4> upper;
};

/// The thesis' own algorithms as stated, to measure their cost; for computing use `gramians`.
///
/// Gaussian: Alg. 5.1 with the factor (b − a)/2 that the printed one lacks. Analytic: Alg. 5.5 with
/// the integrals of Alg. 5.4 (without its last suffix sum), the values of degree p + 1 … 2p + 1 for
/// the p + 1 functions wanted alone (the trapezium of Fig. 5.26), the sign (−1)^(p+1−a), and the
/// constant terms at both ends. Only i <= j, as printed. Requires clamped knots that are simple
/// inside the domain, which Alg. 5.5 does (asserted).
[[nodiscard]] ThesisGramians thesis_gramians(const KnotVector& knots, ThesisMethod method,
                                             Reuse reuse = Reuse::all_in_one);

/// What thesis § 5.9.1 expects by formula, for n control points.
namespace expected {

/// ⌈(2p + 1)/2⌉ against 1 sample per span.
[[nodiscard]] double samples_per_span(int degree, ThesisMethod method);
/// samples · (n + 1)(p + 1); without re-use for three functions (N, N′, N″) against five (one
/// derivative, four integrals).
[[nodiscard]] double evaluations(int degree, int n, ThesisMethod method, Reuse reuse);
/// samples · (n + 1) times the branches of the triangles, forward (p + 1)²/2 against (2p + 2)(2p +
/// 3)/2 with five operations each (Piegl and Tiller A2.2), backward 3²/2 against p (p + 1)/2 with
/// three.
[[nodiscard]] double recursions(int degree, int n, ThesisMethod method);
/// The same and the assembly: a multiplication and an addition to each of p (p + 1)/2 + p + 1
/// values of four Gramians at every sample, for Gauss also a weight on it and three operations to
/// shift the abscissa and its weight; for the analytic method p + 1 multiplications and p additions
/// at each of the 4p − 3 levels of its integrals and p differences of derivatives. The thesis does
/// not print this sum; it is put together from its text.
[[nodiscard]] double operations(int degree, int n, ThesisMethod method);

}  // namespace expected
}  // namespace knead::figures
