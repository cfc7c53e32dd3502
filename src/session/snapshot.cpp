// A session as bytes: all states of its history, with every number as it is.
#include "archive_shapes.hpp"
#include "knead/session/session.hpp"

namespace knead {
namespace {

using archive::choice;
using archive::list;
using archive::pass;
using archive::Reader;
using archive::Writer;

/// With the version of the form, in a hexadecimal digit; no other is read.
constexpr std::string_view any_magic = "Knead snapshot ", magic = "Knead snapshot c\n";

/// FNV-1a over words of eight bytes: detects damage, not tampering.
std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (std::size_t k = 0; k < bytes.size(); k += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + k, std::min<std::size_t>(8, bytes.size() - k));
    hash = (hash ^ word) * 0x100000001b3U;
  }
  return hash ^ bytes.size();
}

std::size_t size_of(const Surface& s) {
  return static_cast<std::size_t>(s.size()) * sizeof(double) * (s.rational() ? 4 : 3) +
         (s.knots(0).knots().size() + s.knots(1).knots().size()) * sizeof(double);
}

/// The part of a state that is not shared with the one before it: steps are appended, most surfaces stay.
struct Neighbour {
  const SharedList<StepRecord>* steps = nullptr;
  std::vector<std::string> surfaces, bodies;  // as bytes
};

/// Writes those items that are not the same as before.
template <class Items>
void write_changed(Writer& a, const Items& items, std::vector<std::string>& before) {
  std::vector<std::string> written;
  a.count(items.size());
  for (std::size_t k = 0; k < items.size(); ++k) {
    const std::string sofar = a.take();
    pass(a, items[k]);
    written.push_back(a.take());
    const bool same = k < before.size() && before[k] == written.back();
    a.bytes(sofar.data(), sofar.size());
    a.flag(same);
    if (!same) a.bytes(written.back().data(), written.back().size());
  }
  before = std::move(written);
}

/// Reads those items that are not the same as before, and what `check` says of each.
template <class Items, class Check>
void read_changed(Reader& a, Items& items, const Check& check) {
  const std::size_t known = items.size();
  items.resize(a.length(1));
  for (std::size_t k = 0; k < items.size() && !a.bad(); ++k) {
    bool same = false;
    a.flag(same);
    if (same && k >= known) return a.fail();
    if (same) continue;
    items[k] = {};
    pass(a, items[k]);
    if (!a.bad() && !check(items[k])) a.fail();
  }
}

void write_state(Writer& a, const SessionState& state, Neighbour& before) {
  const auto& [selected, together, surfaces, tools, forces, load, limit, evolution, scaling, seams, permission, probes,
               followed, coupling, bend, stroke, brush, bodies, body, lattice] = static_cast<const Scene&>(state);
  const auto& [steps, seam_reports, notes, energy_before, modes, buckling] = static_cast<const SessionRecord&>(state);
  archive::optional(a, selected);
  list(a, together);
  write_changed(a, surfaces, before.surfaces);
  a.count(tools.size());
  for (const Tool& tool : tools) pass(a, tool);
  list(a, forces);
  archive::command<LoadCommand>(a, load);
  archive::optional(a, limit);
  archive::command<EvolveCommand>(a, evolution);
  choice(a, scaling, ScalingMode::raw);
  archive::command<SeamsCommand>(a, seams);
  choice(a, permission, RefinePermission::trims);
  list(a, probes);
  archive::optional(a, stroke);
  a.count(followed.size());
  for (const FollowedEdge& edge : followed) a.text(edge.id);
  a.number(coupling.position);
  archive::optional(a, brush);
  a.number(coupling.tangent);
  a.number(bend);
  std::size_t shared = 0;
  if (before.steps != nullptr) {
    const std::size_t most = std::min(steps.size(), before.steps->size());
    while (shared < most && steps[shared] == (*before.steps)[shared]) ++shared;
  }
  before.steps = &steps;
  a.count(shared);
  a.count(steps.size() - shared);
  for (std::size_t k = shared; k < steps.size(); ++k) pass(a, steps[k]);
  list(a, seam_reports);
  list(a, notes);
  archive::optional(a, energy_before);
  const auto converted = state.document ? state.document->converted() : std::vector<std::string>();
  list(a, converted);
  list(a, modes);
  list(a, buckling);
  write_changed(a, bodies, before.bodies);
  archive::optional(a, body);
  archive::optional(a, lattice);
}

/// Whether the shapes from before a stroke are on the nets of the selected surfaces; all of their control points.
std::optional<Eigen::Index> rows_of(const std::vector<OpenStroke::Before>& shapes, const Scene& scene) {
  const std::vector<int> selection = scene.selection();
  if (shapes.size() != selection.size()) return std::nullopt;
  Eigen::Index rows = 0;
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const auto index = static_cast<std::size_t>(selection[k]);
    if (selection[k] < 0 || index >= scene.surfaces.size()) return std::nullopt;
    const Surface& shape = *scene.surfaces[index].current;
    for (const auto& before : {shapes[k].rest, shapes[k].current}) {
      if (before->net() != shape.net()) return std::nullopt;
    }
    rows += shape.size();
  }
  return rows;
}

/// Whether an open stroke fits the selected surfaces and an existing tool.
bool fits(const OpenStroke& stroke, const Scene& scene) {
  const auto rows = rows_of(stroke.before, scene);
  if (!rows || !(stroke.path.spacing > 0)) return false;
  if (stroke.last.rows() != 0 && stroke.last.rows() != *rows) return false;
  return stroke.history.rows() == *rows &&
         std::ranges::any_of(scene.tools, [&](const Tool& t) { return t.name == stroke.tool; });
}

bool fits(const OpenBrush& brush, const Scene& scene) {
  const std::vector<int> selection = scene.selection();
  if (brush.masks.size() != selection.size()) return false;
  const auto is_selected = [&](const BrushPoint& p) {
    return std::ranges::find(selection, p.surface) != selection.end();
  };
  return rows_of(brush.before, scene) && brush.brush.radius > 0 && std::ranges::all_of(brush.path, is_selected);
}

/// The document with these surfaces converted; that of the state before if they are the same.
void read_converted(Reader& a, const Document& opened, SessionState& state) {
  std::vector<std::string> converted;
  list(a, converted);
  if (a.bad() || converted == (state.document ? state.document->converted() : std::vector<std::string>{})) return;
  state.document.reset();
  if (converted.empty()) return;
  auto document = opened.with_splines(converted);
  if (!document) return a.fail();
  state.document = std::make_shared<const Document>(std::move(*document));
}

/// Reads a state into one that starts as a copy of the previous one.
void read_state(Reader& a, const Document& opened, SessionState& state) {
  auto& [selected, together, surfaces, tools, forces, load, limit, evolution, scaling, seams, permission, probes,
         followed, coupling, bend, stroke, brush, bodies, body, lattice] = static_cast<Scene&>(state);
  auto& [steps, seam_reports, notes, energy_before, modes, buckling] = static_cast<SessionRecord&>(state);
  selected.reset();
  archive::optional(a, selected);
  list(a, together);
  read_changed(a, surfaces, [](const SceneSurface& s) {
    if (!s.mask.empty() && s.mask.size() != static_cast<std::size_t>(s.current->size())) return false;
    for (std::size_t d = 0; d < 2; ++d) {  // shapes are compared at equal parameters
      const Interval domain = s.current->knots()[d].domain(), first = s.opened->knots()[d].domain();
      if (first.lower != domain.lower || first.upper != domain.upper) return false;
    }
    // `opened` may differ otherwise once the basis was edited.
    return s.reference->net() == s.current->net() && s.rest->net() == s.current->net();
  });
  if (a.bad()) return;
  tools.clear();
  for (std::size_t k = a.length(4); k > 0 && !a.bad(); --k) {
    if (auto tool = archive::read_tool(a)) tools.push_back(std::move(*tool));
  }
  list(a, forces);
  archive::command<LoadCommand>(a, load);
  limit.reset();
  archive::optional(a, limit);
  archive::command<EvolveCommand>(a, evolution);
  choice(a, scaling, ScalingMode::raw);
  archive::command<SeamsCommand>(a, seams);
  choice(a, permission, RefinePermission::trims);
  probes.clear();
  stroke.reset();
  brush.reset();
  list(a, probes);
  archive::optional(a, stroke);
  followed.clear();
  followed.resize(a.length(4));
  for (FollowedEdge& edge : followed) a.text(edge.id);
  coupling = Scene{}.coupling;
  a.number(coupling.position);
  archive::optional(a, brush);
  a.number(coupling.tangent);
  a.number(bend);
  if (!(bend >= asked_angle && bend <= accepted_angle)) a.fail();
  for (const double t : {coupling.position, coupling.tangent}) {
    if (!(t > 0 && t <= 1)) a.fail();
  }
  std::size_t shared = 0;
  a.count(shared);
  if (shared > steps.size()) return a.fail();
  steps.truncate(shared);
  for (std::size_t more = a.length(4); more > 0 && !a.bad(); --more) {
    StepRecord step;
    pass(a, step);
    steps.push_back(std::move(step));
  }
  list(a, seam_reports);
  notes.clear();
  list(a, notes);
  energy_before.reset();
  archive::optional(a, energy_before);
  read_converted(a, opened, state);
  modes.clear();
  buckling.clear();
  list(a, modes, 20);
  list(a, buckling, 20);
  body.reset();
  read_changed(a, bodies, archive::fits);
  archive::optional(a, body);
  if (body && (*body < 0 || *body >= static_cast<int>(bodies.size()) || selected)) a.fail();
  lattice.reset();
  archive::optional(a, lattice);
  if (lattice && !a.bad() && !archive::is_whole(*lattice)) a.fail();
  for (int k : state.selection()) {
    if (k < 0 || k >= static_cast<int>(surfaces.size())) a.fail();
  }
  if (stroke && !a.bad() && !fits(*stroke, state)) a.fail();
  if (brush && !a.bad() && !fits(*brush, state)) a.fail();
  const auto known_surface = [&surfaces](int k) { return k >= 0 && k < static_cast<int>(surfaces.size()); };
  for (const SceneForce& f : forces) {
    const bool on_body = f.body >= 0 && f.body < static_cast<int>(bodies.size()) && f.surface == -1;
    if (!on_body && !(known_surface(f.surface) && f.body == -1)) a.fail();
  }
  for (const Probe& p : probes) {
    if (!known_surface(p.surface)) a.fail();
  }
}

std::unexpected<Error> damaged(const std::string& what) {
  return input_error(what, "snapshot", "replay the commands of the session instead");
}

}  // namespace

std::string Session::snapshot(std::size_t history_bytes) const {
  // How far back: the newest states whose surfaces fit.
  std::size_t first = position_, bytes = 0;
  std::unordered_map<const Surface*, bool> seen;
  for (std::size_t k = states_.size(); k-- > 0;) {
    for (const SceneSurface& s : states_[k]->surfaces) {
      for (const auto& shape : {s.opened, s.reference, s.rest, s.current}) {
        if (seen.try_emplace(shape.get(), true).second) bytes += size_of(*shape);
      }
      bytes += static_cast<std::size_t>(s.velocity.size()) * sizeof(double);
    }
    if (states_[k]->lattice) {
      for (const auto& shape : states_[k]->lattice->before) {
        if (seen.try_emplace(shape.get(), true).second) bytes += size_of(*shape);
      }
    }
    for (const SceneBody& b : states_[k]->bodies) {
      bytes += 4 * static_cast<std::size_t>(control_points_of(b).size()) * sizeof(double);
    }
    if (k < position_ && bytes > history_bytes) break;
    first = std::min(first, k);
  }
  Writer a;
  std::vector<Command> earlier = earlier_;
  for (std::size_t k = 0; k < first; ++k) earlier.insert(earlier.end(), entries_[k].begin(), entries_[k].end());
  a.text(commands_json(earlier));
  a.count(position_ - first);
  a.count(entries_.size() - first);
  for (std::size_t k = first; k < entries_.size(); ++k) a.text(commands_json(entries_[k]));
  Neighbour before;
  for (std::size_t k = first; k < states_.size(); ++k) write_state(a, *states_[k], before);
  const std::string body = a.take();
  a.count(document_.surfaces().size());
  const std::vector<std::shared_ptr<const Surface>> surfaces = a.surfaces();
  a.count(surfaces.size());
  for (const auto& s : surfaces) archive::write_spline<2>(a, *s);
  a.bytes(body.data(), body.size());
  const std::string content = a.take();
  a.bytes(magic.data(), magic.size());
  const std::uint64_t sum = checksum(content);
  a.bytes(&sum, sizeof sum);
  a.bytes(content.data(), content.size());
  return a.take();
}

Expected<Session> Session::restore(Document document, std::string_view bytes) {
  if (!bytes.starts_with(magic)) {
    return damaged(bytes.starts_with(any_magic) ? "the snapshot is of another version of the program"
                                                : "these bytes are not a snapshot");
  }
  bytes.remove_prefix(magic.size());
  std::uint64_t sum = 0;
  std::vector<std::shared_ptr<const Surface>> surfaces;
  Reader head(bytes, surfaces);
  head.bytes(&sum, sizeof sum);
  if (head.bad() || checksum(head.rest()) != sum) return damaged("the snapshot is damaged");
  std::size_t opened = 0;
  head.count(opened);
  if (opened != document.surfaces().size()) return damaged("the snapshot belongs to another document");
  for (std::size_t k = head.length(8); k > 0; --k) {
    auto surface = archive::read_spline<2>(head);
    if (!surface) return damaged("the snapshot contains an invalid surface");
    surfaces.push_back(std::move(surface));
  }
  Reader a(head.rest(), surfaces);
  Session session(std::move(document));
  session.states_.clear();
  const auto commands = [&a]() -> std::vector<Command> {
    std::string listed;
    a.text(listed);
    if (a.bad()) return {};
    auto parsed = parse_commands(listed);
    if (!parsed) a.fail();
    return parsed ? std::move(*parsed) : std::vector<Command>{};
  };
  session.earlier_ = commands();
  a.count(session.position_);
  for (std::size_t k = a.length(8); k > 0 && !a.bad(); --k) session.entries_.push_back(commands());
  SessionState state;
  for (std::size_t k = 0; k <= session.entries_.size() && !a.bad(); ++k) {
    read_state(a, session.document_, state);
    session.states_.push_back(std::make_shared<const SessionState>(state));
  }
  if (a.bad() || !a.at_end() || session.position_ > session.entries_.size()) {
    return damaged("the snapshot contains data unknown to this program");
  }
  session.know_faces();
  return session;
}

}  // namespace knead
