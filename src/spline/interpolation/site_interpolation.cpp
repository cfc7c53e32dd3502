#include "site_interpolation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace knead {

FunctionsOnDomain functions_on_domain(const KnotVector& knots) {
  const int n = knots.count(), p = knots.degree();
  const auto [lower, upper] = knots.domain();
  FunctionsOnDomain result{0, n};
  while (knots[result.begin + p + 1] <= lower) ++result.begin;
  while (knots[result.end - 1] >= upper) --result.end;
  return result;
}

Expected<SiteInterpolation> SiteInterpolation::create(const KnotVector& knots,
                                                      std::vector<double> sites) {
  assert(static_cast<int>(sites.size()) == knots.count());
  const int p = knots.degree();
  SiteInterpolation result;
  result.degree_ = p;
  const auto [begin, end] = functions_on_domain(knots);
  result.begin_ = begin;
  result.end_ = end;
  result.abscissae_ = std::move(sites);
  for (int i = 0; i < knots.count(); ++i) {
    result.sides_.push_back(knots[i + 1] == knots[i + p + 1] ? Side::left : Side::right);
  }
  result.basis_ = result.tabulate(knots);
  if (auto factored = result.factor(); !factored) return std::unexpected(factored.error());
  return result;
}

// L U of the band by rows, i − p to i + p: without pivoting there is no fill outside it. L and U of
// a totally positive matrix have no negative entries, so that |L| |U| = |C| and rounding does not
// grow. A pivot that is not positive shows that sites break the condition of Schoenberg and Whitney
// by rounding.
Expected<void> SiteInterpolation::factor() {
  const int p = degree_, width = 2 * p + 1;
  lu_.assign(abscissae_.size() * static_cast<std::size_t>(width), 0.0);
  const auto entry = [&](int i, int j) -> double& {
    return lu_[static_cast<std::size_t>(i) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(j - i + p)];
  };
  for (int i = begin_; i < end_; ++i) {
    const int first = basis_.first[static_cast<std::size_t>(i)];
    // Functions of the span outside the band or outside begin … end are zero here.
    for (int r = 0; r <= p; ++r) {
      const int j = first + r;
      if (j >= std::max(begin_, i - p) && j < std::min(end_, i + p + 1))
        entry(i, j) = basis_.row(i, 0)[r];
    }
  }
  for (int k = begin_; k < end_; ++k) {
    const double pivot = entry(k, k);
    if (!(pivot > 0)) {
      return numerical_error(
          fmt::format("the abscissa {} of function {} does not separate it from its neighbours",
                      abscissae_[static_cast<std::size_t>(k)], k),
          {}, "remove knots that lie closer together than rounding can tell apart");
    }
    const int last = std::min(end_ - 1, k + p);
    for (int i = k + 1; i <= last; ++i) {
      const double factor = entry(i, k) /= pivot;
      if (factor == 0) continue;
      for (int j = k + 1; j <= last; ++j) entry(i, j) -= factor * entry(k, j);
    }
  }
  return {};
}

BasisTable SiteInterpolation::tabulate(const KnotVector& other) const {
  const auto width = static_cast<std::size_t>(other.degree() + 1);
  BasisTable table{other.degree(), 0, std::vector<int>(abscissae_.size()),
                   std::vector<double>(abscissae_.size() * width)};
  for (std::size_t i = 0; i < abscissae_.size(); ++i) {
    const int span = other.find_span(abscissae_[i], sides_[i]);
    table.first[i] = span - other.degree();
    basis_values(other, span, abscissae_[i], table.derivatives.data() + i * width);
  }
  return table;
}

// Rows of `inner` numbers are combined as a whole: memory is read in order, whichever direction of
// the tensor is solved.
void SiteInterpolation::solve(double* values, std::size_t outer, std::size_t inner) const {
  const int n = size(), p = degree_;
  const auto entry = [&](int i, int j) {
    return lu_[static_cast<std::size_t>(i) * static_cast<std::size_t>(2 * p + 1) +
               static_cast<std::size_t>(j - i + p)];
  };
  for (std::size_t o = 0; o < outer; ++o, values += static_cast<std::size_t>(n) * inner) {
    const auto row = [&](int i) { return values + static_cast<std::size_t>(i) * inner; };
    const auto eliminate = [&](int i, int j) {
      const double factor = entry(i, j);
      for (std::size_t c = 0; c < inner; ++c) row(i)[c] -= factor * row(j)[c];
    };
    std::fill(row(0), row(begin_), 0.0);
    std::fill(row(end_), row(n), 0.0);
    for (int i = begin_; i < end_; ++i) {
      for (int j = std::max(begin_, i - p); j < i; ++j) eliminate(i, j);
    }
    for (int i = end_; i-- > begin_;) {
      for (int j = i + 1; j <= std::min(end_ - 1, i + p); ++j) eliminate(i, j);
      const double pivot = entry(i, i);
      for (std::size_t c = 0; c < inner; ++c) row(i)[c] /= pivot;
    }
  }
}

}  // namespace knead
