#include "body_model.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "constraints.hpp"
#include "knead/scene/model.hpp"
#include "knead/scene/places.hpp"
#include "knead/spline/basis_terms.hpp"
#include "scene_settings.hpp"

namespace knead {
namespace {

/// Holds the outer layers of control points, and those pinned by their numbers.
template <int D>
void hold_numbered(const BodyInput<D>& input, ConstraintList& list) {
  const auto net = input.reference->net();
  for (int k = 0; k < input.reference->size() && input.hold_rows > 0; ++k) {
    int rest = k;
    for (int d = D - 1; d >= 0; --d) {
      const int count = net[static_cast<std::size_t>(d)], i = rest % count;
      rest /= count;
      if (i < input.hold_rows || i >= count - input.hold_rows) list.hold(k, "hold");
    }
  }
  for (const int k : input.pins) list.hold(k, fmt::format("pin {}", k));
}

template <int D>
Expected<void> append(const BodyInput<D>& input, const SideHold& hold, ConstraintList& to) {
  return hold_side<D>(*input.rest, hold.side, hold.order, to);
}

template <int D>
Expected<void> append(const BodyInput<D>& input, const PlacePin& pin, ConstraintList& to) {
  const auto u = parameters_at<D>(*input.rest, pin.at);
  if (!u) return std::unexpected(u.error());
  std::optional<Point> place;
  if (pin.to) place = Point(pin.to->data());
  return pin_place<D>(*input.rest, *u, place, to);
}

template <int D>
Expected<ConstraintList> body_constraints(const BodyInput<D>& input, std::vector<std::string>& notes) {
  ConstraintList list(input.reference->size());
  hold_numbered(input, list);
  for (const auto& [hold, where] : input.holds) {
    const Components& components = std::visit([](const auto& h) -> const Components& { return h.components; }, hold);
    ConstraintList whole(input.reference->size());
    ConstraintList& to = components == all_components ? list : whole;
    const std::size_t first = to.constraints.size();
    auto done = std::visit([&](const auto& h) { return append<D>(input, h, to); }, hold);
    if (!done) return std::unexpected(done.error());
    const auto* pin = std::get_if<PlacePin>(&hold);
    const Points displacement = where - input.rest->control_points();
    if (pin == nullptr || !pin->to) keep_present(to, displacement, first);
    if (components == all_components) continue;
    const std::size_t partial = list.constraints.size();
    append_components(whole, components, list);
    if (pin == nullptr || !pin->to) keep_present(list, displacement, partial);
  }
  if constexpr (D == 1) {
    if (input.mode == RestMode::none) return list;
    const auto knots = keep_smooth_knots(*input.reference, {}, list);
    if (!knots) return std::unexpected(knots.error());
    for (const SmoothKnot& knot : *knots) {
      if (knot.state == SmoothKnot::State::crease && !knot.closing) {
        notes.push_back(fmt::format("{}: the corner at u = {:.6g} may bend", input.id, knot.knot));
      }
    }
  }
  return list;
}

/// The forces of the scene on one body.
template <int D>
Expected<void> append_forces(const Scene& scene, int index, const BodyShapes<D>& shapes, ActiveLoads& loads) {
  for (const SceneForce& f : scene.forces) {
    if (f.body != index) continue;
    const auto append = [&]<class F>(const F& force) -> Expected<void> {
      if constexpr (requires { force.at; }) {
        const auto u = parameters_at<D>(*shapes.current, force.at);
        if (!u) return std::unexpected(u.error().within(f.name));
        auto terms = basis_terms<D>(*shapes.current, *u);
        if constexpr (PullsAPoint<F>) {
          loads.points.push_back(point_force(force, std::move(terms)));
        } else {
          if (loads.nodal.rows() == 0) loads.nodal = Points::Zero(shapes.current->size(), 3);
          for (const auto& [row, value] : terms) {
            loads.nodal.row(row) += value * Eigen::RowVector3d(force.vector.data());
          }
        }
      }
      return {};
    };
    if (auto done = std::visit(append, f.force); !done) return done;
  }
  return {};
}

}  // namespace

template <int D>
BodyInput<D> body_input(const Scene& scene, const SceneBody& body, const EvolutionPolicy& evolution) {
  const auto& shapes = std::get<BodyShapes<D>>(body.shapes);
  return {.id = body.id,
          .reference = shapes.reference,
          .rest = shapes.rest,
          .mode = body.mode,
          .material = shapes.material,
          .elasticity = shapes.elasticity,
          .mass = body.mass,
          .damping = body.damping,
          .hold_rows = body.hold_rows,
          .pins = body.pins,
          .holds = body.holds,
          .scaling = scene.scaling,
          .evolution = evolution,
          .detail = detail_of(scene.tools)};
}

template <int D>
Expected<std::vector<LinearConstraint>> body_conditions(const BodyInput<D>& input, const Points& present,
                                                        std::vector<std::string>& notes) {
  auto list = body_constraints(input, notes);
  if (!list) return std::unexpected(list.error());
  std::vector<LinearConstraint> conditions;
  for (std::size_t k = 0; k < list->held.size(); ++k) {
    if (!list->held[k]) continue;
    const auto row = static_cast<Eigen::Index>(k);
    const Point stays = (present.row(row) - input.rest->control_points().row(row)).transpose();
    conditions.push_back({list->held_by[k], {{static_cast<int>(k), 1.0}}, stays});
  }
  conditions.insert(conditions.end(), list->constraints.begin(), list->constraints.end());
  return conditions;
}

template <int D>
Expected<BodyModel<D>> make_body_model(BodyInput<D> input) {
  std::vector<std::string> notes;
  auto list = body_constraints(input, notes);
  if (!list) return std::unexpected(list.error());
  ActiveSettings<D> settings;
  settings.material = input.material;
  settings.mass = input.mass;
  settings.damping = input.damping;
  settings.rest = input.mode;
  set_evolution(input.evolution, input.scaling, input.detail, settings);
  if (std::ranges::any_of(list->held, [](bool held) { return held; })) settings.held = std::move(list->held);
  settings.constraints = std::move(list->constraints);
  auto model = ActiveSpline<D>::create(*input.reference, settings);
  if (!model) return std::unexpected(model.error());
  note_engine(model->engine(), notes);
  return BodyModel<D>{std::move(input), *std::move(model), std::move(notes)};
}

ActiveState active_state(const SceneBody& body) {
  return std::visit(
      [&](const auto& shapes) {
        ActiveState before;
        before.control_points = shapes.current->control_points();
        before.rest = shapes.rest->control_points();
        before.velocity = body.velocity;
        return before;
      },
      body.shapes);
}

Expected<ActiveLoads> body_loads(const Scene& scene, int index) {
  const Load& load = scene.load;
  const SceneBody& body = scene.bodies[static_cast<std::size_t>(index)];
  const auto of_surfaces = [&](const char* field, const char* remedy) {
    return input_error(fmt::format("this load acts on surfaces, not on a {}", kind_of(body)), field, remedy);
  };
  if (load.pressure != 0) return of_surfaces("pressure", "leave it out");
  if (load.wind != Vector3{0, 0, 0}) return of_surfaces("wind", "leave it out");
  if (load.varies()) return of_surfaces(load.formula ? "formula" : "samples", "use vector, or forces");
  if (load.per == LoadMeasure::area && load.vector != Vector3{0, 0, 0}) {
    return of_surfaces("per", R"(use "per":"parameters")");
  }
  ActiveLoads loads;
  loads.force = Point(load.vector.data());
  loads.gravity = Point(load.gravity.data());
  auto appended =
      std::visit([&](const auto& shapes) { return append_forces(scene, index, shapes, loads); }, body.shapes);
  if (!appended) return std::unexpected(appended.error());
  if (scene.limit) {
    loads.limit = *scene.limit;
    loads.original =
        std::visit([](const auto& shapes) { return Points(shapes.opened->control_points()); }, body.shapes);
  }
  return loads;
}

template Expected<std::vector<LinearConstraint>> body_conditions<1>(const BodyInput<1>&, const Points&,
                                                                    std::vector<std::string>&);
template Expected<std::vector<LinearConstraint>> body_conditions<3>(const BodyInput<3>&, const Points&,
                                                                    std::vector<std::string>&);
template BodyInput<1> body_input<1>(const Scene&, const SceneBody&, const EvolutionPolicy&);
template BodyInput<3> body_input<3>(const Scene&, const SceneBody&, const EvolutionPolicy&);
template Expected<BodyModel<1>> make_body_model<1>(BodyInput<1>);
template Expected<BodyModel<3>> make_body_model<3>(BodyInput<3>);

}  // namespace knead
