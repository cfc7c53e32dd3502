#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Makes the report give the final position of a surface point: `"measurements": [{"name",
/// "surface", "at", "point", "displacement", "normal", "curvature"}]`. Replaces the measurement of
/// that name.
struct MeasureCommand {
  std::string name = "point";
  std::optional<std::string> surface = {};  ///< id; left out: the first selected one
  Fractions at = {0.5, 0.5};
  std::optional<bool> middle = {};  ///< of the visible part, instead of `at`
};

Expected<void> execute(const MeasureCommand& c, Act& act);
void describe(MeasureCommand& c, Fields& fields);

}  // namespace knead
