#pragma once

#include "knead/base/error.hpp"
#include "morph/surface_fit.hpp"
#include "scene/scene.hpp"

namespace knead {

/// What a surface keeps where it follows data: pins, edges and rows that are held, kept curves,
/// frozen regions, masks and symmetries, all where they are now. Edges of faces that are held
/// together, as sculpting holds them, go along; those held by name stay. Null: nothing.
/// \param surface the edges of its faces are known if any is held by name
/// Errors: those of `freeze_region`.
[[nodiscard]] Expected<std::shared_ptr<const morph::SurfaceHolds>> data_holds(
    const SceneSurface& surface);

/// Whether an edge of the faces on a surface is held by name.
[[nodiscard]] bool holds_edge_by_name(const SceneSurface& surface);

}  // namespace knead
