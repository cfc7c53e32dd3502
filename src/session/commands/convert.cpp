#include "convert.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "knead/brep/face_conversion.hpp"
#include "session/acts/converting.hpp"
#include "session/acts/selection.hpp"
#include "session/acts/trimming.hpp"

namespace knead {
namespace {

/// The surfaces of other forms that meet the selected ones; those that cannot be converted are
/// noted.
Expected<std::vector<std::string>> neighbours(Act& act) {
  if (auto surface = selected(act); !surface) return std::unexpected(surface.error());
  std::vector<std::string> result;
  const brep::Model* const model = act.document.model();
  const auto others =
      model == nullptr ? std::vector<brep::OtherSurface>() : brep::other_surfaces(*model);
  for (const int k : act.state.selection()) {
    const auto region = visible(act, act.state.surfaces[static_cast<std::size_t>(k)]);
    if (!region) return std::unexpected(region.error());
    for (const TrimEdge& edge : (*region)->edges) {
      for (const std::string& support : edge.supports) {
        const std::string id = id_of_support(support);
        if (std::ranges::find(others, id, &brep::OtherSurface::id) == others.end()) continue;
        if (std::ranges::find(result, id) == result.end()) result.push_back(id);
      }
    }
  }
  std::erase_if(result, [&](const std::string& id) {
    const auto made = brep::exact_spline(*model, id);
    if (!made)
      act.state.notes.push_back(fmt::format("{} stays as it is: {}", id, made.error().what));
    return !made;
  });
  if (result.empty()) {
    return input_error(
        "the selected surfaces have no neighbour that could be converted", "neighbours",
        "their faces meet B-spline surfaces only, or what the notes of `knead info --faces` say");
  }
  return result;
}

/// The order at which the edges of the first selected surface are held; 0 where it holds none.
int order_of_holds(const SessionState& state) {
  int order = 0;
  if (!state.selected) return order;
  for (const KeptConstraint& kept :
       state.surfaces[static_cast<std::size_t>(*state.selected)].constraints) {
    if (const auto* holds = std::get_if<TrimHolds>(&kept.constraint))
      order = std::max(0, holds->order);
  }
  return order;
}

}  // namespace

void describe(ConvertCommand& c, Fields& fields) {
  fields.name("convert",
              "make planes, cylinders and the like exact B-spline surfaces that can be sculpted");
  fields.add("surface", c.surface,
             {.help = "id of the surface, or of a face on it, as `knead info --faces` lists them; "
                      "this, `surfaces` or `neighbours`"});
  fields.add("surfaces", c.surfaces, {.help = "several of them"});
  fields.add("neighbours", c.neighbours, {.help = "all that meet faces on the selected surfaces"});
}

Expected<void> execute(const ConvertCommand& c, Act& act) {
  std::vector<std::string> ids = c.surfaces.value_or(std::vector<std::string>{});
  if (c.surface) ids.insert(ids.begin(), *c.surface);
  if (c.neighbours) {
    const auto beside = neighbours(act);
    if (!beside) return std::unexpected(beside.error());
    ids.insert(ids.end(), beside->begin(), beside->end());
  }
  if (ids.empty()) {
    return input_error("the field is missing", "surface",
                       R"(give "surface", "surfaces" or "neighbours":true)");
  }
  return convert_surfaces(act, ids, order_of_holds(act.state));
}

}  // namespace knead
