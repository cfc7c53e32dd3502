#pragma once

#include <functional>

#include "knead/scene/scene.hpp"

namespace knead {

/// A surface made of another one, by its basis alone: shapes that share a basis share the new one.
using SurfaceChange = std::function<Expected<Surface>(const Surface&)>;

/// Replaces every shape of a surface that has the present basis by what `change` makes of it, except `opened`; shapes
/// that are one object stay one. The velocity is left as it is. Errors are those of `change`.
[[nodiscard]] Expected<void> change_basis(SceneSurface& surface, const SurfaceChange& change);

/// The same shapes on another net: all that have the present basis, `opened` and the velocity among them.
/// Errors: control points that are pinned by their numbers (input), and those of `change`.
[[nodiscard]] Expected<void> change_net(SceneSurface& surface, const SurfaceChange& change);

/// What `coarsen` did.
struct Coarsening {
  std::size_t removed = 0;
  double bound = 0;      ///< no point moved further than this, file units
  bool stopped = false;  ///< the surface was moving, and is at rest now: its velocity does not fit a coarser net
};

/// Removes knots while the current shape changes by no more than `tolerance` (a length); every shape on the present
/// basis follows. Errors: control points that are pinned by their numbers (input), and those of
/// `remove_knots`.
[[nodiscard]] Expected<Coarsening> coarsen(SceneSurface& surface, double tolerance);

}  // namespace knead
