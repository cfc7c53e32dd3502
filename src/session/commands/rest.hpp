#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Makes the present shape of the selected surfaces their rest shape, and sets what the energy acts
/// on.
struct RestCommand {
  static constexpr ActsOn acts_on = ActsOn::shapes;
  RestMode mode = RestMode::shape;
};

std::span<const Choice> choices(RestMode);

Expected<void> execute(const RestCommand& c, Act& act);
void describe(RestCommand& c, Fields& fields);

}  // namespace knead
