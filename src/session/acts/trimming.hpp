#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "act.hpp"

namespace knead {

struct SurfacePlace;

// What faces show of the surfaces, and whether they stay unfolded.

/// What faces show of a surface, by the document's file; all of a surface that is in no file.
/// Errors: a face on it cannot be followed (input).
[[nodiscard]] Expected<const VisibleRegion*> visible(Act& act, SceneSurface& surface);
/// Makes `visible` known of all selected surfaces of which edges of faces are held, or of which
/// tools touch only what is visible; where that cannot be known, the latter is noted.
[[nodiscard]] Expected<void> know_trims(Act& act);
/// The fractions of a place. Where edges of faces are held, a place that is not visible is an error
/// which names the nearest one that is; elsewhere it is noted.
[[nodiscard]] Expected<Fractions> place_on(Act& act, SceneSurface& surface,
                                           const SurfacePlace& place);

/// Some edge of the visible faces of a surface is held.
[[nodiscard]] bool any_held(const SceneSurface& s);
/// Whether the selected surfaces of which edges of faces are held have not folded: their normals
/// point to the same side as at rest, at four points per span. Error (numerical): where they do
/// not.
[[nodiscard]] Expected<void> check_folds(const Scene& scene);
/// Makes a motion smaller, everywhere alike, where it would fold a face: what is held is linear in
/// displacements, and so holds for every share of them. \param shows shows this share of it; all of
/// `whole` is shown. Returns the note on it, in which `what` names it; empty: nothing folds.
/// Errors: as above, where not even a tenth of it would be left.
[[nodiscard]] Expected<std::string> keep_unfolded(
    const Scene& scene, std::string_view what, double whole,
    const std::function<Expected<void>(double)>& shows);
/// The same of a step from these shapes, but not of an equilibrium. Of a step that is not the
/// first, nothing may be left of it; then too a note says so.
[[nodiscard]] Expected<std::string> keep_step_unfolded(
    Scene& scene, std::span<const std::shared_ptr<const Surface>> from, bool first,
    const EvolutionPolicy& evolution);

}  // namespace knead
