#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "entity.hpp"
#include "knead/brep/model.hpp"

namespace knead::step {

/// A representation context that assigns a length unit.
struct UnitContext {
  std::uint32_t instance = no_instance;
  brep::LengthUnit unit;
  /// Largest length of its GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT, in `unit`; 0 if none.
  double uncertainty = 0;
};

/// Every GLOBAL_UNIT_ASSIGNED_CONTEXT with a LENGTH_UNIT (ISO 10303-41 and -43), in the order of
/// the file.
[[nodiscard]] std::vector<UnitContext> read_unit_contexts(const Reader& reader);

/// For each given instance the context of its representation: an index into `contexts`, or -1 if it
/// is reached from none or from contexts with different units. A single context applies to all;
/// otherwise references are followed from the items of each representation (an instance that refers
/// to a context directly), not into other representations. Cost: linear in the file for each
/// context.
[[nodiscard]] std::vector<int> contexts_of(const Reader& reader,
                                           const std::vector<UnitContext>& contexts,
                                           const std::vector<std::uint32_t>& instances);

}  // namespace knead::step
