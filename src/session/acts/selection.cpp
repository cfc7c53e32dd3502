#include "selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "knead/base/error_code.hpp"
#include "knead/brep/face_conversion.hpp"
#include "knead/spline/extremum.hpp"

namespace knead {

SceneBody* body(Act& act) {
  return act.state.body ? &act.state.bodies[static_cast<std::size_t>(*act.state.body)] : nullptr;
}

std::unexpected<Error> of_surfaces(Act& act, std::string_view field, const char* remedy) {
  return input_error(fmt::format("a {} has no {}", kind_of(*body(act)), field), std::string(field),
                     remedy);
}

Expected<void> some_selected(Act& act) {
  if (act.state.body) return {};
  const auto surface = selected(act);
  return surface ? Expected<void>() : std::unexpected(surface.error());
}

Expected<SceneSurface*> selected(Act& act) {
  if (act.state.selected) return &act.state.surfaces[static_cast<std::size_t>(*act.state.selected)];
  if (act.state.body) {
    const SceneBody& b = *body(act);
    return input_error(fmt::format("the {} {} is selected, and this acts on surfaces", kind_of(b),
                                   common_of(b).id),
                       {}, "select a surface first");
  }
  if (act.document.is_fresh() && act.state.surfaces.empty()) {
    return input_error("there is no surface yet", {},
                       R"(make one first: {"do":"new","size":[1,1],"net":[8,8]})",
                       {ErrorCode::no_surface});
  }
  if (act.state.surfaces.empty() && !act.state.bodies.empty()) {
    return input_error(
        "the file has no B-spline surface", act.document.name(),
        fmt::format(R"(select one of its curves: {{"do":"select","body":"{}"}})",
                    common_of(act.state.bodies[0]).id),
        {ErrorCode::no_spline_surface, {{"body", common_of(act.state.bodies[0]).id}}});
  }
  if (act.state.surfaces.empty()) {
    const auto others = act.document.model() == nullptr
                            ? std::vector<brep::OtherSurface>()
                            : brep::other_surfaces(*act.document.model());
    if (others.empty())
      return input_error("the file has no B-spline surface that could be sculpted",
                         act.document.name());
    return input_error(
        "the file has no B-spline surface that could be sculpted", act.document.name(),
        fmt::format(R"(make one of another surface: {{"do":"convert","surface":"{}"}})",
                    others[0].id),
        {ErrorCode::no_spline_surface, {{"surface", others[0].id}}});
  }
  return input_error(fmt::format("none of the {} surfaces is selected", act.state.surfaces.size()),
                     {},
                     fmt::format(R"(select one first: {{"do":"select","surface":"{}"}})",
                                 act.state.surfaces.front().id),
                     {ErrorCode::none_selected, {{"surface", act.state.surfaces.front().id}}});
}

Expected<SceneSurface*> selected_alone(Act& act) {
  auto surface = selected(act);
  if (!surface || act.state.together.empty()) return surface;
  return input_error(
      fmt::format("{} surfaces are selected", act.state.together.size() + 1), "select",
      fmt::format(R"(select only the one that is meant: {{"do":"select","surface":"{}"}})",
                  (*surface)->id),
      {ErrorCode::several_selected, {{"surface", (*surface)->id}}});
}

Expected<int> find_surface(const Act& act, const std::string& id) {
  constexpr std::size_t listed = 12;
  std::string known;
  for (std::size_t k = 0; k < act.state.surfaces.size(); ++k) {
    const SceneSurface& surface = std::as_const(act.state.surfaces)[k];
    if (surface.id == id) return static_cast<int>(k);
    if (k < listed) known += (k == 0 ? "" : ", ") + surface.id;
  }
  if (act.document.model() != nullptr) {
    const auto others = brep::other_surfaces(*act.document.model());
    const auto other = std::ranges::find(others, id, &brep::OtherSurface::id);
    if (other != others.end()) {
      return input_error(fmt::format("{} is a {}, not a B-spline surface", id, other->form),
                         "surface",
                         fmt::format(R"(convert it first: {{"do":"convert","surface":"{}"}})", id),
                         {ErrorCode::not_a_spline, {{"surface", id}, {"form", other->form}}});
    }
  }
  if (!act.document.is_fresh()) {
    for (const brep::UnreadableSurface& s : act.document.source()->unreadable()) {
      if (s.id == id) return std::unexpected(s.reason);
    }
  }
  if (act.state.surfaces.size() > listed) known += ", …";
  return input_error(fmt::format("{} has no surface {}", act.document.name(), id), "surface",
                     known.empty() ? "the file has no B-spline surface that could be sculpted"
                                   : "its surfaces are: " + known);
}

Expected<int> selected_surface(Act& act, const std::optional<std::string>& id, const char* field) {
  if (auto first = selected(act); !first) return std::unexpected(first.error());
  if (!id) return *act.state.selected;
  const auto found = find_surface(act, *id);
  if (!found) return found;
  const std::vector<int> selection = act.state.selection();
  if (std::ranges::find(selection, *found) != selection.end()) return found;
  return input_error(fmt::format("{} is not selected", *id), field, "select it first");
}

Expected<Tool*> find_tool(Act& act, const std::optional<std::string>& name) {
  std::string known;
  for (Tool& t : act.state.tools) {
    if (name ? t.name == *name : act.state.tools.size() == 1) return &t;
    known += (known.empty() ? "" : ", ") + t.name;
  }
  if (known.empty())
    return input_error("there is no tool", "tool", "make one first with the command tool");
  return input_error(name ? fmt::format("there is no tool \"{}\"", *name) : "no tool is named",
                     "tool", "the tools are: " + known);
}

Expected<double> diagonal(Act& act) {
  if (act.state.body) return diagonal_of(*body(act));
  auto surface = selected(act);
  if (!surface) return std::unexpected(surface.error());
  const double length = bounding_box(*(*surface)->reference).diagonal();
  if (length > 0) return length;
  return numerical_error(
      "all of the surface is one point", (*surface)->id,
      "select another surface, or give lengths and positions that are not relative");
}

}  // namespace knead
