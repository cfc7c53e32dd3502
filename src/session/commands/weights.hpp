#pragma once

#include "../named_points.hpp"

namespace knead {

/// Other weights for the same control points: a permanent change of shape.
struct WeightsCommand {
  NamedPoints points;
  std::optional<double> weight;  ///< > 0; or:
  std::optional<double> by;      ///< a factor > 0
};

Expected<void> execute(const WeightsCommand& c, Act& act);
void describe(WeightsCommand& c, Fields& fields);

}  // namespace knead
