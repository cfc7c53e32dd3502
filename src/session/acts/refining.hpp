#pragma once

#include <span>
#include <string>

#include "act.hpp"
#include "scene/reshape.hpp"
#include "scene/trims.hpp"

namespace knead {

// Finer nets of the same shapes.

/// The same control points on other knots or with other weights. Errors: a limit is set (input),
/// and those of `change`.
[[nodiscard]] Expected<void> change_basis(Act& act, SceneSurface& surface,
                                          const SurfaceChange& change);
/// The same shapes on another net, which is noted.
[[nodiscard]] Expected<void> change_net(Act& act, SceneSurface& surface,
                                        const SurfaceChange& change);

/// Refines what seams between selected surfaces need; with `followed` only those between faces at
/// edges that follow.
[[nodiscard]] Expected<void> refine_seams(Act& act, bool followed = false);
/// Unites the knots of coupled edges within reach of a place that have too little in common to bend
/// there
/// (`SeamReport::restricted`), unless refining is not permitted. `reports` are those of the
/// selected surfaces.
[[nodiscard]] Expected<void> unite_restricted(Act& act, std::span<const SeamReport> reports,
                                              const Point& place, double reach);
/// Halves the spans of the selected surfaces that a tool reaches. Returns whether there were any.
/// Errors (numerical): `limited`, where nobody asked for it, and a net would get more than 40 000
/// control points, and four times those that it has in the file.
[[nodiscard]] Expected<bool> refine_under(Act& act, const Tool& tool, bool limited = false);

/// Refines the selected surfaces of which edges of faces are held, so that something is free under
/// each tool that touches them.
[[nodiscard]] Expected<void> refine_trims(Act& act);
/// The same at one place, for something of this size.
[[nodiscard]] Expected<void> refine_at_trims(Act& act, SceneSurface& surface, const Fractions& at,
                                             double size);

/// "#12: the net is now …", for the notes.
[[nodiscard]] std::string net_note(const SceneSurface& surface);

}  // namespace knead
