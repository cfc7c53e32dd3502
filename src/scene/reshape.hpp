#pragma once

#include <functional>

#include "scene.hpp"

namespace knead {

/// A surface made from another, depending on its basis alone: shapes that share a basis share the
/// new one.
using SurfaceChange = std::function<Expected<Surface>(const Surface&)>;

/// Replaces every shape of a surface that has the present basis by the result of `change`, except
/// `opened`; shapes that are one object remain one. The velocity is left unchanged. Errors are
/// those of `change`.
[[nodiscard]] Expected<void> change_basis(SceneSurface& surface, const SurfaceChange& change);

/// The same shapes on another net: all that have the present basis, including `opened` and the
/// velocity. Errors: control points pinned by their indices (input), and those of `change`.
[[nodiscard]] Expected<void> change_net(SceneSurface& surface, const SurfaceChange& change);

/// The result of `coarsen`.
struct Coarsening {
  std::size_t removed = 0;
  double bound = 0;      ///< no point moved further than this, file units
  bool stopped = false;  ///< the surface was moving and is now at rest: its velocity does not fit
                         ///< the coarser net
};

/// Removes knots while the current shape changes by no more than `tolerance` (a length); every
/// shape on the present basis follows. Errors: control points pinned by their indices (input), and
/// those of `remove_knots`.
[[nodiscard]] Expected<Coarsening> coarsen(SceneSurface& surface, double tolerance);

}  // namespace knead
