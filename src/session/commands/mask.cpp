#include "mask.hpp"

#include <fmt/format.h>

#include <cmath>

#include "session/acts/limits.hpp"
#include "session/acts/selection.hpp"

namespace knead {
namespace {

constexpr double default_mask_radius = 0.02;  // of the diagonal

}  // namespace

std::span<const Choice> choices(MaskChange) {
  static constexpr Choice list[] = {
      {"clear", MaskChange::clear, "nothing is masked"},
      {"fill", MaskChange::fill, "everything is"},
      {"invert", MaskChange::invert, "what is masked is free, and the other way around"},
      {"blur", MaskChange::blur, "the mean within the radius"},
      {"grow", MaskChange::grow, "the largest within the radius"},
      {"shrink", MaskChange::shrink, "the smallest within the radius"}};
  return list;
}

void describe(MaskCommand& c, Fields& fields) {
  fields.name("mask", "change the mask of the selected surfaces, which `brush` paints, as a whole");
  fields.add("change", c.change, {.help = "how", .presence = Presence::required});
  fields.add("radius", c.radius,
             {.help = "of blur, grow and shrink, measured in space",
              .unit = Unit::length,
              .range = above(0),
              .fallback = "a fiftieth of the diagonal"});
  fields.add("relative", c.relative, {.help = "`radius` is a fraction of the diagonal"});
}

Expected<void> execute(const MaskCommand& c, Act& act) {
  if (auto surface = selected(act); !surface) return std::unexpected(surface.error());
  const auto length = diagonal(act);
  if (!length) return std::unexpected(length.error());
  const double radius =
      c.radius ? *c.radius * (c.relative ? *length : 1) : default_mask_radius * *length;
  if (auto possible = check_radius(radius); !possible) return possible;
  for (int k : act.state.selection()) {
    auto status = change_mask(act.state.surfaces[static_cast<std::size_t>(k)], c.change, radius);
    if (!status) return status;
  }
  return {};
}

}  // namespace knead
