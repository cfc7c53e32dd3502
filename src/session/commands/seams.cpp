#include "seams.hpp"

#include <fmt/format.h>

namespace knead {

template <>
Expected<void> Executor::execute(const SeamsCommand& c) {
  if (c.seams.tolerance && !(*c.seams.tolerance > 0)) {
    return input_error(fmt::format("{} is not a tolerance", *c.seams.tolerance), "tolerance", "use a length > 0");
  }
  state.seams = c.seams;
  return {};
}

}  // namespace knead
