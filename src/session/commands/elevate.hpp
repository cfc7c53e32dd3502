#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Raises the degree without changing the shape.
struct ElevateCommand {
  std::array<int, 2> by = {1, 1};
};

Expected<void> execute(const ElevateCommand& c, Act& act);
void describe(ElevateCommand& c, Fields& fields);

}  // namespace knead
