#pragma once

#include "../command_fields.hpp"

namespace knead {

/// How patches selected together are coupled.
struct SeamsCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
  SeamPolicy seams;
};

Expected<void> execute(const SeamsCommand& c, Act& act);
void describe(SeamsCommand& c, Fields& fields);

}  // namespace knead
