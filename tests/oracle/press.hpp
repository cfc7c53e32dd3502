#pragma once

#include <array>
#include <cstdio>
#include <string>

#include "exchange/step/file.hpp"
#include "knead/brep/face_edges.hpp"
#include "knead/session/command_json.hpp"
#include "knead/spline/evaluate.hpp"
#include "session/session_state.hpp"

namespace knead::oracle {

inline std::string list_of(const Point& p) {
  char text[96];
  std::snprintf(text, sizeof text, "[%.17g,%.17g,%.17g]", p.x(), p.y(), p.z());
  return text;
}

/// A ball of half the distance to the nearest edge, pressed in by a quarter of its radius.
struct Press {
  std::string script;
  std::array<double, 2> at = {};
  Point place;
  double radius = 0, depth = 0;
};

inline Expected<Press> press(const brep::Model& file, const brep::SplineSurface& s,
                             const std::string& mode) {
  const auto region = visible_region(file, s.id);
  if (!region) return std::unexpected(region.error());
  const auto middle = visible_middle(s.surface, *region);
  if (!middle) return std::unexpected(middle.error());
  Press result;
  result.at = parameters_of(s.surface, middle->at);
  result.place = middle->place;
  result.radius = middle->distance / 2;
  result.depth = result.radius / 4;
  Parameters<2> here(1, 2);
  here << result.at[0], result.at[1];
  const auto jet = evaluate<2>(s.surface, here, 1);
  if (!jet) return std::unexpected(jet.error());
  const Point n = Point(jet->at({1, 0}).row(0)).cross(Point(jet->at({0, 1}).row(0))).normalized();
  char radius[32];
  std::snprintf(radius, sizeof radius, "%.17g", result.radius);
  result.script =
      R"({"knead":2,"commands":[{"do":"select","surface":")" + s.id +
      R"("},{"do":"material","alpha":[1,0,1],"beta":[0.003,0.003,0.003]},{"do":"hold","mode":")" +
      mode + R"("},{"do":"tool","name":"ball","radius":)" + radius +
      R"(,"rigid":true,"position":)" + list_of(result.place + (result.radius - result.depth) * n) +
      R"(},{"do":"evolve","mode":"static"}]})";
  return result;
}

/// Runs a script in a session, and saves its document.
inline Expected<std::string> carried_out(Session& session, const std::string& script) {
  const auto commands = parse_script(script, "press");
  if (!commands) return std::unexpected(commands.error());
  for (const Command& command : *commands) {
    if (const auto result = session.execute(command); !result)
      return std::unexpected(result.error());
  }
  return session.save();
}

}  // namespace knead::oracle
