#include <fmt/format.h>

#include "diagnostic_info.hpp"

namespace knead {

// What codes say, and their names in JSON.

std::span<const Choice> choices(ErrorCode) {
  static constexpr Choice list[] = {
      {"none", ErrorCode::none, "nothing but the text is known"},
      {"nothing_held", ErrorCode::nothing_held,
       "nothing holds the shape, so that it has no position of balance"},
      {"nothing_free", ErrorCode::nothing_free,
       "what is pinned, frozen or held leaves nothing free to move under a tool"},
      {"nothing_free_in_rows", ErrorCode::nothing_free_in_rows,
       "held rows of control points leave nothing free to move under a tool"},
      {"nothing_free_at_edges", ErrorCode::nothing_free_at_edges,
       "held edges of faces leave nothing free to move under a tool"},
      {"nothing_free_at_brush", ErrorCode::nothing_free_at_brush,
       "all that a brush would move is held or masked"},
      {"point_frozen", ErrorCode::point_frozen, "a control point that would be moved is frozen"},
      {"region_frozen", ErrorCode::region_frozen, "a frozen region would be moved"},
      {"pins_by_number", ErrorCode::pins_by_number,
       "control points are pinned by their numbers, which would change"},
      {"constraint_contradicts", ErrorCode::constraint_contradicts,
       "a constraint contradicts what is held"},
      {"step_folds", ErrorCode::step_folds, "a step would fold a surface"},
      {"step_folds_beside_edge", ErrorCode::step_folds_beside_edge,
       "a step would fold a surface beside a held edge of its faces"},
      {"step_runs_away", ErrorCode::step_runs_away,
       "a step would move a shape by many times its size"},
      {"step_not_finite", ErrorCode::step_not_finite, "a step has no finite result"},
      {"tool_too_small", ErrorCode::tool_too_small, "a tool is too small for the surface"},
      {"brush_too_small", ErrorCode::brush_too_small, "a brush reaches no control point"},
      {"net_too_large", ErrorCode::net_too_large,
       "a tool needs more control points than a command inserts by itself"},
      {"edge_face_not_spline", ErrorCode::edge_face_not_spline,
       "an edge cannot follow, as one of its faces lies on a surface of another form"},
      {"edge_face_not_selected", ErrorCode::edge_face_not_selected,
       "an edge cannot follow, as the surface of one of its faces is not selected"},
      {"edge_would_open", ErrorCode::edge_would_open, "a held edge would open"},
      {"edge_would_turn", ErrorCode::edge_would_turn,
       "the tangent planes along a held edge would turn"},
      {"edge_would_part", ErrorCode::edge_would_part,
       "the faces at an edge that follows would part, or meet at an angle"},
      {"edge_left_open", ErrorCode::edge_left_open, "an edge is open in what would be saved"},
      {"seam_would_open", ErrorCode::seam_would_open, "a seam between coupled surfaces would open"},
      {"edges_unknown", ErrorCode::edges_unknown,
       "the edges of the faces on a surface cannot be followed"},
      {"beyond_limit", ErrorCode::beyond_limit,
       "a surface would be farther from where it was opened than the limit allows"},
      {"limit_keeps_basis", ErrorCode::limit_keeps_basis,
       "weights and knots stay as they are while a limit is set"},
      {"limit_needs_opened_basis", ErrorCode::limit_needs_opened_basis,
       "weights or knots were edited, so that no limit can be set"},
      {"scaling_is_raw", ErrorCode::scaling_is_raw,
       "strokes that leave their groove need a model in normalised units"},
      {"shell_needed", ErrorCode::shell_needed, "only a shell can do this"},
      {"rest_shape_needed", ErrorCode::rest_shape_needed,
       "a shape without a rest shape cannot do this"},
      {"no_surface", ErrorCode::no_surface, "the scene has no surface"},
      {"no_body", ErrorCode::no_body, "there is no such curve or volume"},
      {"no_spline_surface", ErrorCode::no_spline_surface, "the file has no B-spline surface"},
      {"none_selected", ErrorCode::none_selected, "no surface is selected"},
      {"several_selected", ErrorCode::several_selected,
       "several surfaces are selected where one is meant"},
      {"not_a_spline", ErrorCode::not_a_spline,
       "a surface is no B-spline surface, but can be converted"},
      {"surface_locked", ErrorCode::surface_locked, "a surface is locked"},
      {"seam_creased", ErrorCode::seam_creased, "note: a seam that was smooth has a crease"},
      {"surface_loose", ErrorCode::surface_loose,
       "note: nothing holds the surfaces that are pressed"},
      {"stopped_at_face", ErrorCode::stopped_at_face,
       "note: a surface was stopped before it came through another face"},
      {"through_face", ErrorCode::through_face, "note: a surface came through another face"},
      {"out_of_range", ErrorCode::out_of_range,
       "a number is out of the range of its field, which `where` names"},
  };
  return list;
}

std::span<const Choice> choices(FixCode) {
  static constexpr Choice list[] = {
      {"hold_edges", FixCode::hold_edges,
       "hold the edges of faces, or outer rows of control points where there are none"},
      {"hold_rows", FixCode::hold_rows, "hold the outer rows of control points"},
      {"hold_nothing", FixCode::hold_nothing, "release the held rows"},
      {"release_all", FixCode::release_all, "release all that is held"},
      {"release_pins", FixCode::release_pins, "release pinned control points"},
      {"thaw", FixCode::thaw, "release frozen regions"},
      {"refine", FixCode::refine, "halve the spans of the net"},
      {"permit_refining", FixCode::permit_refining,
       "let commands refine the net where they need to"},
      {"keep_net", FixCode::keep_net, "let commands go on with the net as it is"},
      {"let_follow", FixCode::let_follow, "let edges follow what moves"},
      {"let_go", FixCode::let_go, "let an edge go"},
      {"let_open", FixCode::let_open, "let edges of a surface open"},
      {"let_part", FixCode::let_part, "let coupled surfaces part"},
      {"convert_and_follow", FixCode::convert_and_follow,
       "convert the surfaces at an edge, select all of them, and let the edge follow"},
      {"select_and_follow", FixCode::select_and_follow,
       "select all surfaces at an edge, and let it follow"},
      {"unlock", FixCode::unlock, "let a locked surface be selected again"},
      {"select", FixCode::select, "select what is meant"},
      {"convert", FixCode::convert, "make a B-spline surface of another one"},
      {"end_limit", FixCode::end_limit, "end the limit"},
      {"normalise", FixCode::normalise, "use the model in normalised units"},
      {"set_rest_shape", FixCode::set_rest_shape, "make the present shape the rest shape"},
      {"keep_smooth", FixCode::keep_smooth, "undo, and keep seams smooth; then act again"},
  };
  return list;
}

void describe(DiagnosticValues& v, Fields& fields) {
  fields.name("diagnostic values", "What a code says it about; null what it does not name.");
  fields.add("surface", v.surface, {.help = "its id"});
  fields.add("surfaces", v.surfaces, {.help = "all that are concerned"});
  fields.add("others", v.others, {.help = "those of them that would have to be converted"});
  fields.add("body", v.body, {.help = "id of a curve or a volume"});
  fields.add("edge", v.edge, {.help = "id of an edge of faces"});
  fields.add("edges", v.edges, {.help = "all that are concerned"});
  fields.add("face", v.face, {.help = "its id"});
  fields.add("faces", v.faces, {.help = "those at the edge"});
  fields.add("form", v.form,
             {.help = "of the surface that is no B-spline surface, as in the file"});
  fields.add("tool", v.tool, {.help = "its name"});
  fields.add("hold", v.hold, {.help = "what the edge could do instead: follow, or free"});
  fields.add("permission", v.permission, {.help = "to refine: trims, or never"});
  fields.add("rows", v.rows, {.help = "outer rows of control points"});
  fields.add("point", v.point, {.help = "number of a control point"});
  fields.add("distance", v.distance, {.unit = Unit::length});
  fields.add("limit", v.limit, {.unit = Unit::length});
  fields.add("angle", v.angle, {.unit = Unit::angle});
  fields.add("size", v.size, {.help = "of the tool", .unit = Unit::length});
  fields.add("sizes", v.sizes, {.help = "of the model"});
  fields.add("depth", v.depth, {.unit = Unit::length});
  fields.add("x", v.x, {.help = "of a place", .unit = Unit::length});
  fields.add("y", v.y, {.unit = Unit::length});
  fields.add("z", v.z, {.unit = Unit::length});
  fields.add("first", v.first, {.help = "side of a seam"});
  fields.add("second", v.second, {.help = "its other side"});
  fields.add("other", v.other, {.help = "what a surface comes to, in words"});
  fields.add("reason", v.reason, {.help = "in words"});
}

std::string diagnostics_table() {
  std::string text = "| code | meaning |\n|---|---|\n";
  for (const Choice& code : choices(ErrorCode{}))
    text += fmt::format("| `{}` | {} |\n", code.name, code.help);
  text += "\n| fix | what it does |\n|---|---|\n";
  for (const Choice& fix : choices(FixCode{}))
    text += fmt::format("| `{}` | {} |\n", fix.name, fix.help);
  return text;
}

}  // namespace knead
