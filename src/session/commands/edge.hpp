#pragma once

#include "../command_fields.hpp"

namespace knead {

enum class EdgeCondition { position, tangent, curvature, open, follow };
/// Sides of a domain: edges of a surface, the first ones in the order of `EdgeChoice`; ends of a
/// curve; faces of a volume.
enum class SideChoice { all, u0, u1, v0, v1, w0, w1 };

/// The edges of a surface that a choice up to v1 stands for.
[[nodiscard]] inline EdgeChoice edge_choice(SideChoice side) {
  return static_cast<EdgeChoice>(side);
}

/// Holds edges, with the first or the first two derivatives across them. An edge of a face that is
/// free follows its faces, unless it may open.
struct EdgeCommand {
  static constexpr ActsOn acts_on = ActsOn::shapes;
  SideChoice which = SideChoice::all;
  EdgeCondition hold = EdgeCondition::position;
  std::optional<std::string> edge = {};  ///< of a face, by its id in the file, instead of `which`
  std::optional<std::string> components = {};  ///< "x", "yz", …; default: all
};

std::span<const Choice> choices(EdgeCondition);
std::span<const Choice> choices(SideChoice);

Expected<void> execute(const EdgeCommand& c, Act& act);
void describe(EdgeCommand& c, Fields& fields);

}  // namespace knead
