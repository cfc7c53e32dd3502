#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "scene/display.hpp"
#include "spline/box_tree.hpp"

namespace knead {

/// The shown model as triangles that rays can be sent through: the surfaces of a scene, each of it
/// what its faces show, and the faces around them. Each surface has a tree of its own, made anew
/// where its shape has changed.
///
/// Triangles of a surface lie between grid lines whose chords are within a third of `chord` times
/// the diagonal of the model's box of the surface (`grid_lines`, which has limits), so that the
/// triangles are within about the whole of it; a hit counts where its parameters, linear in the
/// triangle, are visible, so that trims are as exact as their loops.
class ModelFacets {
 public:
  static constexpr double chord = 2.5e-4;
  /// Hits at a smaller angle to a face, radians, run along it and are not counted.
  static constexpr double grazing = 1e-3;

  /// Brings the trees up to date. \param opened the shapes as opened, not the present ones
  /// Errors (numerical): a rational denominator that is not positive. Cost: O(n log n) in the
  /// triangles that change.
  Expected<void> refresh(const Scene& scene, bool opened,
                         std::shared_ptr<const Surroundings> around);

  /// The side of a surface without material: 1 if S_u × S_v points there, else −1; 1 where the file
  /// does not say.
  [[nodiscard]] double outward(int surface) const;

  /// The length of the ray from a point of a surface along a unit vector into the material, to the
  /// next face; none where it meets none.
  ///
  /// The neighbourhood of the start is excluded by its orientation: a face counts where the ray
  /// leaves its material. One where it enters, or of which the file does not say where the material
  /// is, counts on other surfaces only, and farther away than the triangles may be from their
  /// surfaces, on both sides: 2 `chord` of the diagonal. Cost: about O(log n).
  [[nodiscard]] std::optional<double> thickness(int surface, const Point& from,
                                                const Point& inward) const;

 private:
  struct FacetTree {
    std::shared_ptr<const Surface> of;
    Surroundings::Shown shown;
    TriangleTree tree;
    std::vector<Eigen::Vector2d> fractions;  ///< of the domain, by point; empty: all of it is shown
    std::size_t part = 0;                    ///< of an assembly
  };
  [[nodiscard]] static Expected<FacetTree> tree_of(std::shared_ptr<const Surface> surface,
                                                   Surroundings::Shown shown, double tolerance);

  /// Keeps the faces around, by their parts of an assembly; null: none.
  void see(const Surroundings* around);

  std::shared_ptr<const Surroundings> around_;
  double diagonal_ = 0;
  std::vector<FacetTree> parts_;   ///< by surface
  std::vector<FacetTree> others_;  ///< the faces around
  BoxTree boxes_;                  ///< of both, in this order
};

}  // namespace knead
