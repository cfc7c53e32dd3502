#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Has the report tell where a surface point is at the end: `"measurements": [{"name", "surface", "at", "point",
/// "displacement", "normal"}]`. Replaces the measurement of that name.
struct MeasureCommand {
  std::string name = "point";
  Fractions at = {0.5, 0.5};
  std::optional<bool> middle = {};  ///< of what is visible, instead of `at`
};

template <>
Expected<void> Executor::execute(const MeasureCommand& c);
void describe(MeasureCommand& c, Fields& fields);

}  // namespace knead
