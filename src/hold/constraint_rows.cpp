#include "constraint_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/decompositions.hpp"

namespace knead::detail {

LocalBasis::LocalBasis(const KnotVector& knots, int span, double u, int order)
    : first(span - knots.degree()),
      degree(knots.degree()),
      values(static_cast<std::size_t>((order + 1) * (knots.degree() + 1))) {
  basis_derivatives(knots, span, u, order, values.data());
}

// A derivative of order k jumps at a knot of multiplicity m where m + k > p: there a condition is
// needed for either side, elsewhere one serves both.
std::vector<int> spans_at(const KnotVector& knots, double c, int order) {
  const int left = knots.find_span(c, Side::left), right = knots.find_span(c, Side::right);
  if (left == right) return {right};
  return knots.multiplicity(c) + order > knots.degree() ? std::vector<int>{left, right}
                                                        : std::vector<int>{right};
}

// R = w N / W; ∂R = (w ∂N − R ∂W)/W. Polynomial surfaces return before the quotient, so that their
// coefficients are the values of B-splines to the bit.
Expected<Terms> rational_row(const Surface& s, double u, double v, int span_u, int span_v,
                             int along, double* denominator) {
  const LocalBasis a(s.knots(0), span_u, u, 1), b(s.knots(1), span_v, v, 1);
  const int n = s.net()[1], da = along == 0 ? 1 : 0, db = along == 1 ? 1 : 0;
  Terms value, derivative;
  double w = 0, dw = 0;
  for (int i = a.first; i <= a.last(); ++i) {
    for (int j = b.first; j <= b.last(); ++j) {
      const int k = i * n + j;
      const double weight = s.rational() ? s.weights()[static_cast<std::size_t>(k)] : 1;
      value.emplace_back(k, weight * a.at(i, 0) * b.at(j, 0));
      derivative.emplace_back(k, weight * a.at(i, da) * b.at(j, db));
      w += value.back().second;
      dw += derivative.back().second;
    }
  }
  if (denominator != nullptr) *denominator = w;
  if (!s.rational()) return derivative;
  if (!(w > 0)) {
    return numerical_error("the denominator of the surface is not positive",
                           fmt::format("({}, {})", u, v));
  }
  for (std::size_t k = 0; k < value.size(); ++k) {
    if (along >= 0) derivative[k].second -= value[k].second * (dw / w);
    derivative[k].second /= w;
  }
  return derivative;
}

// The largest coefficient is 1, so that violations of different constraints are lengths alike
// (`ConstraintSpace::worst`), whatever the domain's.
void append(ConstraintList& to, const std::string& name, Terms terms,
            const std::optional<Point>& normal) {
  std::erase_if(terms, [](const auto& term) { return term.second == 0; });
  if (terms.empty()) return;
  if (terms.size() == 1 && !normal) {
    to.hold(terms.front().first, name);
    return;
  }
  double largest = 0;
  for (const auto& [unknown, c] : terms) largest = std::max(largest, std::abs(c));
  for (auto& [unknown, c] : terms) c /= largest;
  to.constraints.push_back({name, std::move(terms), Point::Zero(), normal});
}

// QR with column pivoting (Businger and Golub, "Linear least squares solutions by Householder
// transformations", 1965) chooses rows that are far from combinations of those before:
// well-conditioned pivots for the elimination, and a measured remainder of all others. The rank
// starts where the diagonal of R falls below the tolerance, and grows while a remainder, in the
// 1-norm, exceeds it. Cost: O(m n min(m, n)) for m rows and n unknowns near the curve.
Expected<SelectedRows> select_rows(const std::vector<Terms>& rows, double tolerance) {
  std::map<int, Eigen::Index> columns;
  for (const Terms& row : rows) {
    for (const auto& [unknown, c] : row) columns.try_emplace(unknown, 0);
  }
  Eigen::Index next = 0;
  for (auto& [unknown, column] : columns) column = next++;
  // The conditions are the columns of the matrix, from which the decomposition chooses.
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(next, static_cast<Eigen::Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (const auto& [unknown, c] : rows[k])
      a(columns.at(unknown), static_cast<Eigen::Index>(k)) += c;
  }
  const auto qr = PivotedQr::create(a);
  if (!qr) return std::unexpected(qr.error());
  const Eigen::Index most = qr->pivots();
  const auto remainder_of = [&](Eigen::Index rank) {
    return rank == most ? 0.0 : qr->remainder(rank).cwiseAbs().colwise().sum().maxCoeff();
  };
  // The diagonal of R decreases, and a remainder is at most √n times it; remainders of rounding are
  // not independent.
  SelectedRows result;
  for (double threshold = tolerance;; threshold /= 4) {
    Eigen::Index rank = 0;
    while (rank < most && qr->pivot(rank) > std::max(threshold, 1e-13)) ++rank;
    result.remainder = remainder_of(rank);
    if (result.remainder > tolerance && threshold > 1e-13) continue;
    for (Eigen::Index k = 0; k < rank; ++k) result.chosen.push_back(qr->order()[k]);
    std::ranges::sort(result.chosen);  // neighbours together: elimination is then many times faster
    return result;
  }
}

Expected<void> check_parameter(const KnotVector& knots, double u, const char* name) {
  const Interval domain = knots.domain();
  if (domain.contains(u)) return {};
  return input_error(fmt::format("{} lies outside of the domain", u), name,
                     fmt::format("take a number from {} to {}", domain.lower, domain.upper));
}

Expected<void> check_tolerance(double tolerance, const char* name) {
  if (std::isfinite(tolerance) && tolerance >= 0) return {};
  return input_error(fmt::format("{} is not a tolerance", tolerance), name,
                     "use a finite number >= 0");
}

}  // namespace knead::detail
