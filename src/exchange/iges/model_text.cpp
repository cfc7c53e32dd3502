#include "model_text.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "brep/part_graph.hpp"
#include "knead/brep/face_conversion.hpp"
#include "model_geometry.hpp"
#include "text.hpp"

namespace knead::iges {
namespace {

constexpr double least_resolution = 1e-7;  // a length

bool self_crossing(const brep::Support& support) {
  const auto* form = std::get_if<brep::ElementarySurface>(&support.form);
  return form != nullptr && form->kind == brep::ElementarySurface::Kind::torus &&
         form->second > form->radius;
}

/// The model with swept surfaces, and tori that cross themselves, as B-splines. Errors (input): one
/// cannot be made one.
Expected<brep::Model> in_iges_forms(const brep::Model& model) {
  brep::Model result = model;
  for (std::size_t k = 0; k < model.supports.size(); ++k) {
    const brep::Support& stored = model.supports[k];
    if (stored.spline != brep::none || stored.wrong) continue;
    if (!std::holds_alternative<brep::SweptSurface>(stored.form) && !self_crossing(stored))
      continue;
    auto made = brep::exact_spline(model, stored.id);
    if (!made) return std::unexpected(made.error().within(stored.id));
    result.supports[k].spline = static_cast<brep::Index>(result.surfaces.size());
    result.surfaces.push_back(
        {.id = stored.id, .name = {}, .unit = {}, .surface = *std::move(made)});
  }
  return result;
}

/// One part with the lists of its vertices and edges.
class PartWriter {
 public:
  PartWriter(const detail::FacePlan& plan, const brep::Model& model,
             const detail::WrittenPart& part, Sections& to)
      : plan_(plan), model_(model), part_(part), to_(to), geometry_(plan, model, to) {}

  /// The directory numbers of what a subfigure of it lists. `dependent`: it is part of one.
  Expected<std::vector<int>> write(bool dependent) {
    dependent_ = dependent;
    if (auto status = add_lists(); !status) return std::unexpected(std::move(status.error()));
    for (const detail::WrittenSolid& solid : part_.shells.solids) {
      if (auto status = add_solid(solid); !status)
        return std::unexpected(std::move(status.error()));
    }
    for (const detail::WrittenShell& sheet : part_.shells.sheets) {
      const auto shell = add_shell(sheet, dependent_);
      if (!shell) return std::unexpected(shell.error());
      members_.push_back(*shell);
    }
    if (auto status = add_surfaces(); !status) return std::unexpected(std::move(status.error()));
    for (const NamedCurve& c : part_.curves)
      members_.push_back(
          to_.add(126, curve_values(c.curve), {.name = c.name, .dependent = dependent_}));
    return std::move(members_);
  }

 private:
  template <class Visit>
  void for_each_face(const Visit& visit) const {
    const auto shell = [&](const detail::WrittenShell& s) {
      for (const detail::WrittenFace& face : s.faces) visit(model_.faces[face.face]);
    };
    for (const detail::WrittenSolid& solid : part_.shells.solids) {
      shell(solid.outer);
      for (const detail::WrittenShell& hollow : solid.hollows) shell(hollow);
    }
    for (const detail::WrittenShell& sheet : part_.shells.sheets) shell(sheet);
  }

  std::string place_of(brep::Index vertex) {
    const auto [at, fresh] = vertices_.try_emplace(vertex, vertices_.size() + 1);
    if (fresh) append(coordinates_, std::span(model_.vertices[vertex].place.data(), 3));
    return std::to_string(at->second);
  }

  /// The lists of vertices (502) and edges (504). An edge runs along its curve.
  /// Edges name their vertices by a list and a place in it, and loops their edges likewise: both
  /// lists are complete before the first loop is written.
  Expected<void> add_lists() {
    std::vector<std::array<std::string, 3>> entries;  // curve, start, end
    std::string failed;
    Expected<void> status;
    for_each_face([&](const brep::Face& face) {
      for (const brep::Bound& bound : face.bounds) {
        if (bound.kind == brep::Bound::Kind::vertex) place_of(bound.vertex);
      }
      for (const brep::Index edge : brep::edges_around(face)) {
        if (!status || !edges_.try_emplace(edge, edges_.size() + 1).second) continue;
        const auto curve = geometry_.curve(edge);
        if (!curve) {
          status = std::unexpected(curve.error());
          continue;
        }
        const brep::Edge& stored = model_.edges[edge];
        const bool back = plan_.edges[edge]->backwards;
        entries.push_back({std::to_string(*curve), place_of(back ? stored.end : stored.start),
                           place_of(back ? stored.start : stored.end)});
      }
    });
    if (!status || vertices_.empty()) return status;
    coordinates_.insert(coordinates_.begin(), std::to_string(vertices_.size()));
    corner_list_ =
        std::to_string(to_.add(502, std::move(coordinates_), {.form = 1, .dependent = true}));
    if (entries.empty()) return {};
    Values edges = {std::to_string(entries.size())};
    for (const auto& [curve, from, to] : entries)
      edges.insert(edges.end(), {curve, corner_list_, from, corner_list_, to});
    edge_list_ = std::to_string(to_.add(504, std::move(edges), {.form = 1, .dependent = true}));
    return {};
  }

  /// Loops run with their face on the left as seen from the tip of the normal of the surface.
  int add_loop(const brep::Bound& bound, const brep::Face& face) {
    Values loop;
    if (bound.kind == brep::Bound::Kind::vertex) {
      loop = {"1", "1", corner_list_, place_of(bound.vertex), "1", "0"};
    } else {
      std::vector<brep::EdgeUse> uses = bound.edges;
      const bool back = bound.forward != face.same_sense;
      if (back) std::ranges::reverse(uses);
      loop = {std::to_string(uses.size())};
      for (const brep::EdgeUse& use : uses) {
        const bool along = (use.forward != back) != plan_.edges[use.edge]->backwards;
        loop.insert(loop.end(),
                    {"0", edge_list_, std::to_string(edges_.at(use.edge)), along ? "1" : "0", "0"});
      }
    }
    return to_.add(508, std::move(loop), {.form = 1, .dependent = true});
  }

  Expected<int> add_face(const brep::Face& face) {
    const auto surface = geometry_.surface(face.support);
    if (!surface) return surface;
    // Which of several loops is the outer one is not known, and need not be said.
    Values values = {std::to_string(*surface), std::to_string(face.bounds.size()),
                     face.bounds.size() == 1 ? "1" : "0"};
    for (const brep::Bound& bound : face.bounds)
      values.push_back(std::to_string(add_loop(bound, face)));
    const brep::SplineSurface* spline = plan_.model->spline_under(face);
    const auto colour = plan_.colour_of(face);
    return to_.add(510, std::move(values),
                   {.form = 1,
                    .name = spline != nullptr ? spline->name : std::string(),
                    .colour = colour ? to_.add_colour(*colour) : 0,
                    .dependent = true});
  }

  Expected<int> add_shell(const detail::WrittenShell& shell, bool dependent) {
    Values values = {std::to_string(shell.faces.size())};
    for (const detail::WrittenFace& face : shell.faces) {
      const auto number = add_face(model_.faces[face.face]);
      if (!number) return number;
      values.insert(values.end(), {std::to_string(*number), face.same_sense ? "1" : "0"});
    }
    return to_.add(514, std::move(values), {.form = shell.closed ? 1 : 2, .dependent = dependent});
  }

  Expected<void> add_solid(const detail::WrittenSolid& solid) {
    const auto outer = add_shell(solid.outer, true);
    if (!outer) return std::unexpected(outer.error());
    Values values = {std::to_string(*outer), "1", std::to_string(solid.hollows.size())};
    for (const detail::WrittenShell& hollow : solid.hollows) {
      const auto number = add_shell(hollow, true);
      if (!number) return std::unexpected(number.error());
      values.insert(values.end(), {std::to_string(*number), "0"});
    }
    members_.push_back(to_.add(186, std::move(values), {.dependent = dependent_}));
    return {};
  }

  Expected<void> add_surfaces() {
    std::vector<int> numbers;
    for (const NamedSurface& s : part_.surfaces)
      numbers.push_back(
          to_.add(128, surface_values(s.surface), {.name = s.name, .dependent = true}));
    if (numbers.empty()) return {};
    const auto shells = add_shells(part_.surfaces, numbers, to_);
    if (!shells) return std::unexpected(shells.error());
    members_.insert(members_.end(), shells->begin(), shells->end());
    return {};
  }

  const detail::FacePlan& plan_;
  const brep::Model& model_;
  const detail::WrittenPart& part_;
  Sections& to_;
  ModelGeometry geometry_;
  bool dependent_ = false;
  std::vector<int> members_;
  std::map<brep::Index, std::size_t> vertices_, edges_;  // places in the lists, from 1
  Values coordinates_;
  std::string corner_list_, edge_list_;
};

/// A subfigure (308), and an instance (408) of it for each place: scaled where units differ, then
/// turned and moved.
void place(const detail::WrittenPart& part, const std::vector<int>& members, Sections& to) {
  Values values = {"0", hollerith_of(part.name.empty() ? "part" : part.name),
                   std::to_string(members.size())};
  for (const int member : members) values.push_back(std::to_string(member));
  const int definition = to.add(308, std::move(values));
  for (const brep::PartPlace& at : part.places) {
    const double scale = brep::scale_of(at.to_model.linear()).value_or(1);
    Eigen::Affine3d rigid = at.to_model;
    rigid.linear() /= scale;
    const int matrix = to.add(124, matrix_values(rigid), {.dependent = true});
    Values instance = {std::to_string(definition)};
    append(instance, std::array{0.0, 0.0, 0.0, scale});
    to.add(408, std::move(instance), {.transform = matrix});
  }
}

double largest_coordinate(const detail::FacePlan& plan) {
  double result = 0;
  const auto extend = [&](const Points& points) {
    result = std::max(result, points.cwiseAbs().maxCoeff());
  };
  for (const brep::Vertex& vertex : plan.model->vertices)
    result = std::max(result, vertex.place.cwiseAbs().maxCoeff());
  for (const brep::SplineSurface& s : plan.model->surfaces) extend(s.surface.control_points());
  for (const brep::FreeCurve& c : plan.model->curves) extend(c.curve.control_points());
  return result;
}

}  // namespace

Expected<std::string> model_text(const detail::FacePlan& plan, const SaveOptions& options) {
  const auto unit = unit_of_new_file(plan.unit);
  if (!unit) return std::unexpected(unit.error());
  const auto model = in_iges_forms(*plan.model);
  if (!model) return std::unexpected(model.error());
  Sections sections;
  double resolution = least_resolution;
  for (const detail::WrittenPart& part : plan.parts) {
    const bool moved = part.places.size() != 1 || !part.places[0].to_model.matrix().isIdentity(0);
    const auto members = PartWriter(plan, *model, part, sections).write(moved);
    if (!members) return std::unexpected(members.error());
    if (moved) place(part, *members, sections);
    const double scale = brep::scale_of(part.places[0].to_model.linear()).value_or(1);
    resolution = std::max(resolution, scale * part.uncertainty);
  }
  return sections.text(options.title,
                       global_section(options.title, **unit, largest_coordinate(plan), resolution));
}

}  // namespace knead::iges
