#pragma once

#include <vector>

#include "step_entity.hpp"
#include "step_surfaces.hpp"

namespace knead::step {

/// `SurfaceEntity::trimmed` and `SurfaceEntity::faces`.
struct FaceUse {
  bool trimmed = false;
  int faces = 0;
};

/// How the faces of a file use each of `surfaces`; `uncertainty` belongs to them one by one.
[[nodiscard]] std::vector<FaceUse> face_uses(const Reader& reader, const std::vector<ReadSurface>& surfaces,
                                             const std::vector<double>& uncertainty);

}  // namespace knead::step
