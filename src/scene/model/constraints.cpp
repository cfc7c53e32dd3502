#include "constraints.hpp"

#include <fmt/format.h>

#include <functional>
#include <numeric>

#include "knead/spline/extremum.hpp"
#include "scene/held_points.hpp"
#include "scene/mask.hpp"
#include "scene/places.hpp"
#include "scene/trims.hpp"

namespace knead {
namespace {

/// What is left of the conditions at smooth knot lines whose ratio varies, beside held edges of
/// faces: where these take most of the freedom, the exact conditions leave none.
constexpr double smooth_beside_edges = 1e-3;

constexpr double pole_tolerance = 1e-9;  // of the surface's size
constexpr double pole_flatness = 1e-6;
constexpr double symmetry_tolerance = 1e-6;  // of the surface's size
constexpr double symmetry_angle = 1e-3;

/// Appends the conditions of `from` for these coordinates only. One on a single control point
/// leaves its coordinate its bits, as a held flag does.
/// A held control point has no equation of its own: its row leaves the unknowns. One of which only
/// some coordinates are held becomes an equation n · D = value per coordinate instead.
void append_components(const ConstraintList& from, const Components& components,
                       ConstraintList& to) {
  const auto append = [&](LinearConstraint condition) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (!components[c]) continue;
      condition.normal = Point::Unit(static_cast<Eigen::Index>(c));
      to.constraints.push_back(condition);
    }
  };
  for (std::size_t k = 0; k < from.held.size(); ++k) {
    if (from.held[k]) append({from.held_by[k], {{static_cast<int>(k), 1.0}}});
  }
  for (const LinearConstraint& condition : from.constraints) append(condition);
}

/// Appends the conditions of one constraint.
template <int D>
struct Asked {
  const Spline<D>& reference;
  const Spline<D>& rest;
  const Spline<D>& where;
  ConstraintList& list;

  Expected<void> operator()(const EdgeHold& c) const {
    return holding([&] {
      return by_components(
          c.components, [&](ConstraintList& to) { return hold_edge(rest, c.edge, c.order, to); });
    });
  }

  Expected<void> operator()(const SideHold& c) const {
    return holding([&] {
      return by_components(c.components, [&](ConstraintList& to) {
        return hold_side<D>(rest, c.side, c.order, to);
      });
    });
  }

  Expected<void> operator()(const PointPinOf<D>& c) const {
    const auto u = parameters_at<D>(rest, c.at);
    if (!u) return std::unexpected(u.error());
    std::optional<Point> to;
    if (c.to) to = Point((*c.to)[0], (*c.to)[1], (*c.to)[2]);
    const auto pin = [&] {
      return by_components(c.components, [&](ConstraintList& rows) {
        if constexpr (D == 2) {
          return pin_point(rest, (*u)[0], (*u)[1], to, rows);
        } else {
          return pin_place<D>(rest, *u, to, rows);
        }
      });
    };
    return to ? pin() : holding(pin);
  }

  Expected<void> operator()(const Freeze& c) const {
    const auto region = region_at(rest, c.region);
    if (!region) return std::unexpected(region.error());
    const auto frozen = freeze_region(rest, (*region)[0], (*region)[1], list);
    if (!frozen) return std::unexpected(frozen.error());
    return {};
  }

  Expected<void> operator()(const Keep& c) const {
    return holding([&]() -> Expected<void> {
      for (int direction = 0; direction < 2; ++direction) {
        const std::optional<double>& line = direction == 0 ? c.u : c.v;
        if (!line) continue;
        Fractions at = {0, 0};
        at[static_cast<std::size_t>(direction)] = *line;
        const auto u = parameters_at(rest, at, direction == 0 ? "u" : "v");
        if (!u) return std::unexpected(u.error());
        auto status =
            hold_isoline(rest, direction, (*u)[static_cast<std::size_t>(direction)], 0, list);
        if (!status) return status;
      }
      if (c.curve.empty()) return {};
      Parameters<2> polyline(static_cast<Eigen::Index>(c.curve.size()), 2);
      for (std::size_t k = 0; k < c.curve.size(); ++k) {
        const auto u = parameters_at(rest, c.curve[k], "curve");
        if (!u) return std::unexpected(u.error());
        polyline.row(static_cast<Eigen::Index>(k)) << (*u)[0], (*u)[1];
      }
      const auto kept = keep_curve(rest, polyline, c.tolerance, list);
      if (!kept) return std::unexpected(kept.error());
      return {};
    });
  }

  Expected<void> operator()(const EdgeSymmetry& c) const {
    return symmetry_constraints(reference, c, list);
  }
  Expected<void> operator()(const MirrorSymmetry& c) const {
    return symmetry_constraints(reference, c, list);
  }
  // Edges of faces are held all at once, by `hold_face_edges`.
  Expected<void> operator()(const TrimHolds&) const { return {}; }
  Expected<void> operator()(const TrimEdgeHold&) const { return {}; }

 private:
  /// What `f` appends to a list, for these coordinates only.
  template <class F>
  Expected<void> by_components(const Components& components, const F& f) const {
    if (components == all_components) return f(list);
    ConstraintList all(reference.size());
    if (auto status = f(all); !status) return status;
    append_components(all, components, list);
    return {};
  }

  /// What `f` appends is held where it was when requested, not where it is at rest.
  template <class F>
  Expected<void> holding(const F& f) const {
    const std::size_t first = list.constraints.size();
    if (auto status = f(); !status) return status;
    keep_present(list, where.control_points() - rest.control_points(), first);
    return {};
  }
};

/// Layers and control points held by their indices.
template <std::size_t D>
void hold_numbered(const std::array<int, D>& net, int rows,
                   const std::set<std::array<int, D>>& pins, ConstraintList& list) {
  const int size = std::accumulate(net.begin(), net.end(), 1, std::multiplies());
  for (int k = 0; k < size && rows > 0; ++k) {
    int rest = k;
    for (std::size_t d = D; d-- > 0;) {
      const int i = rest % net[d];
      rest /= net[d];
      if (i < rows || i >= net[d] - rows) list.hold(k, "hold");
    }
  }
  for (const std::array<int, D>& pin : pins) {
    int number = 0;
    for (std::size_t d = 0; d < D; ++d) number = number * net[d] + pin[d];
    list.hold(number, D == 2 ? fmt::format("pin ({})", fmt::join(pin, ", "))
                             : fmt::format("pin {}", number));
  }
}

void hold_masked(const std::vector<bool>& masked, ConstraintList& list) {
  for (std::size_t k = 0; k < masked.size(); ++k) {
    if (masked[k]) list.hold(static_cast<int>(k), "mask");
  }
}

}  // namespace

Expected<void> symmetry_constraints(const Surface& reference, const EdgeSymmetry& symmetry,
                                    ConstraintList& list) {
  const double size = bounding_box(reference).diagonal();
  for (SurfaceEdge edge : edges_of(symmetry.which)) {
    auto status = hold_symmetry_plane(reference, edge, symmetry.plane, 1, symmetry_tolerance * size,
                                      symmetry_angle, list);
    if (!status) return status;
  }
  return {};
}

Expected<void> symmetry_constraints(const Surface& reference, const MirrorSymmetry& symmetry,
                                    ConstraintList& list) {
  const auto plane = plane_of(symmetry, reference);
  if (!plane) return std::unexpected(plane.error());
  const auto report = keep_mirror(reference, symmetry.direction, *plane, 1e-9, list);
  if (!report) return std::unexpected(report.error());
  return {};
}

namespace {

/// No hinges: smooth knot lines and poles of surfaces, and smooth knots of curves, stay smooth.
Expected<void> keep_smooth_places(const ShapeInput<2>& s, ConstraintList& list,
                                  std::vector<std::string>& notes) {
  if (s.smooth_knot_lines) {
    SmoothOptions options;
    if (s.visible) options.tolerance = smooth_beside_edges;
    const auto lines = keep_smooth(*s.reference, options, list);
    if (!lines) return std::unexpected(lines.error());
    for (const SmoothLine& line : *lines) {
      if (line.state == SmoothLine::State::crease) {
        notes.push_back(fmt::format("{}: the crease at {} = {:.6g} may bend", s.id,
                                    line.direction == 0 ? "u" : "v", line.knot));
      }
    }
  }
  if (!s.smooth_poles) return {};
  const double size = bounding_box(*s.reference).diagonal();
  const auto poles = keep_poles(*s.reference, pole_tolerance * size, pole_flatness, list);
  return poles ? Expected<void>() : std::unexpected(poles.error());
}

Expected<void> keep_smooth_places(const ShapeInput<1>& s, ConstraintList& list,
                                  std::vector<std::string>& notes) {
  const auto knots = keep_smooth_knots(*s.reference, {}, list);
  if (!knots) return std::unexpected(knots.error());
  for (const SmoothKnot& knot : *knots) {
    if (knot.state == SmoothKnot::State::crease && !knot.closing) {
      notes.push_back(fmt::format("{}: the corner at u = {:.6g} may bend", s.id, knot.knot));
    }
  }
  return {};
}

Expected<void> keep_smooth_places(const ShapeInput<3>&, ConstraintList&,
                                  std::vector<std::string>&) {
  return {};
}

}  // namespace

// All conditions on one shape, in the order in which the elimination will see them: control points
// by number, the mask, edges of faces (all of one surface at once, as they share rows), what
// commands asked for, and smoothness last, so that a contradiction is reported at what was asked
// for. Edges and smoothness are measured on the reference shape, everything else on the shape at
// rest; D = 0 is rest in either case.
template <int D>
Expected<ConstraintList> constraints_of(const ShapeInput<D>& s, std::vector<std::string>& notes) {
  ConstraintList list(s.reference->size());
  hold_numbered(s.reference->net(), s.hold_rows, s.pins, list);
  if constexpr (D == 2) {
    hold_masked(s.masked, list);
    if (s.visible) {
      const auto held = hold_face_edges(*s.reference, s.constraints, *s.visible, list);
      if (!held) return std::unexpected(held.error());
    }
  }
  const Spline<D>& rest = s.rest ? *s.rest : *s.reference;
  for (const auto& [constraint, where] : s.constraints) {
    if (auto status = std::visit(Asked<D>{*s.reference, rest, *where, list}, constraint); !status) {
      return std::unexpected(status.error());
    }
  }
  if (s.mode == RestMode::none)
    return list;  // the energy acts on the shape itself: no rest shape to stay smooth to
  if (auto smooth = keep_smooth_places(s, list, notes); !smooth)
    return std::unexpected(smooth.error());
  return list;
}

template Expected<ConstraintList> constraints_of<1>(const ShapeInput<1>&,
                                                    std::vector<std::string>&);
template Expected<ConstraintList> constraints_of<2>(const ShapeInput<2>&,
                                                    std::vector<std::string>&);
template Expected<ConstraintList> constraints_of<3>(const ShapeInput<3>&,
                                                    std::vector<std::string>&);

HeldInput held_input(const SceneSurface& s) {
  return {s.current->net(),
          s.hold_rows,
          s.pins,
          s.constraints,
          holds_trims(s.constraints) ? s.visible : nullptr,
          masked_points(s)};
}

//   0: free, 1: held, 2: in some condition with others.
// Without smoothness and symmetries: these bind nearly every control point and would hide the rest.
Expected<std::vector<std::uint8_t>> held_points(const HeldInput& input) {
  ConstraintList list(input.net[0] * input.net[1]);
  hold_numbered(input.net, input.hold_rows, input.pins, list);
  hold_masked(input.masked, list);
  if (input.visible) {
    const auto held =
        hold_face_edges(*input.constraints.front().where, input.constraints, *input.visible, list);
    if (!held) return std::unexpected(held.error());
  }
  for (const auto& [constraint, where] : input.constraints) {
    if (std::holds_alternative<EdgeSymmetry>(constraint) ||
        std::holds_alternative<MirrorSymmetry>(constraint)) {
      continue;
    }
    // Which control points are held depends only on the basis, which all shapes share.
    if (auto status = std::visit(Asked<2>{*where, *where, *where, list}, constraint); !status) {
      return std::unexpected(status.error());
    }
  }
  std::vector<std::uint8_t> held(list.held.size(), 0);
  for (const LinearConstraint& c : list.constraints) {
    for (const auto& [row, coefficient] : c.terms) {
      if (coefficient != 0) held[static_cast<std::size_t>(row)] = 2;
    }
  }
  for (std::size_t k = 0; k < held.size(); ++k) {
    if (list.held[k]) held[k] = 1;
  }
  return held;
}

}  // namespace knead
