#include "points.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "knead/scene/places.hpp"
#include "knead/spline/extremum.hpp"

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
                           "leave it out, or release it first");
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

template <>
Expected<void> Executor::execute(const PointsCommand& c) {
  auto surface = selected_alone();
  if (!surface) return std::unexpected(surface.error());
  SceneSurface& s = **surface;
  const auto named = indices_of(c.points, s.current->net());
  if (!named) return std::unexpected(named.error());
  if (c.by.has_value() == !c.to.empty()) {
    return input_error("one of by and to is needed", "by", "give [dx, dy, dz], or a list of positions");
  }
  if (!c.to.empty() && c.relative) {
    return input_error("positions are not relative", "relative", "leave it out, or give by");
  }
  if (!c.to.empty() && c.to.size() != named->size()) {
    return input_error(fmt::format("{} positions for {} control points", c.to.size(), named->size()), "to",
                       "give one for each; a point named twice counts once");
  }
  double unit = 1;
  if (c.relative) {
    const auto length = diagonal();
    if (!length) return std::unexpected(length.error());
    unit = *length;
  }
  const Points& before = s.current->control_points();
  Points after = before, motion = Points::Zero(before.rows(), 3);
  for (std::size_t k = 0; k < named->size(); ++k) {
    const int row = (*named)[k];
    const Vector3& given = c.by ? *c.by : c.to[k];
    const Eigen::RowVector3d vector(given[0], given[1], given[2]);
    if (c.by) {
      after.row(row) += unit * vector;
    } else {
      after.row(row) = vector;
    }
    motion.row(row) = after.row(row) - before.row(row);
  }
  if (auto may = allowed(s, *named, motion); !may) return may;
  auto moved = s.current->with_control_points(after);
  if (!moved) {
    Error error = moved.error().within(c.by ? "by" : "to");
    error.remedy = "use smaller numbers";
    return std::unexpected(std::move(error));
  }
  const auto current = std::make_shared<const Surface>(std::move(*moved));
  if (state.limit) {
    const double was = largest_distance(*s.current, *s.opened), is = largest_distance(*current, *s.opened);
    if (!(is <= *state.limit * (1 + limit_tolerance)) && is > was) {
      return input_error(fmt::format("the surface would be {:.6g} from where it was opened, and {:.6g} is the limit",
                                     is, *state.limit),
                         c.by ? "by" : "to", R"(move it less, or end the limit: {"do":"limit"})");
    }
  }
  // Clay: the reference shapes and held positions move along. Places that coincided still do, to the
  // bit.
  const auto along = [&](std::shared_ptr<const Surface>& shape) -> Expected<void> {
    if (shape == s.current) {
      shape = current;
      return {};
    }
    Points points = shape->control_points();
    for (int row : *named) {
      if (same_bits(points, before, row)) {
        points.row(row) = after.row(row);
      } else {
        points.row(row) += motion.row(row);
      }
    }
    auto made = shape->with_control_points(std::move(points));
    if (!made) return std::unexpected(made.error());
    shape = std::make_shared<const Surface>(std::move(*made));
    return {};
  };
  if (auto done = along(s.rest); !done) return done;
  for (KeptConstraint& kept : s.constraints) {
    if (auto done = along(kept.where); !done) return done;
  }
  s.current = current;
  return {};
}

}  // namespace knead
