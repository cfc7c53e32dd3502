#include "executor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "knead/base/error_code.hpp"
#include "knead/brep/face_conversion.hpp"
#include "knead/spline/extremum.hpp"

namespace knead {

SceneBody* Executor::body() { return state.body ? &state.bodies[static_cast<std::size_t>(*state.body)] : nullptr; }

std::unexpected<Error> Executor::of_surfaces(std::string_view field, const char* remedy) {
  return input_error(fmt::format("a {} has no {}", kind_of(*body()), field), std::string(field), remedy);
}

Expected<void> Executor::some_selected() {
  if (state.body) return {};
  const auto surface = selected();
  return surface ? Expected<void>() : std::unexpected(surface.error());
}

Expected<SceneSurface*> Executor::selected() {
  if (state.selected) return &state.surfaces[static_cast<std::size_t>(*state.selected)];
  if (state.body) {
    const SceneBody& b = *body();
    return input_error(fmt::format("the {} {} is selected, and this acts on surfaces", kind_of(b), common_of(b).id), {},
                       "select a surface first");
  }
  if (document.is_fresh() && state.surfaces.empty()) {
    return input_error("there is no surface yet", {}, R"(make one first: {"do":"new","size":[1,1],"net":[8,8]})",
                       {ErrorCode::no_surface});
  }
  if (state.surfaces.empty() && !state.bodies.empty()) {
    return input_error(
        "the file has no B-spline surface", document.name(),
        fmt::format(R"(select one of its curves: {{"do":"select","body":"{}"}})", common_of(state.bodies[0]).id),
        {ErrorCode::no_spline_surface, {{"body", common_of(state.bodies[0]).id}}});
  }
  if (state.surfaces.empty()) {
    const auto others =
        document.model() == nullptr ? std::vector<brep::OtherSurface>() : brep::other_surfaces(*document.model());
    if (others.empty()) return input_error("the file has no B-spline surface that could be sculpted", document.name());
    return input_error("the file has no B-spline surface that could be sculpted", document.name(),
                       fmt::format(R"(make one of another surface: {{"do":"convert","surface":"{}"}})", others[0].id),
                       {ErrorCode::no_spline_surface, {{"surface", others[0].id}}});
  }
  return input_error(fmt::format("none of the {} surfaces is selected", state.surfaces.size()), {},
                     fmt::format(R"(select one first: {{"do":"select","surface":"{}"}})", state.surfaces.front().id),
                     {ErrorCode::none_selected, {{"surface", state.surfaces.front().id}}});
}

Expected<SceneSurface*> Executor::selected_alone() {
  auto surface = selected();
  if (!surface || state.together.empty()) return surface;
  return input_error(
      fmt::format("{} surfaces are selected", state.together.size() + 1), "select",
      fmt::format(R"(select only the one that is meant: {{"do":"select","surface":"{}"}})", (*surface)->id),
      {ErrorCode::several_selected, {{"surface", (*surface)->id}}});
}

Expected<int> Executor::find_surface(const std::string& id) const {
  constexpr std::size_t listed = 12;
  std::string known;
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const SceneSurface& surface = std::as_const(state.surfaces)[k];
    if (surface.id == id) return static_cast<int>(k);
    if (k < listed) known += (k == 0 ? "" : ", ") + surface.id;
  }
  if (document.model() != nullptr) {
    const auto others = brep::other_surfaces(*document.model());
    const auto other = std::ranges::find(others, id, &brep::OtherSurface::id);
    if (other != others.end()) {
      return input_error(fmt::format("{} is a {}, not a B-spline surface", id, other->form), "surface",
                         fmt::format(R"(convert it first: {{"do":"convert","surface":"{}"}})", id),
                         {ErrorCode::not_a_spline, {{"surface", id}, {"form", other->form}}});
    }
  }
  if (!document.is_fresh()) {
    for (const brep::UnreadableSurface& s : document.source()->unreadable()) {
      if (s.id == id) return std::unexpected(s.reason);
    }
  }
  if (state.surfaces.size() > listed) known += ", …";
  return input_error(
      fmt::format("{} has no surface {}", document.name(), id), "surface",
      known.empty() ? "the file has no B-spline surface that could be sculpted" : "its surfaces are: " + known);
}

Expected<int> Executor::selected_surface(const std::optional<std::string>& id, const char* field) {
  if (auto first = selected(); !first) return std::unexpected(first.error());
  if (!id) return *state.selected;
  const auto found = find_surface(*id);
  if (!found) return found;
  const std::vector<int> selection = state.selection();
  if (std::ranges::find(selection, *found) != selection.end()) return found;
  return input_error(fmt::format("{} is not selected", *id), field, "select it first");
}

Expected<Tool*> Executor::find_tool(const std::optional<std::string>& name) {
  std::string known;
  for (Tool& t : state.tools) {
    if (name ? t.name == *name : state.tools.size() == 1) return &t;
    known += (known.empty() ? "" : ", ") + t.name;
  }
  if (known.empty()) return input_error("there is no tool", "tool", "make one first with the command tool");
  return input_error(name ? fmt::format("there is no tool \"{}\"", *name) : "no tool is named", "tool",
                     "the tools are: " + known);
}

Expected<double> Executor::diagonal() {
  if (state.body) return diagonal_of(*body());
  auto surface = selected();
  if (!surface) return std::unexpected(surface.error());
  const double length = bounding_box(*(*surface)->reference).diagonal();
  if (length > 0) return length;
  return numerical_error("all of the surface is one point", (*surface)->id,
                         "select another surface, or give lengths and positions that are not relative");
}

Expected<void> Executor::keep(const Constraint& constraint) {
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  for (int k : state.selection()) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(k)];
    s.constraints.push_back({constraint, s.current});
  }
  return check_constraints();
}

Expected<void> Executor::check_constraints() {
  if (state.body) {
    const auto check = [&]<int D>(const SceneShape<D>&) -> Expected<void> {
      const auto model = make_model(model_input<D>(state, trial_evolution()));
      return model ? Expected<void>() : std::unexpected(model.error());
    };
    return std::visit(check, *body());
  }
  if (auto known = know_trims(); !known) return known;
  if (auto known = know_followed(); !known) return known;
  return conditions.check(model_input(state, trial_evolution()));
}

Expected<void> Executor::check_constraints_on(std::span<const int> changed) {
  if (auto known = know_trims(); !known) return known;
  const ModelInput input = model_input(state, trial_evolution());
  return check_conditions(asks_for_motion(input) ? input : part_of(input, changed));
}

Expected<void> Executor::change_basis(SceneSurface& surface, const SurfaceChange& change) {
  if (state.limit) {
    return input_error("a limit is measured on the weights and knots that the surface was opened with", "limit",
                       R"(end it first: {"do":"limit"})", {ErrorCode::limit_keeps_basis});
  }
  // `opened` is unchanged: deviations are measured from it.
  if (auto done = knead::change_basis(surface, change); !done) return done;
  surface.velocity.resize(0, 3);  // it is a spline on the old basis
  return surface.constraints.empty() ? Expected<void>() : check_constraints();
}

}  // namespace knead
