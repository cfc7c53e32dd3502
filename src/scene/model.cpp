#include "knead/scene/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "constraints.hpp"
#include "joined_surfaces.hpp"
#include "knead/scene/followed.hpp"
#include "knead/scene/mask.hpp"
#include "knead/scene/trims.hpp"
#include "knead/sculpt/edge_coupling.hpp"
#include "knead/sculpt/loads.hpp"
#include "met_conditions.hpp"
#include "scene_settings.hpp"
#include "smooth_seams.hpp"

namespace knead {
namespace {

constexpr CouplingTolerance smooth_tolerance{.position = 1e-3, .tangent = 1e-6};
constexpr double exact_ratio = 1e-7;  // radians that derivatives at a seam may be off a fixed ratio
constexpr SeamOptions along_edges{.rigid = false}, along_smooth_edges{.angle = exact_ratio, .rigid = false};

bool varies(const MaterialFieldOf<2>& material) {
  const auto field = [](const Coefficient<2>& c) { return !std::holds_alternative<double>(c); };
  return std::ranges::any_of(material.alpha, field) || std::ranges::any_of(material.beta, field) ||
         field(material.mass) || field(material.damping);
}

/// Whether some constraint is measured from the rest shape: edges of faces are held, and symmetries kept, on the
/// reference, so that the same model serves while strokes leave their mark on the rest shape.
bool measures_from_rest(const std::vector<KeptConstraint>& constraints) {
  return std::ranges::any_of(constraints, [](const KeptConstraint& kept) {
    const Constraint& c = kept.constraint;
    return !std::holds_alternative<TrimHolds>(c) && !std::holds_alternative<TrimEdgeHold>(c) &&
           !std::holds_alternative<EdgeSymmetry>(c) && !std::holds_alternative<MirrorSymmetry>(c);
  });
}

/// Coefficients as constants if all surfaces have the same material, else as fields.
void set_material(const std::vector<SurfaceInput>& surfaces, ActiveSettings<2>& settings) {
  const MaterialFieldOf<2>& material = surfaces.front().material;
  const bool varying = std::ranges::any_of(
      surfaces, [&](const SurfaceInput& s) { return varies(s.material) || !(s.material == material); });
  if (varying) {
    for (const SurfaceInput& s : surfaces) settings.fields.push_back(s.material);
    return;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    settings.material.alpha[k] = std::get<double>(material.alpha[k]);
    settings.material.beta[k] = std::get<double>(material.beta[k]);
  }
  settings.mass = std::get<double>(material.mass);
  settings.damping = std::get<double>(material.damping);
}

/// Appends the constraints of every surface, and the rows.
Expected<void> hold_surfaces(const std::vector<SurfaceInput>& surfaces, JoinedSurfaces& joined) {
  auto& [rows, settings, held_by, seams, notes, entwined] = joined;
  rows = {0};
  for (const SurfaceInput& s : surfaces) {
    if (s.mode != surfaces.front().mode) {
      return input_error("surfaces that are selected together have different rest modes", "rest",
                         "give `rest` once with all of them selected");
    }
    auto list = constraints_of(s, notes);
    if (!list) return std::unexpected(list.error());
    settings.held.insert(settings.held.end(), list->held.begin(), list->held.end());
    for (std::string& name : list->held_by) {
      held_by.push_back(surfaces.size() > 1 && !name.empty() ? s.id + ": " + name : std::move(name));
    }
    for (LinearConstraint& c : list->constraints) {
      for (auto& term : c.terms) term.first += rows.back();
      if (surfaces.size() > 1) c.name = s.id + ": " + c.name;
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
  const auto coupled = couple_edges(patches, rows, edges, settings.constraints, settings.held, input.coupling);
  if (!coupled) return std::unexpected(coupled.error());
  settings.constraints.insert(settings.constraints.end(), coupled->constraints.begin(), coupled->constraints.end());
  return {};
}

/// Appends the conditions that keep tangent planes common at smooth seams whose sides are in no fixed ratio.
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
  const auto coupled = couple_edges(patches, rows, edges, settings.constraints, settings.held, smooth_tolerance);
  if (!coupled) return std::unexpected(coupled.error());
  settings.constraints.insert(settings.constraints.end(), coupled->constraints.begin(), coupled->constraints.end());
  return {};
}

/// The forces of the parts of the load that vary, which depend on the surfaces as they are opened.
Expected<void> keep_varying_load(SceneModel& scene) {
  if (!scene.input.varying) return {};
  scene.varying_load = Points::Zero(scene.model.rows().back(), 3);
  for (std::size_t patch = 0; patch < scene.input.surfaces.size(); ++patch) {
    const SurfaceInput& s = scene.input.surfaces[patch];
    const DomainScaling<2>& scaling = scene.model.scaling(static_cast<int>(patch));
    const bool by_area = scene.input.varying->per == LoadMeasure::area;
    const auto fields = load_fields(*scene.input.varying, *s.reference);
    if (!fields) return std::unexpected(fields.error());
    for (const Surface& field : *fields) {
      auto forces = by_area ? area_load_forces(*s.rest, field) : load_forces<2>(*s.reference, scaling, field);
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
    const double own = t.detail();
    if (std::isfinite(own) && (detail == 0 || own < detail)) detail = own;
  }
  return detail;
}

EvolutionPolicy trial_evolution() {
  EvolutionPolicy evolution;
  evolution.lambda = 1e6;
  return evolution;
}

Expected<FoundSeams> seams_between(const SeamPolicy& policy, std::span<const Surface* const> patches) {
  const double tolerance = policy.tolerance.value_or(suggested_seam_tolerance(patches));
  if (tolerance == 0) return FoundSeams{};  // surfaces that collapse to one point
  return find_seams(patches, tolerance);
}

ModelInput model_input(const Scene& scene, const EvolutionPolicy& evolution) {
  ModelInput input;
  const bool visible_only = touches_visible(scene);
  const bool by_area = scene.load.varies() && scene.load.per == LoadMeasure::area;
  for (int k : scene.selection()) {
    const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(k)];
    input.surfaces.push_back({.id = s.id,
                              .reference = s.reference,
                              .rest = measures_from_rest(s.constraints) || by_area ? s.rest : nullptr,
                              .mode = s.mode,
                              .material = s.material,
                              .elasticity = s.elasticity,
                              .hold_rows = s.hold_rows,
                              .pins = s.pins,
                              .constraints = s.constraints,
                              .smooth_knot_lines = s.smooth_knot_lines,
                              .smooth_poles = s.smooth_poles,
                              .visible = holds_trims(s.constraints) ? s.visible : nullptr,
                              .touched = visible_only ? s.visible : nullptr,
                              .masked = masked_points(s)});
  }
  input.seams = scene.seams;
  input.scaling = scene.scaling;
  input.evolution = evolution;
  if (scene.load.varies()) input.varying = scene.load;
  input.detail = detail_of(scene.tools);
  input.followed = followed_inputs(scene);
  if (!input.followed.empty()) input.coupling = scene.coupling;
  return input;
}

Expected<void> check_model_size(Eigen::Index control_points) {
  if (control_points <= max_model_size) return {};
  return input_error(fmt::format("{} control points are selected, and no more than {} can be moved together",
                                 control_points, max_model_size),
                     "net", "make the net coarser, or select fewer surfaces");
}

Expected<JoinedSurfaces> join_surfaces(const ModelInput& input) {
  Eigen::Index size = 0;
  for (const SurfaceInput& s : input.surfaces) size += s.reference->size();
  if (auto fits = check_model_size(size); !fits) return std::unexpected(fits.error());
  JoinedSurfaces joined;
  ActiveSettings<2>& settings = joined.settings;
  if (auto held = hold_surfaces(input.surfaces, joined); !held) return std::unexpected(held.error());
  std::vector<const Surface*> pointers;
  for (const SurfaceInput& s : input.surfaces) pointers.push_back(s.reference.get());
  std::vector<SeamReport>& reports = joined.seams;
  if (input.seams.couple) {
    const auto found = seams_between(input.seams, pointers);
    if (!found) return std::unexpected(found.error());
    for (const SeamOptions& options : {SeamOptions{}, along_edges, along_smooth_edges}) {
      // Along edges that follow, seams that would move stiffly as a whole are left to the coupling of these edges, and
      // where these are smooth, tangent planes at a ratio that is not the same everywhere.
      std::vector<Seam> seams;
      std::ranges::copy_if(found->seams, std::back_inserter(seams), [&](const Seam& s) {
        const auto edge = followed_at(input.followed, s);
        return options.rigid ? edge == nullptr : edge != nullptr && is_smooth(*edge) == (options.angle == exact_ratio);
      });
      auto coupled = couple_seams(pointers, joined.rows, seams, options);
      if (!coupled) return std::unexpected(coupled.error());
      settings.constraints.insert(settings.constraints.end(), coupled->constraints.begin(), coupled->constraints.end());
      reports.insert(reports.end(), coupled->reports.begin(), coupled->reports.end());
    }
  }
  const std::size_t before = settings.constraints.size();
  if (input.seams.smooth) {
    if (auto kept = keep_smooth(pointers, joined.rows, reports, settings); !kept) return std::unexpected(kept.error());
  }
  joined.entwined = !input.followed.empty() || settings.constraints.size() > before;
  if (auto coupled = couple_followed(input, pointers, joined.rows, settings); !coupled) {
    return std::unexpected(coupled.error());
  }
  if (std::ranges::any_of(input.surfaces, [](const SurfaceInput& s) { return s.touched != nullptr; })) {
    for (const SurfaceInput& s : input.surfaces) settings.visible.push_back(s.touched);
  }
  return joined;
}

ModelInput part_of(const ModelInput& input, std::span<const int> surfaces) {
  ModelInput part = input;
  part.surfaces.clear();
  part.followed.clear();
  std::vector<const Surface*> all;
  for (const SurfaceInput& s : input.surfaces) all.push_back(s.reference.get());
  part.seams.tolerance = input.seams.tolerance.value_or(suggested_seam_tolerance(all));
  std::vector<int> place(input.surfaces.size(), -1);
  for (const int k : surfaces) {
    place[static_cast<std::size_t>(k)] = static_cast<int>(part.surfaces.size());
    part.surfaces.push_back(input.surfaces[static_cast<std::size_t>(k)]);
  }
  for (FollowedInput edge : input.followed) {
    for (int& patch : edge.patches) patch = place[static_cast<std::size_t>(patch)];
    if (std::ranges::find(edge.patches, -1) == edge.patches.end()) part.followed.push_back(std::move(edge));
  }
  return part;
}

bool asks_for_motion(const ModelInput& input) {
  const auto asks = [](const SurfaceInput& s) {
    return std::ranges::any_of(s.constraints, [&](const KeptConstraint& kept) {
      const auto* pin = std::get_if<PointPin>(&kept.constraint);
      if (pin != nullptr && pin->to) return true;
      const bool keeps_place = pin != nullptr || std::holds_alternative<EdgeHold>(kept.constraint) ||
                               std::holds_alternative<Keep>(kept.constraint);
      return keeps_place && kept.where != s.rest;
    });
  };
  return std::ranges::any_of(input.surfaces, asks);
}

Expected<void> check_conditions(const ModelInput& input) { return MetConditions().check(input); }

Expected<SceneModel> make_model(ModelInput input) {
  auto joined = join_surfaces(input);
  if (!joined) return std::unexpected(joined.error());
  ActiveSettings<2>& settings = joined->settings;
  std::vector<Surface> patches;
  for (const SurfaceInput& s : input.surfaces) patches.push_back(*s.reference);
  set_material(input.surfaces, settings);
  settings.rest = input.surfaces.front().mode;
  set_evolution(input.evolution, input.scaling, input.detail, settings);
  auto model = ActiveSurface::create(std::move(patches), settings);
  if (!model) return std::unexpected(model.error());
  note_engine(model->engine(), joined->notes);
  SceneModel made{std::move(input), std::move(*model), std::move(joined->seams), std::move(joined->notes)};
  if (auto loaded = keep_varying_load(made); !loaded) return std::unexpected(loaded.error());
  return made;
}

}  // namespace knead
