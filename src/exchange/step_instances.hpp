#pragma once

#include <vector>

#include "knead/exchange/step_file.hpp"
#include "step_entity.hpp"

namespace knead::step {

/// The placements of components in assemblies (ISO 10303-44, and mapped items of ISO 10303-43), in the order of the
/// file: first each NEXT_ASSEMBLY_USAGE_OCCURRENCE, then each MAPPED_ITEM.
[[nodiscard]] std::vector<Instance> read_instances(const Reader& reader);

/// AXIS2_PLACEMENT_3D; none if the instance is not one or lacks its location.
[[nodiscard]] std::optional<AxisPlacement> read_placement(const Reader& reader, std::uint32_t instance);

}  // namespace knead::step
