// What the targets of sessions have in common: commands made small, and what holds of every state.
#pragma once

#include <algorithm>
#include <optional>

#include "fuzz.hpp"
#include "knead/session/command_json.hpp"
#include "session/commands.hpp"
#include "session/session_state.hpp"

namespace knead::fuzz {

/// The command with numbers that a run has time for: a script may ask for much more, which is legal
/// and slow.
[[nodiscard]] inline std::optional<Command> small(const Command& command) {
  const auto at_most = [](auto& list, int most) {
    for (int& x : list) x = std::min(x, most);
  };
  if (const auto* c = fields_of<NewCommand>(command)) {
    NewCommand less = *c;
    at_most(less.net, less.net.size() == 3 ? 5 : 8);
    if (less.knots_u.size() > 24 || less.knots_v.size() > 24) return std::nullopt;
    return make_command(std::move(less));
  }
  if (const auto* c = fields_of<StepCommand>(command)) {
    StepCommand less = *c;
    less.count = std::min(less.count, 2);
    if (less.increments) less.increments = std::min(*less.increments, 2);
    return make_command(std::move(less));
  }
  if (const auto* c = fields_of<StrokeCommand>(command)) {
    StrokeCommand less = *c;
    less.steps = std::min(less.steps, 1);
    if (less.path.size() > 2) less.path.resize(2);
    return make_command(std::move(less));
  }
  if (const auto* c = fields_of<DragCommand>(command)) {
    DragCommand less = *c;
    less.steps = std::min(less.steps, 1);
    return make_command(std::move(less));
  }
  if (const auto* c = fields_of<LatticeCommand>(command)) {
    LatticeCommand less = *c;
    less.steps = std::min(less.steps, 1);
    at_most(less.net, 4);
    at_most(less.degree, 2);
    return make_command(std::move(less));
  }
  if (const auto* c = fields_of<MorphCommand>(command)) {
    MorphCommand less = *c;
    less.request.settings.refinement = 1;
    return make_command(std::move(less));
  }
  if (const auto* c = fields_of<ElevateCommand>(command)) {
    ElevateCommand less = *c;
    at_most(less.by, 1);
    return make_command(std::move(less));
  }
  if (fields_of<LimitCommand>(command) != nullptr)
    return std::nullopt;  // kept in rounds that take seconds
  return command;
}

inline int control_points(const Session& session) {
  Eigen::Index points = 0;
  for (const SceneSurface& s : session.state().surfaces) points += s.current->size();
  return static_cast<int>(points);
}

/// Of every state: numbers only, and one net for all shapes of a surface.
inline void check_state(const Session& session) {
  for (const SceneSurface& s : session.state().surfaces) {
    check_finite(*s.current, "the present shape");
    check_finite(*s.rest, "the shape at rest");
    check(s.current->net() == s.rest->net() && s.current->net() == s.reference->net(),
          "shapes of several nets");
    check(s.velocity.rows() == 0 || s.velocity.rows() == s.current->size(),
          "velocities of another net");
  }
}

/// Executes the commands of a script, made small. An error changes nothing.
inline void run(Session& session, std::string_view script, std::size_t most) {
  const auto commands = parse_script(script, "fuzz.json");
  if (!commands) return check_error(commands.error());
  for (std::size_t k = 0; k < std::min(commands->size(), most); ++k) {
    const std::string json = to_json((*commands)[k]);
    const auto again = parse_command(json);
    check(again.has_value() && to_json(*again) == json,
          "a command is not what it is written as: " + json);
    const auto command = small((*commands)[k]);
    if (!command || control_points(session) > 600) continue;
    const SessionState* before = &session.state();
    const auto status = session.execute(*command);
    if (!status) check_error(status.error());
    if (!status) check(&session.state() == before, "a command that failed changed the state");
    check_state(session);
  }
}

}  // namespace knead::fuzz
