#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "shape_kernel.hpp"
#include "spline/foot_search.hpp"

namespace knead::detail {

using Patches = std::vector<std::unique_ptr<Patch>>;
using Inside = std::function<bool(const Point&)>;

/// A solid whose surface is made of patches. It is symmetric in the folded coordinates: only the
/// octant, quarter or half where they are positive has patches.
class SearchedSolid final : public ShapeKernel {
 public:
  /// \param round the solid is a solid of revolution about z and its patches are meridians in y = 0
  SearchedSolid(Patches patches, Inside inside, std::array<bool, 3> fold, bool round,
                const BoundingBox& extent, double feature);

  Nearest nearest(const Point& x) const override;

 private:
  void orient(Patch& patch) const;

  Inside inside_;
  std::array<bool, 3> fold_;
  bool round_;
  std::unique_ptr<FootSearch> search_;
};

}  // namespace knead::detail
