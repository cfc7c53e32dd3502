#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Other knots for the same control points: a permanent change of shape.
struct KnotsCommand {
  std::string direction;      ///< "u" or "v"
  std::vector<double> knots;  ///< the whole vector, as many as before, on the same domain
};

Expected<void> execute(const KnotsCommand& c, Act& act);
void describe(KnotsCommand& c, Fields& fields);

}  // namespace knead
