#include "seams_space.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "base/decompositions.hpp"
#include "knead/spline/basis.hpp"
#include "seams_edge.hpp"

namespace knead::seams {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Clamped on [0, 1] with these knots inside, each `more` times more often than listed.
std::vector<double> clamped_over(int degree, std::span<const InnerKnot> inner, int more) {
  std::vector<double> knots(at(degree + 1), 0.0);
  for (const InnerKnot& k : inner) knots.insert(knots.end(), at(k.multiplicity + more), k.t);
  knots.insert(knots.end(), at(degree + 1), 1.0);
  return knots;
}

/// Adds `factor` times the polar form of the piece of span s at p arguments, as a row over the
/// coefficients s − p … s (Goldman's form of the Oslo algorithm: de Boor's recursion read
/// backwards).
void add_blossom(const KnotVector& x, int s, std::span<const double> arguments, double factor,
                 std::span<double> row) {
  const int p = x.degree();
  std::vector<double> g(at(p + 1), 0.0);  // g[j − (s − p)]
  g[at(p)] = 1;
  for (int r = p; r >= 1;
       --r) {  // the first argument goes to the narrowest quotients: all terms are non-negative
    const double t = arguments[at(p - r)];
    std::vector<double> next(at(p + 1), 0.0);
    for (int j = s - p + r; j <= s; ++j) {
      const double width = x[j + p - r + 1] - x[j];
      const double g_j = g[at(j - s + p)];
      next[at(j - s + p)] += (t - x[j]) / width * g_j;
      next[at(j - s + p - 1)] += (x[j + p - r + 1] - t) / width * g_j;
    }
    g = std::move(next);
  }
  for (int k = 0; k <= p; ++k) row[at(s - p + k)] += factor * g[at(k)];
}

/// Coefficients on `to` from those on `from`: same domain [0, 1], `to` clamped with all inner knots
/// of `from`, its degree the same or one higher (then a mean over the omitted argument, Prautzsch
/// 1984).
///
/// Coefficient i on `to` is the polar form of the piece of `from` at the knots i + 1 … i + q of
/// `to` (L. Ramshaw, "Blossoms are polar forms", 1989). The piece is one that contains these knots'
/// spans. Every term is non-negative, so that no digit cancels, and rows sum to 1 to rounding.
RowMatrix coarse_to_fine(const KnotVector& from, const KnotVector& to) {
  const int p = from.degree(), q = to.degree();
  assert(q == p || q == p + 1);
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> row(at(from.count())), arguments;
  for (int i = 0; i < to.count(); ++i) {
    std::ranges::fill(row, 0.0);
    for (int left_out = q == p ? q + 1 : 1; left_out <= q + (q == p ? 1 : 0); ++left_out) {
      arguments.clear();
      for (int k = 1; k <= q; ++k) {
        if (k != left_out) arguments.push_back(to[i + k]);
      }
      const double before = left_out == 1 && to[i + 1] < 1 ? to[i + 1] : to[i];
      add_blossom(from, from.find_span(before), arguments, q == p ? 1.0 : 1.0 / q, row);
    }
    for (int j = 0; j < from.count(); ++j) {
      if (row[at(j)] != 0) entries.emplace_back(i, j, row[at(j)]);
    }
  }
  RowMatrix result(to.count(), from.count());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

// Degree by degree, then all knots at once: each map is exact in exact arithmetic.
std::optional<RowMatrix> onto(int degree, const std::vector<double>& knots, int common_degree,
                              const std::vector<double>& common) {
  auto from = KnotVector::create(degree, knots);
  const auto to = KnotVector::create(common_degree, common);
  if (!from || !to) return std::nullopt;
  const std::vector<InnerKnot> inner = inner_knots(knots);
  RowMatrix result(from->count(), from->count());
  result.setIdentity();
  for (int p = degree + 1; p <= common_degree; ++p) {
    auto next = KnotVector::create(p, clamped_over(p, inner, p - degree));
    if (!next) return std::nullopt;
    result = RowMatrix(coarse_to_fine(*from, *next) * result);
    from = std::move(next);
  }
  return RowMatrix(coarse_to_fine(*from, *to) * result);
}

/// The independent ones of the conditions R_a E_a = R_b E_b: their number, the columns of both
/// minus the dimension of the intersection, is known. After a few dozen, elimination could not tell
/// the others from rounding.
std::optional<std::vector<Eigen::Index>> independent_rows(const RowMatrix& from_a,
                                                          const RowMatrix& from_b,
                                                          Eigen::Index common) {
  Eigen::MatrixXd both(from_a.cols() + from_b.cols(), from_a.rows());
  both << Eigen::MatrixXd(from_a.transpose()), -Eigen::MatrixXd(from_b.transpose());
  const auto factors = detail::PivotedQr::create(both);
  if (!factors) return std::nullopt;
  const Eigen::VectorXi& order = factors->order();
  std::vector<Eigen::Index> rows(order.data(), order.data() + (both.rows() - common));
  std::ranges::sort(rows);
  return rows;
}

}  // namespace

std::vector<double> normalised_knots(const KnotVector& knots, bool reversed) {
  const Interval domain = knots.domain();
  std::vector<double> t;
  t.reserve(knots.knots().size());
  for (double x : knots.knots()) {
    // Measured from the nearer end, so that mirrored knots have mirrored values.
    const double from_start = (x - domain.lower) / domain.length(),
                 from_end = (domain.upper - x) / domain.length();
    t.push_back(reversed ? (from_start < from_end ? 1 - from_start : from_end)
                         : (from_start < from_end ? from_start : 1 - from_end));
  }
  if (reversed) std::ranges::reverse(t);
  return t;
}

std::vector<InnerKnot> inner_knots(std::span<const double> normalised) {
  std::vector<InnerKnot> inner;
  for (double t : normalised) {
    if (t <= 0 || t >= 1) continue;
    if (inner.empty() || inner.back().t != t) inner.push_back({t, 0});
    ++inner.back().multiplicity;
  }
  return inner;
}

// A merge of two ascending lists. A pair is taken only if neither knot is nearer to the next one of
// the other list, so that clusters are matched one to one.
std::vector<std::pair<std::size_t, std::size_t>> matching_knots(std::span<const InnerKnot> a,
                                                                std::span<const InnerKnot> b,
                                                                double agreement) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    const double distance = std::abs(a[i].t - b[j].t);
    const bool next_a = i + 1 < a.size() && std::abs(a[i + 1].t - b[j].t) < distance;
    const bool next_b = j + 1 < b.size() && std::abs(a[i].t - b[j + 1].t) < distance;
    if (distance <= agreement && !next_a && !next_b) {
      pairs.emplace_back(i++, j++);
    } else if (a[i].t < b[j].t) {
      ++i;
    } else {
      ++j;
    }
  }
  return pairs;
}

// The common space has the higher degree q and, at every knot of either, the larger multiplicity
// after elevation: m_a + q − p_a or m_b + q − p_b. It contains both spaces. Their intersection is
// what both sides of a seam can do together; its dimension, min(p_a, p_b) + 1 and the
// multiplicities that both have, is known in integers, and says how many conditions are
// independent. Knots of b within `agreement` of one of a take its value first: spans that short
// between them would carry conditions of their own.
std::optional<CommonSpace> common_space(const KnotVector& a, const KnotVector& b, bool reversed,
                                        double agreement) {
  const std::vector<double> knots_a = normalised_knots(a, false);
  std::vector<double> knots_b = normalised_knots(b, reversed);
  const std::vector<InnerKnot> inner_a = inner_knots(knots_a);
  const int degree = std::max(a.degree(), b.degree());
  const int more_a = degree - a.degree(), more_b = degree - b.degree();

  CommonSpace result;
  std::vector<InnerKnot> inner_b = inner_knots(knots_b);
  const auto pairs = matching_knots(inner_a, inner_b, agreement);
  for (const auto& [i, j] : pairs) {
    result.mismatch = std::max(result.mismatch, std::abs(inner_a[i].t - inner_b[j].t));
    std::ranges::replace(knots_b, inner_b[j].t, inner_a[i].t);
    inner_b[j].t = inner_a[i].t;
  }
  if (!std::ranges::is_sorted(knots_b)) return std::nullopt;

  std::vector<InnerKnot> common;
  std::size_t j = 0, pair = 0;
  Eigen::Index shared = std::min(a.degree(), b.degree()) +
                        1;  // dimension of the intersection: the smoother of either
  result.same = more_a == 0 && more_b == 0 && inner_a.size() == inner_b.size() &&
                pairs.size() == inner_a.size();
  for (std::size_t i = 0; i < inner_a.size(); ++i) {
    while (j < inner_b.size() && inner_b[j].t < inner_a[i].t) {
      common.push_back({inner_b[j].t, inner_b[j].multiplicity + more_b});
      ++j;
    }
    InnerKnot knot{inner_a[i].t, inner_a[i].multiplicity + more_a};
    if (pair < pairs.size() && pairs[pair].first == i) {
      result.same = result.same && inner_b[j].multiplicity == inner_a[i].multiplicity;
      shared +=
          std::max(0, std::min(inner_a[i].multiplicity - more_b, inner_b[j].multiplicity - more_a));
      knot.multiplicity = std::max(knot.multiplicity, inner_b[j].multiplicity + more_b);
      ++j;
      ++pair;
    }
    common.push_back(knot);
  }
  for (; j < inner_b.size(); ++j)
    common.push_back({inner_b[j].t, inner_b[j].multiplicity + more_b});

  const std::vector<double> knots = clamped_over(degree, common, 0);
  auto from_a = onto(a.degree(), knots_a, degree, knots);
  auto from_b = onto(b.degree(), knots_b, degree, knots);
  if (!from_a || !from_b) return std::nullopt;
  result.from_a = std::move(*from_a);
  result.from_b = std::move(*from_b);
  if (a.degree() == b.degree()) {
    result.independent.resize(static_cast<std::size_t>(result.from_a.rows()));
    std::iota(result.independent.begin(), result.independent.end(), Eigen::Index{0});
  } else {
    auto independent = independent_rows(result.from_a, result.from_b, shared);
    if (!independent) return std::nullopt;
    result.independent = std::move(*independent);
  }
  if (reversed) {  // columns in b's own order
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index k = 0; k < result.from_b.outerSize(); ++k) {
      for (RowMatrix::InnerIterator it(result.from_b, k); it; ++it) {
        entries.emplace_back(static_cast<int>(k), b.count() - 1 - static_cast<int>(it.col()),
                             it.value());
      }
    }
    result.from_b.setFromTriplets(entries.begin(), entries.end());
  }
  return result;
}

// The numerator on the edge is Σ_j E_j B_j(t), one form E_j for each function along it; on a
// clamped end `value` has one entry a row.
EdgeForms edge_forms(const Surface& surface, SurfaceEdge edge) {
  const int across = edge_across(edge);
  const KnotVector& knots = surface.knots(across);
  const auto [m, n] = surface.net();
  const int count = surface.net()[at(1 - across)], p = knots.degree();
  const double end = edge_end(surface, edge), sign = edge_at_end(edge) ? -1 : 1;
  const int span = knots.find_span(end);
  std::vector<double> basis(at(2 * (p + 1)));
  basis_derivatives(knots, span, end, 1, basis.data());
  std::vector<Eigen::Triplet<double>> values, derivatives;
  for (int r = 0; r <= p; ++r) {
    for (int j = 0; j < count; ++j) {
      const int i = span - p + r, row = across == 0 ? i * n + j : j * n + i;
      const double weight = surface.rational() ? surface.weights()[at(row)] : 1;
      if (basis[at(r)] != 0) values.emplace_back(j, row, basis[at(r)] * weight);
      if (basis[at(p + 1 + r)] != 0)
        derivatives.emplace_back(j, row, sign * basis[at(p + 1 + r)] * weight);
    }
  }
  EdgeForms forms{RowMatrix(count, m * n), RowMatrix(count, m * n), {}, {}};
  forms.value.setFromTriplets(values.begin(), values.end());
  forms.derivative.setFromTriplets(derivatives.begin(), derivatives.end());
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(m * n);
  forms.weight = forms.value * ones;
  forms.weight_derivative = forms.derivative * ones;
  return forms;
}

}  // namespace knead::seams
