// What a session shows of its state.
#include "session_state.hpp"

namespace knead {

const Document& Session::document_of(const SessionState& state) const {
  return state.document ? *state.document : document_;
}
const Document& Session::document() const { return document_of(state()); }

std::vector<SessionSurface> Session::surfaces() const {
  std::vector<SessionSurface> list;
  for (const SceneSurface& s : state().surfaces)
    list.push_back({s.id, s.name, s.unit, s.opened, s.rest, s.current});
  return list;
}

std::vector<int> Session::selection() const { return state().selection(); }
const std::vector<Tool>& Session::tools() const { return state().tools; }
std::vector<StepRecord> Session::steps() const {
  return {state().steps.begin(), state().steps.end()};
}
const std::vector<ModeRecord>& Session::modes() const { return state().modes; }
const std::vector<ModeRecord>& Session::buckling() const { return state().buckling; }

}  // namespace knead
