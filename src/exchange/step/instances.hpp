#pragma once

#include <Eigen/Geometry>
#include <unordered_map>
#include <vector>

#include "entity.hpp"
#include "knead/brep/model.hpp"

namespace knead::step {

/// A component within an assembly, with the representations that are related.
struct Component {
  brep::Instance instance;
  std::uint32_t parent = no_instance, child = no_instance;  ///< representations; none: not given
  std::optional<Eigen::Affine3d> frame,
      place;  ///< of the component, and where that lies in the parent
};

/// Products, their representations, and how these are put together (ISO 10303-43 and -44).
struct Structure {
  std::vector<Component>
      components;  ///< each NEXT_ASSEMBLY_USAGE_OCCURRENCE, MAPPED_ITEM, other transformed relation
  std::vector<std::pair<std::uint32_t, std::uint32_t>>
      linked;  ///< representations related without a transformation
  std::unordered_map<std::uint32_t, std::string>
      product_of;  ///< of each representation of a product: its name
};

[[nodiscard]] Structure read_structure(const Reader& reader);

/// AXIS2_PLACEMENT_3D, in parameters AXIS2_PLACEMENT_2D; none if the instance is not one or lacks
/// its location.
[[nodiscard]] std::optional<brep::AxisPlacement> read_placement(const Reader& reader,
                                                                std::uint32_t instance);

}  // namespace knead::step
