#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Keeps a curve of the surface in place: an isoparametric line, or a polyline of (s, t).
struct KeepCommand {
  Keep keep;
};

Expected<void> execute(const KeepCommand& c, Act& act);
void describe(KeepCommand& c, Fields& fields);

}  // namespace knead
