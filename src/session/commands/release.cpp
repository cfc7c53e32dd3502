#include "release.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "session/acts/selection.hpp"

namespace knead {
namespace {

constexpr std::string_view kinds[] = {"hold", "pins", "edges", "freeze", "keep", "symmetry", "mask"};

/// The name of a constraint in `release`.
struct KindOf {
  std::string_view operator()(const EdgeHold&) const { return "edges"; }
  std::string_view operator()(const SideHold&) const { return "edges"; }
  template <int D>
  std::string_view operator()(const PointPinOf<D>&) const {
    return "pins";
  }
  std::string_view operator()(const Freeze&) const { return "freeze"; }
  std::string_view operator()(const Keep&) const { return "keep"; }
  std::string_view operator()(const EdgeSymmetry&) const { return "symmetry"; }
  std::string_view operator()(const MirrorSymmetry&) const { return "symmetry"; }
  std::string_view operator()(const TrimHolds&) const { return "hold"; }
  std::string_view operator()(const TrimEdgeHold&) const { return "edges"; }
};

/// Error (input): something is named that cannot be released.
Expected<void> check_release(const ReleaseCommand& c) {
  const std::vector<std::string> what = c.what.value_or(std::vector<std::string>{});
  for (std::size_t k = 0; k < what.size(); ++k) {
    if (std::ranges::find(kinds, what[k]) != std::end(kinds)) continue;
    return input_error(fmt::format("\"{}\" cannot be released", what[k]), fmt::format("what[{}]", k),
                       "use hold, pins, edges, freeze, keep, symmetry or mask");
  }
  return {};
}

}  // namespace

void describe(ReleaseCommand& c, Fields& fields) {
  fields.name("release", "free what is held, pinned, frozen, kept or masked");
  fields.add(
      "what", c.what,
      {.help = "some of `hold`, `pins`, `edges`, `freeze`, `keep`, `symmetry`, `mask`", .fallback = "all of them"});
}

Expected<void> execute(const ReleaseCommand& c, Act& act) {
  if (auto some = some_selected(act); !some) return some;
  if (auto known = check_release(c); !known) return known;
  const auto meant = [&](std::string_view kind) {
    return !c.what || std::ranges::find(*c.what, kind) != c.what->end();
  };
  return each_selected(act, [&]<int D>(SceneShape<D>& s) -> Expected<void> {
    if (meant("hold")) s.hold_rows = 0;
    if (meant("pins")) s.pins.clear();
    std::erase_if(s.constraints, [&](const KeptConstraintOf<D>& kept) {
      if constexpr (D == 2) {
        const auto* edges = std::get_if<TrimHolds>(&kept.constraint);
        if (edges != nullptr && edges->order < 0) return false;
      }
      return meant(std::visit(KindOf{}, kept.constraint));
    });
    if constexpr (D == 2) {
      if (meant("mask")) s.mask.clear();
    }
    return {};
  });
}

}  // namespace knead
