#include "placing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "holding.hpp"
#include "knead/base/error_code.hpp"
#include "knead/hold/seams.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/extremum.hpp"
#include "refining.hpp"
#include "scene/model/model.hpp"
#include "scene/places.hpp"
#include "spline/onto_net.hpp"

namespace knead {
namespace {

constexpr double symmetry_tolerance = 1e-9;  // of the largest move
constexpr double limit_tolerance = 1e-6;     // relative, as for steps
constexpr double frozen_tolerance = 1e-7;    // of the size, on another basis
constexpr double seam_tolerance = 1e-6;      // of the size, beyond what a seam was open

// By bits, so that 0 and −0 differ: a file that is written keeps the sign.
bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same_bits(const Points& a, const Points& b, Eigen::Index row) {
  return same_bits(a(row, 0), b(row, 0)) && same_bits(a(row, 1), b(row, 1)) &&
         same_bits(a(row, 2), b(row, 2));
}

/// p + 2 places in every span of a part of a domain, its ends included.
std::vector<double> places_in(const KnotVector& knots, const Interval& part) {
  std::vector<double> places = {part.lower};
  const int count = knots.degree() + 2;
  const auto all = knots.knots();
  for (std::size_t k = 0; k + 1 < all.size(); ++k) {
    const double lower = std::max(all[k], part.lower), upper = std::min(all[k + 1], part.upper);
    for (int i = 1; i <= count && lower < upper; ++i)
      places.push_back(lower + (upper - lower) * i / count);
  }
  return places;
}

/// A surface that a command has changed.
struct Placed {
  const SceneSurface& now;
  const Surface& before;
  std::string_view command;

  [[nodiscard]] Expected<void> check_frozen(const Freeze& freeze) const {
    const auto region = region_at(before, freeze.region);
    if (!region) return std::unexpected(region.error());
    ConstraintList list(before.size());
    const auto frozen = freeze_region(before, (*region)[0], (*region)[1], list);
    if (!frozen) return std::unexpected(frozen.error());
    if (before.knots() != now.current->knots()) return check_frozen_points(*frozen);
    const auto weight = [](const Surface& s, int k) {
      return s.weights().empty() ? 1.0 : s.weights()[static_cast<std::size_t>(k)];
    };
    const int n = before.net()[1];
    for (int k = 0; k < before.size(); ++k) {
      if (!list.held[static_cast<std::size_t>(k)]) continue;
      if (same_bits(before.control_points(), now.current->control_points(), k) &&
          weight(before, k) == weight(*now.current, k)) {
        continue;
      }
      return input_error(
          fmt::format("{}: control point {} ({}, {}) is frozen", now.id, k, k / n, k % n),
          std::string(command), "leave it as it is, or release it first",
          {ErrorCode::point_frozen, {{"point", static_cast<double>(k)}}});
    }
    return {};
  }

  /// Of a surface on another basis.
  [[nodiscard]] Expected<void> check_frozen_points(const FrozenRegion& frozen) const {
    const std::vector<double> u = places_in(before.knots(0), frozen.u),
                              v = places_in(before.knots(1), frozen.v);
    const auto then = evaluate_grid<2>(before, {u, v}), is = evaluate_grid<2>(*now.current, {u, v});
    if (!then) return std::unexpected(then.error());
    if (!is) return std::unexpected(is.error());
    const double farthest = (is->points() - then->points()).rowwise().norm().maxCoeff();
    if (farthest <= frozen_tolerance * net_size(before)) return {};
    return input_error(fmt::format("{}: a frozen region would move by {:.3g}", now.id, farthest),
                       std::string(command), "release it first",
                       {ErrorCode::region_frozen, {{"surface", now.id}, {"distance", farthest}}});
  }

  // The conditions of a symmetry are applied to the motion alone: what the file was asymmetric by
  // is no fault of the command.
  template <class Symmetry>
  [[nodiscard]] Expected<void> check_symmetry(const Symmetry& symmetry) const {
    const auto base = onto_net(before, *now.current);
    // Where the net is no finer one the constraints were tried again.
    if (!base || base->knots() != now.current->knots()) return {};
    const Points motion = now.current->control_points() - base->control_points();
    const double largest = motion.cwiseAbs().maxCoeff();
    // Knots were inserted: where their mirror images are missing, the next model inserts them or
    // says so.
    if (before.knots() != now.current->knots() && largest <= frozen_tolerance * net_size(before))
      return {};
    ConstraintList list(now.reference->size());
    if (auto made = symmetry_constraints(*now.reference, symmetry, list); !made) return made;
    for (const LinearConstraint& c : list.constraints) {
      Point sum = Point::Zero();
      for (const auto& [row, coefficient] : c.terms)
        sum += coefficient * motion.row(row).transpose();
      const double off = c.normal ? std::abs(c.normal->normalized().dot(sum)) : sum.norm();
      if (off <= symmetry_tolerance * largest) continue;
      return input_error(
          fmt::format("{}: the kept symmetry would be lost", now.id), std::string(command),
          "move the mirror images too, each mirrored, or release the symmetry first");
    }
    return {};
  }

  [[nodiscard]] Expected<void> check_limit(double limit) const {
    const double was = largest_distance(before, *now.opened),
                 is = largest_distance(*now.current, *now.opened);
    if (is <= limit * (1 + limit_tolerance) || is <= was) return {};
    return input_error(
        fmt::format("{} would be {:.6g} from where it was opened, and {:.6g} is the limit", now.id,
                    is, limit),
        std::string(command), R"(move it less, or end the limit: {"do":"limit"})",
        {ErrorCode::beyond_limit, {{"distance", is}, {"limit", limit}}});
  }

  [[nodiscard]] Expected<void> check() const {
    const auto holds = [&]<class C>(const C& constraint) -> Expected<void> {
      if constexpr (std::is_same_v<C, Freeze>) return check_frozen(constraint);
      if constexpr (std::is_same_v<C, EdgeSymmetry> || std::is_same_v<C, MirrorSymmetry>) {
        return check_symmetry(constraint);
      }
      return {};
    };
    for (const KeptConstraint& kept : now.constraints) {
      if (auto held = std::visit(holds, kept.constraint); !held) return held;
    }
    return {};
  }
};

/// Seams between the selected surfaces, and of each with itself.
/// Seams are those of the shapes before, so that surfaces which a command brought together are
/// none. A seam may open by 1 % of what it was open, or by rounding.
Expected<void> check_seams(const Scene& scene, const Scene& before, std::string_view command) {
  std::vector<const Surface*> then, now;
  std::vector<std::string> ids;
  bool moved = false;
  for (const int k : scene.selection()) {
    const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(k)];
    const SceneSurface* const was = find_surface(before, s.id, static_cast<std::size_t>(k));
    if (was == nullptr) return {};
    moved = moved || was->current != s.current;
    then.push_back(was->current.get());
    now.push_back(s.current.get());
    ids.push_back(s.id);
  }
  if (!moved || !scene.seams.couple) return {};
  const auto found = seams_between(scene.seams, then);
  if (!found) return std::unexpected(found.error());
  double size = 0;
  for (const Surface* surface : now) size = std::max(size, net_size(*surface));
  for (const Seam& seam : found->seams) {
    const auto gap = moved_gap(seam, then, now);
    if (!gap) return std::unexpected(gap.error());
    if (*gap <= std::max(1.01 * seam.gap, seam_tolerance * size)) continue;
    const auto edge = [&](const PatchEdge& e) {
      return fmt::format("{}, edge {}", ids[static_cast<std::size_t>(e.patch)], edge_name(e.edge));
    };
    return std::unexpected(
        Error(ErrorKind::numerical,
              fmt::format("the seam between {} and {} would open by {:.3g}; this was refused",
                          edge(seam.a), edge(seam.b), *gap),
              std::string(command),
              R"(move less, or let the surfaces part: {"do":"seams","couple":false})")
            .with({ErrorCode::seam_would_open,
                   {{"first", ids[static_cast<std::size_t>(seam.a.patch)]},
                    {"second", ids[static_cast<std::size_t>(seam.b.patch)]},
                    {"distance", *gap}}}));
  }
  return {};
}

}  // namespace

// Places of constraints and rest shapes are often equal to the shape, row by row. Such rows take
// the new bits; adding the motion to them would give others, and what was equal would differ by
// rounding. If all rows are equal the shape itself is shared.
template <int D>
Expected<std::shared_ptr<const Spline<D>>> moved_along(
    const std::shared_ptr<const Spline<D>>& shape, const Spline<D>& before,
    const std::shared_ptr<const Spline<D>>& after) {
  const Points &from = before.control_points(), &to = after->control_points();
  Points points = shape->control_points();
  bool any = false, all = true;
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    const bool here = same_bits(points, from, row);
    all = all && here;
    if (same_bits(from, to, row)) continue;
    any = true;
    if (here) {
      points.row(row) = to.row(row);
    } else {
      points.row(row) += to.row(row) - from.row(row);
    }
  }
  if (!any) return shape;
  if (all) return after;
  auto made = shape->with_control_points(std::move(points));
  if (!made) return std::unexpected(made.error());
  return std::make_shared<const Spline<D>>(*std::move(made));
}

template <int D>
Expected<void> put(SceneShape<D>& s, std::shared_ptr<const Spline<D>> current) {
  for (KeptConstraintOf<D>& kept : s.constraints) {
    auto along = moved_along<D>(kept.where, *s.current, current);
    if (!along) return std::unexpected(along.error());
    kept.where = *std::move(along);
  }
  s.current = std::move(current);
  return {};
}

Expected<void> check_placed(Act& act, const Scene& before, std::string_view command) {
  for (std::size_t k = 0; k < act.state.surfaces.size(); ++k) {
    const SceneSurface& s = std::as_const(act.state).surfaces[k];
    const SceneSurface* const was = find_surface(before, s.id, k);
    if (was == nullptr || was->current == s.current) continue;
    const Placed placed{s, *was->current, command};
    if (auto status = placed.check(); !status) return status;
    if (!act.state.limit) continue;
    if (auto status = placed.check_limit(*act.state.limit); !status) return status;
  }
  if (act.edges_measured) return {};
  if (auto closed = check_seams(act.state, before, command); !closed) return closed;
  return check_held_edges(act, before);
}

template Expected<std::shared_ptr<const Curve>> moved_along<1>(const std::shared_ptr<const Curve>&,
                                                               const Curve&,
                                                               const std::shared_ptr<const Curve>&);
template Expected<std::shared_ptr<const Surface>> moved_along<2>(
    const std::shared_ptr<const Surface>&, const Surface&, const std::shared_ptr<const Surface>&);
template Expected<std::shared_ptr<const Volume>> moved_along<3>(
    const std::shared_ptr<const Volume>&, const Volume&, const std::shared_ptr<const Volume>&);
template Expected<void> put<1>(SceneShape<1>&, std::shared_ptr<const Spline<1>>);
template Expected<void> put<2>(SceneShape<2>&, std::shared_ptr<const Spline<2>>);
template Expected<void> put<3>(SceneShape<3>&, std::shared_ptr<const Spline<3>>);

}  // namespace knead
