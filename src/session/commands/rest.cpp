#include "rest.hpp"

namespace knead {

template <>
Expected<void> Executor::execute(const RestCommand& c) {
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  for (int k : state.selection()) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(k)];
    s.rest = s.reference = s.current;
    s.mode = c.mode;
  }
  return {};
}

}  // namespace knead
