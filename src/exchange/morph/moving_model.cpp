#include "moving_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/parallel_for.hpp"
#include "brep/check/bare_faces.hpp"
#include "brep/check/meeting_courses.hpp"
#include "brep/shared_edge.hpp"
#include "knead/base/printable.hpp"
#include "knead/brep/face_conversion.hpp"
#include "knead/brep/face_edges.hpp"
#include "knead/hold/seams.hpp"
#include "morph/seam_edges.hpp"

namespace knead::detail {
namespace {

using brep::Model;

/// The ids of the surfaces that are named themselves, or by faces on them.
Expected<std::set<std::string>> surfaces_named(const Model& model,
                                               const std::vector<std::string>& ids,
                                               std::string_view option) {
  std::set<std::string> result;
  for (const std::string& id : ids) {
    const auto face = std::ranges::find(model.faces, id, &brep::Face::id);
    const auto support = std::ranges::find(model.supports, id, &brep::Support::id);
    if (face != model.faces.end() && face->support != brep::none) {
      result.insert(model.supports[face->support].id);
    } else if (support != model.supports.end() || model.find_surface(id) != nullptr) {
      result.insert(id);
    } else {
      return input_error(fmt::format("\"{}\" is neither a face nor a surface", printable(id, 40)),
                         option, "`knead info --faces FILE` lists them");
    }
  }
  return result;
}

/// Which surfaces may move, by the ids of the file as opened.
struct Choice {
  std::set<std::string> faces, keep;
  bool all = true;

  [[nodiscard]] bool moves(const std::string& surface) const {
    return (all || faces.contains(surface)) && !keep.contains(surface);
  }
};

Expected<Choice> choice_of(const Model& model, const MorphSettings& settings) {
  auto faces = surfaces_named(model, settings.faces, "faces");
  if (!faces) return std::unexpected(faces.error());
  auto keep = surfaces_named(model, settings.keep, "keep");
  if (!keep) return std::unexpected(keep.error());
  return Choice{*std::move(faces), *std::move(keep), settings.faces.empty()};
}

/// A source with surfaces as B-splines, and those that could not become one.
struct Converted {
  std::shared_ptr<const Source> source;
  std::vector<std::string> ids;
  std::vector<MorphException> failed;
};

/// Converts all of these that can be.
Converted converted(const std::shared_ptr<const Source>& source,
                    const std::vector<std::string>& wanted) {
  Converted result{source, {}, {}};
  std::vector<std::string> reasons(wanted.size());
  const auto model = source->model();
  parallel_for(std::ssize(wanted), 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      const auto form = brep::exact_spline(*model, wanted[k]);
      if (!form) reasons[k] = form.error().message();
    }
  });
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    if (reasons[k].empty())
      result.ids.push_back(wanted[k]);
    else
      result.failed.push_back({wanted[k], reasons[k]});
  }
  if (result.ids.empty()) return result;
  if (auto made = source->with_splines(result.ids)) {
    result.source = *std::move(made);
    return result;
  }
  // One by one, to find those that the file's format cannot take.
  for (const std::string& id : std::exchange(result.ids, {})) {
    auto made = result.source->with_splines(std::span(&id, 1));
    if (!made) {
      result.failed.push_back({id, made.error().message()});
      continue;
    }
    result.source = *std::move(made);
    result.ids.push_back(id);
  }
  return result;
}

// The fit knows all surfaces as B-splines, so that those that stay hold the edges of those that
// move; only these are written as such.
void convert(const std::shared_ptr<const Source>& source, const Choice& choice,
             const MorphSettings& settings, MovingModel& result) {
  std::vector<std::string> all, moving;
  for (const auto& other : brep::other_surfaces(*source->model())) {
    if (other.faces.empty()) continue;
    all.push_back(other.id);
    if (!choice.moves(other.id)) continue;
    if (settings.convert)
      moving.push_back(other.id);
    else
      result.fixed.push_back({other.id, fmt::format("a {} is not converted", other.form)});
  }
  Converted known = converted(source, all);
  result.source = std::move(known.source);
  std::erase_if(moving, [&](const std::string& id) {
    return std::ranges::find(known.ids, id) == known.ids.end();
  });
  for (MorphException& failed : known.failed) {
    if (settings.convert && choice.moves(failed.id)) result.fixed.push_back(std::move(failed));
  }
  result.written = result.source;
  if (moving.size() < known.ids.size()) result.written = converted(source, moving).source;
  result.converted = std::move(moving);
}

/// Which surface of the converted file each face of the file as opened lies on, if one.
void add_surfaces(const Model& opened, const Choice& choice, bool convert, const MorphHolds& holds,
                  MovingModel& result) {
  const Model& model = *result.model;
  std::map<std::string, const brep::Support*> support_of_face;  // as opened
  for (const brep::Face& face : opened.faces) {
    if (face.support != brep::none) support_of_face[face.id] = &opened.supports[face.support];
  }
  const std::size_t count = result.source->surfaces().size();
  result.faces.resize(count);
  result.shown.assign(count, model.faces.empty());
  std::vector<bool> moves(count, false);
  for (std::size_t k = 0; k < count; ++k)
    moves[k] = model.faces.empty() && choice.moves(result.source->surfaces()[k].id);
  for (const brep::Face& face : model.faces) {
    const auto* spline = model.spline_under(face);
    if (spline == nullptr) continue;
    const auto k = static_cast<std::size_t>(spline - model.surfaces.data());
    result.shown[k] = true;
    result.faces[k].push_back(face.id);
    const auto before = support_of_face.find(face.id);
    moves[k] = before != support_of_face.end() && choice.moves(before->second->id) &&
               (convert || before->second->spline != brep::none);
  }
  for (std::size_t k = 0; k < count; ++k) {
    const SourceSurface& of_file = result.source->surfaces()[k];
    morph::FitSurface surface{of_file.surface, {}, !moves[k], of_file.id};
    const auto kept = holds.find(of_file.id);
    if (kept != holds.end()) surface.holds = kept->second;
    result.surfaces.push_back(std::move(surface));
  }
}

void add_regions(MovingModel& result) {
  const VisibleRegions regions(result.model);
  const auto count = static_cast<std::ptrdiff_t>(result.surfaces.size());
  std::vector<std::string> wrong(result.surfaces.size());
  parallel_for(count, 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      if (!result.shown[k]) continue;
      auto region = regions.of(result.source->surfaces()[k].id);
      if (region)
        result.surfaces[k].region = *std::move(region);
      else
        wrong[k] = region.error().message();
    }
  });
  for (std::size_t k = 0; k < wrong.size(); ++k) {
    if (wrong[k].empty()) continue;
    result.shown[k] = false;
    result.surfaces[k].fixed = true;
    result.fixed.push_back({result.source->surfaces()[k].id, wrong[k]});
  }
}

/// An edge of a surface that cannot be followed on all of its faces keeps its place on this one.
void hold_edge(int surface, std::size_t number, MovingModel& result) {
  const morph::FitSurface& on = result.surfaces[static_cast<std::size_t>(surface)];
  const TrimEdge& edge = on.region.edges[number];
  if (on.fixed || edge.course.size() < 2) return;
  morph::FitEdge held{.course = nullptr, .surfaces = {surface}, .name = edge.id, .held = true};
  for (std::size_t k = 0; k < edge.course.size(); ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(edge.course.size() - 1);
    held.samples.push_back({share, edge.points[k], {edge.course[k]}});
  }
  result.edges.push_back(std::move(held));
}

// Each edge once, however many surfaces it is on. One that cannot be followed on all of them, as a
// face at it is no B-spline surface, holds those that are.
void add_edges(MovingModel& result) {
  std::map<std::string, std::vector<std::pair<int, std::size_t>>> uses;
  std::vector<std::string> ids;
  for (std::size_t k = 0; k < result.surfaces.size(); ++k) {
    const auto& edges = result.surfaces[k].region.edges;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      auto& use = uses[edges[e].id];
      if (use.empty()) ids.push_back(edges[e].id);
      use.emplace_back(static_cast<int>(k), e);
    }
  }
  if (result.model->edges.empty()) return;
  std::vector<std::optional<Expected<SharedEdge>>> courses(ids.size());
  parallel_for(
      static_cast<std::ptrdiff_t>(ids.size()), 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
          courses[k].emplace(SharedEdge::create(*result.model, ids[k]));
      });
  for (std::size_t k = 0; k < ids.size(); ++k) {
    if (!*courses[k]) {
      result.unknown_edges.push_back({ids[k], courses[k]->error().message()});
      for (const auto& [surface, e] : uses[ids[k]]) hold_edge(surface, e, result);
      continue;
    }
    morph::FitEdge edge;
    edge.course = std::make_shared<const SharedEdge>(**std::move(courses[k]));
    for (const std::string& id : edge.course->surfaces())
      edge.surfaces.push_back(static_cast<int>(result.model->surface_index(id)));
    result.edges.push_back(std::move(edge));
  }
}

// Faces and surfaces that meet without a common edge stay together where they do; beside one that
// is no B-spline surface, the other one keeps its place.
void add_meetings(MovingModel& result) {
  for (brep::MeetingCourse& met : brep::meeting_courses(*result.model)) {
    morph::FitEdge edge{.course = nullptr,
                        .surfaces = {},
                        .samples = std::move(met.samples),
                        .name = std::move(met.id)};
    for (const brep::Index surface : met.surfaces) {
      if (surface != brep::none) edge.surfaces.push_back(static_cast<int>(surface));
    }
    edge.held = edge.surfaces.size() < met.surfaces.size();
    result.edges.push_back(std::move(edge));
  }
}

/// Surfaces without area go with what they meet, of the same part: no face can meet them.
Expected<void> add_seams(MovingModel& result) {
  std::map<const brep::Part*, std::vector<int>> bare;
  const auto& assembly = result.model->assembly;
  for (std::size_t k = 0; k < result.surfaces.size(); ++k) {
    if (!result.shown[k] || !result.faces[k].empty()) continue;
    bare[assembly ? assembly->part_of(result.source->surfaces()[k].id) : nullptr].push_back(
        static_cast<int>(k));
  }
  const auto surface = [&](int k) -> const Surface& {
    return *result.surfaces[static_cast<std::size_t>(k)].surface;
  };
  for (const auto& [part, numbers] : bare) {
    std::vector<bool> area;
    std::vector<const Surface*> patches;
    for (const int k : numbers) {
      patches.push_back(&surface(k));
      area.push_back(brep::has_area(surface(k)));
    }
    if (numbers.size() < 2 || std::ranges::find(area, false) == area.end()) continue;
    auto seams = find_seams(patches, suggested_seam_tolerance(patches));
    if (!seams) return std::unexpected(seams.error());
    std::erase_if(seams->seams, [&](const Seam& seam) {
      return area[static_cast<std::size_t>(seam.a.patch)] &&
             area[static_cast<std::size_t>(seam.b.patch)];
    });
    auto edges = morph::edges_of_seams(patches, seams->seams);
    if (!edges) return std::unexpected(edges.error());
    for (morph::FitEdge& edge : *edges) {
      for (int& s : edge.surfaces) s = numbers[static_cast<std::size_t>(s)];
      result.edges.push_back(std::move(edge));
    }
  }
  return {};
}

}  // namespace

std::string MovingModel::unit() const {
  return model->assembly ? model->assembly->unit : model->length_unit();
}

Expected<MovingModel> moving_model(const std::shared_ptr<const Source>& source,
                                   const MorphSettings& settings, const MorphHolds& holds) {
  MovingModel result;
  const auto opened = source->model();
  if (!opened) {
    return input_error(fmt::format("a {} file has no faces", source->format()), source->name(),
                       "`knead export` writes its surfaces as faces of a new file");
  }
  const auto choice = choice_of(*opened, settings);
  if (!choice) return std::unexpected(choice.error());
  convert(source, *choice, settings, result);
  result.model = result.source->model();
  if (result.source->surfaces().empty())
    return input_error("there is no B-spline surface that could move", source->name(),
                       "let others be converted");
  add_surfaces(*opened, *choice, settings.convert, holds, result);
  add_regions(result);
  add_edges(result);
  add_meetings(result);
  if (auto right = add_seams(result); !right) return std::unexpected(right.error());
  if (auto right = add_places(settings, result); !right) return std::unexpected(right.error());
  if (std::ranges::all_of(result.surfaces, &morph::FitSurface::fixed)) {
    return input_error("nothing is free to move", source->name(),
                       result.fixed.empty() ? "keep fewer faces"
                                            : fmt::format("surface {}: {}", result.fixed.front().id,
                                                          result.fixed.front().reason));
  }
  return result;
}

}  // namespace knead::detail
