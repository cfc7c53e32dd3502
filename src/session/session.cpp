#include "knead/session/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <type_traits>
#include <utility>

#include "acts/following.hpp"
#include "acts/placing.hpp"
#include "acts/selection.hpp"
#include "base/interruption.hpp"
#include "commands.hpp"
#include "document_regions.hpp"
#include "gestures/brushing.hpp"
#include "gestures/stroking.hpp"
#include "knead/spline/extremum.hpp"
#include "scene/trims.hpp"
#include "session_state.hpp"

namespace knead {

struct Session::ModelCache : ActCache {};

Session::Session(Document document)
    : document_(std::move(document)), cache_(std::make_unique<ModelCache>()) {
  auto state = std::make_shared<SessionState>();
  for (const DocumentSurface& s : document_.surfaces()) {
    state->surfaces.push_back(untouched<2>(s.id, s.name, s.unit, s.surface));
  }
  for (const SourceCurve& c : document_.curves()) {
    state->bodies.emplace_back(untouched<1>(c.id, c.name, c.unit, c.curve));
  }
  if (state->surfaces.size() == 1) state->selected = 0;
  if (state->surfaces.empty() && state->bodies.size() == 1) state->body = 0;
  states_.push_back(std::move(state));
}

Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;
Session::~Session() = default;

namespace {

/// Whether a command reports on the session and leaves the history as it is.
bool only_looks(const Command& command) {
  return fields_of<ModesCommand>(command) != nullptr ||
         fields_of<BucklingCommand>(command) != nullptr;
}

/// Whether surfaces move only as a model lets them, which keeps what holds them: nothing need be
/// measured.
bool moves_a_model(const Command& command) {
  const auto any_of = [&]<class... C>(std::type_identity<C>...) {
    return ((fields_of<C>(command) != nullptr) || ...);
  };
  return any_of(std::type_identity<StepCommand>(), std::type_identity<EvolveCommand>(),
                std::type_identity<DragCommand>(), std::type_identity<StrokeCommand>(),
                std::type_identity<BrushCommand>(), std::type_identity<RelaxCommand>());
}

/// Applies a command to what is selected.
template <class C>
Expected<void> apply(const C& command, Act& act) {
  const SceneBody* const chosen = target_of<C>() == ActsOn::surfaces ? body(act) : nullptr;
  if (chosen == nullptr) return execute(command, act);
  return input_error(fmt::format("this command acts on surfaces, and the {} {} is selected",
                                 kind_of(*chosen), common_of(*chosen).id),
                     std::string(type_of<C>().name), "select a surface first");
}

}  // namespace

Expected<void> Session::execute(const Command& command, const Progress& progress,
                                const GoOn& go_on) {
  const Interruption interruption(go_on);
  auto status = carry_out(command, progress);
  // What a command asks for is input, also where the function that refuses it takes it as an
  // argument.
  if (!status && status.error().kind == ErrorKind::usage) status.error().kind = ErrorKind::input;
  if (status || !interruption.happened()) return status;
  *cache_ = {};
  return interrupted_error();
}

// A command acts on a copy of the present state, in which shapes are shared, and the copy becomes
// the present one only if every check passes: an error leaves nothing behind. Checks come in the
// order in which one may change what the next sees: the law of motion and faces in the way make
// motions smaller, then edges that follow are measured, then what was placed without a model. The
// entry of the history is the command as it came out, so that replaying the journal needs no option
// of the session.
Expected<void> Session::carry_out(const Command& command, const Progress& progress) {
  if (fields_of<UndoCommand>(command)) {
    if (!can_undo()) return input_error("there is nothing to undo");
    --position_;
    return {};
  }
  if (fields_of<RedoCommand>(command)) {
    if (!can_redo()) return input_error("there is nothing to redo");
    ++position_;
    return {};
  }
  Command meant = command;
  auto next = std::make_shared<SessionState>(state());
  if (cache_->faces.document != state().document) cache_->faces = {state().document};
  Act act{document(), *next, *cache_, progress};
  // An open stroke or brush ends with whatever command comes next that does not go on with it.
  if (!fields_of<StrokeCommand>(command)) {
    if (auto lifted = Stroke(act).lift(); !lifted) return lifted;
    if (auto kept = keep_law(act); !kept) return kept;
  }
  if (!fields_of<BrushCommand>(command)) {
    if (auto lifted = BrushStroke(act).lift(); !lifted) return lifted;
  }
  act.meeting = FaceMeeting(through_of(meant, stops_at_faces_).value_or(Through::allow));
  const auto applied = [&](const auto& fields) { return apply(fields, act); };
  if (auto status = std::visit(applied, meant.any().fields); !status) return status;
  if (auto kept = keep_law(act); !kept) return kept;
  if (auto met = act.meeting.at_end(act, state()); !met) return met;
  if (!act.edges_measured) {
    if (auto closed = check_followed(*next, state()); !closed) return closed;
  }
  if (!moves_a_model(meant)) {
    if (auto held = check_placed(act, state(), meant.name()); !held) return held;
  }
  if (act.meeting.stopped()) meant = that_stops(meant);
  if (act.steps_kept) {
    StepCommand made = *fields_of<StepCommand>(meant);
    made.count = *act.steps_kept;
    meant = make_command(std::move(made));
  }
  if (only_looks(meant) && !state().stroke && !state().brush) {
    states_[position_] = std::move(next);
    return {};
  }
  states_.resize(position_ + 1);
  entries_.resize(position_);
  states_.push_back(std::move(next));
  entries_.push_back({meant});
  ++position_;
  return {};
}

// The history is set aside and put back by a destructor, whatever way the loop is left; what the
// cache has learned stays.
Expected<void> Session::rehearse(std::span<const Command> commands, const GoOn& go_on) {
  /// What stands now, which comes back whatever happens.
  struct Kept {
    Session& session;
    decltype(states_) states;
    decltype(entries_) entries;
    std::size_t position, floor;
    ~Kept() {
      session.states_ = std::move(states);
      session.entries_ = std::move(entries);
      session.position_ = position;
      session.floor_ = floor;
    }
  };
  decltype(states_) alone = {states_[position_]};
  const Kept kept{*this, std::exchange(states_, std::move(alone)), std::exchange(entries_, {}),
                  std::exchange(position_, 0), std::exchange(floor_, 0)};
  for (const Command& command : commands) {
    if (auto status = execute(command, {}, go_on); !status) return status;
  }
  return {};
}

std::vector<Command> Session::journal() const {
  std::vector<Command> commands = earlier_;
  for (std::size_t k = 0; k < position_; ++k)
    commands.insert(commands.end(), entries_[k].begin(), entries_[k].end());
  return commands;
}

// What follows from the file alone is not in a snapshot: regions and courses are made again, once
// for each surface and edge of a document, and shared by all states.
void Session::know_faces() {
  std::map<std::string, std::shared_ptr<const VisibleRegion>> known;
  std::map<std::string, std::shared_ptr<const SharedEdge>> courses;
  std::optional<DocumentRegions> regions;
  const Document* last = nullptr;
  for (auto& state : states_) {
    const Document& document = document_of(*state);
    const brep::Model* const model = document.model();
    if (model == nullptr) return;
    if (last != &document) {  // neighbours lie on other surfaces
      known.clear();
      regions.reset();
    }
    last = &document;
    auto next = std::make_shared<SessionState>(*state);
    for (std::size_t k = 0; k < next->surfaces.size(); ++k) {
      if (!holds_trims(std::as_const(next->surfaces)[k].constraints)) continue;
      SceneSurface& s = next->surfaces[k];
      auto found = known.find(s.id);
      if (found == known.end()) {
        // If they cannot be followed the next step says so.
        if (!regions) regions.emplace(document);
        auto region = regions->of(s.id);
        found =
            known
                .emplace(s.id, region ? std::make_shared<const VisibleRegion>(std::move(*region))
                                      : nullptr)
                .first;
      }
      s.visible = found->second;
    }
    for (FollowedEdge& edge : next->followed) {
      auto found = courses.find(edge.id);
      if (found == courses.end()) {
        auto course = SharedEdge::create(*model, edge.id);
        found =
            courses
                .emplace(edge.id,
                         course ? std::make_shared<const SharedEdge>(std::move(*course)) : nullptr)
                .first;
      }
      edge.course = found->second;
    }
    state = std::move(next);
  }
}

namespace {

/// Whether nothing is selected, or only what is where its energy is zero.
bool is_at_rest(const Scene& scene) {
  const auto rests = [](const auto& s) { return s.mode == RestMode::shape && s.current == s.rest; };
  if (scene.body) return std::visit(rests, scene.bodies[static_cast<std::size_t>(*scene.body)]);
  return std::ranges::all_of(
      scene.selection(), [&](int k) { return rests(scene.surfaces[static_cast<std::size_t>(k)]); });
}

}  // namespace

Expected<double> Session::energy() {
  const Scene& scene = state();
  if (is_at_rest(scene)) return 0;  // even if no model can be made
  if (const Model* model = cache_->models.measuring(scene))
    return model->energy(active_state(scene));
  const auto made = model_of(scene, trial_evolution());
  if (!made) return std::unexpected(made.error());
  return (*made)->energy(active_state(scene));
}

double Session::largest_displacement(int surface) const {
  const SceneSurface& s = state().surfaces[static_cast<std::size_t>(surface)];
  return largest_distance(*s.current, *s.opened);
}

int moved_control_points(const SceneSurface& s) {
  const Points &opened = s.opened->control_points(), &current = s.current->control_points();
  if (s.opened->knots() != s.current->knots()) return static_cast<int>(current.rows());
  const auto weight = [](const Surface& shape, Eigen::Index i) {
    return shape.rational() ? shape.weights()[static_cast<std::size_t>(i)] : 1;
  };
  int moved = 0;
  for (Eigen::Index i = 0; i < opened.rows(); ++i) {
    moved += std::memcmp(opened.data() + 3 * i, current.data() + 3 * i, 3 * sizeof(double)) != 0 ||
             weight(*s.opened, i) != weight(*s.current, i);
  }
  return moved;
}

int Session::moved_control_points(int surface) const {
  return knead::moved_control_points(state().surfaces[static_cast<std::size_t>(surface)]);
}

// What a session shows of its state

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
