#include "fixes.hpp"

#include <array>
#include <utility>

#include "diagnostic_info.hpp"

namespace knead {
namespace {

Command let_edge(const std::string& edge, EdgeCondition hold) {
  EdgeCommand command;
  command.edge = edge;
  command.hold = hold;
  return make_command(command);
}

/// A command of which one field is given.
template <class C, class Field, class Value>
Command with(Field C::*field, Value&& value) {
  C command;
  command.*field = std::forward<Value>(value);
  return make_command(command);
}

Command held_by(HoldMode mode) { return with(&HoldCommand::mode, mode); }
Command permitting(RefinePermission permission) {
  return with(&RefineCommand::permission, permission);
}
Command released(const char* what) {
  return with(&ReleaseCommand::what, std::vector<std::string>{what});
}
Command selected(const std::string& surface) { return with(&SelectCommand::surface, surface); }
Command selected_together(const std::vector<std::string>& ids) {
  return with(&SelectCommand::surfaces, ids);
}
Command converted(const std::vector<std::string>& surfaces) {
  return with(&ConvertCommand::surfaces, surfaces);
}

Command without_seams() {
  SeamsCommand command;
  command.seams.couple = false;
  return make_command(command);
}

Command with_smooth_seams() {
  SeamsCommand command;
  command.seams.smooth = true;
  return make_command(command);
}

std::vector<Fix> fixes_at_edges(ErrorCode code, const DiagnosticValues& v) {
  const std::string edge = v.edge.value_or("");
  std::vector<Command> follow;
  for (const std::string& id : v.edges) follow.push_back(let_edge(id, EdgeCondition::follow));
  switch (code) {
    case ErrorCode::step_folds_beside_edge:
      if (v.hold == "follow")
        return {{FixCode::let_follow, {let_edge(edge, EdgeCondition::follow)}}};
      return {{FixCode::let_go, {let_edge(edge, EdgeCondition::open)}}};
    case ErrorCode::edge_would_open:
    case ErrorCode::edge_would_turn:
      return {{FixCode::let_follow, follow}};
    case ErrorCode::edge_left_open:
      return {{FixCode::let_open, {selected(v.surface.value_or("")), held_by(HoldMode::open)}}};
    case ErrorCode::seam_would_open:
      return {{FixCode::let_part, {without_seams()}}};
    case ErrorCode::edges_unknown:
      return {{FixCode::hold_rows, {make_command(HoldCommand{})}},
              {FixCode::let_open, {held_by(HoldMode::open)}}};
    case ErrorCode::edge_face_not_spline:
      if (v.others.empty()) return {};
      return {{FixCode::convert_and_follow,
               {converted(v.others), selected_together(v.surfaces),
                let_edge(edge, EdgeCondition::follow)}}};
    case ErrorCode::edge_face_not_selected:
      return {{FixCode::select_and_follow,
               {selected_together(v.surfaces), let_edge(edge, EdgeCondition::follow)}}};
    default:
      return {};
  }
}

std::vector<Fix> fixes_of_selection(ErrorCode code, const DiagnosticValues& v) {
  const std::string surface = v.surface.value_or("");
  switch (code) {
    case ErrorCode::no_spline_surface:
      if (v.body) return {{FixCode::select, {with(&SelectCommand::body, *v.body)}}};
      return {{FixCode::convert, {converted({surface})}}};
    case ErrorCode::none_selected:
    case ErrorCode::several_selected:
      return {{FixCode::select, {selected(surface)}}};
    case ErrorCode::not_a_spline:
      return {{FixCode::convert, {converted({surface})}}};
    case ErrorCode::surface_locked: {
      LockCommand unlock;
      unlock.surfaces = {surface};
      unlock.locked = false;
      return {{FixCode::unlock, {make_command(unlock)}}};
    }
    default:
      return fixes_at_edges(code, v);
  }
}

}  // namespace

std::vector<Fix> fixes_for(const Diagnostic& diagnostic) {
  const DiagnosticValues v = values_of(diagnostic);
  switch (diagnostic.code) {
    case ErrorCode::nothing_held:
    case ErrorCode::step_runs_away:
    case ErrorCode::step_not_finite:
      return {{FixCode::hold_rows, {make_command(HoldCommand{})}}};
    case ErrorCode::surface_loose:
      return {{FixCode::hold_edges, {held_by(HoldMode::position)}},
              {FixCode::hold_rows, {make_command(HoldCommand{})}}};
    case ErrorCode::nothing_free:
    case ErrorCode::nothing_free_at_brush:
    case ErrorCode::constraint_contradicts:
      return {{FixCode::release_all, {make_command(ReleaseCommand{})}}};
    case ErrorCode::nothing_free_in_rows:
      return {{FixCode::refine,
               {with(&RefineCommand::region, std::array{Fractions{0, 1}, Fractions{0, 1}})}},
              {FixCode::hold_nothing, {released("hold")}}};
    case ErrorCode::nothing_free_at_edges:
      if (v.permission != "never") return {};
      return {{FixCode::permit_refining, {permitting(RefinePermission::trims)}}};
    case ErrorCode::point_frozen:
    case ErrorCode::region_frozen:
      return {{FixCode::thaw, {released("freeze")}}};
    case ErrorCode::pins_by_number:
      return {{FixCode::release_pins, {released("pins")}}};
    case ErrorCode::brush_too_small:
      return {{FixCode::permit_refining, {permitting(RefinePermission::automatic)}}};
    case ErrorCode::net_too_large:
      return {{FixCode::keep_net, {permitting(RefinePermission::never)}}};
    case ErrorCode::beyond_limit:
    case ErrorCode::limit_keeps_basis:
      return {{FixCode::end_limit, {make_command(LimitCommand{})}}};
    case ErrorCode::scaling_is_raw:
      return {{FixCode::normalise, {make_command(ScalingCommand{})}}};
    case ErrorCode::rest_shape_needed:
      return {{FixCode::set_rest_shape, {make_command(RestCommand{})}}};
    case ErrorCode::seam_creased:
      return {{FixCode::keep_smooth, {make_command(UndoCommand{}), with_smooth_seams()}}};
    default:
      return fixes_of_selection(diagnostic.code, v);
  }
}

}  // namespace knead
