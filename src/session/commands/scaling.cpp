#include "scaling.hpp"

namespace knead {

template <>
Expected<void> Executor::execute(const ScalingCommand& c) {
  state.scaling = c.mode;
  return {};
}

}  // namespace knead
