#include "release.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace knead {
namespace {

constexpr std::string_view kinds[] = {"hold", "pins", "edges", "freeze", "keep", "symmetry", "mask"};

/// The name of a constraint in `release`.
struct KindOf {
  std::string_view operator()(const EdgeHold&) const { return "edges"; }
  std::string_view operator()(const PointPin&) const { return "pins"; }
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
  fields.add(
      "what", c.what,
      {.help = "some of `hold`, `pins`, `edges`, `freeze`, `keep`, `symmetry`, `mask`", .fallback = "all of them"});
}

Expected<void> check_release(const ReleaseCommand& c) {
  const std::vector<std::string> what = c.what.value_or(std::vector<std::string>{});
  for (std::size_t k = 0; k < what.size(); ++k) {
    if (std::ranges::find(kinds, what[k]) != std::end(kinds)) continue;
    return input_error(fmt::format("\"{}\" cannot be released", what[k]), fmt::format("what[{}]", k),
                       "use hold, pins, edges, freeze, keep, symmetry or mask");
  }
  return {};
}

template <>
Expected<void> Executor::execute(const ReleaseCommand& c) {
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  if (auto known = check_release(c); !known) return known;
  const auto meant = [&](std::string_view kind) {
    return !c.what || std::ranges::find(*c.what, kind) != c.what->end();
  };
  for (int k : state.selection()) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(k)];
    if (meant("hold")) s.hold_rows = 0;
    if (meant("pins")) s.pins.clear();
    if (meant("mask")) s.mask.clear();
    std::erase_if(s.constraints, [&](const KeptConstraint& kept) {
      const auto* edges = std::get_if<TrimHolds>(&kept.constraint);
      return !(edges != nullptr && edges->order < 0) && meant(std::visit(KindOf{}, kept.constraint));
    });
  }
  return {};
}

}  // namespace knead
