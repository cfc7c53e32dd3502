#include "restated.hpp"

#include <algorithm>

#include "command_fields.hpp"
#include "components.hpp"

namespace knead {
namespace {

/// All edges in the order of `SurfaceEdge`, after `SideChoice::all`.
SideChoice choice_of(SurfaceEdge edge) {
  return static_cast<SideChoice>(static_cast<int>(edge) + 1);
}

std::optional<MirrorPlane> plane_given(const SymmetryCommand& c) {
  if (!c.point || !c.normal) return std::nullopt;
  return MirrorPlane{point_of(*c.point), point_of(*c.normal)};
}

// The command that makes a constraint, and below the constraint that a command makes: states are
// saved and shown as commands, so that a constraint needs no form of its own. Enumerations are in
// the same order on both sides, on which the conversions by numbers rely.
struct Restate {
  Command operator()(const EdgeHold& c) const {
    return make_command(EdgeCommand{
        choice_of(c.edge), static_cast<EdgeCondition>(c.order), {}, components_text(c.components)});
  }
  Command operator()(const SideHold& c) const {
    const auto which = static_cast<SideChoice>(1 + 2 * c.side.direction + (c.side.upper ? 1 : 0));
    return make_command(
        EdgeCommand{which, static_cast<EdgeCondition>(c.order), {}, components_text(c.components)});
  }
  Command operator()(const TrimHolds& c) const {
    HoldCommand hold;
    hold.mode = c.order < 0 ? HoldMode::open
                            : static_cast<HoldMode>(static_cast<int>(HoldMode::position) + c.order);
    return make_command(hold);
  }
  Command operator()(const TrimEdgeHold& c) const {
    return make_command(EdgeCommand{SideChoice::all,
                                    c.follow      ? EdgeCondition::follow
                                    : c.order < 0 ? EdgeCondition::open
                                                  : static_cast<EdgeCondition>(c.order),
                                    c.id});
  }
  template <int D>
  Command operator()(const PointPinOf<D>& c) const {
    PinCommand pin;
    pin.at = std::vector<double>(c.at.begin(), c.at.end());
    pin.to = c.to;
    pin.components = components_text(c.components);
    return make_command(pin);
  }
  Command operator()(const Freeze& c) const { return make_command(FreezeCommand{c}); }
  Command operator()(const Keep& c) const { return make_command(KeepCommand{c}); }
  Command operator()(const EdgeSymmetry& c) const {
    SymmetryCommand symmetry;
    symmetry.edge = c.which;
    symmetry.point = array_of(c.plane.point);
    symmetry.normal = array_of(c.plane.normal);
    return make_command(symmetry);
  }
  Command operator()(const MirrorSymmetry& c) const {
    SymmetryCommand symmetry;
    symmetry.mirror = c.direction == 0 ? "u" : "v";
    if (c.plane) {
      symmetry.point = array_of(c.plane->point);
      symmetry.normal = array_of(c.plane->normal);
    }
    return make_command(symmetry);
  }
};

/// One side, or none.
std::optional<EdgeHold> side_hold(const EdgeCommand& c, const Components& components, EdgeHold) {
  if (c.which > SideChoice::v1) return std::nullopt;
  return EdgeHold{edges_of(edge_choice(c.which)).front(), static_cast<int>(c.hold), components};
}
std::optional<SideHold> side_hold(const EdgeCommand& c, const Components& components, SideHold) {
  const int side = static_cast<int>(c.which) - static_cast<int>(SideChoice::u0);
  return SideHold{{side / 2, side % 2 != 0}, static_cast<int>(c.hold), components};
}

/// Those that shapes of all dimensions have: one side is held, or one point.
template <int D>
std::optional<ConstraintOf<D>> hold_of(const Command& command) {
  if (const auto* c = fields_of<EdgeCommand>(command)) {
    const auto components = components_of(c->components);
    if (c->edge || c->which == SideChoice::all || c->hold > EdgeCondition::curvature ||
        !components) {
      return std::nullopt;
    }
    return side_hold(*c, *components, std::variant_alternative_t<0, ConstraintOf<D>>());
  }
  if (const auto* c = fields_of<PinCommand>(command)) {
    const auto components = components_of(c->components);
    if (!c->at || c->at->size() != D || !components) return std::nullopt;
    PointPinOf<D> pin{.to = c->to, .components = *components};
    std::ranges::copy(*c->at, pin.at.begin());
    return pin;
  }
  return std::nullopt;
}

}  // namespace

template <int D>
Command restated(const ConstraintOf<D>& constraint) {
  return std::visit(Restate{}, constraint);
}

template Command restated<1>(const ConstraintOf<1>&);
template Command restated<2>(const ConstraintOf<2>&);
template Command restated<3>(const ConstraintOf<3>&);

template <int D>
std::optional<ConstraintOf<D>> constraint_of(const Command& command) {
  return hold_of<D>(command);
}

template std::optional<ConstraintOf<1>> constraint_of<1>(const Command&);
template std::optional<ConstraintOf<3>> constraint_of<3>(const Command&);

template <>
std::optional<Constraint> constraint_of<2>(const Command& command) {
  if (const auto* c = fields_of<EdgeCommand>(command)) {
    if (c->edge) {
      const bool held = c->hold <= EdgeCondition::curvature;
      return TrimEdgeHold{*c->edge, held ? static_cast<int>(c->hold) : -1,
                          !held && c->hold != EdgeCondition::open};
    }
  }
  if (const auto* c = fields_of<HoldCommand>(command)) {
    const HoldMode mode = c->mode.value_or(HoldMode::rows);
    if (mode == HoldMode::rows) return std::nullopt;
    if (mode == HoldMode::open) return TrimHolds{-1};
    return TrimHolds{static_cast<int>(mode) - static_cast<int>(HoldMode::position)};
  }
  if (const auto* c = fields_of<FreezeCommand>(command)) return c->freeze;
  if (const auto* c = fields_of<KeepCommand>(command)) return c->keep;
  if (const auto* c = fields_of<SymmetryCommand>(command)) {
    const auto plane = plane_given(*c);
    if (c->mirror) return MirrorSymmetry{*c->mirror == "u" ? 0 : 1, plane};
    if (c->edge && plane) return EdgeSymmetry{*c->edge, *plane};
  }
  return hold_of<2>(command);
}

}  // namespace knead
