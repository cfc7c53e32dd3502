#include "refine.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "knead/spline/spline_refinement.hpp"
#include "scene/places.hpp"
#include "session/acts/limits.hpp"
#include "session/acts/refining.hpp"
#include "session/acts/selection.hpp"

namespace knead {

std::span<const Choice> choices(RefinePermission) {
  static constexpr Choice list[] = {{"auto", RefinePermission::automatic,
                                     "from now on commands refine what they need (under a tool, at "
                                     "seams, for `mirror`), up to 40000 control points or four "
                                     "times those in the file"},
                                    {"never", RefinePermission::never, "they say what is missing"},
                                    {"trims", RefinePermission::trims,
                                     "only between a tool and held edges of faces, and at seams "
                                     "under strokes whose nets have too little in common"}};
  return list;
}

void describe(RefineCommand& c, Fields& fields) {
  fields.name("refine", "refine the net without changing the shape");
  fields.add("region", c.region,
             {.help = "`[[s0, s1], [t0, t1]]`: halves the spans there",
              .unit = Unit::fraction,
              .range = between(0, 1)});
  fields.add("under", c.under, {.help = "name of a tool: halves the spans that it reaches"});
  fields.add("knots_u", c.knots_u, {.help = "knots to insert in u, as parameters of the file"});
  fields.add("knots_v", c.knots_v, {.help = "knots to insert in v"});
  fields.add("permission", c.permission,
             {.help = "what steps may refine from here on", .fallback = "`\"trims\"`"});
}

namespace {

bool names_nothing(const RefineCommand& c) {
  return !c.under && !c.region && c.knots_u.empty() && c.knots_v.empty();
}

/// Halves all spans of the selected curve or volume.
Expected<void> halve(Act& act, const RefineCommand& c) {
  constexpr const char* all = "leave it out: every span is halved";
  if (c.under) return of_surfaces(act, "under", all);
  if (c.region) return of_surfaces(act, "region", all);
  if (!names_nothing(c)) return of_surfaces(act, c.knots_u.empty() ? "knots_v" : "knots_u", all);
  SceneBody& chosen = *body(act);
  const std::string& id = common_of(chosen).id;
  double size = 1;
  for (const int n : net_of(chosen)) size *= 2.0 * n;
  if (size > static_cast<double>(max_net_size)) {
    return input_error(fmt::format("the net could get more than {} control points", max_net_size),
                       id, "work on a smaller net");
  }
  if (auto status = halve_spans(chosen); !status) return status;
  act.state.notes.push_back(
      fmt::format("{}: the net is now {}", id, fmt::join(net_of(chosen), " by ")));
  return {};
}

}  // namespace

Expected<void> execute(const RefineCommand& c, Act& act) {
  if (act.state.body && (!c.permission || !names_nothing(c))) return halve(act, c);
  if (c.permission) act.state.permission = *c.permission;
  const bool knots = !c.knots_u.empty() || !c.knots_v.empty();
  const int ways = static_cast<int>(c.region.has_value()) + static_cast<int>(c.under.has_value()) +
                   static_cast<int>(knots);
  if (ways == 0 && c.permission) return {};
  if (ways != 1) {
    return input_error("what to refine is not clear", "region",
                       "give one of region, under, and knots_u with knots_v");
  }
  if (auto surface = selected(act); !surface) return std::unexpected(surface.error());
  if (c.under) {
    auto tool = find_tool(act, c.under);
    if (!tool) return std::unexpected(tool.error());
    const auto any = refine_under(act, **tool);
    if (!any) return std::unexpected(any.error());
    if (!*any)
      return input_error(fmt::format("the tool {} does not reach the surface", *c.under), "under",
                         "move it nearer");
    return {};
  }
  for (SceneSurface& s : selected_surfaces(act.state)) {
    Expected<void> status;
    if (c.region) {
      const auto region = region_at(*s.current, *c.region);
      if (!region) return std::unexpected(region.error());
      status = change_net(act, s,
                          [&](const Surface& shape) { return refine_region<2>(shape, *region); });
    } else {
      const auto [m, n] = s.current->net();
      const auto finer = [](int count, const std::vector<double>& added) {
        return count + static_cast<int>(std::min<std::size_t>(added.size(), max_net_size));
      };
      if (auto fits = check_net_size({finer(m, c.knots_u), finer(n, c.knots_v)}); !fits)
        return fits;
      status = change_net(act, s, [&](const Surface& shape) {
        return insert_knots<2>(shape, {c.knots_u, c.knots_v});
      });
    }
    if (!status) return status;
  }
  return {};
}

}  // namespace knead
