#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "exchange/support.hpp"
#include "knead/session/command_json.hpp"
#include "session/commands.hpp"
#include "session/session_state.hpp"

namespace knead::testing {

inline Session open_sample() {
  auto document = Document::open(std::string(KNEAD_SOURCE_DIR) + "/samples/bonnet.step");
  if (!document) ADD_FAILURE() << document.error().message();
  return Session(std::move(*document));
}

/// Of its file, as it was opened.
inline std::string bytes_of(const Document& document) {
  std::vector<std::shared_ptr<const Surface>> surfaces;
  for (const SourceSurface& s : document.source()->surfaces()) surfaces.push_back(s.surface);
  return *document.source()->save(surfaces);
}

inline Session fresh() { return Session(Document::fresh("test")); }

/// Executes commands; fails the test where one is refused.
inline void run(Session& session, const std::vector<std::string>& commands) {
  for (const std::string& json : commands) {
    const auto command = parse_command(json);
    ASSERT_TRUE(command) << json << ": " << command.error().message();
    const auto status = session.execute(*command);
    ASSERT_TRUE(status) << json << ": " << status.error().message();
  }
}

/// The error of a command; fails the test where it is accepted.
inline Error refusal(Session& session, const std::string& json) {
  const auto command = parse_command(json);
  if (!command) return command.error();
  const auto status = session.execute(*command);
  if (status) {
    ADD_FAILURE() << json << " was accepted";
    return {};
  }
  return status.error();
}

inline bool same_bits(const Surface& a, const Surface& b) {
  for (int d = 0; d < 2; ++d) {
    if (!std::ranges::equal(a.knots(d).knots(), b.knots(d).knots())) return false;
  }
  return std::ranges::equal(a.weights(), b.weights()) &&
         same_bits(a.control_points(), b.control_points());
}

/// All that a user could see of a state is the same, to the last bit (not the time that steps
/// took).
inline ::testing::AssertionResult same_state(const SessionState& a, const SessionState& b) {
  const auto differs = [](const std::string& what) {
    return ::testing::AssertionFailure() << what << " differs";
  };
  if (a.selected != b.selected || a.together != b.together) return differs("selection");
  if (a.surfaces.size() != b.surfaces.size()) return differs("number of surfaces");
  for (std::size_t k = 0; k < a.surfaces.size(); ++k) {
    const SceneSurface &s = a.surfaces[k], &t = b.surfaces[k];
    if (s.id != t.id || s.name != t.name || s.unit != t.unit) return differs("label of " + s.id);
    if (!same_bits(*s.opened, *t.opened)) return differs("opened " + s.id);
    if (!same_bits(*s.reference, *t.reference)) return differs("reference " + s.id);
    if (!same_bits(*s.rest, *t.rest)) return differs("rest " + s.id);
    if (!same_bits(*s.current, *t.current)) return differs("current " + s.id);
    if (!same_bits(s.velocity, t.velocity)) return differs("velocity " + s.id);
    if (s.mode != t.mode || !(s.material == t.material) || s.elasticity != t.elasticity ||
        !(s.plastic == t.plastic))
      return differs("material " + s.id);
    if (s.hold_rows != t.hold_rows || s.pins != t.pins) return differs("hold " + s.id);
    if (s.mask != t.mask) return differs("mask of " + s.id);
    if (s.smooth_knot_lines != t.smooth_knot_lines || s.smooth_poles != t.smooth_poles)
      return differs("smooth");
    if (s.constraints.size() != t.constraints.size()) return differs("constraints of " + s.id);
    for (std::size_t c = 0; c < s.constraints.size(); ++c) {
      if (!(s.constraints[c].constraint == t.constraints[c].constraint))
        return differs("a constraint of " + s.id);
      if (!same_bits(*s.constraints[c].where, *t.constraints[c].where))
        return differs("a constraint's place");
    }
  }
  if (a.body != b.body || a.bodies.size() != b.bodies.size()) return differs("bodies");
  for (std::size_t k = 0; k < a.bodies.size(); ++k) {
    const ShapeCommon &s = common_of(a.bodies[k]), &t = common_of(b.bodies[k]);
    if (s.id != t.id || s.name != t.name || s.unit != t.unit) return differs("label of " + s.id);
    if (!same_bits(control_points_of(a.bodies[k]), control_points_of(b.bodies[k])))
      return differs("current " + s.id);
    if (!same_bits(s.velocity, t.velocity) || s.mode != t.mode)
      return differs("velocity or mode of " + s.id);
    if (s.hold_rows != t.hold_rows || a.bodies[k].index() != b.bodies[k].index())
      return differs("hold of " + s.id);
    const auto same = [&]<int D>(const SceneShape<D>& p) {
      const auto& q = std::get<SceneShape<D>>(b.bodies[k]);
      return p.material == q.material && p.elasticity == q.elasticity && p.pins == q.pins &&
             std::ranges::equal(p.constraints, q.constraints, [](const auto& x, const auto& y) {
               return x.constraint == y.constraint &&
                      same_bits(x.where->control_points(), y.where->control_points());
             });
    };
    if (!std::visit(same, a.bodies[k])) return differs("material or hold of " + s.id);
  }
  if (a.tools.size() != b.tools.size()) return differs("number of tools");
  for (std::size_t k = 0; k < a.tools.size(); ++k) {
    const Tool &s = a.tools[k], &t = b.tools[k];
    const Placement &p = s.shape.placement(), &q = t.shape.placement();
    if (s.name != t.name || !(s.shape.shape() == t.shape.shape())) return differs("tool " + s.name);
    if (p.position != q.position || p.rotation.coeffs() != q.rotation.coeffs() ||
        p.scale != q.scale)
      return differs("place of " + s.name);
    if (s.mode != t.mode || s.stiffness != t.stiffness || s.range != t.range ||
        s.rigid != t.rigid || s.friction != t.friction || s.plasticity != t.plasticity ||
        s.direction != t.direction)
      return differs("setting of " + s.name);
  }
  if (a.stroke.has_value() != b.stroke.has_value()) return differs("a tool that is down");
  if (a.stroke &&
      (!same_bits(a.stroke->history, b.stroke->history) ||
       !same_bits(a.stroke->last, b.stroke->last) || a.stroke->tool != b.stroke->tool ||
       !(a.stroke->path == b.stroke->path) || !(a.stroke->plasticity == b.stroke->plasticity) ||
       a.stroke->lambda != b.stroke->lambda || a.stroke->tension != b.stroke->tension))
    return differs("the open stroke");
  if (a.forces.size() != b.forces.size()) return differs("number of forces");
  if (!(a.load == b.load) || a.limit != b.limit) return differs("load or limit");
  if (!(a.evolution == b.evolution) || a.scaling != b.scaling || !(a.seams == b.seams) ||
      a.permission != b.permission)
    return differs("setting");
  if (a.steps.size() != b.steps.size()) return differs("number of steps");
  for (std::size_t k = 0; k < a.steps.size(); ++k) {
    const StepRecord &s = a.steps[k], &t = b.steps[k];
    if (s.energy != t.energy || s.residual != t.residual ||
        s.largest_displacement != t.largest_displacement || s.gap != t.gap ||
        s.iterations != t.iterations || s.note != t.note)
      return differs("record of step " + std::to_string(k));
  }
  if (a.notes != b.notes || a.energy_before != b.energy_before) return differs("notes");
  for (const auto list : {&SessionState::modes, &SessionState::buckling}) {
    if (!std::ranges::equal(a.*list, b.*list, [](const ModeRecord& s, const ModeRecord& t) {
          return s.value == t.value && s.residual == t.residual && same_bits(s.shape, t.shape);
        })) {
      return differs("modes");
    }
  }
  if (a.seam_reports.size() != b.seam_reports.size()) return differs("seam reports");
  return ::testing::AssertionSuccess();
}

}  // namespace knead::testing
