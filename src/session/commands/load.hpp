#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Loads on the selected surfaces; each command replaces the previous loads.
struct LoadCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
  Load load;
};

std::span<const Choice> choices(LoadMeasure);

Expected<void> execute(const LoadCommand& c, Act& act);
void describe(LoadCommand& c, Fields& fields);

}  // namespace knead
