#include "points.hpp"

#include <fmt/format.h>

#include <cmath>

#include "session/acts/placing.hpp"
#include "session/acts/selection.hpp"

namespace knead {

void describe(PointsCommand& c, Fields& fields) {
  fields.name("points", "move control points of the selected surface by hand, permanently");
  describe(c.points, fields);
  fields.add("by", c.by,
             {.help = "`[dx, dy, dz]` for all of them; this or `to`", .unit = Unit::length});
  fields.add("to", c.to,
             {.help = "`[[x, y, z], …]`: a place for each, in the order in which they are named, "
                      "each counted once",
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
        return input_error(fmt::format("there is no control point {}", number),
                           fmt::format("which[{}]", k),
                           fmt::format("use numbers from 0 to {}", shape.size() - 1));
      }
      if (std::ranges::find(points, number) == points.end()) points.push_back(number);
    }
    if (!points.empty()) return points;
    return input_error("no control points are named", "which",
                       "give their numbers, counted from 0");
  }
}

/// All control points after the command.
Expected<Points> points_after(Act& act, const PointsCommand& c, const std::vector<int>& named,
                              const Points& before) {
  if (c.by.has_value() == !c.to.empty()) {
    return input_error("one of by and to is needed", "by",
                       "give [dx, dy, dz], or a list of positions");
  }
  if (!c.to.empty() && c.relative) {
    return input_error("positions are not relative", "relative",
                       act.state.body ? "leave it out" : "leave it out, or give by");
  }
  if (!c.to.empty() && c.to.size() != named.size()) {
    return input_error(fmt::format("{} positions for {} control points", c.to.size(), named.size()),
                       "to", "give one for each; a point named twice counts once");
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

template <int D>
Expected<void> move_by_hand(Act& act, SceneShape<D>& s, const PointsCommand& c) {
  const auto named = named_of<D>(act, c.points, *s.current);
  if (!named) return std::unexpected(named.error());
  const auto after = points_after(act, c, *named, s.current->control_points());
  if (!after) return std::unexpected(after.error());
  const char* const field = c.by ? "by" : "to";
  auto moved = s.current->with_control_points(*after);
  if (!moved) {
    if (D != 2) return std::unexpected(moved.error());
    Error error = moved.error().within(field);
    error.remedy = "use smaller numbers";
    return std::unexpected(std::move(error));
  }
  auto current = std::make_shared<const Spline<D>>(*std::move(moved));
  auto rest = moved_along<D>(s.rest, *s.current, current);
  if (!rest) return std::unexpected(rest.error());
  s.rest = *std::move(rest);
  return put<D>(s, std::move(current));
}

}  // namespace

Expected<void> execute(const PointsCommand& c, Act& act) {
  if (act.state.body)
    return std::visit([&](auto& s) { return move_by_hand(act, s, c); }, *body(act));
  auto surface = selected_alone(act);
  return surface ? move_by_hand(act, **surface, c) : std::unexpected(surface.error());
}

}  // namespace knead
