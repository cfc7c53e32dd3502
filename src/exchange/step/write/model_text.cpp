#include "model_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "exchange/part21/part21_text.hpp"
#include "model_geometry.hpp"
#include "new_faces.hpp"

namespace knead::step {
namespace {

constexpr double least_uncertainty = 1e-7;  // a length

void list(std::string& all, const std::string& item) { all += (all.empty() ? "" : ",") + item; }

/// One product with everything that it holds.
class PartWriter {
 public:
  PartWriter(const detail::FacePlan& plan, const detail::WrittenPart& part, const std::string& name,
             NewFile& file)
      : plan_(plan), part_(part), name_(name), file_(file), geometry_(plan, file) {}

  struct Result {
    NewFile::Product product;
    std::string representation, frame;
  };

  Expected<Result> write() {
    result_.product = file_.add_product(name_);
    context_ = file_.add_context(part_.unit, std::max(part_.uncertainty, least_uncertainty));
    result_.frame = file_.add_origin();
    std::string solids, sheets;
    for (const detail::WrittenSolid& solid : part_.shells.solids) list(solids, add_solid(solid));
    if (!solids.empty()) represent("ADVANCED_BREP_SHAPE_REPRESENTATION", solids);
    std::string open;
    for (const detail::WrittenShell& shell : part_.shells.sheets) list(open, add_shell(shell));
    if (!open.empty()) list(sheets, file_.add("SHELL_BASED_SURFACE_MODEL('',(" + open + "))"));
    if (auto status = add_natural_faces(sheets); !status)
      return std::unexpected(std::move(status.error()));
    if (!sheets.empty()) represent("MANIFOLD_SURFACE_SHAPE_REPRESENTATION", sheets);
    std::string curves;
    for (const NamedCurve& curve : part_.curves)
      list(curves, geometry_.spline(curve.curve, curve.name));
    if (!curves.empty())
      represent("GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION",
                file_.add("GEOMETRIC_CURVE_SET('',(" + curves + "))"));
    file_.add(fmt::format("SHAPE_DEFINITION_REPRESENTATION({},{})", result_.product.shape,
                          result_.representation));
    add_colours(colours_, context_, [&](const std::string& record) { return file_.add(record); });
    return result_;
  }

 private:
  /// The first representation is that of the product; the others are related to it.
  void represent(const char* kind, const std::string& items) {
    const auto made = file_.add(fmt::format("{}({},({},{}),{})", kind, encode_string(name_),
                                            result_.frame, items, context_));
    if (result_.representation.empty())
      result_.representation = made;
    else
      file_.add(fmt::format("SHAPE_REPRESENTATION_RELATIONSHIP('','',{},{})",
                            result_.representation, made));
  }

  std::string add_face(const detail::WrittenFace& written) {
    const brep::Face& face = plan_.model->faces[written.face];
    std::string bounds;
    for (const brep::Bound& bound : face.bounds) {
      std::string loop;
      if (bound.kind == brep::Bound::Kind::vertex) {
        loop = file_.add("VERTEX_LOOP(''," + geometry_.vertex(bound.vertex) + ")");
      } else {
        std::string edges;
        for (const brep::EdgeUse& use : bound.edges) {
          list(edges, file_.add(fmt::format("ORIENTED_EDGE('',*,*,{},{})", geometry_.edge(use.edge),
                                            use.forward ? ".T." : ".F.")));
        }
        loop = file_.add("EDGE_LOOP('',(" + edges + "))");
      }
      // Which of several bounds is the outer one is not known, and need not be said.
      const bool outer = face.bounds.size() == 1 && bound.kind == brep::Bound::Kind::edges;
      list(bounds,
           file_.add(fmt::format("{}('',{},{})", outer ? "FACE_OUTER_BOUND" : "FACE_BOUND", loop,
                                 detail::runs_forward(bound, face, written) ? ".T." : ".F.")));
    }
    const brep::SplineSurface* spline = plan_.model->spline_under(face);
    const auto made = file_.add(
        fmt::format("ADVANCED_FACE({},({}),{},{})",
                    encode_string(spline != nullptr ? spline->name : std::string()), bounds,
                    geometry_.surface(face.support), written.same_sense ? ".T." : ".F."));
    if (const auto colour = plan_.colour_of(face)) colours_.push_back({made, *colour});
    return made;
  }

  std::string add_shell(const detail::WrittenShell& shell) {
    std::string faces;
    for (const detail::WrittenFace& face : shell.faces) list(faces, add_face(face));
    return file_.add(
        fmt::format("{}('',({}))", shell.closed ? "CLOSED_SHELL" : "OPEN_SHELL", faces));
  }

  std::string add_solid(const detail::WrittenSolid& solid) {
    const auto outer = add_shell(solid.outer);
    if (solid.hollows.empty()) return file_.add(fmt::format("MANIFOLD_SOLID_BREP('',{})", outer));
    std::string hollows;
    for (const detail::WrittenShell& hollow : solid.hollows)
      list(hollows,
           file_.add(fmt::format("ORIENTED_CLOSED_SHELL('',*,{},.F.)", add_shell(hollow))));
    return file_.add(fmt::format("BREP_WITH_VOIDS('',{},({}))", outer, hollows));
  }

  Expected<void> add_natural_faces(std::string& sheets) {
    if (part_.surfaces.empty()) return {};
    std::vector<NewSurface> surfaces;
    std::vector<std::string> names;
    for (const NamedSurface& s : part_.surfaces) {
      surfaces.push_back({s.name, s.surface, s.colour});
      names.push_back(geometry_.spline(s.surface, s.name));
    }
    auto made =
        add_faces(surfaces, names, [&](const std::string& record) { return file_.add(record); });
    if (!made) return std::unexpected(std::move(made.error()));
    list(sheets, made->model);
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
      if (surfaces[k].colour) colours_.push_back({made->faces[k], *surfaces[k].colour});
    }
    return {};
  }

  const detail::FacePlan& plan_;
  const detail::WrittenPart& part_;
  const std::string& name_;
  NewFile& file_;
  ModelGeometry geometry_;
  Result result_;
  std::string context_;
  std::vector<Coloured> colours_;
};

/// The assembly that parts are components of.
class AssemblyWriter {
 public:
  AssemblyWriter(const detail::FacePlan& plan, NewFile& file) : plan_(plan), file_(file) {}

  void write(const std::string& name, const std::vector<PartWriter::Result>& parts) {
    const auto product = file_.add_product(name);
    const auto context = file_.add_context(plan_.unit, least_uncertainty);
    std::vector<std::vector<std::string>> frames;
    std::string all = file_.add_origin();
    for (const detail::WrittenPart& part : plan_.parts) {
      auto& stored = frames.emplace_back();
      for (const brep::PartPlace& place : part.places)
        list(all, stored.emplace_back(frame(place.to_model)));
    }
    const auto representation = file_.add(
        fmt::format("SHAPE_REPRESENTATION({},({}),{})", encode_string(name), all, context));
    file_.add(fmt::format("SHAPE_DEFINITION_REPRESENTATION({},{})", product.shape, representation));
    for (std::size_t k = 0; k < parts.size(); ++k) {
      for (std::size_t n = 0; n < frames[k].size(); ++n) {
        const std::string label = encode_string(plan_.parts[k].places[n].path);
        const auto use =
            file_.add(fmt::format("NEXT_ASSEMBLY_USAGE_OCCURRENCE('{}',{},'',{},{},$)", ++uses_,
                                  label, product.definition, parts[k].product.definition));
        const auto shape = file_.add(fmt::format("PRODUCT_DEFINITION_SHAPE('','',{})", use));
        const auto move = file_.add(
            fmt::format("ITEM_DEFINED_TRANSFORMATION('','',{},{})", parts[k].frame, frames[k][n]));
        const auto relation =
            file_.add(fmt::format("(REPRESENTATION_RELATIONSHIP('','',{},{})REPRESENTATION_"
                                  "RELATIONSHIP_WITH_TRANSFORMATION({})"
                                  "SHAPE_REPRESENTATION_RELATIONSHIP())",
                                  parts[k].representation, representation, move));
        file_.add(fmt::format("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION({},{})", relation, shape));
      }
    }
  }

 private:
  /// The units of the contexts scale by themselves.
  std::string frame(const Eigen::Affine3d& place) {
    const Point origin = place.translation(), z = place.linear().col(2).normalized(),
                x = place.linear().col(0).normalized();
    const auto direction = [&](const Point& d) {
      return file_.add(fmt::format("DIRECTION('',({},{},{}))", format_real(d.x()),
                                   format_real(d.y()), format_real(d.z())));
    };
    const auto at = file_.add_point(origin.data()), axis = direction(z), along = direction(x);
    return file_.add(fmt::format("AXIS2_PLACEMENT_3D('',{},{},{})", at, axis, along));
  }

  const detail::FacePlan& plan_;
  NewFile& file_;
  int uses_ = 0;
};

}  // namespace

Expected<std::string> model_text(const detail::FacePlan& plan, const TextOptions& options) {
  for (const std::string* unit : {&plan.unit, &options.unit}) {
    if (auto known = check_unit(*unit); !known) return std::unexpected(std::move(known.error()));
  }
  NewFile file(options.schema);
  std::vector<PartWriter::Result> parts;
  for (const detail::WrittenPart& part : plan.parts) {
    auto made =
        PartWriter(plan, part, part.name.empty() ? options.product : part.name, file).write();
    if (!made) return std::unexpected(std::move(made.error()));
    parts.push_back(*std::move(made));
  }
  if (plan.placed()) AssemblyWriter(plan, file).write(options.product, parts);
  return file.text(options);
}

}  // namespace knead::step
