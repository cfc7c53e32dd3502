#pragma once

#include "knead/base/error.hpp"

namespace knead {

// What errors and notes say to programs. What may be done about them is a `Fix`
// (`knead/session/command.hpp`); docs/errors.md lists all of them with their names and values.

enum class ErrorCode : unsigned short {
  none,  ///< nothing but the text is known

  nothing_held,           ///< nothing holds the shape, so that it has no position of balance
  nothing_free,           ///< pins, frozen regions and held lines leave nothing free: tool
  nothing_free_in_rows,   ///< held rows of control points do: tool, surface, rows
  nothing_free_at_edges,  ///< held edges of faces do: tool, surface, permission
  nothing_free_at_brush,  ///< all that a brush would move is held or masked
  point_frozen,           ///< a control point that would be moved: point
  region_frozen,          ///< a region that would be moved: surface, distance
  pins_by_number,  ///< pinned control points, whose numbers a change of the net would change:
                   ///< surface
  constraint_contradicts,  ///< what else is held

  step_folds,              ///< the surface: surface
  step_folds_beside_edge,  ///< likewise, beside a held edge of its faces: surface, edge, hold
  step_runs_away,          ///< many sizes of the model: sizes
  step_not_finite,         ///< numbers overflow
  tool_too_small,          ///< for the surface: size
  brush_too_small,         ///< it reaches no control point
  net_too_large,           ///< that a tool needs: tool, surface

  edge_face_not_spline,    ///< an edge cannot follow, as a face lies on another form: edge, face,
                           ///< surface, form, surfaces, others
  edge_face_not_selected,  ///< an edge cannot follow, as a face would have to be selected: edge,
                           ///< surface, surfaces
  edge_would_open,         ///< a held one: edge, surface, distance, edges
  edge_would_turn,         ///< the tangent planes along a held one: edge, surface, angle, edges
  edge_would_part,         ///< one that follows: edge
  edge_left_open,          ///< in what would be saved: edge, surface, faces, distance
  seam_would_open,         ///< between surfaces that are coupled: first, second, distance
  edges_unknown,           ///< of the faces on a surface: surface

  beyond_limit,       ///< a surface would be farther from where it was opened: distance, limit
  limit_keeps_basis,  ///< weights and knots stay while a limit is set
  limit_needs_opened_basis,  ///< weights or knots were edited, so that a limit cannot be set:
                             ///< surface

  scaling_is_raw,     ///< strokes that leave their groove need the normalised one
  shell_needed,       ///< for what only a shell can do
  rest_shape_needed,  ///< a shape that is at rest somewhere

  no_surface,         ///< in the scene
  no_body,            ///< there is no such curve or volume
  no_spline_surface,  ///< in the file, but a curve or a surface to be converted: body, surface
  none_selected,      ///< of the surfaces; the first is: surface
  several_selected,   ///< where one is meant: surface
  not_a_spline,       ///< but a surface that can be converted: surface, form
  surface_locked,     ///< and so not to be selected: surface

  seam_creased,     ///< note: first, second, angle, x, y, z, reason
  surface_loose,    ///< note: nothing holds what is pressed: surfaces
  stopped_at_face,  ///< note: before a surface came through another face: surface, other, x, y, z,
                    ///< depth
  through_face,     ///< note: likewise, and it went on

  out_of_range,  ///< a number of a field
};

}  // namespace knead
