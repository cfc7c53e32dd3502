#include "nested_nets.hpp"

#include <algorithm>

#include "knead/spline/spline_refinement.hpp"

namespace knead {
namespace {

constexpr double even_span = 1.5;
constexpr double fewer = 0.75;  // as many control points at most as before, or nothing is gained

/// Without every second knot inside the domain, all of its repetitions.
///
/// The first movable knot inside goes, with all its repetitions, and the next one stays: about half
/// the spans are left. A knot of multiplicity p or more is a crease that bends for free; without it
/// no coarse function could represent the motion that costs least.
KnotVector without_every_second(const KnotVector& knots) {
  const Interval domain = knots.domain();
  std::vector<double> kept;
  bool leave_out = false;
  const std::span<const double> all = knots.knots();
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i + 1;
    while (end < all.size() && all[end] == all[i]) ++end;
    const std::size_t smooth =
        std::max<std::size_t>(1, static_cast<std::size_t>(knots.degree()) - 1);
    const bool movable = all[i] > domain.lower && all[i] < domain.upper && end - i <= smooth;
    if (movable) leave_out = !leave_out;
    if (!movable || !leave_out)
      kept.insert(kept.end(), all.begin() + static_cast<std::ptrdiff_t>(i),
                  all.begin() + static_cast<std::ptrdiff_t>(end));
    i = end;
  }
  auto made = KnotVector::create(knots.degree(), std::move(kept));
  return made ? *made : knots;
}

template <int D>
using Nets = std::vector<std::array<KnotVector, D>>;

/// One step coarser.
///
/// Semi-coarsening: the smoother damps what oscillates along short spans, since these have the
/// large eigenvalues. Leaving out knots along long ones as well would leave functions that neither
/// the smoother nor the coarser space reaches.
template <int D>
Nets<D> coarser(const Nets<D>& nets, std::span<const DomainScaling<D>> scalings) {
  Nets<D> result = nets;
  for (std::size_t k = 0; k < nets.size(); ++k) {
    std::array<double, D> span{};
    for (std::size_t d = 0; d < D; ++d) {
      const KnotVector& knots = nets[k][d];
      span[d] = knots.domain().length() * scalings[k].factors[d] /
                static_cast<double>(knots.spans().size());
    }
    const double shortest = *std::ranges::min_element(span);
    for (std::size_t d = 0; d < D; ++d) {
      if (span[d] <= even_span * shortest) result[k][d] = without_every_second(nets[k][d]);
    }
  }
  return result;
}

template <int D>
int size_of(const std::array<KnotVector, D>& net) {
  int size = 1;
  for (const KnotVector& knots : net) size *= knots.count();
  return size;
}

template <int D>
int size_of(const Nets<D>& nets) {
  int size = 0;
  for (const auto& net : nets) size += size_of<D>(net);
  return size;
}

/// Appends the rows of R₀ ⊗ … of one patch, `row` and `column` its first ones.
///
/// P = R₀ ⊗ R₁ ⊗ …, R_d the knot insertion of one direction: row i of P is the product of one row
/// of each, last direction fastest.
template <int D>
void append(const std::array<KnotVector, D>& from, const std::array<KnotVector, D>& to, int row,
            int column, std::vector<Eigen::Triplet<double>>& entries) {
  std::vector<Refinement> maps;
  for (std::size_t d = 0; d < D; ++d) {
    auto map = Refinement::create(from[d], to[d]);
    if (!map) return;
    maps.push_back(std::move(*map));
  }
  const int size = size_of<D>(to);
  for (int i = 0; i < size; ++i) {
    std::vector<std::pair<int, double>> terms = {{0, 1.0}};
    int rest = i, stride = size;
    for (std::size_t d = 0; d < D; ++d) {
      stride /= to[d].count();
      const int here = rest / stride;
      rest %= stride;
      std::vector<std::pair<int, double>> next;
      const auto values = maps[d].row(here);
      for (const auto& [place, value] : terms) {
        for (std::size_t j = 0; j < values.size(); ++j) {
          if (values[j] == 0) continue;
          next.emplace_back(place * from[d].count() + maps[d].first(here) + static_cast<int>(j),
                            value * values[j]);
        }
      }
      terms = std::move(next);
    }
    for (const auto& [place, value] : terms) entries.emplace_back(row + i, column + place, value);
  }
}

}  // namespace

// Rational patches have the same P, without weights: coarse spaces are then not quite subspaces of
// functions, which costs iterations alone, as B stays symmetric and positive for any P.
template <int D>
std::vector<SparseMatrix> nested_prolongations(std::span<const Spline<D>> patches,
                                               std::span<const DomainScaling<D>> scalings,
                                               int enough) {
  Nets<D> fine;
  for (const Spline<D>& patch : patches) {
    std::array<KnotVector, D> net = [&]<std::size_t... d>(std::index_sequence<d...>) {
      return std::array<KnotVector, D>{patch.knots(static_cast<int>(d))...};
    }
    (std::make_index_sequence<D>());
    fine.push_back(std::move(net));
  }
  std::vector<SparseMatrix> result;
  while (size_of<D>(fine) > enough) {
    Nets<D> coarse = coarser<D>(fine, scalings);
    // Creases or fixed knots everywhere: a cycle over spaces that hardly shrink costs more than it
    // gains.
    if (size_of<D>(coarse) > fewer * size_of<D>(fine)) return {};
    std::vector<Eigen::Triplet<double>> entries;
    int row = 0, column = 0;
    for (std::size_t k = 0; k < fine.size(); ++k) {
      append<D>(coarse[k], fine[k], row, column, entries);
      row += size_of<D>(fine[k]);
      column += size_of<D>(coarse[k]);
    }
    SparseMatrix p(row, column);
    p.setFromTriplets(entries.begin(), entries.end());
    result.push_back(std::move(p));
    fine = std::move(coarse);
  }
  return result;
}

template std::vector<SparseMatrix> nested_prolongations<1>(std::span<const Spline<1>>,
                                                           std::span<const DomainScaling<1>>, int);
template std::vector<SparseMatrix> nested_prolongations<2>(std::span<const Spline<2>>,
                                                           std::span<const DomainScaling<2>>, int);
template std::vector<SparseMatrix> nested_prolongations<3>(std::span<const Spline<3>>,
                                                           std::span<const DomainScaling<3>>, int);

}  // namespace knead
