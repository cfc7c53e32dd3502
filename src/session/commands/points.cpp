#include "points.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "knead/base/error_code.hpp"
#include "knead/spline/extremum.hpp"
#include "scene/places.hpp"
#include "session/acts/selection.hpp"

namespace knead {
namespace {

constexpr double symmetry_tolerance = 1e-9;  // of the largest move
constexpr double limit_tolerance = 1e-6;     // relative, as for steps

bool same_bits(const Points& a, const Points& b, Eigen::Index row) {
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (std::bit_cast<std::uint64_t>(a(row, k)) != std::bit_cast<std::uint64_t>(b(row, k))) return false;
  }
  return true;
}

/// Appends a symmetry; ignores other constraints.
Expected<void> append_symmetry(const Surface& reference, const Constraint& constraint, ConstraintList& list) {
  if (const auto* edge = std::get_if<EdgeSymmetry>(&constraint)) return symmetry_constraints(reference, *edge, list);
  if (const auto* mirror = std::get_if<MirrorSymmetry>(&constraint)) {
    return symmetry_constraints(reference, *mirror, list);
  }
  return {};
}

/// Refuses what must not be moved by hand: frozen regions, and halves of a symmetry without their images.
Expected<void> allowed(const SceneSurface& s, const std::vector<int>& named, const Points& motion) {
  const int n = s.current->net()[1];
  for (const KeptConstraint& kept : s.constraints) {
    ConstraintList list(s.current->size());
    if (const auto* freeze = std::get_if<Freeze>(&kept.constraint)) {
      const auto region = region_at(*s.rest, freeze->region);
      if (!region) return std::unexpected(region.error());
      const auto frozen = freeze_region(*s.rest, (*region)[0], (*region)[1], list);
      if (!frozen) return std::unexpected(frozen.error());
      for (int k : named) {
        if (!list.held[static_cast<std::size_t>(k)] || motion.row(k).isZero(0)) continue;
        return input_error(fmt::format("control point {} ({}, {}) is frozen", k, k / n, k % n), "which",
                           "leave it out, or release it first",
                           {ErrorCode::point_frozen, {{"point", static_cast<double>(k)}}});
      }
    } else {
      if (auto done = append_symmetry(*s.reference, kept.constraint, list); !done) return done;
      const double largest = motion.cwiseAbs().maxCoeff();
      for (const LinearConstraint& c : list.constraints) {
        Point sum = Point::Zero();
        for (const auto& [row, coefficient] : c.terms) sum += coefficient * motion.row(row).transpose();
        const double off = c.normal ? std::abs(c.normal->normalized().dot(sum)) : sum.norm();
        if (off <= symmetry_tolerance * largest) continue;
        return input_error("the kept symmetry would be lost", "which",
                           "move the mirror images too, each mirrored, or release the symmetry first");
      }
    }
  }
  return {};
}

}  // namespace

void describe(PointsCommand& c, Fields& fields) {
  fields.name("points", "move control points of the selected surface by hand, permanently");
  describe(c.points, fields);
  fields.add("by", c.by, {.help = "`[dx, dy, dz]` for all of them; this or `to`", .unit = Unit::length});
  fields.add("to", c.to,
             {.help = "`[[x, y, z], …]`: a place for each, in the order in which they are named, each counted once",
              .unit = Unit::length});
  fields.add("relative", c.relative, {.help = "`by` is in fractions of the diagonal"});
  describe_allowance(c.allow, fields);
}

namespace {

template <int D>
Expected<std::vector<int>> named_of(Act& act, const NamedPoints& named, const Spline<D>& shape) {
  if constexpr (D == 2) {
    return indices_of(named, shape.net());
  } else {
    if (!named.rows_u.empty()) return of_surfaces(act, "rows_u", "give which");
    if (!named.rows_v.empty()) return of_surfaces(act, "rows_v", "give which");
    std::vector<int> points;
    for (std::size_t k = 0; k < named.which.size(); ++k) {
      const int number = named.which[k];
      if (number < 0 || number >= shape.size()) {
        return input_error(fmt::format("there is no control point {}", number), fmt::format("which[{}]", k),
                           fmt::format("use numbers from 0 to {}", shape.size() - 1));
      }
      if (std::ranges::find(points, number) == points.end()) points.push_back(number);
    }
    if (!points.empty()) return points;
    return input_error("no control points are named", "which", "give their numbers, counted from 0");
  }
}

/// All control points after the command.
Expected<Points> points_after(Act& act, const PointsCommand& c, const std::vector<int>& named, const Points& before) {
  if (c.by.has_value() == !c.to.empty()) {
    return input_error("one of by and to is needed", "by", "give [dx, dy, dz], or a list of positions");
  }
  if (!c.to.empty() && c.relative) {
    return input_error("positions are not relative", "relative",
                       act.state.body ? "leave it out" : "leave it out, or give by");
  }
  if (!c.to.empty() && c.to.size() != named.size()) {
    return input_error(fmt::format("{} positions for {} control points", c.to.size(), named.size()), "to",
                       "give one for each; a point named twice counts once");
  }
  double unit = 1;
  if (c.relative) {
    const auto length = diagonal(act);
    if (!length) return std::unexpected(length.error());
    unit = *length;
  }
  Points after = before;
  for (std::size_t k = 0; k < named.size(); ++k) {
    const Eigen::RowVector3d vector(c.by ? c.by->data() : c.to[k].data());
    if (c.by) {
      after.row(named[k]) += unit * vector;
    } else {
      after.row(named[k]) = vector;
    }
  }
  return after;
}

/// Whether a limit allows a surface to become this one.
Expected<void> within_limit(const Act& act, const SceneSurface& s, const Surface& current, const char* field) {
  const std::optional<double>& limit = act.state.limit;
  if (!limit) return {};
  const double was = largest_distance(*s.current, *s.opened), is = largest_distance(current, *s.opened);
  if (is <= *limit * (1 + limit_tolerance) || is <= was) return {};
  return input_error(
      fmt::format("the surface would be {:.6g} from where it was opened, and {:.6g} is the limit", is, *limit), field,
      R"(move it less, or end the limit: {"do":"limit"})",
      {ErrorCode::beyond_limit, {{"distance", is}, {"limit", *limit}}});
}

/// Clay: the reference shapes and held positions move along. Places that coincided still do, to the bit.
template <int D>
Expected<void> move_all(SceneShape<D>& s, const std::vector<int>& named, std::shared_ptr<const Spline<D>> current) {
  const Points &before = s.current->control_points(), &after = current->control_points();
  const auto along = [&](std::shared_ptr<const Spline<D>>& shape) -> Expected<void> {
    if (shape == s.current) {
      shape = current;
      return {};
    }
    Points points = shape->control_points();
    for (int row : named) {
      if (same_bits(points, before, row)) {
        points.row(row) = after.row(row);
      } else {
        points.row(row) += after.row(row) - before.row(row);
      }
    }
    auto made = shape->with_control_points(std::move(points));
    if (!made) return std::unexpected(made.error());
    shape = std::make_shared<const Spline<D>>(*std::move(made));
    return {};
  };
  if (auto done = along(s.rest); !done) return done;
  for (KeptConstraintOf<D>& kept : s.constraints) {
    if (auto done = along(kept.where); !done) return done;
  }
  s.current = std::move(current);
  return {};
}

template <int D>
Expected<void> move_by_hand(Act& act, SceneShape<D>& s, const PointsCommand& c) {
  const auto named = named_of<D>(act, c.points, *s.current);
  if (!named) return std::unexpected(named.error());
  const auto after = points_after(act, c, *named, s.current->control_points());
  if (!after) return std::unexpected(after.error());
  if constexpr (D == 2) {
    if (auto may = allowed(s, *named, *after - s.current->control_points()); !may) return may;
  }
  const char* const field = c.by ? "by" : "to";
  auto moved = s.current->with_control_points(*after);
  if (!moved) {
    if (D != 2) return std::unexpected(moved.error());
    Error error = moved.error().within(field);
    error.remedy = "use smaller numbers";
    return std::unexpected(std::move(error));
  }
  auto current = std::make_shared<const Spline<D>>(*std::move(moved));
  if constexpr (D == 2) {
    if (auto within = within_limit(act, s, *current, field); !within) return within;
  }
  return move_all<D>(s, *named, std::move(current));
}

}  // namespace

Expected<void> execute(const PointsCommand& c, Act& act) {
  if (act.state.body) return std::visit([&](auto& s) { return move_by_hand(act, s, c); }, *body(act));
  auto surface = selected_alone(act);
  return surface ? move_by_hand(act, **surface, c) : std::unexpected(surface.error());
}

}  // namespace knead
