#pragma once

#include "../command_fields.hpp"

namespace knead {

enum class EdgeCondition { position, clamped, curvature, free, follow };
/// Holds edges, with the first or the first two derivatives across them.
struct EdgeCommand {
  EdgeChoice which = EdgeChoice::all;
  EdgeCondition hold = EdgeCondition::position;
  std::optional<std::string> edge = {};        ///< of a face, by its id in the file, instead of `which`
  std::optional<std::string> components = {};  ///< "x", "yz", …; default: all
};

std::span<const Choice> choices(EdgeCondition);

/// In version 2 an edge of a face that is freed follows its faces.
void read_as_version_2(EdgeCommand& c);

template <>
Expected<void> Executor::execute(const EdgeCommand& c);
void describe(EdgeCommand& c, Fields& fields);

}  // namespace knead
