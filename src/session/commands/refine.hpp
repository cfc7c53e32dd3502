#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Refines nets without changing the shape: halves spans in a region or under a tool, or inserts
/// knots.
struct RefineCommand {
  static constexpr ActsOn acts_on = ActsOn::shapes;
  std::optional<std::array<Fractions, 2>> region;
  std::optional<std::string> under;  ///< name of a tool
  std::vector<double> knots_u, knots_v;
  std::optional<RefinePermission>
      permission;  ///< whether other commands may refine exactly what they need
};

std::span<const Choice> choices(RefinePermission);

Expected<void> execute(const RefineCommand& c, Act& act);
void describe(RefineCommand& c, Fields& fields);

}  // namespace knead
