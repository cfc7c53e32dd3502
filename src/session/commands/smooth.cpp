#include "smooth.hpp"

namespace knead {

template <>
Expected<void> Executor::execute(const SmoothCommand& c) {
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  for (int k : state.selection()) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(k)];
    s.smooth_knot_lines = c.knot_lines;
    s.smooth_poles = c.poles;
  }
  return {};
}

}  // namespace knead
