#include "knead/session/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "described_state.hpp"
#include "knead/brep/model.hpp"
#include "scene/followed.hpp"
#include "scene/parted_edges.hpp"
#include "scene/shell_fields.hpp"
#include "scene/trims.hpp"
#include "session_state.hpp"
#include "tool/describe_shape.hpp"

namespace knead {
namespace {

/// Whether edges of faces were freed, so that they may be open.
bool frees_edges(const SessionState& state) {
  const auto frees = [](const KeptConstraint& kept) {
    const auto* all = std::get_if<TrimHolds>(&kept.constraint);
    const auto* edge = std::get_if<TrimEdgeHold>(&kept.constraint);
    return (all != nullptr && all->order < 0) ||
           (edge != nullptr && edge->order < 0 && !edge->follow);
  };
  return std::ranges::any_of(state.surfaces, [&](const SceneSurface& s) {
    return std::ranges::any_of(s.constraints, frees);
  });
}

/// Notes on the edges that were freed and are open. If they cannot be known, `save` says why.
std::vector<std::string> notes_on_open_edges(const Session& session) {
  std::vector<std::string> notes;
  const auto parted =
      frees_edges(session.state()) ? session.parted_edges() : Expected<std::vector<PartedEdge>>();
  for (const PartedEdge& edge : parted.value_or(std::vector<PartedEdge>())) {
    if (edge.freed) notes.push_back(note_on(edge));
  }
  return notes;
}

std::vector<RepeatedSurface> repeated_surfaces(const Session& session) {
  std::vector<RepeatedSurface> result;
  const brep::Model* const model = session.document().model();
  if (model == nullptr || model->instances.empty() || !model->assembly) return result;
  const auto& surfaces = session.state().surfaces;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    const brep::Part* part = model->assembly->part_of(surfaces[k].id);
    if (part == nullptr || part->places.size() < 2 ||
        session.moved_control_points(static_cast<int>(k)) == 0)
      continue;
    result.push_back({surfaces[k].id, part->name, static_cast<int>(part->places.size())});
  }
  return result;
}

/// The shapes of modes on the control points of one selected surface, which begin at a row of
/// theirs.
std::vector<std::pair<std::string, Points>> shapes_on(const SessionState& state, Eigen::Index first,
                                                      Eigen::Index count) {
  std::vector<std::pair<std::string, Points>> shapes;
  const auto append = [&](const char* name, const std::vector<ModeRecord>& modes) {
    for (std::size_t k = 0; k < modes.size(); ++k) {
      if (modes[k].shape.rows() < first + count) continue;  // of another selection, or another net
      shapes.emplace_back(fmt::format("{}_{}", name, k + 1),
                          modes[k].shape.middleRows(first, count));
    }
  };
  append("mode", state.modes);
  append("buckling", state.buckling);
  return shapes;
}

std::string_view hold_of(const TrimReport::Edge& edge) {
  constexpr std::string_view names[] = {"open", "position", "tangent", "curvature"};
  return edge.follows ? "follow" : names[edge.held.order + 1];
}

/// The angles between the tangent planes at an edge that follows and was smooth as opened; none for
/// other edges.
std::optional<Parting> angles_at(const SessionState& state, const std::string& edge) {
  const auto found = std::ranges::find(state.followed, edge, &FollowedEdge::id);
  if (found == state.followed.end() || !found->course || !is_smooth(*found->course))
    return std::nullopt;
  const auto measured = parting(state, *found->course);
  return measured ? std::optional(*measured) : std::nullopt;
}

}  // namespace

Outcome outcome_of(Session& session, std::size_t opened) {
  const SessionState& state = session.state();
  Outcome o;
  o.places = repeated_surfaces(session);
  o.notes = state.notes;
  const std::vector<std::string> open = notes_on_open_edges(session);
  o.notes.insert(o.notes.end(), open.begin(), open.end());
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  // Finished work is written even if its energy cannot be computed.
  if (const auto energy = session.energy()) {
    o.energy_after = *energy;
    o.energy_before = state.energy_before.value_or(*energy);
  } else {
    o.energy_after = unknown;
    o.energy_before = state.energy_before.value_or(unknown);
    o.no_energy = energy.error();
  }
  for (const StepRecord& s : state.steps) o.time += s.time;
  if (!state.steps.empty()) {
    o.residual = state.steps.back().residual;
    o.gap = state.steps.back().gap;
  }
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const int moved = session.moved_control_points(static_cast<int>(k));
    const bool converted = !session.document().is_fresh() && k >= opened;
    if (moved > 0 || converted) ++o.surfaces;
    if (moved == 0) continue;
    o.moved += moved;
    o.largest_displacement =
        std::max(o.largest_displacement, session.largest_displacement(static_cast<int>(k)));
  }
  for (const SceneBody& body : state.bodies) {
    const int moved = moved_control_points(body);
    if (moved == 0) continue;
    o.moved += moved;
    ++o.bodies;
    o.largest_displacement = std::max(o.largest_displacement, largest_displacement(body));
  }
  return o;
}

std::vector<EdgesReport> report_edges(const Session& session) {
  const SessionState& state = session.state();
  std::vector<EdgesReport> list;
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const SceneSurface& s = state.surfaces[k];
    const bool moved = s.current != s.opened;
    if (!s.visible || s.visible->edges.empty() || !(moved || holds_trims(s.constraints))) continue;
    const auto trims = trim_report(s);
    if (!trims) continue;
    EdgesReport& report = list.emplace_back(static_cast<int>(k));
    report.free = trims->free;
    report.visible = trims->visible;
    report.net = trims->net;
    report.samples = trims->samples;
    report.largest_gap = trims->largest;
    for (const TrimReport::Edge& edge : trims->edges) {
      report.edges.push_back({edge.held.id, hold_of(edge), edge.held.order >= 0,
                              edge.held.along_lines, edge.held.points, edge.deviation,
                              edge.neighbours});
    }
  }
  return list;
}

std::vector<FollowedReport> report_followed(const Session& session) {
  std::vector<FollowedReport> list;
  for (const FollowedEdge& edge : session.state().followed) {
    if (const auto angles = angles_at(session.state(), edge.id))
      list.push_back({edge.id, angles->angle, angles->angle_before});
  }
  return list;
}

std::vector<SeamSummary> report_seams(const Session& session) {
  const SessionState& state = session.state();
  const auto side = [&](const PatchEdge& edge) {
    return fmt::format("{} {}", state.surfaces[static_cast<std::size_t>(edge.patch)].id,
                       edge_name(edge.edge));
  };
  std::vector<SeamSummary> list;
  for (const SeamReport& s : state.seam_reports) {
    const auto continuity = choices(s.continuity)[static_cast<std::size_t>(s.continuity)].name;
    list.push_back({side(s.seam.a), side(s.seam.b), std::string(continuity), s.seam.gap, s.reason});
  }
  return list;
}

std::optional<BodyReport> report_body(const Session& session) {
  const SessionState& state = session.state();
  if (!state.body) return std::nullopt;
  const SceneBody& body = state.bodies[static_cast<std::size_t>(*state.body)];
  const ShapeCommon& common = common_of(body);
  return BodyReport{kind_of(body), common.id,        common.name,
                    common.unit,   degrees_of(body), net_of(body)};
}

std::optional<ShellMaterial> shell_of(const Session& session, int surface) {
  const auto& elasticity = session.state().surfaces[static_cast<std::size_t>(surface)].elasticity;
  const auto* shell = std::get_if<ShellMaterial>(&elasticity);
  return shell != nullptr ? std::optional(*shell) : std::nullopt;
}

std::string in_words(const Shape& shape) {
  const Type& shapes = type_of<Shape>();
  const Type& type = *shapes.variants[shape.index()];
  std::string text(type.name), separator = " of ";
  for (const Field& field : type.fields) {
    if (!field.type->numeric()) continue;
    const auto* numbers = static_cast<const double*>(field.of(shapes.part(&shape)));
    const std::size_t count = field.type->kind == Kind::array ? field.type->length : 1;
    std::string values;
    for (std::size_t k = 0; k < count; ++k) {
      values += fmt::format("{}{:.4g}", k == 0 ? "" : " x ", numbers[k] * field.factor);
    }
    text += fmt::format("{}{} {}", std::exchange(separator, ", "), field.name, values);
  }
  return text;
}

Expected<std::vector<FieldGrid>> result_grids(const Session& session, int samples) {
  const SessionState& state = session.state();
  std::vector<FieldGrid> grids;
  Eigen::Index first = 0;
  for (const int index : state.selection()) {
    const SceneSurface& s = state.surfaces[static_cast<std::size_t>(index)];
    const Eigen::Index count = s.current->size();
    auto grid = result_grid(s, samples, shapes_on(state, first, count));
    if (!grid) return std::unexpected(grid.error().within(s.id));
    grids.push_back(std::move(*grid));
    first += count;
  }
  return grids;
}

}  // namespace knead
