#include "keep.hpp"

namespace knead {

template <>
Expected<void> Executor::execute(const KeepCommand& c) {
  const int ways = static_cast<int>(c.keep.u.has_value()) + static_cast<int>(c.keep.v.has_value()) +
                   static_cast<int>(!c.keep.curve.empty());
  if (ways != 1) {
    return input_error("one of u, v and curve is needed", "keep", "give exactly one of them");
  }
  return keep(c.keep);
}

}  // namespace knead
