#pragma once

#include "../named_points.hpp"

namespace knead {

/// Other weights for control points, which stay: the shape changes, for good.
struct WeightsCommand {
  NamedPoints points;
  std::optional<double> weight;  ///< > 0; or:
  std::optional<double> by;      ///< a factor > 0
};

KNEAD_COMMAND(WeightsCommand, "weights", "other weights: control points stay, the shape changes for good") {
  visit_points(c.points, v);
  v.field("weight", Presence::optional, c.weight, "what each weighs, > 0; 1 where nothing was said; or:");
  v.field("by", Presence::optional, c.by, "a factor > 0 for the weight of each");
}

}  // namespace knead
