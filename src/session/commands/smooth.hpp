#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Whether knot lines of full multiplicity are kept from creasing, and poles from tearing.
struct SmoothCommand {
  bool knot_lines = true;
  bool poles = true;
};

Expected<void> execute(const SmoothCommand& c, Act& act);
void describe(SmoothCommand& c, Fields& fields);

}  // namespace knead
