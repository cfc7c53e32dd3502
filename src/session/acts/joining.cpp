#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "knead/session/session.hpp"
#include "session/commands.hpp"
#include "session/session_state.hpp"

namespace knead {
namespace {

/// Whether the second stroke continues the first, so that one stroke along both paths is
/// equivalent.
bool goes_on(const StrokeCommand& first, const StrokeCommand& second) {
  return first.open.value_or(false) && first.tool == second.tool &&
         first.relative == second.relative && first.plasticity == second.plasticity &&
         first.steps == second.steps && first.plastic == second.plastic;
}

/// The same for a brush: all but the path and what a hand changes as it goes is the same.
bool goes_on(const BrushCommand& first, const BrushCommand& second) {
  BrushCommand like = second;
  like.path = first.path;
  like.surface = first.surface;
  like.surfaces = first.surfaces;
  like.pressure = first.pressure;
  like.tilt = first.tilt;
  like.open = first.open;
  like.allow = first.allow;
  like.by = first.by;
  like.angle = first.angle;
  like.factor = first.factor;
  return first.open.value_or(false) && like == first;
}

/// The surface of each point of the path of a brush.
std::vector<std::string> surfaces_of(const BrushCommand& c, const Scene& scene) {
  if (!c.surfaces.empty()) return c.surfaces;
  return {c.path.size(),
          c.surface.value_or(scene.surfaces[static_cast<std::size_t>(*scene.selected)].id)};
}

/// Puts the path of one command before that of the one that goes on with it.
void prepend(const StrokeCommand& first, const Scene&, StrokeCommand& both) {
  both.path.insert(both.path.begin(), first.path.begin(), first.path.end());
}
void prepend(const BrushCommand& first, const Scene& scene, BrushCommand& both) {
  const auto one_after_the_other = [&]<class T>(std::vector<T> before, std::vector<T>& after,
                                                const T& without) {
    if (before.empty() && after.empty()) return;
    before.resize(first.path.size(), without);
    after.resize(both.path.size(), without);
    after.insert(after.begin(), before.begin(), before.end());
  };
  one_after_the_other(first.pressure, both.pressure, 1.0);
  one_after_the_other(first.tilt, both.tilt, Vector3{});
  if (first.surface != both.surface || !first.surfaces.empty() || !both.surfaces.empty()) {
    std::vector<std::string> surfaces = surfaces_of(first, scene), more = surfaces_of(both, scene);
    surfaces.insert(surfaces.end(), more.begin(), more.end());
    both.surface.reset();
    both.surfaces = std::move(surfaces);
  }
  both.path.insert(both.path.begin(), first.path.begin(), first.path.end());
}

/// One command for two where the second goes on with the first.
template <class C>
std::optional<C> one_of(const Command& first, const Command& second, const Scene& scene) {
  const C* const down = fields_of<C>(first);
  const C* const on = fields_of<C>(second);
  if (down == nullptr || on == nullptr || !goes_on(*down, *on)) return std::nullopt;
  C both = *on;
  prepend(*down, scene, both);
  return both;
}

}  // namespace

// The last two entries become one, and the state between them goes. Commands become one where that
// is the same by construction: steps with equal settings add their counts, strokes and brushes that
// go on join their paths. Others stand one after the other in the entry.
void Session::join() {
  if (position_ < floor_ + 2 || can_redo()) return;
  std::vector<Command> last = std::move(entries_.back());
  entries_.pop_back();
  std::vector<Command>& entry = entries_.back();
  auto first = last.begin();
  const auto* before = fields_of<StepCommand>(entry.back());
  const auto* after = fields_of<StepCommand>(*first);
  if (before && after && before->lambda == after->lambda && before->weight == after->weight &&
      before->allow == after->allow &&
      before->count <= std::numeric_limits<int>::max() - after->count) {
    StepCommand both = *before;
    both.count += after->count;
    entry.back() = make_command(both);
    ++first;
  }
  if (first != last.end()) {
    if (const auto stroke = one_of<StrokeCommand>(entry.back(), *first, state())) {
      entry.back() = make_command(*stroke);
      ++first;
    } else if (const auto brush = one_of<BrushCommand>(entry.back(), *first, state())) {
      entry.back() = make_command(*brush);
      ++first;
    }
  }
  entry.insert(entry.end(), first, last.end());
  states_.erase(states_.end() - 2);
  --position_;
}

}  // namespace knead
