#pragma once

#include "../command_fields.hpp"

namespace knead {

/// What a hold applies to: outer rows of control points, or the edges of the faces on a surface.
enum class HoldMode { rows, position, tangent, curvature, open };

std::span<const Choice> choices(HoldMode);

/// Holds the outer `rows` rows of control points on every side, or the edges of the faces on a
/// surface with their tangent planes (g1) and curvatures (g2); `free` holds neither. Replaces an
/// earlier hold.
struct HoldCommand {
  static constexpr ActsOn acts_on = ActsOn::shapes;
  int rows = 2;
  std::optional<HoldMode> mode = {};  ///< default: rows
  std::optional<bool> all = {};  ///< for every surface of the document, not just the selected ones
};

Expected<void> execute(const HoldCommand& c, Act& act);
void describe(HoldCommand& c, Fields& fields);

}  // namespace knead
