// A session as bytes: all states of its history, with every number as it is.
#include <algorithm>

#include "described_archive.hpp"
#include "described_state.hpp"
#include "knead/session/command_json.hpp"
#include "knead/spline/extremum.hpp"

namespace knead {

/// What comes before the states.
struct SnapshotHead {
  int surfaces = 0;     ///< of the document, as opened
  std::string earlier;  ///< commands that cannot be undone, as JSON
  int position = 0;
  std::vector<std::string> entries;  ///< commands of each
};
static void describe(SnapshotHead& h, Fields& fields) {
  fields.add_all("surfaces", h.surfaces, "earlier", h.earlier, "position", h.position, "entries",
                 h.entries);
}

namespace {

/// With the version of the form, in a hexadecimal digit; no other is read.
constexpr std::string_view any_magic = "Knead snapshot ", magic = "Knead snapshot e\n";
constexpr std::size_t sum_size = sizeof(std::uint64_t);

/// What the states of a snapshot may need.
constexpr std::size_t most_memory = std::size_t{1} << 30U;

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

std::vector<std::string> converted_in(const SessionState& state) {
  return state.document ? state.document->converted() : std::vector<std::string>();
}

// --- what is read fits together
// --------------------------------------------------------------------------------------

// Bytes that pass the checksum may still be made by hand: whatever code later relies on without a
// test is tested here, once.
bool fits(const SceneSurface& s) {
  if (!s.mask.empty() && s.mask.size() != static_cast<std::size_t>(s.current->size())) return false;
  for (std::size_t d = 0; d < 2; ++d) {  // shapes are compared at equal parameters
    const Interval domain = s.current->knots()[d].domain(), first = s.opened->knots()[d].domain();
    if (first.lower != domain.lower || first.upper != domain.upper) return false;
  }
  // `opened` may differ otherwise once the basis was edited.
  return s.reference->net() == s.current->net() && s.rest->net() == s.current->net();
}

/// Whether what is read of a curve or volume fits its net.
template <int D>
bool fits(const SceneShape<D>& s) {
  const auto net = s.current->net();
  const auto on_net = [&](const auto& spline) { return spline->net() == net; };
  for (const auto& pin : s.pins) {
    for (std::size_t d = 0; d < net.size(); ++d) {
      if (pin[d] < 0 || pin[d] >= net[d]) return false;
    }
  }
  return on_net(s.opened) && on_net(s.reference) && on_net(s.rest) &&
         std::ranges::all_of(s.constraints, [&](const auto& kept) { return on_net(kept.where); }) &&
         (s.velocity.rows() == 0 || s.velocity.rows() == s.current->size());
}

/// Whether a lattice has the control points that its net says, and a shape before and after of each
/// of its surfaces.
bool fits(const PulledLattice& lattice) {
  double count = 1;
  for (const int n : lattice.net) count *= n;
  if (static_cast<double>(lattice.points.rows()) != count || !lattice.points.allFinite())
    return false;
  const std::size_t surfaces = lattice.surfaces.size();
  if (lattice.before.size() != surfaces || lattice.after.size() != surfaces) return false;
  for (std::size_t k = 0; k < surfaces; ++k) {
    if (!same_basis(*lattice.before[k], *lattice.after[k])) return false;
  }
  return surfaces > 0;
}

/// Whether the shapes from before a stroke are on the nets of the selected surfaces; all of their
/// control points.
std::optional<Eigen::Index> rows_of(const std::vector<OpenStroke::Before>& shapes,
                                    const Scene& scene) {
  const std::vector<int> selection = scene.selection();
  if (shapes.size() != selection.size()) return std::nullopt;
  Eigen::Index rows = 0;
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const Surface& shape = *scene.surfaces[static_cast<std::size_t>(selection[k])].current;
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

bool fits(const OpenBrush& open, const Scene& scene) {
  const std::vector<int> selection = scene.selection();
  if (open.masks.size() != selection.size()) return false;
  const auto is_selected = [&](const BrushPoint& p) {
    return std::ranges::find(selection, p.surface) != selection.end();
  };
  const auto& [columns, heights] = open.brush.pattern;
  if (open.brush.kind == BrushKind::stamp &&
      (columns < 2 || heights.size() < 4 ||
       heights.size() % static_cast<std::size_t>(columns) != 0)) {
    return false;
  }
  return rows_of(open.before, scene) && open.brush.radius > 0 &&
         std::ranges::all_of(open.path, is_selected);
}

/// Whether a scene fits together; what it shares with the one before does.
bool fits(const Scene& scene, const Scene& before) {
  const auto known = [](const auto& items, int k) { return k >= 0 && k < std::ssize(items); };
  const auto known_surface = [&](int k) {
    return k >= 0 && static_cast<std::size_t>(k) < scene.surfaces.size();
  };
  for (std::size_t k = 0; k < scene.surfaces.size(); ++k) {
    const SceneSurface& s = scene.surfaces[k];
    if ((k >= before.surfaces.size() || &s != &before.surfaces[k]) && !fits(s)) return false;
  }
  for (const SceneBody& b : scene.bodies) {
    if (!std::visit([](const auto& s) { return fits(s); }, b)) return false;
  }
  for (const SceneForce& f : scene.forces) {
    if (f.surface == -1 ? !known(scene.bodies, f.body) : !known_surface(f.surface) || f.body != -1)
      return false;
  }
  const auto is_share = [](double t) { return t > 0 && t <= 1; };
  return std::ranges::all_of(scene.selection(), known_surface) &&
         (!scene.body || (known(scene.bodies, *scene.body) && !scene.selected)) &&
         std::ranges::all_of(scene.probes, known_surface, &Probe::surface) &&
         is_share(scene.coupling.position) && is_share(scene.coupling.tangent) &&
         scene.bend >= asked_angle && scene.bend <= accepted_angle &&
         (!scene.stroke || fits(*scene.stroke, scene)) &&
         (!scene.brush || fits(*scene.brush, scene)) && (!scene.lattice || fits(*scene.lattice));
}

/// Reads a state into one that is as the one before.
void read_state(StateReader& a, const Document& opened, SessionState& state, Weight& weight) {
  const Scene before = state;
  const std::vector<std::string> known = converted_in(state);
  std::vector<std::string> converted = known;
  a.read(type_of<SessionState>(), &state);
  a.read(type_of<std::vector<std::string>>(), &converted);
  if (!a.bad()) a.takes_memory(sizeof state + weight.of(type_of<SessionState>(), &state));
  if (a.bad() || !fits(state, before)) return static_cast<void>(a.fail());
  if (converted == known) return;
  state.document.reset();
  if (converted.empty()) return;
  auto document = opened.with_splines(converted);
  if (!document) return static_cast<void>(a.fail());
  state.document = std::make_shared<const Document>(std::move(*document));
}

std::vector<Command> read_commands_of(StateReader& a, const std::string& listed) {
  auto parsed = parse_commands(listed);
  if (!parsed) a.fail();
  return parsed ? std::move(*parsed) : std::vector<Command>{};
}

std::unexpected<Error> damaged(const std::string& what) {
  return input_error(what, "snapshot", "replay the commands of the session instead");
}

}  // namespace

// Each state is written as its difference from the one before, and a spline that several states
// share once: the size grows with what changed, not with the length of the history.
std::string Session::snapshot(std::size_t history_bytes) const {
  // How far back: the newest states that fit.
  std::size_t first = position_, bytes = 0;
  Weight weight;
  for (std::size_t k = states_.size(); k-- > 0;) {
    bytes += weight.of(type_of<SessionState>(), states_[k].get());
    if (k < position_ && bytes > history_bytes) break;
    first = std::min(first, k);
  }
  std::vector<Command> earlier = earlier_;
  for (std::size_t k = 0; k < first; ++k)
    earlier.insert(earlier.end(), entries_[k].begin(), entries_[k].end());
  SnapshotHead head{static_cast<int>(document_.surfaces().size()),
                    commands_json(earlier),
                    static_cast<int>(position_ - first),
                    {}};
  for (std::size_t k = first; k < entries_.size(); ++k)
    head.entries.push_back(commands_json(entries_[k]));
  StateWriter a(std::string(magic) + std::string(sum_size, '\0'));
  a.write(type_of<SnapshotHead>(), &head, type_of<SnapshotHead>().initial);
  const auto* before = static_cast<const SessionState*>(type_of<SessionState>().initial);
  for (std::size_t k = first; k < states_.size(); ++k) {
    const std::vector<std::string> converted = converted_in(*states_[k]),
                                   known = converted_in(*before);
    a.write(type_of<SessionState>(), states_[k].get(), before);
    a.write(type_of<std::vector<std::string>>(), &converted, &known);
    before = states_[k].get();
  }
  std::string& out = a.out();
  const std::uint64_t sum = checksum(std::string_view(out).substr(magic.size() + sum_size));
  std::memcpy(out.data() + magic.size(), &sum, sum_size);
  return std::move(out);
}

Expected<Session> Session::restore(Document document, std::string_view bytes) {
  if (!bytes.starts_with(magic)) {
    return damaged(bytes.starts_with(any_magic)
                       ? "the snapshot is of another version of the program"
                       : "these bytes are not a snapshot");
  }
  bytes.remove_prefix(magic.size());
  std::uint64_t sum = 0;
  if (bytes.size() >= sum_size) std::memcpy(&sum, bytes.data(), sum_size);
  if (bytes.size() < sum_size || checksum(bytes.substr(sum_size)) != sum)
    return damaged("the snapshot is damaged");
  StateReader a(bytes.substr(sum_size), most_memory);
  SnapshotHead head;
  a.read(type_of<SnapshotHead>(), &head);
  if (!a.bad() && static_cast<std::size_t>(head.surfaces) != document.surfaces().size()) {
    return damaged("the snapshot belongs to another document");
  }
  Session session(std::move(document));
  session.states_.clear();
  if (!a.bad()) session.earlier_ = read_commands_of(a, head.earlier);
  session.position_ = static_cast<std::size_t>(head.position);
  for (const std::string& entry : head.entries)
    session.entries_.push_back(read_commands_of(a, entry));
  SessionState state;
  Weight weight;
  for (std::size_t k = 0; k <= session.entries_.size() && !a.bad(); ++k) {
    read_state(a, session.document_, state, weight);
    session.states_.push_back(std::make_shared<const SessionState>(state));
  }
  if (a.bad() || !a.rest().empty() || session.position_ > session.entries_.size()) {
    return damaged("the snapshot contains data unknown to this program");
  }
  session.know_faces();
  return session;
}

}  // namespace knead
