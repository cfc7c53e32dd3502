#include "select.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "knead/base/error_code.hpp"
#include "knead/energy/domain_scaling.hpp"
#include "session/acts/holding.hpp"
#include "session/acts/selection.hpp"

namespace knead {
namespace {

/// The indices, followed by those of all surfaces that seams connect with them, except surfaces
/// without area (collapsed caps) and locked ones, which have a note. Errors (input): one of the
/// given surfaces has no area.
Expected<std::vector<int>> connected(std::vector<int> chosen, SessionState& state) {
  const auto collapsed = [&](int k) {
    return !normalised_scaling<2>(*state.surfaces[static_cast<std::size_t>(k)].reference);
  };
  const auto locked = [&](int k) { return state.surfaces[static_cast<std::size_t>(k)].locked; };
  const auto id = [&](int k) { return state.surfaces[static_cast<std::size_t>(k)].id; };
  for (int k : chosen) {
    if (collapsed(k))
      return input_error(id(k) + " has no area", "surface",
                         "choose a surface that is not collapsed");
  }
  std::vector<const Surface*> all;
  for (const SceneSurface& s : state.surfaces) all.push_back(s.reference.get());
  const auto found = seams_between(state.seams, all);
  if (!found) return std::unexpected(found.error());
  std::vector<int> left_out;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    for (const Seam& seam : found->seams) {
      if (seam.kind == SeamKind::partial) continue;
      const int other = seam.a.patch == chosen[k]   ? seam.b.patch
                        : seam.b.patch == chosen[k] ? seam.a.patch
                                                    : -1;
      if (other < 0 || std::ranges::find(chosen, other) != chosen.end()) continue;
      if (std::ranges::find(left_out, other) != left_out.end()) continue;
      (locked(other) || collapsed(other) ? left_out : chosen).push_back(other);
    }
  }
  for (int k : left_out) {
    state.notes.push_back(id(k) + " is connected but left out: it " +
                          (locked(k) ? "is locked" : "has no area"));
  }
  return chosen;
}

Expected<void> select_body(const std::string& id, const Document& document, SessionState& state) {
  std::string known;
  for (std::size_t k = 0; k < state.bodies.size(); ++k) {
    const std::string& known_id = common_of(state.bodies[k]).id;
    known += (known.empty() ? "" : ", ") + known_id;
    if (known_id != id) continue;
    state.body = static_cast<int>(k);
    state.select({});
    return {};
  }
  if (document.source() != nullptr && document.source()->is_bound_curve(id)) {
    return input_error(
        fmt::format(
            "edges or surfaces of the file are made of the curve {}, so it cannot be moved alone",
            id),
        "body", "select a surface; edges between faces follow where they are asked to");
  }
  std::string remedy = "they are: " + known;
  if (known.empty()) {
    remedy = document.is_fresh() ? R"(make one first: {"do":"new","shape":"curve"})"
                                 : "the file has no B-spline curves that stand for themselves";
  }
  return input_error(fmt::format("there is no curve or volume {}", id), "body", remedy,
                     {ErrorCode::no_body});
}

}  // namespace

void describe(SelectCommand& c, Fields& fields) {
  fields.name("select",
              "choose the surfaces, or the curve or volume, that the following commands act on");
  fields.add("surface", c.surface,
             {.help = "id as `knead info` lists it, `\"#123\"`; this or `surfaces`"});
  fields.add("surfaces", c.surfaces, {.help = "several of them"});
  fields.add(
      "connected", c.connected,
      {.help = "also all surfaces that seams connect with these, directly or through others"});
  fields.add("body", c.body,
             {.help = "id of a curve or a volume, instead; it is selected alone. Those of a file "
                      "are its free curves"});
}

Expected<void> execute(const SelectCommand& c, Act& act) {
  if (c.body) {
    if (c.surface || c.surfaces || c.connected) {
      return input_error("both surfaces and a body are named", "body",
                         "curves and volumes are selected alone");
    }
    return select_body(*c.body, act.document, act.state);
  }
  std::vector<std::string> ids = c.surfaces.value_or(std::vector<std::string>{});
  if (c.surface) ids.insert(ids.begin(), *c.surface);
  if (ids.empty())
    return input_error("the field is missing", "surface",
                       "give \"surface\", \"surfaces\" or \"body\"");
  std::vector<int> chosen;
  for (const std::string& id : ids) {
    auto index = find_surface(act, id);
    if (!index) {
      if (&id - ids.data() >= (c.surface ? 1 : 0) && index.error().where == "surface")
        index.error().where = "surfaces";
      return std::unexpected(index.error());
    }
    if (act.state.surfaces[static_cast<std::size_t>(*index)].locked) {
      return input_error(
          id + " is locked", c.surface && *c.surface == id ? "surface" : "surfaces",
          fmt::format(R"(unlock it first: {{"do":"lock","surfaces":["{}"],"locked":false}})", id),
          {ErrorCode::surface_locked, {{"surface", id}}});
    }
    if (std::ranges::find(chosen, *index) == chosen.end()) chosen.push_back(*index);
  }
  if (c.connected) {
    auto all = connected(std::move(chosen), act.state);
    if (!all) return std::unexpected(all.error());
    chosen = std::move(*all);
  }
  act.state.body.reset();
  act.state.select(chosen);
  hold_likewise(act);
  return {};
}

}  // namespace knead
