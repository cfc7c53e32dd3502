#include "studio_state.hpp"

#include <limits>

#include "knead/session/command_json.hpp"
#include "studio_context.hpp"

namespace knead::studio {

std::string state_json(const Session& session) { return session_json(session); }
std::string journal_json(const Session& session) { return script_json(session.journal()); }

Point middle(const Document& document) {
  Point lower = Point::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
  for (const DocumentSurface& s : document.surfaces()) {
    lower = lower.cwiseMin(s.surface->control_points().colwise().minCoeff().transpose());
    upper = upper.cwiseMax(s.surface->control_points().colwise().maxCoeff().transpose());
  }
  if (!document.surfaces().empty()) return (lower + upper) / 2;
  return document.step_file() != nullptr ? middle_of(*document.step_file()) : Point::Zero();
}

}  // namespace knead::studio
