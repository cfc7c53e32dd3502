#include "restated.hpp"

#include "command_fields.hpp"
#include "components.hpp"

namespace knead {
namespace {

/// All edges in the order of `SurfaceEdge`, after `SideChoice::all`.
SideChoice choice_of(SurfaceEdge edge) { return static_cast<SideChoice>(static_cast<int>(edge) + 1); }

std::optional<MirrorPlane> plane_given(const SymmetryCommand& c) {
  if (!c.point || !c.normal) return std::nullopt;
  return MirrorPlane{point_of(*c.point), point_of(*c.normal)};
}

struct Restate {
  Command operator()(const EdgeHold& c) const {
    return make_command(
        EdgeCommand{choice_of(c.edge), static_cast<EdgeCondition>(c.order), {}, components_text(c.components)});
  }
  Command operator()(const TrimHolds& c) const {
    HoldCommand hold;
    hold.mode = c.order < 0 ? HoldMode::free : static_cast<HoldMode>(static_cast<int>(HoldMode::trim) + c.order);
    return make_command(hold);
  }
  Command operator()(const TrimEdgeHold& c) const {
    return make_command(EdgeCommand{SideChoice::all,
                                    c.follow      ? EdgeCondition::follow
                                    : c.order < 0 ? EdgeCondition::free
                                                  : static_cast<EdgeCondition>(c.order),
                                    c.id});
  }
  Command operator()(const PointPin& c) const {
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

}  // namespace

Command restated(const Constraint& constraint) { return std::visit(Restate{}, constraint); }

std::optional<Constraint> constraint_of(const Command& command) {
  if (const auto* c = fields_of<EdgeCommand>(command)) {
    if (c->edge) {
      const bool follow = c->hold == EdgeCondition::follow;
      return TrimEdgeHold{*c->edge, follow || c->hold == EdgeCondition::free ? -1 : static_cast<int>(c->hold), follow};
    }
    if (c->which == SideChoice::all || c->which > SideChoice::v1 || c->hold > EdgeCondition::curvature)
      return std::nullopt;
    const auto components = components_of(c->components);
    if (!components) return std::nullopt;
    return EdgeHold{edges_of(edge_choice(c->which)).front(), static_cast<int>(c->hold), *components};
  }
  if (const auto* c = fields_of<HoldCommand>(command)) {
    const HoldMode mode = c->mode.value_or(HoldMode::rows);
    if (mode == HoldMode::rows) return std::nullopt;
    if (mode == HoldMode::free) return TrimHolds{-1};
    return TrimHolds{static_cast<int>(mode) - static_cast<int>(HoldMode::trim)};
  }
  if (const auto* c = fields_of<PinCommand>(command)) {
    if (!c->at || c->at->size() != 2) return std::nullopt;
    const auto components = components_of(c->components);
    if (!components) return std::nullopt;
    return PointPin{{(*c->at)[0], (*c->at)[1]}, c->to, *components};
  }
  if (const auto* c = fields_of<FreezeCommand>(command)) return c->freeze;
  if (const auto* c = fields_of<KeepCommand>(command)) return c->keep;
  if (const auto* c = fields_of<SymmetryCommand>(command)) {
    const auto plane = plane_given(*c);
    if (c->mirror) return MirrorSymmetry{*c->mirror == "u" ? 0 : 1, plane};
    if (c->edge && plane) return EdgeSymmetry{*c->edge, *plane};
  }
  return std::nullopt;
}

}  // namespace knead
