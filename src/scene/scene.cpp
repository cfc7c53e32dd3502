#include "knead/scene/scene.hpp"

namespace knead {

std::vector<int> Scene::selection() const {
  std::vector<int> result;
  if (selected) result.push_back(*selected);
  result.insert(result.end(), together.begin(), together.end());
  return result;
}

Expected<std::vector<Tool>> tools_and_images(const Scene& scene) {
  std::vector<Tool> tools = scene.tools;
  if (!scene.selected) return tools;
  const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(*scene.selected)];
  for (const KeptConstraint& kept : s.constraints) {
    const auto* symmetry = std::get_if<MirrorSymmetry>(&kept.constraint);
    if (symmetry == nullptr) continue;
    const auto plane = plane_of(*symmetry, *s.reference);
    if (!plane) return std::unexpected(plane.error());
    const std::size_t count = tools.size();
    for (std::size_t k = 0; k < count; ++k) {
      auto image = mirrored(tools[k], plane->point, plane->normal.normalized());
      if (!image) return std::unexpected(image.error());
      if (*image) tools.push_back(std::move(**image));
    }
  }
  return tools;
}

}  // namespace knead
