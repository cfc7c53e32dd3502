#include "fit_nets.hpp"

#include <cmath>
#include <numeric>

#include "brep/boundary_curve.hpp"
#include "brep/check/bare_faces.hpp"
#include "knead/brep/model.hpp"

namespace knead::morph {
namespace {

constexpr double same_point = 1e-9;   // of the diagonal of the net, as for `closed_directions`
constexpr double flat_ring = 1e-6;    // rings are flat whose singular values are below this share
constexpr double same_weight = 1e-9;  // relative

/// Sets of control points that move as one: a forest, of which the least member is the root.
class Joined {
 public:
  explicit Joined(int count) : root_(static_cast<std::size_t>(count)) {
    std::iota(root_.begin(), root_.end(), 0);
  }
  int find(int k) {
    while (root(k) != k) k = root(k) = root(root(k));
    return k;
  }
  void join(int a, int b) {
    a = find(a);
    b = find(b);
    root(std::max(a, b)) = std::min(a, b);
  }

 private:
  int& root(int k) { return root_[static_cast<std::size_t>(k)]; }
  std::vector<int> root_;
};

/// Whether all control points of the row at an end are one point.
bool is_pole(const detail::NetAcross& net, int row) {
  const double near = same_point * brep::net_diagonal(net.surface().control_points());
  for (int j = 1; j < net.columns(); ++j) {
    if ((net.point(row, j) - net.point(row, 0)).norm() > near) return false;
  }
  return true;
}

/// Whether the rational bases of the first and the last row are the same.
bool same_bases(const detail::NetAcross& net) {
  const int last = net.rows() - 1;
  const double ratio = net.weight(last, 0) / net.weight(0, 0);
  for (int j = 0; j < net.columns(); ++j) {
    if (!(std::abs(net.weight(last, j) - ratio * net.weight(0, j)) <=
          same_weight * std::abs(net.weight(last, j))))
      return false;
  }
  return true;
}

/// A surface that is a curve stays one, and one that is a point.
void join_collapsed(const Surface& surface, int first, Joined& joined) {
  const auto collapsed = brep::collapsed_directions(surface);
  for (int d = 0; d < 2; ++d) {
    const detail::NetAcross net(surface, d);
    for (int row = 1; collapsed[static_cast<std::size_t>(d)] && row < net.rows(); ++row) {
      for (int j = 0; j < net.columns(); ++j)
        joined.join(first + net.index(0, j), first + net.index(row, j));
    }
  }
}

void join_ends(const Surface& surface, const VisibleRegion& region, int first, Joined& joined) {
  const auto closed = brep::closed_directions(surface);
  for (int d = 0; d < 2; ++d) {
    const detail::NetAcross net(surface, d);
    const auto at = static_cast<std::size_t>(d);
    for (int end = 0; end < 2; ++end) {
      const int row = end == 0 ? 0 : net.rows() - 1;
      if (!region.poles[at][static_cast<std::size_t>(end)] && !is_pole(net, row)) continue;
      for (int j = 1; j < net.columns(); ++j)
        joined.join(first + net.index(row, 0), first + net.index(row, j));
    }
    if (!closed[at] || !net.knots().clamped() || !same_bases(net)) continue;
    for (int j = 0; j < net.columns(); ++j)
      joined.join(first + net.index(0, j), first + net.index(net.rows() - 1, j));
  }
}

/// A side that has no speed at its ends or in whole spans, as control points there coincide, still
/// has none: where derivatives of S along it vanish so do those of D ∘ S, whatever D is. Else
/// tangent planes there would be by chance, and faces that meet there come apart.
void join_still_sides(const Surface& surface, int first, Joined& joined) {
  const double near = same_point * brep::net_diagonal(surface.control_points());
  for (int d = 0; d < 2; ++d) {
    const detail::NetAcross net(surface, d);
    const bool clamped = net.knots().clamped();
    for (const int j : {0, net.columns() - 1}) {
      for (int begin = 0, end = 0; begin < net.rows(); begin = end) {
        for (end = begin + 1; end < net.rows(); ++end) {
          if ((net.point(end, j) - net.point(begin, j)).norm() > near) break;
        }
        const bool at_end = clamped && (begin == 0 || end == net.rows());
        if (!at_end && end - begin <= net.knots().degree()) continue;
        for (int row = begin + 1; row < end; ++row)
          joined.join(first + net.index(begin, j), first + net.index(row, j));
      }
    }
  }
}

}  // namespace

void FitNets::number(std::span<const FitSurface> given) {
  first.assign(1, 0);
  for (const Surface& s : surfaces) first.push_back(first.back() + s.size());
  Joined joined(first.back());
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (fixed[s]) continue;
    join_ends(surfaces[s], given[s].region, first[s], joined);
    join_collapsed(surfaces[s], first[s], joined);
    join_still_sides(surfaces[s], first[s], joined);
  }
  unknown.assign(static_cast<std::size_t>(first.back()), -1);
  unknowns = 0;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (fixed[s]) continue;
    for (int k = first[s]; k < first[s + 1]; ++k) {
      const int root = joined.find(k);
      unknown[static_cast<std::size_t>(k)] =
          root == k ? unknowns++ : unknown[static_cast<std::size_t>(root)];
    }
  }
}

Expected<void> FitNets::hold(std::span<const FitSurface> given) {
  kept = ConstraintList(unknowns);
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (fixed[s]) continue;
    Expected<ConstraintList> own = ConstraintList(surfaces[s].size());
    if (given[s].holds) own = given[s].holds->conditions(surfaces[s]);
    if (!own) return std::unexpected(own.error());
    const double size = brep::net_diagonal(surfaces[s].control_points());
    const auto poles = keep_poles(surfaces[s], same_point * size, flat_ring, *own);
    if (!poles) return std::unexpected(poles.error());
    const auto of = [&](int k) { return unknown[static_cast<std::size_t>(first[s] + k)]; };
    for (int k = 0; k < surfaces[s].size(); ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (own->held[at]) kept.hold(of(k), own->held_by[at]);
    }
    for (LinearConstraint& condition : own->constraints) {
      for (auto& [k, c] : condition.terms) k = of(k);
      condition.value.setZero();
      kept.constraints.push_back(std::move(condition));
    }
  }
  return {};
}

Expected<void> FitNets::add_row(int surface, const std::array<double, 2>& at, Side side, int along,
                                double factor, Terms& to) const {
  if (stays(surface) || factor == 0) return {};
  const auto s = static_cast<std::size_t>(surface);
  const Surface& shape = surfaces[s];
  const auto row = detail::rational_row(shape, at[0], at[1], shape.knots(0).find_span(at[0], side),
                                        shape.knots(1).find_span(at[1], side), along);
  if (!row) return std::unexpected(row.error());
  for (const auto& [k, c] : *row)
    to.emplace_back(unknown[static_cast<std::size_t>(first[s] + k)], factor * c);
  return {};
}

Points FitNets::of_surface(int surface, const Points& x) const {
  const auto s = static_cast<std::size_t>(surface);
  Points result = Points::Zero(surfaces[s].size(), 3);
  if (fixed[s]) return result;
  for (int k = 0; k < surfaces[s].size(); ++k)
    result.row(k) = x.row(unknown[static_cast<std::size_t>(first[s] + k)]);
  return result;
}

Point value_of(const Terms& row, const Points& x) {
  Point result = Point::Zero();
  for (const auto& [k, c] : row) result += c * x.row(k).transpose();
  return result;
}

}  // namespace knead::morph
