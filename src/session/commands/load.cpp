#include "load.hpp"

namespace knead {

template <>
Expected<void> Executor::execute(const LoadCommand& c) {
  if (!c.load.samples.empty() || c.load.counts != std::array<int, 2>{0, 0}) {
    auto surface = selected();
    if (!surface) return std::unexpected(surface.error());
    if (auto field = load_field(c.load, *(*surface)->reference); !field) return std::unexpected(field.error());
  }
  state.load = c.load;
  return {};
}

}  // namespace knead
