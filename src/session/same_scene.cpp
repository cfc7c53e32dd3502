#include "same_scene.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <variant>

namespace knead {
namespace {

bool same_numbers(const double* a, const double* b, std::size_t count) {
  return count == 0 || std::memcmp(a, b, count * sizeof(double)) == 0;
}

bool same_numbers(const Points& a, const Points& b) {
  return a.rows() == b.rows() && same_numbers(a.data(), b.data(), static_cast<std::size_t>(a.size()));
}

template <int D>
bool same_shape(const std::shared_ptr<const Spline<D>>& a, const std::shared_ptr<const Spline<D>>& b) {
  if (a == b) return true;
  return a->knots() == b->knots() && a->weights().size() == b->weights().size() &&
         same_numbers(a->weights().data(), b->weights().data(), a->weights().size()) &&
         same_numbers(a->control_points(), b->control_points());
}

/// All fields are named, so that a new one is thought of.
bool same_surface(const SceneSurface& a, const SceneSurface& b) {
  const auto& [id, name, unit, opened, reference, rest, current, velocity, mode, material, elasticity, hold_rows, pins,
               constraints, smooth_knot_lines, smooth_poles, plastic, mask, visible] = a;
  return id == b.id && name == b.name && unit == b.unit && same_shape<2>(opened, b.opened) &&
         same_shape<2>(reference, b.reference) && same_shape<2>(rest, b.rest) && same_shape<2>(current, b.current) &&
         same_numbers(velocity, b.velocity) && mode == b.mode && material == b.material && elasticity == b.elasticity &&
         hold_rows == b.hold_rows && pins == b.pins && constraints == b.constraints &&
         smooth_knot_lines == b.smooth_knot_lines && smooth_poles == b.smooth_poles && plastic == b.plastic &&
         mask == b.mask && (visible != nullptr || true);
}

template <int D>
bool same_shapes(const BodyShapes<D>& a, const BodyShapes<D>& b) {
  const auto& [opened, reference, rest, current, material, elasticity] = a;
  return same_shape<D>(opened, b.opened) && same_shape<D>(reference, b.reference) && same_shape<D>(rest, b.rest) &&
         same_shape<D>(current, b.current) && material == b.material && elasticity == b.elasticity;
}

bool same_body(const SceneBody& a, const SceneBody& b) {
  const auto& [id, name, unit, shapes, velocity, mode, mass, damping, hold_rows, pins, holds] = a;
  const bool moved = std::visit(
      [&]<int D>(const BodyShapes<D>& own) {
        const auto* other = std::get_if<BodyShapes<D>>(&b.shapes);
        return other == nullptr || !same_shapes<D>(own, *other);
      },
      shapes);
  return !moved && id == b.id && name == b.name && unit == b.unit && same_numbers(velocity, b.velocity) &&
         mode == b.mode && mass == b.mass && damping == b.damping && hold_rows == b.hold_rows && pins == b.pins &&
         holds == b.holds;
}

}  // namespace

bool same_scene(const Scene& a, const Scene& b) {
  if (a.stroke || a.brush || b.stroke || b.brush) return false;
  const bool settings = a.selected == b.selected && a.together == b.together && a.body == b.body && a.load == b.load &&
                        a.limit == b.limit && a.evolution == b.evolution && a.scaling == b.scaling &&
                        a.seams == b.seams && a.permission == b.permission && a.bend == b.bend &&
                        a.coupling == b.coupling;
  if (!settings || a.surfaces.size() != b.surfaces.size() || a.bodies.size() != b.bodies.size()) return false;
  for (std::size_t k = 0; k < a.surfaces.size(); ++k) {
    if (&a.surfaces[k] != &b.surfaces[k] && !same_surface(a.surfaces[k], b.surfaces[k])) return false;
  }
  return std::ranges::equal(a.bodies, b.bodies, same_body);
}

}  // namespace knead
