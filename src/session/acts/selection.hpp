#pragma once

#include <optional>
#include <ranges>
#include <string>
#include <string_view>
#include <variant>

#include "act.hpp"

namespace knead {

// What is selected, and what commands name.

/// The selected surfaces of a scene, the first one first. The scene must outlive them.
[[nodiscard]] inline auto selected_surfaces(auto& scene) {
  return scene.selection() | std::views::transform([&scene](int k) -> auto& {
           return scene.surfaces[static_cast<std::size_t>(k)];
         });
}

/// The selected curve or volume; null if none is.
[[nodiscard]] SceneBody* body(Act& act);
/// An error, as of `selected`, where nothing is selected.
[[nodiscard]] Expected<void> some_selected(Act& act);
/// Calls f with each selected shape, the first one first, until it returns an error.
template <class F>
Expected<void> each_selected(Act& act, const F& f) {
  if (act.state.body) return std::visit(f, *body(act));
  for (const int k : act.state.selection()) {
    if (auto status = f(act.state.surfaces[static_cast<std::size_t>(k)]); !status) return status;
  }
  return {};
}
/// The error (input) of a field that the selected curve or volume does not have.
[[nodiscard]] std::unexpected<Error> of_surfaces(Act& act, std::string_view field,
                                                 const char* remedy = "leave it out");

/// The first selected surface, or an error that says how to select one.
[[nodiscard]] Expected<SceneSurface*> selected(Act& act);
/// The only selected surface. Error: there are several.
[[nodiscard]] Expected<SceneSurface*> selected_alone(Act& act);
[[nodiscard]] Expected<int> find_surface(const Act& act, const std::string& id);
/// The selected surface of this id; without one the first selected. Errors (input), named `field`:
/// it is not selected.
[[nodiscard]] Expected<int> selected_surface(Act& act, const std::optional<std::string>& id,
                                             const char* field = "surface");
[[nodiscard]] Expected<Tool*> find_tool(Act& act, const std::optional<std::string>& name);
/// Diagonal of the bounding box of the first selected surface's reference: the unit of `relative`.
[[nodiscard]] Expected<double> diagonal(Act& act);

}  // namespace knead
