#include "rest.hpp"

namespace knead {

std::span<const Choice> choices(RestMode) {
  static constexpr Choice list[] = {
      {"shape", RestMode::shape,
       "the energy is that of the displacement from the rest shape, and without tools nothing moves"},
      {"none", RestMode::none, "that of the shape itself, as in the thesis; without forces it shrinks"}};
  return list;
}

void describe(RestCommand& c, Fields& fields) {
  fields.name("rest", "make the present shape the rest shape; what the energy acts on");
  fields.add("mode", c.mode);
}

template <>
Expected<void> Executor::execute(const RestCommand& c) {
  if (SceneBody* const b = body()) {
    std::visit([](auto& shapes) { shapes.rest = shapes.reference = shapes.current; }, b->shapes);
    b->mode = c.mode;
    return {};
  }
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  for (int k : state.selection()) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(k)];
    s.rest = s.reference = s.current;
    s.mode = c.mode;
  }
  return {};
}

}  // namespace knead
