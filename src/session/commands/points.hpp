#pragma once

#include "../command_fields.hpp"
#include "../named_points.hpp"

namespace knead {

/// Moves control points by hand. The resulting shape is clay: it is permanent.
struct PointsCommand {
  static constexpr ActsOn acts_on = ActsOn::shapes;
  NamedPoints points;
  std::optional<Vector3> by;  ///< the same for all; or:
  std::vector<Vector3> to;    ///< one place for each
  bool relative = false;      ///< `by` is in fractions of the bounding-box diagonal
  std::optional<ThroughAllowance> allow = {};
};

Expected<void> execute(const PointsCommand& c, Act& act);
void describe(PointsCommand& c, Fields& fields);

}  // namespace knead
