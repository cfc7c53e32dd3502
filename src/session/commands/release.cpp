#include "release.hpp"

namespace knead {

void describe(ReleaseCommand&, Fields& fields) {
  fields.name("release", "free all that is held, pinned, frozen or kept");
}

template <>
Expected<void> Executor::execute(const ReleaseCommand&) {
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  for (int k : state.selection()) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(k)];
    s.hold_rows = 0;
    s.pins.clear();
    s.constraints.clear();
  }
  return {};
}

}  // namespace knead
