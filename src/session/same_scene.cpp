#include "same_scene.hpp"

#include <algorithm>

#include "described_archive.hpp"
#include "described_state.hpp"

namespace knead {

bool same_scene(const Scene& a, const Scene& b) {
  if (a.stroke || a.brush || b.stroke || b.brush) return false;
  return std::ranges::all_of(type_of<Scene>().fields, [&](const Field& field) {
    return field.name == "followed" || same(*field.type, field.of(&a), field.of(&b), true);
  });
}

}  // namespace knead
