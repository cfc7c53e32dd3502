#include "studio_state.hpp"

#include <nlohmann/json.hpp>

#include "knead/session/command_json.hpp"

namespace knead::studio {
namespace {

using Json = nlohmann::json;

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json of(const Point& p) { return {p[0], p[1], p[2]}; }

Json of(const Shape& shape) {
  struct {
    Json operator()(const SphereShape& s) const { return {{"shape", "sphere"}, {"radius", s.radius}}; }
    Json operator()(const EllipsoidShape& s) const { return {{"shape", "ellipsoid"}, {"sizes", s.semi_axes}}; }
    Json operator()(const BoxShape& s) const {
      return {{"shape", "box"}, {"sizes", s.half_sizes}, {"rounding", s.rounding}};
    }
    Json operator()(const CylinderShape& s) const {
      return {{"shape", "cylinder"}, {"radius", s.radius}, {"height", 2 * s.half_height}};
    }
    Json operator()(const ConeShape& s) const {
      return {{"shape", "cone"}, {"radius", s.radius}, {"height", s.height}, {"top_radius", s.top_radius}};
    }
    Json operator()(const CapsuleShape& s) const {
      return {{"shape", "capsule"}, {"radius", s.radius}, {"height", 2 * s.half_height}};
    }
    Json operator()(const TorusShape& s) const { return {{"shape", "torus"}, {"radius", s.major}, {"minor", s.minor}}; }
    Json operator()(const PlaneShape&) const { return {{"shape", "plane"}}; }
    Json operator()(const BowlShape& s) const {
      return {{"shape", "bowl"}, {"radius", s.radius}, {"thickness", s.thickness}};
    }
    Json operator()(const SuperellipsoidShape& s) const {
      return {{"shape", "superellipsoid"}, {"sizes", s.semi_axes}, {"exponents", {s.e1, s.e2}}};
    }
    Json operator()(const SupertoroidShape& s) const {
      return {{"shape", "supertoroid"}, {"radius", s.major}, {"semi_axes", s.semi_axes}, {"exponents", {s.e1, s.e2}}};
    }
    Json operator()(const SplineShape&) const { return {{"shape", "surface"}}; }
  } visitor;
  return std::visit(visitor, shape);
}

Json of(const Tool& tool) {
  const Placement& at = tool.shape.placement();
  const char* mode = tool.mode == ToolMode::proximity ? "proximity"
                     : tool.mode == ToolMode::imprint ? "imprint"
                                                      : "collision";
  Json json = of(tool.shape.shape());
  json.update({{"name", tool.name},
               {"mode", mode},
               {"stiffness", tool.stiffness},
               {"range", tool.range},
               {"rigid", tool.rigid},
               {"friction", tool.friction},
               {"plasticity", tool.plasticity},
               {"direction", tool.direction == ToolDirection::push ? "push" : "pull"},
               {"position", of(at.position)},
               {"rotation", {at.rotation.x(), at.rotation.y(), at.rotation.z(), at.rotation.w()}},
               {"scale", at.scale},
               {"size", tool.shape.size()}});
  return json;
}

/// Constants as numbers; null where a coefficient varies.
template <std::size_t N>
Json of(const std::array<Coefficient<2>, N>& coefficients) {
  Json json = Json::array();
  for (const Coefficient<2>& c : coefficients) {
    const double* constant = std::get_if<double>(&c);
    json.push_back(constant ? Json(*constant) : Json());
  }
  return json;
}

Json of(const Session& session, int index) {
  const SceneSurface& s = session.state().surfaces[static_cast<std::size_t>(index)];
  Json asked = Json::array();
  for (const KeptConstraint& kept : s.constraints) {
    asked.push_back(Json::parse(to_json(kept.constraint), nullptr, false));
  }
  const Points& points = s.current->control_points();
  const auto constant = [](const Coefficient<2>& c) {
    return std::get_if<double>(&c) ? Json(std::get<double>(c)) : Json();
  };
  return {{"id", s.id},
          {"name", s.name},
          {"unit", s.unit},
          {"degree", {s.current->knots(0).degree(), s.current->knots(1).degree()}},
          {"net", s.current->net()},
          {"rational", s.current->rational()},
          {"lower", of(Point(points.colwise().minCoeff().transpose()))},
          {"upper", of(Point(points.colwise().maxCoeff().transpose()))},
          {"alpha", of(s.material.alpha)},
          {"beta", of(s.material.beta)},
          {"mass", constant(s.material.mass)},
          {"damping", constant(s.material.damping)},
          {"rest", s.mode == RestMode::none ? "none" : "shape"},
          {"hold", s.hold_rows},
          {"pins", s.pins.size()},
          {"pinned", s.pins},
          {"constraints", std::move(asked)},
          {"moved", session.moved_control_points(index)}};
}

Json of(const StepRecord& s) {
  return {{"time", s.time},
          {"energy", s.energy},
          {"stretch", s.stretch},
          {"bend", s.bend},
          {"kinetic", s.kinetic},
          {"contact", s.contact},
          {"residual", s.residual},
          {"displacement", s.largest_displacement},
          {"gap", s.gap},
          {"violation", s.violation},
          {"iterations", s.iterations},
          {"converged", s.converged},
          {"limited", s.limited},
          {"note", s.note}};
}

}  // namespace

std::string error_json(const Error& error) {
  const char* kind = error.kind == ErrorKind::numerical ? "numerical"
                     : error.kind == ErrorKind::usage   ? "usage"
                                                        : "input";
  return text_of({{"error",
                   {{"kind", kind},
                    {"what", error.what},
                    {"where", error.where},
                    {"remedy", error.remedy},
                    {"message", error.message()}}}});
}

std::string state_json(const Session& session) {
  const SessionState& state = session.state();
  Json surfaces = Json::array(), tools = Json::array(), forces = Json::array();
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) surfaces.push_back(of(session, static_cast<int>(k)));
  for (const Tool& tool : state.tools) tools.push_back(of(tool));
  for (const SceneForce& force : state.forces) forces.push_back(Json::parse(to_json(force), nullptr, false));
  Json seams = Json::array();
  for (const SeamReport& seam : state.seam_reports) {
    constexpr const char* names[] = {"none", "C0", "G1", "periodic"};
    seams.push_back(
        {{"continuity", names[static_cast<int>(seam.continuity)]}, {"gap", seam.seam.gap}, {"reason", seam.reason}});
  }
  Json json = {{"name", session.document().name()},
               {"fresh", session.document().is_fresh()},
               {"selection", state.selection()},
               {"surfaces", std::move(surfaces)},
               {"tools", std::move(tools)},
               {"forces", std::move(forces)},
               {"load", Json::parse(to_json(state.load), nullptr, false)},
               {"evolve", Json::parse(to_json(state.evolution), nullptr, false)},
               {"limit", state.limit ? Json(*state.limit) : Json()},
               {"raw", state.scaling == ScalingMode::raw},
               {"coupled", state.seams.couple},
               {"refine", state.permission == RefinePermission::automatic ? "auto" : "never"},
               {"seams", std::move(seams)},
               {"notes", state.notes},
               {"steps", state.steps.size()},
               {"last", state.steps.empty() ? Json() : of(state.steps.back())},
               {"undo", session.can_undo()},
               {"redo", session.can_redo()}};
  return text_of(json);
}

std::string steps_json(const SessionState& state, std::size_t first) {
  Json json = Json::array();
  for (std::size_t k = first; k < state.steps.size(); ++k) json.push_back(of(state.steps[k]));
  return text_of(json);
}

std::string journal_json(const Session& session) { return script_json(session.journal()); }

}  // namespace knead::studio
