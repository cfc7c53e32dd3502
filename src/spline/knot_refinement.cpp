#include "knead/spline/spline_refinement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace knead {
namespace {

using Row = std::array<double, max_degree + 1>;

/// The polar form of the polynomial piece on `span` at p ascending arguments: Σ_r out[r]
/// c_{span−p+r}.
void polar_form(const KnotVector& x, int span, const double* arguments, Row& out) {
  const int p = x.degree();
  out.fill(0);
  for (int j = span - p; j <= span; ++j) {
    if (std::equal(arguments, arguments + p, x.knots().begin() + j + 1)) {
      out[static_cast<std::size_t>(j - span + p)] = 1;
      return;
    }
  }
  // Outwards from the span, first to the right and then to the left: in this order each argument
  // leaves only functions for which the next one has factors of the same sign.
  Row ordered{};
  const double* inside = std::lower_bound(arguments, arguments + p, x[span]);
  std::reverse_copy(arguments, inside, std::copy(inside, arguments + p, ordered.begin()));
  out[0] = 1;
  for (int k = 1; k <= p; ++k) {
    const double t = ordered[static_cast<std::size_t>(k - 1)];
    double from_left = 0;
    for (int r = 0; r < k; ++r) {
      const double lower = x[span - k + 1 + r], upper = x[span + 1 + r], length = upper - lower;
      const double value = out[static_cast<std::size_t>(r)];
      // A zero stays a zero of positive sign, whatever its factor.
      out[static_cast<std::size_t>(r)] =
          from_left + (value == 0 ? 0 : (upper - t) / length * value);
      from_left = value == 0 ? 0 : (t - lower) / length * value;
    }
    out[static_cast<std::size_t>(k)] = from_left;
  }
}

/// If function i of y has no support in the domain and is one of x: its index there; −1 otherwise.
int outside(const KnotVector& x, const KnotVector& y, int i) {
  const int p = x.degree();
  const Interval domain = y.domain();
  if (y.degree() != p || (y[i + p + 1] > domain.lower && y[i] < domain.upper)) return -1;
  for (int j = 0; j < x.count(); ++j) {
    if (std::equal(y.knots().begin() + i, y.knots().begin() + i + p + 2, x.knots().begin() + j))
      return j;
  }
  return -1;
}

/// Every distinct knot strictly inside the domain.
std::vector<double> inner_breaks(const KnotVector& knots) {
  std::vector<double> breaks;
  const Interval domain = knots.domain();
  for (const double x : knots.knots()) {
    if (domain.lower < x && x < domain.upper && (breaks.empty() || breaks.back() < x))
      breaks.push_back(x);
  }
  return breaks;
}

Expected<void> check_inserted(const KnotVector& knots, std::span<const double> inserted) {
  for (std::size_t k = 0; k < inserted.size(); ++k) {
    const double u = inserted[k];
    const auto where = fmt::format("inserted knot {}", k);
    if (!std::isfinite(u)) return input_error("the knot is not a finite number", where);
    if (!knots.domain().contains(u)) {
      return input_error(
          fmt::format("the knot {} is outside of the domain", u), where,
          fmt::format("insert knots from {} to {}", knots.domain().lower, knots.domain().upper));
    }
    const auto before =
        std::count(inserted.begin(), inserted.begin() + static_cast<std::ptrdiff_t>(k) + 1, u);
    if (knots.multiplicity(u) + before > knots.degree() + 1) {
      return input_error(
          fmt::format("the knot {} would be repeated more than {} times", u, knots.degree() + 1),
          where, fmt::format("it stands there {} times already", knots.multiplicity(u)));
    }
  }
  return {};
}

std::vector<double> merged(std::span<const double> knots, std::vector<double> more) {
  more.insert(more.end(), knots.begin(), knots.end());
  std::ranges::stable_sort(more);
  return more;
}

}  // namespace

Expected<KnotVector> with_knots(const KnotVector& knots, std::span<const double> inserted) {
  if (auto valid = check_inserted(knots, inserted); !valid)
    return std::unexpected(std::move(valid.error()));
  return KnotVector::create(knots.degree(),
                            merged(knots.knots(), {inserted.begin(), inserted.end()}));
}

Expected<KnotVector> with_periodic_knots(const KnotVector& knots,
                                         std::span<const double> inserted) {
  if (auto valid = check_inserted(knots, inserted); !valid)
    return std::unexpected(std::move(valid.error()));
  const auto [a, b] = knots.domain();
  if (knots.clamped_start() || knots.clamped_end()) {
    return input_error("clamped knots are not periodic", {}, "insert without periodicity");
  }
  std::vector<double> more(inserted.begin(), inserted.end());
  for (std::size_t k = 0; k < inserted.size(); ++k) {
    if (inserted[k] == a || inserted[k] == b) {
      return input_error("the knot is an end of the period", fmt::format("inserted knot {}", k),
                         "insert knots inside the domain");
    }
    for (const double image : {inserted[k] - (b - a), inserted[k] + (b - a)}) {
      if ((knots[0] < image && image < a) || (b < image && image < knots.knots().back()))
        more.push_back(image);
    }
  }
  const auto all = merged(knots.knots(), std::move(more));
  // The p knots next to the domain on either side; the knots at its ends stay.
  const auto before = std::ranges::lower_bound(knots.knots(), a) - knots.knots().begin();
  const auto after = knots.knots().end() - std::ranges::upper_bound(knots.knots(), b);
  const auto first = std::ranges::lower_bound(all, a) - before,
             last = std::ranges::upper_bound(all, b) + after;
  return KnotVector::create(knots.degree(), {first, last});
}

Expected<KnotVector> elevated_knots(const KnotVector& knots) {
  const int q = knots.degree() + 1;
  if (q > max_degree) {
    return input_error(fmt::format("degree {} cannot be elevated", knots.degree()), {},
                       fmt::format("degrees go to {}", max_degree));
  }
  const auto x = knots.knots();
  // Every distinct knot once more: degree and multiplicity grow by one, continuity stays.
  std::vector<double> raised;
  for (std::size_t k = 0; k < x.size(); ++k) {
    raised.push_back(x[k]);
    if (k + 1 == x.size() || x[k] < x[k + 1]) raised.push_back(x[k]);
  }
  const Interval domain = knots.domain();
  const auto first = std::ranges::upper_bound(raised, domain.lower) - 1 - q;
  const auto last = std::ranges::lower_bound(raised, domain.upper) + 1 + q;
  return KnotVector::create(q, {first, last});
}

KnotVector bezier_knots(const KnotVector& knots) {
  std::vector<double> breaks{knots.domain().lower};
  for (const double x : inner_breaks(knots)) breaks.push_back(x);
  breaks.push_back(knots.domain().upper);
  std::vector<double> all;
  for (const double x : breaks)
    all.insert(all.end(), static_cast<std::size_t>(knots.degree() + 1), x);
  return *KnotVector::create(knots.degree(), std::move(all));
}

std::vector<double> span_midpoints(const KnotVector& knots, Interval interval) {
  std::vector<double> result;
  for (const int s : knots.spans()) {
    const double a = knots[s], b = knots[s + 1], middle = std::midpoint(a, b);
    const bool meets = interval.lower < interval.upper ? interval.lower < b && a < interval.upper
                                                       : interval.lower <= b && a <= interval.upper;
    if (meets && a < middle && middle < b) result.push_back(middle);
  }
  return result;
}

Expected<Refinement> Refinement::create(KnotVector from, KnotVector to) {
  const int p = from.degree(), q = to.degree();
  if (q != p && q != p + 1) {
    return input_error(fmt::format("degree {} does not become degree {} in one step", p, q), {},
                       "keep the degree, or raise it by one");
  }
  if (from.domain().lower != to.domain().lower || from.domain().upper != to.domain().upper) {
    return input_error(fmt::format("the domain [{}, {}] is not [{}, {}]", to.domain().lower,
                                   to.domain().upper, from.domain().lower, from.domain().upper));
  }
  for (const double u : inner_breaks(from)) {
    const int needed = from.multiplicity(u) + q - p;
    if (to.multiplicity(u) < needed) {
      return input_error(fmt::format("the knot {} stands {} times", u, to.multiplicity(u)), {},
                         fmt::format("it must stand {} times at least", needed));
    }
  }

  Refinement result(std::move(from), std::move(to));
  const KnotVector& x = result.from_;
  const KnotVector& y = result.to_;
  const Interval domain = x.domain();
  for (int i = 0; i < y.count(); ++i) {
    const double* arguments = y.knots().data() + i + 1;
    Row row{};
    if (const int j = outside(x, y, i); j >= 0) {
      const int first = std::min(j, x.count() - p - 1);
      row[static_cast<std::size_t>(j - first)] = 1;
      result.first_.push_back(first);
      result.copied_.push_back(j);
      result.values_.insert(result.values_.end(), row.begin(), row.begin() + p + 1);
      continue;
    }
    // A piece under function i; any will do.
    const int span = x.find_span(std::clamp(y[i], domain.lower, domain.upper));
    if (q == p) {
      polar_form(x, span, arguments, row);
    } else {
      // The polar form of a polynomial of degree p as one of degree q = p + 1 is the mean over all
      // ways of leaving one argument out (Ramshaw).
      Row others{}, part{};
      for (int left_out = 0; left_out < q; ++left_out) {
        std::copy(arguments + left_out + 1, arguments + q,
                  std::copy(arguments, arguments + left_out, others.begin()));
        polar_form(x, span, others.data(), part);
        for (std::size_t r = 0; r < row.size(); ++r) row[r] += part[r];
      }
      for (double& value : row) value /= q;
    }
    const auto end = row.begin() + p + 1;
    const auto unit = std::find(row.begin(), end, 1.0);
    // A row that is a unit vector copies a control point bit by bit.
    const bool copies = unit != end && std::count(row.begin(), end, 0.0) == p;
    result.first_.push_back(span - p);
    result.copied_.push_back(copies ? span - p + static_cast<int>(unit - row.begin()) : -1);
    result.values_.insert(result.values_.end(), row.begin(), end);
  }
  return result;
}

void Refinement::apply(const double* in, double* out, int outer, int inner) const {
  const auto step = static_cast<std::size_t>(inner);
  const auto rows = static_cast<std::size_t>(to_.count()),
             columns = static_cast<std::size_t>(from_.count());
  for (std::size_t o = 0; o < static_cast<std::size_t>(outer); ++o) {
    for (std::size_t i = 0; i < rows; ++i) {
      double* const to = out + (o * rows + i) * step;
      const double* const block = in + o * columns * step;
      if (const int j = copied_[i]; j >= 0) {
        std::copy_n(block + static_cast<std::size_t>(j) * step, step, to);
        continue;
      }
      std::fill_n(to, step, 0.0);
      const auto entries = row(static_cast<int>(i));
      for (std::size_t r = 0; r < entries.size(); ++r) {
        if (entries[r] == 0) continue;
        const double* const from = block + (static_cast<std::size_t>(first_[i]) + r) * step;
        for (std::size_t c = 0; c < step; ++c) to[c] += entries[r] * from[c];
      }
    }
  }
}

Eigen::SparseMatrix<double> Refinement::matrix() const {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < to_.count(); ++i) {
    const auto values = row(i);
    for (std::size_t r = 0; r < values.size(); ++r) {
      if (values[r] != 0) entries.emplace_back(i, first(i) + static_cast<int>(r), values[r]);
    }
  }
  Eigen::SparseMatrix<double> result(to_.count(), from_.count());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace knead
