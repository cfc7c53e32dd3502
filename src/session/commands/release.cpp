#include "release.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "session/acts/selection.hpp"

namespace knead {
namespace {

constexpr Choice kinds[] = {{"hold", "rows and edges of faces"},
                            {"pins", "control points and points"},
                            {"edges", "edges, ends and sides"},
                            {"freeze", "regions"},
                            {"keep", "curves"},
                            {"symmetry", "at edges and between mirror images"},
                            {"mask", "what brushes have painted"}};

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

}  // namespace

void describe(ReleaseCommand& c, Fields& fields) {
  fields.name("release", "free what is held, pinned, frozen, kept or masked");
  fields.add("what", c.what, {.help = "what of it", .fallback = "all of it", .choices = kinds});
}

Expected<void> execute(const ReleaseCommand& c, Act& act) {
  if (auto some = some_selected(act); !some) return some;
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
