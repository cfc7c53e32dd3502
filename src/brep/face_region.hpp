#pragma once

#include <span>
#include <vector>

#include "brep/surfaces/surface_foot.hpp"
#include "brep/tessellation/parameter_region.hpp"
#include "face_loops.hpp"
#include "trim_loops.hpp"

namespace knead::brep {

/// The bounds of a face as polygons in the plane of the unwrapped parameters of its surface. `size`
/// is the diagonal of its net. Errors (input): its edges cannot be followed, or do not lie on its
/// surface.
[[nodiscard]] Expected<std::vector<RegionPart>> region_of(const Model& model, const Face& face,
                                                          EdgeSampler& edges,
                                                          const SurfaceFoot& feet, double size);

/// Feet are found to about 1e-14 of the size of a surface: a face within less than this share of it
/// has one for all of its edges, and looking for others takes long.
inline constexpr double least_extent = 1e-13;
/// Errors (input): the bounds of a face, if more than a point, are smaller than that beside the net
/// of its surface. A wrong coordinate makes surfaces of such a size.
[[nodiscard]] Expected<void> check_extent(const Model& model, const Face& face,
                                          std::span<const Loop> loops, double size);

/// Appends a part, once for every turn that brings some of it into the domain.
void add_turns(const RegionPart& part, const ParameterSpace& space, std::vector<TrimFace>& faces);

/// A point lies on a surface if its foot is no farther than this share of the net's diagonal.
inline constexpr double on_surface = 1e-5;

/// The edges of a face may be this share of its extent off its surface.
inline constexpr double off_surface = 0.02;

}  // namespace knead::brep
