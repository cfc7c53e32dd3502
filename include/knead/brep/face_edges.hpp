#pragma once

#include <memory>
#include <string>

#include "knead/brep/model.hpp"
#include "knead/brep/visible_region.hpp"

namespace knead {

/// The part of a B-spline surface that the faces of a model show, and their edges with their names,
/// neighbours and course in the parameters of the surface.
///
/// Bounds are followed as by `trim_loops`; edges are sampled more finely, from foot point to foot
/// point, and chords are divided until the foot of their midpoint is within 2e-4 of the edge's
/// extent of the chord in parameters. Each edge appears once. A file's own parameter curves
/// (PCURVE) are not needed. Without faces it is the `region_of_sides`. Errors: no such surface; a
/// face on it that cannot be followed, named with the reason (input). Cost: O((p + 1)²) per point
/// and iteration, and a pass over the file.
[[nodiscard]] Expected<VisibleRegion> visible_region(const brep::Model& model,
                                                     const std::string& surface);

/// The region of a surface without faces: all of it, within those of its sides "u0", "u1", "v0" and
/// "v1" that are neither closed nor a single point. Errors: those of evaluation.
[[nodiscard]] Expected<VisibleRegion> region_of_sides(const Surface& surface);

/// The same of many surfaces of a file. Cost: the pass over the file is made once, by the
/// constructor; `of` takes what the edges around that surface take. Immutable, const is
/// thread-safe.
class VisibleRegions {
 public:
  explicit VisibleRegions(std::shared_ptr<const brep::Model> model);
  ~VisibleRegions();
  VisibleRegions(const VisibleRegions&) = delete;
  VisibleRegions& operator=(const VisibleRegions&) = delete;

  /// Errors: those of `visible_region`.
  [[nodiscard]] Expected<VisibleRegion> of(const std::string& surface) const;

 private:
  struct Faces;
  std::unique_ptr<const Faces> faces_;
};

}  // namespace knead
