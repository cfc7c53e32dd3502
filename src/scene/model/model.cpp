#include "model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "constraints.hpp"
#include "hold/edge_coupling.hpp"
#include "joined_shapes.hpp"
#include "knead/energy/loads.hpp"
#include "met_conditions.hpp"
#include "scene/followed.hpp"
#include "scene/mask.hpp"
#include "scene/scene_settings.hpp"
#include "scene/trims.hpp"
#include "smooth_seams.hpp"

namespace knead {
namespace {

// A model is a function of its input alone: `model_input` collects whatever the matrix and its
// factor depend on (shapes, constraints, material, seams, evolution), and two equal inputs may
// share a model. What only changes right-hand sides (tools, forces, velocities, the present shape)
// stays out, and so does the rest shape unless a constraint is measured from it.
constexpr CouplingTolerance smooth_tolerance{.position = 1e-3, .tangent = 1e-6};
constexpr double exact_ratio = 1e-7;  // radians that derivatives at a seam may be off a fixed ratio
constexpr SeamOptions along_edges{.rigid = false},
    along_smooth_edges{.angle = exact_ratio, .rigid = false};

template <int D>
bool varies(const MaterialFieldOf<D>& material) {
  const auto field = [](const Coefficient<D>& c) { return !std::holds_alternative<double>(c); };
  return std::ranges::any_of(material.alpha, field) || std::ranges::any_of(material.beta, field) ||
         field(material.mass) || field(material.damping);
}

/// Whether some constraint is measured from the rest shape: edges of faces are held, and symmetries
/// kept, on the reference, so that the same model serves while strokes leave their mark on the rest
/// shape.
bool measures_from_rest(const std::vector<KeptConstraint>& constraints) {
  return std::ranges::any_of(constraints, [](const KeptConstraint& kept) {
    const Constraint& c = kept.constraint;
    return !std::holds_alternative<TrimHolds>(c) && !std::holds_alternative<TrimEdgeHold>(c) &&
           !std::holds_alternative<EdgeSymmetry>(c) && !std::holds_alternative<MirrorSymmetry>(c);
  });
}

/// Coefficients as constants if all shapes have the same material, else as fields.
/// Constants are worth telling apart: with them K is a sum of few Kronecker products of banded
/// Gramians, else it is assembled entry by entry from triple Gramians.
template <int D>
void set_material(const std::vector<ShapeInput<D>>& shapes, ActiveSettings<D>& settings) {
  const MaterialFieldOf<D>& material = shapes.front().material;
  const bool varying = std::ranges::any_of(shapes, [&](const ShapeInput<D>& s) {
    return varies(s.material) || !(s.material == material);
  });
  if (varying) {
    for (const ShapeInput<D>& s : shapes) settings.fields.push_back(s.material);
    return;
  }
  settings.material = material.constants();
  settings.mass = std::get<double>(material.mass);
  settings.damping = std::get<double>(material.damping);
}

/// Appends the constraints of every shape, and the rows.
/// Control points are numbered through all shapes: those of shape k begin at rows[k].
template <int D>
Expected<void> hold_shapes(const std::vector<ShapeInput<D>>& shapes, JoinedShapes<D>& joined) {
  auto& [rows, settings, held_by, seams, notes, entwined] = joined;
  rows = {0};
  for (const ShapeInput<D>& s : shapes) {
    if (s.mode != shapes.front().mode) {
      return input_error("surfaces that are selected together have different rest modes", "rest",
                         "give `rest` once with all of them selected");
    }
    auto list = constraints_of(s, notes);
    if (!list) return std::unexpected(list.error());
    settings.held.insert(settings.held.end(), list->held.begin(), list->held.end());
    for (std::string& name : list->held_by) {
      held_by.push_back(shapes.size() > 1 && !name.empty() ? s.id + ": " + name : std::move(name));
    }
    for (LinearConstraint& c : list->constraints) {
      for (auto& term : c.terms) term.first += rows.back();
      if (shapes.size() > 1) c.name = s.id + ": " + c.name;
      settings.constraints.push_back(std::move(c));
    }
    rows.push_back(rows.back() + s.reference->size());
  }
  if (std::ranges::none_of(settings.held, [](bool f) { return f; })) settings.held.clear();
  return {};
}

/// Appends the conditions that keep faces together along the edges that follow them.
Expected<void> couple_followed(const ModelInput& input, std::span<const Surface* const> patches,
                               std::span<const int> rows, ActiveSettings<2>& settings) {
  const auto edges = coupled_edges(input.followed, patches);
  if (edges.empty()) return {};
  const auto coupled =
      couple_edges(patches, rows, edges, settings.constraints, settings.held, input.coupling);
  if (!coupled) return std::unexpected(coupled.error());
  settings.constraints.insert(settings.constraints.end(), coupled->constraints.begin(),
                              coupled->constraints.end());
  return {};
}

/// Appends the conditions that keep tangent planes common at smooth seams whose sides are in no
/// fixed ratio.
/// `couple_seams` keeps tangent planes where the derivatives across both sides are in a fixed
/// ratio: one condition per row of control points. Elsewhere the ratio varies along the seam;
/// conditions at points are chosen as for edges of faces, but once, to a fixed tolerance.
Expected<void> keep_smooth(std::span<const Surface* const> patches, std::span<const int> rows,
                           std::span<SeamReport> reports, ActiveSettings<2>& settings) {
  std::vector<CoupledEdge> edges;
  for (SeamReport& report : reports) {
    if (!may_crease(report)) continue;
    auto edge = smooth_seam_edge(patches, report.seam);
    if (!edge) return std::unexpected(edge.error());
    edges.push_back(std::move(*edge));
    report.continuity = SeamContinuity::g1;
    report.reason = "tangent planes are kept common at points along the seam";
  }
  if (edges.empty()) return {};
  const auto coupled =
      couple_edges(patches, rows, edges, settings.constraints, settings.held, smooth_tolerance);
  if (!coupled) return std::unexpected(coupled.error());
  settings.constraints.insert(settings.constraints.end(), coupled->constraints.begin(),
                              coupled->constraints.end());
  return {};
}

/// The forces of the parts of the load that vary, which depend on the surfaces as they are opened.
Expected<void> keep_varying_load(SceneModel& scene) {
  if (!scene.input.varying) return {};
  scene.varying_load = Points::Zero(scene.model.rows().back(), 3);
  for (std::size_t patch = 0; patch < scene.input.shapes.size(); ++patch) {
    const SurfaceInput& s = scene.input.shapes[patch];
    const DomainScaling<2>& scaling = scene.model.scaling(static_cast<int>(patch));
    const bool by_area = scene.input.varying->per == LoadMeasure::area;
    const auto fields = load_fields(*scene.input.varying, *s.reference);
    if (!fields) return std::unexpected(fields.error());
    for (const Surface& field : *fields) {
      auto forces =
          by_area ? area_load_forces(*s.rest, field) : load_forces<2>(*s.reference, scaling, field);
      if (!forces) return std::unexpected(forces.error());
      if (by_area) *forces /= scaling.length * scaling.length;  // per area in lengths of the model
      scene.varying_load.middleRows(scene.model.rows()[patch], s.reference->size()) += *forces;
    }
  }
  return {};
}

}  // namespace

double detail_of(const std::vector<Tool>& tools) {
  double detail = 0;
  for (const Tool& t : tools) {
    const double tool_detail = t.detail();
    if (std::isfinite(tool_detail) && (detail == 0 || tool_detail < detail)) detail = tool_detail;
  }
  return detail;
}

// λ so large that a step hardly moves: conditions are all that is tried.
EvolutionPolicy trial_evolution() {
  EvolutionPolicy evolution;
  evolution.lambda = 1e6;
  return evolution;
}

Expected<FoundSeams> seams_between(const SeamPolicy& policy,
                                   std::span<const Surface* const> patches) {
  const double tolerance = policy.tolerance.value_or(suggested_seam_tolerance(patches));
  if (tolerance == 0) return FoundSeams{};  // surfaces that collapse to one point
  return find_seams(patches, tolerance);
}

template <int D>
ModelInputOf<D> model_input(const Scene& scene, const EvolutionPolicy& evolution) {
  ModelInputOf<D> input;
  for (const SceneShape<D>* shape : selected_shapes<D>(scene)) {
    const SceneShape<D>& s = *shape;
    ShapeInput<D>& to = input.shapes.emplace_back();
    to.id = s.id;
    to.reference = s.reference;
    to.rest = s.rest;
    to.mode = s.mode;
    to.material = s.material;
    to.elasticity = s.elasticity;
    to.hold_rows = s.hold_rows;
    to.pins = s.pins;
    to.constraints = s.constraints;
    if constexpr (D == 2) {
      const bool by_area = scene.load.varies() && scene.load.per == LoadMeasure::area;
      if (!measures_from_rest(s.constraints) && !by_area) to.rest = nullptr;
      to.smooth_knot_lines = s.smooth_knot_lines;
      to.smooth_poles = s.smooth_poles;
      if (holds_trims(s.constraints)) to.visible = s.visible;
      if (touches_visible(scene)) to.touched = s.visible;
      to.masked = masked_points(s);
    }
  }
  input.scaling = scene.scaling;
  input.evolution = evolution;
  input.detail = detail_of(scene.tools);
  if constexpr (D == 2) {
    input.seams = scene.seams;
    if (scene.load.varies()) input.varying = scene.load;
    input.followed = followed_inputs(scene);
    if (!input.followed.empty()) input.coupling = scene.coupling;
  }
  return input;
}

template ModelInputOf<1> model_input<1>(const Scene&, const EvolutionPolicy&);
template ModelInputOf<2> model_input<2>(const Scene&, const EvolutionPolicy&);
template ModelInputOf<3> model_input<3>(const Scene&, const EvolutionPolicy&);

Expected<void> check_model_size(Eigen::Index control_points) {
  if (control_points <= max_model_size) return {};
  return input_error(
      fmt::format("{} control points are selected, and no more than {} can be moved together",
                  control_points, max_model_size),
      "net", "make the net coarser, or select fewer surfaces");
}

template <int D>
Expected<JoinedShapes<D>> join_shapes(const ModelInputOf<D>& input) {
  JoinedShapes<D> joined;
  if (auto held = hold_shapes(input.shapes, joined); !held) return std::unexpected(held.error());
  return joined;
}

template <>
Expected<JoinedShapes<2>> join_shapes(const ModelInput& input) {
  Eigen::Index size = 0;
  for (const SurfaceInput& s : input.shapes) size += s.reference->size();
  if (auto fits = check_model_size(size); !fits) return std::unexpected(fits.error());
  JoinedShapes<2> joined;
  ActiveSettings<2>& settings = joined.settings;
  if (auto held = hold_shapes(input.shapes, joined); !held) return std::unexpected(held.error());
  std::vector<const Surface*> pointers;
  for (const SurfaceInput& s : input.shapes) pointers.push_back(s.reference.get());
  // Order matters: conditions along edges that follow are chosen last, in the unknowns that holds,
  // seams and smooth seams leave, since a QR decomposition decides how many of them there is room
  // for; the others have no such choice.
  std::vector<SeamReport>& reports = joined.seams;
  if (input.seams.couple) {
    const auto found = seams_between(input.seams, pointers);
    if (!found) return std::unexpected(found.error());
    for (const SeamOptions& options : {SeamOptions{}, along_edges, along_smooth_edges}) {
      // Along edges that follow, seams that would move stiffly as a whole are left to the coupling
      // of these edges, and where these are smooth, tangent planes at a ratio that is not the same
      // everywhere.
      std::vector<Seam> seams;
      std::ranges::copy_if(found->seams, std::back_inserter(seams), [&](const Seam& s) {
        const auto edge = followed_at(input.followed, s);
        return options.rigid
                   ? edge == nullptr
                   : edge != nullptr && is_smooth(*edge) == (options.angle == exact_ratio);
      });
      auto coupled = couple_seams(pointers, joined.rows, seams, options);
      if (!coupled) return std::unexpected(coupled.error());
      settings.constraints.insert(settings.constraints.end(), coupled->constraints.begin(),
                                  coupled->constraints.end());
      reports.insert(reports.end(), coupled->reports.begin(), coupled->reports.end());
    }
  }
  const std::size_t before = settings.constraints.size();
  if (input.seams.smooth) {
    if (auto kept = keep_smooth(pointers, joined.rows, reports, settings); !kept)
      return std::unexpected(kept.error());
  }
  joined.entwined = !input.followed.empty() || settings.constraints.size() > before;
  if (auto coupled = couple_followed(input, pointers, joined.rows, settings); !coupled) {
    return std::unexpected(coupled.error());
  }
  if (std::ranges::any_of(input.shapes,
                          [](const SurfaceInput& s) { return s.touched != nullptr; })) {
    for (const SurfaceInput& s : input.shapes) settings.visible.push_back(s.touched);
  }
  return joined;
}

ModelInput part_of(const ModelInput& input, std::span<const int> surfaces) {
  ModelInput part = input;
  part.shapes.clear();
  part.followed.clear();
  std::vector<const Surface*> all;
  for (const SurfaceInput& s : input.shapes) all.push_back(s.reference.get());
  part.seams.tolerance = input.seams.tolerance.value_or(suggested_seam_tolerance(all));
  std::vector<int> place(input.shapes.size(), -1);
  for (const int k : surfaces) {
    place[static_cast<std::size_t>(k)] = static_cast<int>(part.shapes.size());
    part.shapes.push_back(input.shapes[static_cast<std::size_t>(k)]);
  }
  for (FollowedInput edge : input.followed) {
    for (int& patch : edge.patches) patch = place[static_cast<std::size_t>(patch)];
    if (std::ranges::find(edge.patches, -1) == edge.patches.end())
      part.followed.push_back(std::move(edge));
  }
  return part;
}

// Conditions with value 0 can always be met, by D = 0. Only those with targets, or that hold a
// place other than that at rest, may contradict one another, and need a check before a step.
bool asks_for_motion(const ModelInput& input) {
  const auto asks = [](const SurfaceInput& s) {
    return std::ranges::any_of(s.constraints, [&](const KeptConstraint& kept) {
      const auto* pin = std::get_if<PointPin>(&kept.constraint);
      if (pin != nullptr && pin->to) return true;
      const bool keeps_place = pin != nullptr ||
                               std::holds_alternative<EdgeHold>(kept.constraint) ||
                               std::holds_alternative<Keep>(kept.constraint);
      return keeps_place && kept.where != s.rest;
    });
  };
  return std::ranges::any_of(input.shapes, asks);
}

Expected<void> check_conditions(const ModelInput& input) { return MetConditions().check(input); }

template Expected<JoinedShapes<1>> join_shapes<1>(const ModelInputOf<1>&);
template Expected<JoinedShapes<3>> join_shapes<3>(const ModelInputOf<3>&);

template <int D>
Expected<SceneModelOf<D>> make_model(ModelInputOf<D> input) {
  auto joined = join_shapes(input);
  if (!joined) return std::unexpected(joined.error());
  ActiveSettings<D>& settings = joined->settings;
  std::vector<Spline<D>> patches;
  for (const ShapeInput<D>& s : input.shapes) patches.push_back(*s.reference);
  set_material(input.shapes, settings);
  settings.rest = input.shapes.front().mode;
  set_evolution(input.evolution, input.scaling, input.detail, settings);
  auto model = ActiveSpline<D>::create(std::move(patches), settings);
  if (!model) return std::unexpected(model.error());
  note_engine(model->engine(), joined->notes);
  SceneModelOf<D> made{std::move(input), std::move(*model), std::move(joined->seams),
                       std::move(joined->notes)};
  if constexpr (D == 2) {
    if (auto loaded = keep_varying_load(made); !loaded) return std::unexpected(loaded.error());
  }
  return made;
}

template Expected<SceneModelOf<1>> make_model<1>(ModelInputOf<1>);
template Expected<SceneModelOf<2>> make_model<2>(ModelInputOf<2>);
template Expected<SceneModelOf<3>> make_model<3>(ModelInputOf<3>);

}  // namespace knead
