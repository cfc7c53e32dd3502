#pragma once

#include <map>
#include <memory>
#include <vector>

#include "knead/session/session.hpp"

namespace knead {

/// All shapes of a surface but `opened`, and those that its constraints are about.
inline std::vector<std::shared_ptr<const Surface>*> shapes_of(SurfaceState& surface) {
  std::vector<std::shared_ptr<const Surface>*> shapes = {&surface.reference, &surface.rest, &surface.current};
  for (KeptConstraint& kept : surface.constraints) shapes.push_back(&kept.where);
  return shapes;
}

/// Replaces every shape by what `change` makes of it; shapes that are one object stay one. Errors are those of
/// `change`.
template <class F>
Expected<void> change_shapes(const std::vector<std::shared_ptr<const Surface>*>& shapes, const F& change) {
  std::map<const Surface*, std::shared_ptr<const Surface>> changed;
  for (auto* shape : shapes) {
    auto& made = changed[shape->get()];
    if (!made) {
      auto result = change(**shape);
      if (!result) return std::unexpected(result.error());
      made = std::make_shared<const Surface>(std::move(*result));
    }
    *shape = made;
  }
  return {};
}

}  // namespace knead
