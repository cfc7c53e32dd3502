#pragma once

#include <span>
#include <string>

#include "act.hpp"

namespace knead {

// What holds the selected surfaces.

/// Keeps a constraint on the selected surfaces, after trying that it can be made.
[[nodiscard]] Expected<void> add_constraint(Act& act, const Constraint& constraint);
/// Whether the constraints there are can be made, and met together: what cannot is refused now, not
/// at the next step. No matrix is factored.
[[nodiscard]] Expected<void> check_constraints(Act& act);
/// Whether the constraints can be made on some selected surfaces, of which those alone changed that
/// ask for no motion (edges that are held where they are, freed or followed); of all surfaces,
/// where some constraint does. Whether the model can be factored is found out by the next step.
/// \param changed ascending numbers in the selection
[[nodiscard]] Expected<void> check_constraints_on(Act& act, std::span<const int> changed);

/// Holds the edges of faces on selected surfaces of which nothing is said as those of the first one
/// that has its edges held; what cannot be followed is noted.
void hold_likewise(Act& act);
/// Whether the edges of faces that are held stayed where they were as surfaces changed from
/// `before`: for commands that place control points, as no model holds the edges there. Errors
/// (numerical): an edge that moved, by how much, and how it may follow.
[[nodiscard]] Expected<void> check_held_edges(Act& act, const Scene& before);

/// Some selected surface is held by the edges of its faces.
[[nodiscard]] bool holds_edges(const Scene& scene);
/// The error of a step in which nothing is free to move under a tool.
[[nodiscard]] Error all_held(const Scene& scene, const std::string& tool);

}  // namespace knead
