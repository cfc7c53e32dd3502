#include "scene.hpp"

namespace knead {

std::vector<int> Scene::selection() const {
  std::vector<int> result;
  if (selected) result.push_back(*selected);
  result.insert(result.end(), together.begin(), together.end());
  return result;
}

void Scene::select(const std::vector<int>& chosen) {
  selected.reset();
  together = chosen;
  if (chosen.empty()) return;
  selected = chosen.front();
  together.erase(together.begin());
}

template <int D>
std::vector<const SceneShape<D>*> selected_shapes(const Scene& scene) {
  std::vector<const SceneShape<D>*> shapes;
  if constexpr (D == 2) {
    for (const int k : scene.selection())
      shapes.push_back(&scene.surfaces[static_cast<std::size_t>(k)]);
  } else if (scene.body) {
    const auto* shape =
        std::get_if<SceneShape<D>>(&scene.bodies[static_cast<std::size_t>(*scene.body)]);
    if (shape != nullptr) shapes.push_back(shape);
  }
  return shapes;
}

template std::vector<const SceneCurve*> selected_shapes<1>(const Scene&);
template std::vector<const SceneSurface*> selected_shapes<2>(const Scene&);
template std::vector<const SceneVolume*> selected_shapes<3>(const Scene&);

const SceneSurface* find_surface(const Scene& scene, const std::string& id, std::size_t likely) {
  if (likely < scene.surfaces.size() && scene.surfaces[likely].id == id)
    return &scene.surfaces[likely];
  const auto found = std::ranges::find(scene.surfaces, id, &SceneSurface::id);
  return found == scene.surfaces.end() ? nullptr : &*found;
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
