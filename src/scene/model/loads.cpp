#include <fmt/format.h>

#include <algorithm>

#include "dead_loads.hpp"
#include "knead/base/error_code.hpp"
#include "knead/energy/loads.hpp"
#include "model.hpp"
#include "scene/formula_field.hpp"
#include "scene/places.hpp"
#include "scene/scene_settings.hpp"
#include "spline/basis_terms.hpp"

namespace knead {

namespace {

template <int D>
using Selected = std::vector<const SceneShape<D>*>;

/// What f makes of the selected shapes.
template <class F>
auto with_selected(const Scene& scene, const F& f) {
  if (!scene.body) return f(selected_shapes<2>(scene));
  return scene.bodies[static_cast<std::size_t>(*scene.body)].index() == 0
             ? f(selected_shapes<1>(scene))
             : f(selected_shapes<3>(scene));
}

// One vector of unknowns for all selected shapes, the control points of one after the other.
// Velocities are there if any of them moves.
template <int D>
ActiveState stacked(const Selected<D>& shapes) {
  Eigen::Index size = 0, at = 0;
  bool moving = false;
  for (const SceneShape<D>* s : shapes) {
    size += s->current->size();
    moving = moving || s->velocity.rows() > 0;
  }
  ActiveState result;
  result.control_points.resize(size, 3);
  result.rest.resize(size, 3);
  if (moving) result.velocity = Points::Zero(size, 3);
  for (const SceneShape<D>* s : shapes) {
    const Eigen::Index n = s->current->size();
    result.control_points.middleRows(at, n) = s->current->control_points();
    result.rest.middleRows(at, n) = s->rest->control_points();
    if (s->velocity.rows() > 0) result.velocity.middleRows(at, n) = s->velocity;
    at += n;
  }
  return result;
}

}  // namespace

ActiveState active_state(const Scene& scene) {
  return with_selected(scene, []<int D>(const Selected<D>& shapes) { return stacked<D>(shapes); });
}

namespace {

Expected<Surface> samples_as_field(const Load& load, const Surface& surface) {
  Points samples(static_cast<Eigen::Index>(load.samples.size()), 3);
  for (std::size_t k = 0; k < load.samples.size(); ++k) {
    samples.row(static_cast<Eigen::Index>(k)) << load.samples[k][0], load.samples[k][1],
        load.samples[k][2];
  }
  auto field = sampled_load<2>(surface, load.counts, std::move(samples));
  if (!field) return std::unexpected(field.error().within("samples"));
  return field;
}

/// One component of a load.
Expected<Surface> formula_as_field(const Load& load, std::size_t component,
                                   const Surface& surface) {
  const auto field = formula_field((*load.formula)[component], surface, load.tolerance);
  if (!field) return std::unexpected(field.error().within(fmt::format("formula[{}]", component)));
  Points forces = Points::Zero(static_cast<Eigen::Index>(field->coefficients().size()), 3);
  for (std::size_t k = 0; k < field->coefficients().size(); ++k) {
    forces(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(component)) =
        field->coefficients()[k];
  }
  return Surface::create(field->knots(), std::move(forces));
}

}  // namespace

Expected<std::vector<Surface>> load_fields(const Load& load, const Surface& surface) {
  std::vector<Surface> fields;
  if (!load.samples.empty()) {
    auto field = samples_as_field(load, surface);
    if (!field) return std::unexpected(field.error());
    fields.push_back(std::move(*field));
  }
  for (std::size_t k = 0; load.formula && k < 3; ++k) {
    auto field = formula_as_field(load, k, surface);
    if (!field) return std::unexpected(field.error());
    fields.push_back(std::move(*field));
  }
  return fields;
}

namespace {

/// Σ over the selected surfaces of the loads that keep their direction, but the one per parameter
/// domain.
/// Loads per area of the rest shape, and forces at points and lines. Loads per parameter domain are
/// left to the model, which integrates a constant by its Gramians.
Expected<Points> dead_loads(const Scene& scene, const ActiveSurface& model) {
  Points nodal = Points::Zero(model.rows().back(), 3);
  const std::vector<int> selection = scene.selection();
  for (std::size_t patch = 0; patch < selection.size(); ++patch) {
    const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(selection[patch])];
    const DomainScaling<2>& scaling = model.scaling(static_cast<int>(patch));
    auto rows = nodal.middleRows(model.rows()[patch], s.current->size());
    if (scene.load.per == LoadMeasure::area) {
      const auto forces = area_forces(*s.rest, scaling, Point(scene.load.vector.data()));
      if (!forces) return std::unexpected(forces.error());
      rows += *forces;
    }
    for (const SceneForce& f : scene.forces) {
      if (f.surface != selection[patch] || !f.keeps_direction()) continue;
      const auto forces = dead_forces(s, f, scaling.length);
      if (!forces) return std::unexpected(forces.error());
      rows += *forces;
    }
  }
  return nodal;
}

/// A spring or volcano and its mirror images. \param first row of the surface's first control point
/// Σ_i R_i(u) X_i is the point that is pulled; the image under a mirror symmetry is pulled to the
/// reflected target. At 0.5 both are one point.
template <PullsAPoint F>
Expected<void> append_point_force(const SceneSurface& s, const F& f, int first,
                                  std::vector<PointForce>& points) {
  const auto u = parameters_at<2>(*s.current, f.at);
  if (!u) return std::unexpected(u.error());
  PointForce force = point_force(f, basis_terms<2>(*s.current, *u, first));
  for (const KeptConstraint& kept : s.constraints) {
    const auto* symmetry = std::get_if<MirrorSymmetry>(&kept.constraint);
    if (symmetry == nullptr) continue;
    const auto plane = plane_of(*symmetry, *s.reference);
    if (!plane) return std::unexpected(plane.error());
    std::vector<double> at = f.at;
    double& along = at[static_cast<std::size_t>(symmetry->direction)];
    if (along == 0.5) continue;
    along = 1 - along;
    const auto there = parameters_at<2>(*s.current, at);
    if (!there) return std::unexpected(there.error());
    PointForce image = force;
    image.terms = basis_terms<2>(*s.current, *there, first);
    const Point n = plane->normal.normalized();
    image.to -= 2 * n.dot(image.to - plane->point) * n;
    points.push_back(std::move(image));
  }
  points.push_back(std::move(force));
  return {};
}

}  // namespace

Expected<std::vector<PointForce>> active_point_forces(const Scene& scene) {
  std::vector<PointForce> points;
  for (const SceneForce& f : scene.forces) {
    int first = 0;
    for (const int k : scene.selection()) {
      const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(k)];
      if (k != f.surface) {
        first += s.current->size();
        continue;
      }
      const auto append = [&]<class F>(const F& force) -> Expected<void> {
        if constexpr (PullsAPoint<F>) return append_point_force(s, force, first, points);
        return {};
      };
      if (auto status = std::visit(append, f.force); !status)
        return std::unexpected(status.error());
      break;
    }
  }
  return points;
}

Points opened_points(const Scene& scene) {
  return with_selected(scene, [](const auto& shapes) {
    Eigen::Index size = 0, at = 0;
    for (const auto* s : shapes) size += s->opened->size();
    Points original(size, 3);
    for (const auto* s : shapes) {
      original.middleRows(at, s->opened->size()) = s->opened->control_points();
      at += s->opened->size();
    }
    return original;
  });
}

Expected<ActiveLoads> active_loads(const Scene& scene, const SceneModel& scene_model) {
  const ActiveSurface& model = scene_model.model;
  const auto vector = [](const Vector3& v) { return Point(v[0], v[1], v[2]); };
  ActiveLoads loads;
  if (scene.load.per != LoadMeasure::area) loads.force = vector(scene.load.vector);
  loads.gravity = vector(scene.load.gravity);
  loads.pressure = scene.load.pressure;
  loads.wind = vector(scene.load.wind);
  auto nodal = dead_loads(scene, model);
  if (!nodal) return std::unexpected(nodal.error());
  if (scene_model.varying_load.rows() > 0) *nodal += scene_model.varying_load;
  if ((nodal->array() != 0).any()) loads.nodal = std::move(*nodal);
  for (const SceneForce& f : scene.forces) {
    const std::vector<int> selection = scene.selection();
    if (std::holds_alternative<MomentForce>(f.force) &&
        std::ranges::find(selection, f.surface) != selection.end()) {
      return input_error("a moment acts on shells only", f.name,
                         R"(give {"do":"material","model":"shell"})", {ErrorCode::shell_needed});
    }
  }
  auto points = active_point_forces(scene);
  if (!points) return std::unexpected(points.error());
  loads.points = std::move(*points);
  if (scene.limit) {
    loads.limit = *scene.limit;
    loads.original = opened_points(scene);
  }
  return loads;
}

namespace {

/// The forces of the scene on its selected curve or volume.
template <int D>
Expected<void> append_forces(const Scene& scene, const Spline<D>& shape, ActiveLoads& loads) {
  for (const SceneForce& f : scene.forces) {
    if (f.body != *scene.body) continue;
    const auto append = [&]<class F>(const F& force) -> Expected<void> {
      if constexpr (requires { force.at; }) {
        const auto u = parameters_at<D>(shape, force.at);
        if (!u) return std::unexpected(u.error().within(f.name));
        auto terms = basis_terms<D>(shape, *u);
        if constexpr (PullsAPoint<F>) {
          loads.points.push_back(point_force(force, std::move(terms)));
        } else {
          if (loads.nodal.rows() == 0) loads.nodal = Points::Zero(shape.size(), 3);
          for (const auto& [row, value] : terms) {
            loads.nodal.row(row) += value * Eigen::RowVector3d(force.vector.data());
          }
        }
      }
      return {};
    };
    if (auto status = std::visit(append, f.force); !status) return status;
  }
  return {};
}

}  // namespace

template <int D>
Expected<ActiveLoads> body_loads(const Scene& scene) {
  const Load& load = scene.load;
  const auto of_surfaces = [&](const char* field, const char* remedy) {
    return input_error(fmt::format("this load acts on surfaces, not on a {}", kind_of(D)), field,
                       remedy);
  };
  if (load.pressure != 0) return of_surfaces("pressure", "leave it out");
  if (load.wind != Vector3{0, 0, 0}) return of_surfaces("wind", "leave it out");
  if (load.varies())
    return of_surfaces(load.formula ? "formula" : "samples", "use vector, or forces");
  if (load.per == LoadMeasure::area && load.vector != Vector3{0, 0, 0}) {
    return of_surfaces("per", R"(use "per":"parameters")");
  }
  ActiveLoads loads;
  loads.force = Point(load.vector.data());
  loads.gravity = Point(load.gravity.data());
  const SceneShape<D>& shape = *selected_shapes<D>(scene).front();
  if (auto appended = append_forces<D>(scene, *shape.current, loads); !appended) {
    return std::unexpected(appended.error());
  }
  if (scene.limit) {
    loads.limit = *scene.limit;
    loads.original = shape.opened->control_points();
  }
  return loads;
}

template Expected<ActiveLoads> body_loads<1>(const Scene&);
template Expected<ActiveLoads> body_loads<3>(const Scene&);

}  // namespace knead
