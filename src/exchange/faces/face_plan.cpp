#include "face_plan.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "brep/face_loops.hpp"
#include "brep/part_graph.hpp"
#include "exchange/left_out_list.hpp"
#include "exchange/length_units.hpp"

namespace knead::detail {
namespace {

using brep::Index;

Expected<void> refuse(std::string reason) { return input_error(std::move(reason)); }

bool torn(const Surface& s) {
  return std::ranges::any_of(
      s.knots(), [](const KnotVector& k) { return k.max_interior_multiplicity() > k.degree(); });
}
bool torn(const Curve& c) { return c.knots(0).max_interior_multiplicity() > c.knots(0).degree(); }

/// What of a model can be written.
/// Every face is written, or listed with the reason why it or its trims are not: nothing is lost
/// without a word. Geometry of edges is examined once, when the first face asks for it.
class Planner {
 public:
  Planner(const Source& source, std::string unit, Conversion conversion)
      : source_(source), prepared_(prepared(source.model(), conversion)), model_(*prepared_.model) {
    plan_.model = prepared_.model;
    plan_.edges.resize(model_.edges.size());
    plan_.colours = source.colours();
    plan_.unit = std::move(unit);
  }

  Expected<FacePlan> plan() {
    list_unreadable();
    choose_faces();
    const brep::Assembly assembly = model_.assembly ? *model_.assembly : brep::single_part(model_);
    if (!model_.assembly) list_.add({"assembly", "assemblies", model_.assembly.error().what});
    if (assembly.unit != "unknown") plan_.unit = assembly.unit;
    for (const brep::Part& part : assembly.parts) add_part(part);
    for (const SkippedFace& s : prepared_.analytic)
      list_.add({"surface that stays what it is", "surfaces that stay what they are", s.reason.what,
                 s.reason.remedy},
                s.id);
    constexpr LeftOutKind tessellated = {"tessellated item", "tessellated items",
                                         "triangles have no surfaces"};
    for (const brep::TessellatedItem& item : model_.tessellated.items)
      list_.add(tessellated, item.mesh.id);
    for (const SkippedFace& item : model_.tessellated.skipped) list_.add(tessellated, item.id);
    plan_.left_out = list_.take();
    for (LeftOut& left : source_.left_out()) plan_.left_out.push_back(std::move(left));
    if (plan_.parts.empty())
      return input_error("there is no face, surface or curve to write", source_.name());
    return std::move(plan_);
  }

 private:
  void list_unreadable() {
    for (const brep::UnreadableSurface& s : source_.unreadable()) {
      list_.add({"surface that cannot be read", "surfaces that cannot be read", s.reason.what,
                 s.reason.remedy},
                s.id, 1, s.reason.line);
    }
  }

  void choose_faces() {
    kept_.resize(model_.faces.size(), false);
    for (std::size_t k = 0; k < model_.faces.size(); ++k) {
      const brep::Face& face = model_.faces[k];
      if (auto can = writable(face); can) {
        kept_[k] = true;
        for (const Index edge : brep::edges_around(face)) plan_.edges[edge] = **piece(edge);
      } else if (model_.spline_under(face) != nullptr) {
        list_.add({"face whose trims are left out", "faces whose trims are left out",
                   "the surface is written whole: " + can.error().what, can.error().remedy},
                  face.id, 1, face.line);
      } else {
        list_.add({"face", "faces", can.error().what, can.error().remedy}, face.id, 1, face.line);
      }
    }
  }

  Expected<void> writable(const brep::Face& face) {
    if (face.support == brep::none) return refuse("it has no surface");
    const brep::Support& support = model_.supports[face.support];
    if (support.wrong) return refuse("its surface cannot be read: " + support.wrong->what);
    const auto* swept = std::get_if<brep::SweptSurface>(&support.form);
    if (swept != nullptr && (swept->wrong || swept->curve == nullptr))
      return refuse("its surface cannot be read: " +
                    (swept->wrong ? swept->wrong->what : "it has no swept curve"));
    if (support.spline == brep::none && std::holds_alternative<std::monostate>(support.form))
      return refuse("its surface is of a form that is not known");
    if (support.spline != brep::none && torn(model_.surfaces[support.spline].surface))
      return refuse("new files know no surface that is torn along a knot");
    if (face.bounds.empty()) return refuse("it has no bounds");
    for (const brep::Bound& bound : face.bounds) {
      if (bound.wrong) return std::unexpected(*bound.wrong);
      const bool vertex = bound.kind == brep::Bound::Kind::vertex && bound.vertex != brep::none;
      if (vertex && model_.vertices[bound.vertex].wrong)
        return std::unexpected(*model_.vertices[bound.vertex].wrong);
      if (!vertex && bound.edges.empty()) return refuse("one of its bounds is of an unknown form");
      for (const brep::EdgeUse& use : bound.edges) {
        if (const auto& stored = piece(use.edge); !*stored) return std::unexpected(stored->error());
      }
    }
    return {};
  }

  const std::optional<Expected<WrittenEdge>>& piece(Index edge) {
    pieces_.resize(model_.edges.size());
    auto& stored = pieces_[edge];
    if (stored) return stored;
    const auto made = brep::edge_piece(model_, edge);
    if (!made) return stored = std::unexpected(made.error());
    const auto* spline = std::get_if<std::shared_ptr<const Curve>>(&model_.edges[edge].curve->form);
    if (spline != nullptr && torn(**spline))
      return stored = std::unexpected(
                 input_error("new files know no curve that is torn along a knot").error());
    return stored = WrittenEdge{{made->from, made->to}, made->backwards};
  }

  void add_part(const brep::Part& part) {
    WrittenPart made;
    made.name = part.name;
    made.unit = part.unit == "unknown" || !is_length_unit(part.unit) ? plan_.unit : part.unit;
    std::vector<Index> faces;
    std::unordered_set<std::string> covered;
    for (const std::string& id : part.faces) {
      const auto face = face_named(id);
      if (face == brep::none || !kept_[face]) continue;
      faces.push_back(face);
      const brep::Support& support = model_.supports[model_.faces[face].support];
      covered.insert(support.id);
      made.uncertainty = std::max(made.uncertainty, support.uncertainty);
    }
    made.shells = written_shells(model_, faces);
    for (const std::string& id : part.surfaces) {
      const brep::SplineSurface* s = model_.find_surface(id);
      if (s == nullptr || covered.contains(id)) continue;
      NamedSurface& stored =
          made.surfaces.emplace_back(NamedSurface{s->name.empty() ? s->id : s->name, s->surface});
      if (const auto colour = plan_.colours.find(id); colour != plan_.colours.end())
        stored.colour = colour->second;
      if (torn(s->surface)) {
        list_.add({"surface", "surfaces", "new files know none that is torn along a knot"}, id);
        made.surfaces.pop_back();
      } else if (without_face(stored)) {
        list_.add({"surface", "surfaces", "all its sides are points, so that it has no face",
                   "write it bare, with --sets"},
                  id);
        made.surfaces.pop_back();
      }
    }
    for (const std::string& id : part.curves) {
      const brep::FreeCurve* c = curve_named(id);
      if (c == nullptr) continue;
      if (torn(c->curve))
        list_.add({"curve", "curves", "new files know none that is torn along a knot"}, id);
      else
        made.curves.push_back({c->name.empty() ? c->id : c->name, c->curve});
    }
    if (faces.empty() && made.surfaces.empty() && made.curves.empty()) return;
    put_places(part, made);
    plan_.faces += faces.size();
    plan_.solids += made.shells.solids.size();
    plan_.surfaces += made.surfaces.size();
    plan_.curves += made.curves.size();
    plan_.parts.push_back(std::move(made));
  }

  static bool without_face(const NamedSurface& surface) {
    const auto left = without_faces({&surface, 1});
    return !left || !left->empty();
  }

  // Formats place parts by rotations and shifts alone. A part in its own unit must have exactly the
  // scale that the units imply; anything else would change its size.
  void put_places(const brep::Part& part, WrittenPart& made) {
    constexpr double same = 1e-9;
    const auto *made_unit = length_unit_named(made.unit), *whole = length_unit_named(plan_.unit);
    const double ratio =
        made_unit != nullptr && whole != nullptr ? made_unit->millimetres / whole->millimetres : 1;
    for (const brep::PartPlace& place : part.places) {
      const Eigen::Matrix3d linear = place.to_model.linear();
      const auto scale = brep::scale_of(linear);
      if (!scale || linear.determinant() < 0 || std::abs(*scale / ratio - 1) > same) {
        list_.add({"place of a part", "places of parts", "it mirrors, shears or scales the part"},
                  part.name);
        continue;
      }
      made.places.push_back(place);
    }
    if (!made.places.empty()) return;
    list_.add(
        {"part", "parts", "none of its places can be kept, so that it stands at its own origin"},
        part.name);
    made.places.emplace_back().to_model.linear() *= ratio;
  }

  Index face_named(const std::string& id) {
    if (faces_.empty()) {
      for (std::size_t k = 0; k < model_.faces.size(); ++k)
        faces_.emplace(model_.faces[k].id, static_cast<Index>(k));
    }
    const auto found = faces_.find(id);
    return found == faces_.end() ? brep::none : found->second;
  }

  const brep::FreeCurve* curve_named(const std::string& id) {
    if (curves_.empty()) {
      for (const brep::FreeCurve& c : model_.curves) curves_.emplace(c.id, &c);
    }
    const auto found = curves_.find(id);
    return found == curves_.end() ? nullptr : found->second;
  }

  const Source& source_;
  PreparedModel prepared_;
  const brep::Model& model_;
  FacePlan plan_;
  LeftOutList list_;
  std::vector<bool> kept_;
  std::vector<std::optional<Expected<WrittenEdge>>> pieces_;
  std::unordered_map<std::string, Index> faces_;
  std::unordered_map<std::string, const brep::FreeCurve*> curves_;
};

}  // namespace

bool FacePlan::placed() const {
  return parts.size() != 1 || parts[0].places.size() != 1 ||
         !parts[0].places[0].to_model.matrix().isIdentity(0);
}

std::optional<Colour> FacePlan::colour_of(const brep::Face& face) const {
  auto found = colours.find(face.id);
  if (found == colours.end() && face.support != brep::none)
    found = colours.find(model->supports[face.support].id);
  return found == colours.end() ? std::nullopt : std::optional(found->second);
}

Expected<FacePlan> face_plan(const Source& source, const std::string& unit, Conversion conversion) {
  if (source.model() == nullptr) return input_error("the file has no faces", source.name());
  return Planner(source, unit, conversion).plan();
}

}  // namespace knead::detail
