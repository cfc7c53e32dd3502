#include "chebyshev_interpolation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "greville_interpolation.hpp"

namespace knead {
namespace {

constexpr int most_rounds = 20;
constexpr double equal_level = 1.001;  // of the extrema, at which they count as equal
constexpr double rounding = 1e-12;     // relative, of values of the same height

/// The knots of one piece between knots of multiplicity p + 1, clamped.
std::vector<KnotVector> pieces_of(const KnotVector& knots) {
  const int p = knots.degree();
  const auto [lower, upper] = knots.domain();
  std::vector<KnotVector> pieces;
  std::vector<double> piece(static_cast<std::size_t>(p + 1), lower);
  const auto close = [&](double end) {
    piece.insert(piece.end(), static_cast<std::size_t>(p + 1), end);
    if (auto made = KnotVector::create(p, std::move(piece))) pieces.push_back(std::move(*made));
    piece.assign(static_cast<std::size_t>(p + 1), end);
  };
  std::vector<double> inside;
  std::ranges::copy_if(knots.knots(), std::back_inserter(inside),
                       [&](double x) { return x > lower && x < upper; });
  for (std::size_t k = 0; k < inside.size();) {
    const auto same = static_cast<std::size_t>(std::ranges::count(inside, inside[k]));
    if (same > static_cast<std::size_t>(p)) {
      close(inside[k]);
    } else {
      piece.insert(piece.end(), same, inside[k]);
    }
    k += same;
  }
  close(upper);
  return pieces;
}

/// The spline on one piece that is ±1 alternately at the sites, 1 at the last.
class Alternating {
 public:
  Alternating(const KnotVector& knots, const std::vector<double>& sites,
              const SiteInterpolation& at)
      : knots_(knots), sites_(sites), spans_(knots.spans()), coefficients_(sites.size()) {
    for (std::size_t i = 0; i < sites.size(); ++i) coefficients_[i] = sign(i);
    at.solve(coefficients_.data(), 1, 1);
  }

  /// Where there are several of one height, from the first to the last.
  struct Extremum {
    double first = 0, last = 0, value = 0;
    [[nodiscard]] double at() const { return 0.5 * (first + last); }
  };

  /// Of each site, the extremum around it.
  [[nodiscard]] std::vector<Extremum> extrema() const {
    std::vector<Extremum> result;
    for (const double site : sites_) result.push_back({site, site, 1});
    for (const int span : spans_) {
      const double a = knots_[span], b = knots_[span + 1];
      // Of degree p there are at most p − 1 extrema inside, crowded to the ends at worst as those
      // of a polynomial.
      const int samples = 4 * knots_.degree();
      Sample before{a, jet(span, a)};
      take(a, before.jet[0], result);
      for (int k = 1; k <= samples; ++k) {
        const double u =
            k == samples ? b : a + (b - a) * 0.5 * (1 - std::cos(std::numbers::pi * k / samples));
        if (!(u > before.at)) continue;
        const Sample after{u, jet(span, u)};
        take(u, after.jet[0], result);
        if (before.jet[1] * after.jet[1] < 0) take_between(span, before, after, result);
        before = after;
      }
    }
    return result;
  }

 private:
  struct Sample {
    double at = 0;
    std::array<double, 2> jet = {};
  };

  [[nodiscard]] double sign(std::size_t i) const {
    return (sites_.size() - 1 - i) % 2 == 0 ? 1 : -1;
  }

  /// Value and slope on a span.
  [[nodiscard]] std::array<double, 2> jet(int span, double u) const {
    const int p = knots_.degree();
    std::array<double, 2 * (max_degree + 1)> basis;
    basis_derivatives(knots_, span, u, 1, basis.data());
    std::array<double, 2> result = {0, 0};
    for (int r = 0; r <= p; ++r) {
      const double c = coefficients_[static_cast<std::size_t>(span - p + r)];
      result[0] += basis[static_cast<std::size_t>(r)] * c;
      result[1] += basis[static_cast<std::size_t>(p + 1 + r)] * c;
    }
    return result;
  }

  /// Takes the zero of the slope between two samples, to rounding: sites of mirrored knots are
  /// mirrored.
  void take_between(int span, const Sample& before, const Sample& after,
                    std::vector<Extremum>& result) const {
    double low = before.at, high = after.at;
    for (double middle = 0.5 * (low + high); middle > low && middle < high;
         middle = 0.5 * (low + high)) {
      (jet(span, middle)[1] * before.jet[1] > 0 ? low : high) = middle;
    }
    take(low, jet(span, low)[0], result);
  }

  /// Takes a value as that of the extremum around a site beside it, if it is of its sign and no
  /// smaller. Of two of one height neither is taken alone: mirrored knots have mirrored sites, the
  /// middle one included.
  void take(double u, double value, std::vector<Extremum>& result) const {
    const auto after = std::ranges::upper_bound(sites_, u) - sites_.begin();
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(after - 1, 0);
         i <= std::min(after, std::ssize(sites_) - 1); ++i) {
      const auto k = static_cast<std::size_t>(i);
      Extremum& there = result[k];
      const double height = value * sign(k);
      if (height > (1 + rounding) * there.value) {
        there = {u, u, height};
      } else if (height >= (1 - rounding) * there.value) {
        there = {std::min(there.first, u), std::max(there.last, u), std::max(there.value, height)};
      }
    }
  }

  const KnotVector& knots_;
  const std::vector<double>& sites_;
  std::vector<int> spans_;
  std::vector<double> coefficients_;
};

std::vector<double> sites_of_piece(const KnotVector& knots) {
  std::vector<double> sites = greville_sites(knots), best = sites;
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; round < most_rounds; ++round) {
    const auto at = SiteInterpolation::create(knots, sites);
    if (!at) break;
    const auto extrema = Alternating(knots, sites, *at).extrema();
    double level = 1;
    for (const auto& extremum : extrema) level = std::max(level, extremum.value);
    if (!(level < least)) break;  // no nearer: what is left is rounding
    least = level;
    best = sites;
    if (level <= equal_level) break;
    for (std::size_t i = 0; i < sites.size(); ++i) sites[i] = extrema[i].at();
  }
  return best;
}

}  // namespace

std::vector<double> chebyshev_sites(const KnotVector& knots) {
  const auto [begin, end] = functions_on_domain(knots);
  std::vector<double> sites(static_cast<std::size_t>(begin), knots.domain().lower);
  for (const KnotVector& piece : pieces_of(knots)) {
    const std::vector<double> more = sites_of_piece(piece);
    sites.insert(sites.end(), more.begin(), more.end());
  }
  sites.resize(static_cast<std::size_t>(knots.count()), knots.domain().upper);
  return sites;
}

Expected<ChebyshevInterpolation> ChebyshevInterpolation::create(const KnotVector& knots) {
  auto made = SiteInterpolation::create(knots, chebyshev_sites(knots));
  if (!made) return std::unexpected(made.error());
  return ChebyshevInterpolation(std::move(*made));
}

}  // namespace knead
