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
bool same_spline(const std::shared_ptr<const Spline<D>>& a, const std::shared_ptr<const Spline<D>>& b) {
  if (a == b) return true;
  return a->knots() == b->knots() && a->weights().size() == b->weights().size() &&
         same_numbers(a->weights().data(), b->weights().data(), a->weights().size()) &&
         same_numbers(a->control_points(), b->control_points());
}

/// All fields are named, so that a new one is thought of.
bool same_common(const ShapeCommon& a, const ShapeCommon& b) {
  const auto& [id, name, unit, velocity, mode, hold_rows] = a;
  return id == b.id && name == b.name && unit == b.unit && same_numbers(velocity, b.velocity) && mode == b.mode &&
         hold_rows == b.hold_rows;
}

bool same_own(const SurfaceOwn& a, const SurfaceOwn& b) {
  const auto& [smooth_knot_lines, smooth_poles, plastic, mask, visible] = a;
  return smooth_knot_lines == b.smooth_knot_lines && smooth_poles == b.smooth_poles && plastic == b.plastic &&
         mask == b.mask && (visible != nullptr || true);
}
bool same_own(const Nothing&, const Nothing&) { return true; }

template <int D>
bool same_shape(const SceneShape<D>& a, const SceneShape<D>& b) {
  const auto& [opened, reference, rest, current, material, elasticity, pins, constraints] =
      static_cast<const ShapeOf<D>&>(a);
  return same_common(a, b) && same_spline<D>(opened, b.opened) && same_spline<D>(reference, b.reference) &&
         same_spline<D>(rest, b.rest) && same_spline<D>(current, b.current) && material == b.material &&
         elasticity == b.elasticity && pins == b.pins && constraints == b.constraints && same_own(a, b);
}

bool same_body(const SceneBody& a, const SceneBody& b) {
  return a.index() == b.index() &&
         std::visit([&]<int D>(const SceneShape<D>& s) { return same_shape(s, std::get<SceneShape<D>>(b)); }, a);
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
    if (&a.surfaces[k] != &b.surfaces[k] && !same_shape(a.surfaces[k], b.surfaces[k])) return false;
  }
  return std::ranges::equal(a.bodies, b.bodies, same_body);
}

}  // namespace knead
