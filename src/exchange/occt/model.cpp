#include "model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "brep/geometry_forms.hpp"
#include "brep/model_builder.hpp"
#include "brep/part_graph.hpp"

namespace knead::occt {
namespace {

// Of faces in groups, which may be used again and again.
constexpr std::size_t most_uses = 1'000'000;
constexpr std::size_t most_mapped = 50'000;  // of faces that are used again, together
constexpr std::size_t most_chained = 4000;

using brep::Index;

class ModelReader {
 public:
  ModelReader(const BrepFile& file, std::string name)
      : file_(file),
        builder_(std::move(name), static_cast<int>(file.surfaces.size() + file.shapes.size())) {}

  ReadModel read() {
    const std::size_t count = file_.surfaces.size();
    read_.places.assign(count, Eigen::Affine3d::Identity());
    supports_.assign(count, brep::none);
    for (const Use& root : file_.roots) visit(root, Eigen::Affine3d::Identity(), false);
    for (std::size_t k = 0; k < count; ++k) {  // those without a face
      if (supports_[k] == brep::none && file_.surfaces[k].spline)
        put_surface(k, Eigen::Affine3d::Identity());
    }
    read_.model = std::move(builder_).complete("unknown", 0);
    add_parts(read_.model);
    return std::move(read_);
  }

 private:
  int name_of(std::size_t shape) const {
    return static_cast<int>(file_.surfaces.size() + shape) + 1;
  }

  /// `again`: 0, or the number of the way from where a part that this belongs to was first to where
  /// it is now.
  /// A shape may be used any number of times, each with a location and an orientation that add up
  /// on the way from the root. The first use of a face becomes the face of the model. Every other
  /// use keeps only the motion from the first, way = move · first⁻¹; within a group used again all
  /// faces share the motion of the group. Assemblies with thousands of equal screws so cost one
  /// screw and as many motions.
  void visit(const Use& use, const Eigen::Affine3d& outer, bool turned, int again = 0) {
    if (++uses_ > most_uses) return;
    const BrepShape& shape = file_.shapes[use.shape];
    const Eigen::Affine3d move = outer * use.place;
    const bool is_own = turned != (use.orientation == '-');
    if (shape.kind != Shape::face && shape.kind != Shape::group) return;
    const auto [first, fresh] = first_.try_emplace(use.shape, move);
    if (!fresh && again == 0) {
      ways_.push_back(move * first->second.inverse());
      again = static_cast<int>(ways_.size());
    }
    if (shape.kind == Shape::group) {
      for (const Use& part : shape.uses) visit(part, move, is_own, again);
    } else if (fresh) {
      add_face(use.shape, move, is_own);
    } else {
      ways_of_[use.shape].push_back(again);
    }
  }

  /// Faces that are used again elsewhere, together with those that are used again in the same
  /// places: the parts of an assembly, beside one of everything else.
  void add_parts(brep::Model& model) {
    std::map<std::vector<int>, std::vector<Index>> groups;  // faces
    std::map<std::string, Index> faces;
    for (Index f = 0; f < model.faces.size(); ++f) faces.emplace(model.faces[f].id, f);
    std::size_t places = 0;
    for (const auto& [shape, all] : ways_of_) {
      // A way that is the identity is the same face again; one that shears or scales unevenly can
      // be no place of a part. Both are only counted.
      std::vector<int> ways;
      for (const int k : all) {
        const Eigen::Affine3d& way = ways_[static_cast<std::size_t>(k) - 1];
        const bool elsewhere =
            !way.isApprox(Eigen::Affine3d::Identity(), 1e-9) && brep::scale_of(way.linear());
        if (elsewhere && ++places <= most_mapped)
          ways.push_back(k);
        else
          ++read_.again;
      }
      const auto face = faces.find(brep::ModelBuilder::name(name_of(shape)));
      if (!ways.empty() && face != faces.end()) groups[ways].push_back(face->second);
    }
    if (groups.empty()) return;
    brep::Assembly result;
    result.unit = model.length_unit();
    for (const auto& [ways, members] : groups) {
      brep::Part part{{}, result.unit, {}, {}, {}, {brep::PartPlace{}}};
      for (const Index f : members) part.add(model, f);
      for (const int k : ways) {
        part.places.push_back({{}, ways_[static_cast<std::size_t>(k) - 1]});
        model.instances.emplace_back().id = brep::ModelBuilder::name(builder_.fresh());
      }
      result.parts.push_back(std::move(part));
    }
    brep::add_rest(model, result);
    model.assembly = std::move(result);
  }

  void add_face(std::size_t index, const Eigen::Affine3d& move, bool turned) {
    const BrepShape& shape = file_.shapes[index];
    if (shape.geometry == 0) return;
    brep::Face face;
    face.id = brep::ModelBuilder::name(name_of(index));
    face.kind = "ADVANCED_FACE";
    for (const Use& wire : shape.uses) {
      if (file_.shapes[wire.shape].kind != Shape::wire) continue;
      brep::Bound bound = read_loop(wire, move * wire.place);
      if (bound.kind == brep::Bound::Kind::unknown) continue;
      bound.forward = !turned;  // loops run about the normal of the surface here, and about that of
                                // the face there
      face.bounds.push_back(std::move(bound));
    }
    const std::size_t below = static_cast<std::size_t>(shape.geometry) - 1;
    face.support = support_of(below, move * shape.place);
    // The reversed face of a left-handed frame has the normal of the right-handed one built here.
    face.same_sense = turned == mirrored(file_.surfaces[below], move * shape.place);
    if (!face.bounds.empty()) builder_.add_face(std::move(face));
  }

  /// The axes of a plane, cylinder, cone, sphere or torus may be left-handed: its normal is then
  /// the other one.
  static bool mirrored(const BrepSurface& surface, const Eigen::Affine3d& move) {
    if (surface.type > 5) return false;
    const auto axis = [&](std::size_t k) { return Point(move.linear() * at(surface.numbers, k)); };
    return axis(2).cross(axis(3)).dot(axis(1)) < 0;
  }

  /// A surface at this place; another one than the first is a surface of its own, that is not
  /// sculpted.
  Index support_of(std::size_t k, const Eigen::Affine3d& move) {
    if (supports_[k] == brep::none) {
      put_surface(k, move);
      return supports_[k];
    }
    if (read_.places[k].isApprox(move, 1e-12)) return supports_[k];
    const int name = builder_.fresh();
    if (!file_.surfaces[k].spline)
      return builder_.add_support(elementary(name, file_.surfaces[k], move));
    brep::Support elsewhere;
    elsewhere.id = brep::ModelBuilder::name(name);
    // It would have to be sculpted in both places at once.
    elsewhere.kind = "BREP_SURFACE_ELSEWHERE";
    return builder_.add_support(std::move(elsewhere));
  }

  void put_surface(std::size_t k, const Eigen::Affine3d& move) {
    read_.places[k] = move;
    const BrepSurface& surface = file_.surfaces[k];
    const int name = static_cast<int>(k) + 1;
    if (!surface.spline) {
      supports_[k] = builder_.add_support(elementary(name, surface, move));
      return;
    }
    auto made = *surface.spline ? detail::surface_of(**surface.spline)
                                : Expected<Surface>(std::unexpected(surface.spline->error()));
    if (made && !move.matrix().isIdentity(0))
      made = made->with_control_points(moved(made->control_points(), move));
    if (!made) {
      brep::Support support;
      support.id = brep::ModelBuilder::name(name);
      support.kind = "BREP_SURFACE_9";
      support.wrong = brep::fault(made.error());
      builder_.add_unreadable(name, std::move(made.error()));
      supports_[k] = builder_.add_support(std::move(support));
      return;
    }
    supports_[k] = builder_.add_surface(name, {}, *std::move(made), "unknown", 0);
    read_.surfaces.push_back(k);
  }

  static Point at(const std::vector<double>& v, std::size_t k) {
    return {v[3 * k], v[3 * k + 1], v[3 * k + 2]};
  }
  static double scale_of(const Eigen::Affine3d& move) {
    return std::cbrt(std::abs(move.linear().determinant()));
  }
  /// Location, axis, x, y.
  static std::optional<brep::Frame> frame_of(const std::vector<double>& v,
                                             const Eigen::Affine3d& move) {
    return brep::frame_of(move * at(v, 0), move.linear() * at(v, 1), move.linear() * at(v, 2));
  }
  static Points moved(Points points, const Eigen::Affine3d& move) {
    for (Eigen::Index p = 0; p < points.rows(); ++p)
      points.row(p) = (move * Point(points.row(p).transpose())).transpose();
    return points;
  }

  static brep::Support elementary(int name, const BrepSurface& surface,
                                  const Eigen::Affine3d& move) {
    using Kind = brep::ElementarySurface::Kind;
    constexpr std::array<std::pair<const char*, Kind>, 5> kinds = {
        {{"PLANE", Kind::plane},
         {"CYLINDRICAL_SURFACE", Kind::cylinder},
         {"CONICAL_SURFACE", Kind::cone},
         {"SPHERICAL_SURFACE", Kind::sphere},
         {"TOROIDAL_SURFACE", Kind::torus}}};
    brep::Support support;
    support.id = brep::ModelBuilder::name(name);
    const auto& v = surface.numbers;
    if (surface.type >= 1 && surface.type <= 5) {
      const auto& [title, kind] = kinds[static_cast<std::size_t>(surface.type) - 1];
      support.kind = title;
      const double scale = scale_of(move), second = v.size() > 13 ? v[13] : 0;
      auto form = brep::elementary_of(kind, frame_of(v, move), v.size() > 12 ? scale * v[12] : 0,
                                      kind == Kind::torus ? scale * second : second);
      if (form)
        support.form = *std::move(form);
      else
        support.wrong = brep::fault(form.error().within(support.label()));
    } else if (surface.type == 6 || surface.type == 7) {
      const bool revolution = surface.type == 7;
      support.kind = revolution ? "SURFACE_OF_REVOLUTION" : "SURFACE_OF_LINEAR_EXTRUSION";
      support.form = swept(surface, move, revolution);
    } else {
      support.kind = fmt::format("BREP_SURFACE_{}", surface.type);
    }
    return support;
  }

  static brep::SweptSurface swept(const BrepSurface& surface, const Eigen::Affine3d& move,
                                  bool revolution) {
    const auto& v = surface.numbers;
    const Point origin = revolution ? Point(move * at(v, 0)) : Point(Point::Zero());
    const Point axis = move.linear() * at(v, revolution ? 1 : 0);
    brep::SweptSurface result{revolution, brep::frame_about(origin, axis)};
    auto profile = curve(*surface.profile, move);
    if (profile && axis.norm() > 0)
      result.curve = std::make_shared<const brep::CurveGeometry>(*std::move(profile));
    else
      result.wrong =
          brep::fault(profile ? input_error("its axis has no length").error() : profile.error());
    return result;
  }

  static Expected<brep::CurveGeometry> curve(const BrepCurve& brep_curve,
                                             const Eigen::Affine3d& move) {
    const auto& v = brep_curve.numbers;
    if (brep_curve.type == 8) return curve(*brep_curve.basis, move);
    if (brep_curve.type == 1) return brep::line_of(move * at(v, 0), move.linear() * at(v, 1));
    if (brep_curve.type == 2 || brep_curve.type == 3) {
      const double a = v[12] * scale_of(move),
                   b = brep_curve.type == 2 ? a : v[13] * scale_of(move);
      return brep::conic_of(brep::Conic::Form::ellipse, frame_of(v, move), a, b);
    }
    if (!brep_curve.spline)
      return input_error(
          fmt::format("it lies on a curve of type {}, which is not read", brep_curve.type));
    auto spline =
        brep_curve.spline->with_control_points(moved(brep_curve.spline->control_points(), move));
    if (!spline) return std::unexpected(std::move(spline.error()));
    return brep::spline_of(*std::move(spline));
  }

  /// An edge as a loop runs along it, and the vertices at its ends.
  struct Turn {
    Index edge = brep::none;
    bool back = false;
    Index from = brep::none, to = brep::none;
  };

  /// Wires list their edges in any order: puts each behind one that ends where it begins, and the
  /// way back along a seam behind what else begins there. Cost: quadratic in the edges of a wire,
  /// for at most `most_chained`.
  static void chain(std::vector<Turn>& turns) {
    if (turns.size() > most_chained) return;
    for (std::size_t k = 1; k < turns.size(); ++k) {
      const Turn& before = turns[k - 1];
      std::size_t next = turns.size();
      for (std::size_t j = k; j < turns.size(); ++j) {
        if (turns[j].from != before.to) continue;
        const bool returns = turns[j].edge == before.edge;
        if (!returns || next == turns.size()) next = j;
        if (!returns) break;
      }
      if (next < turns.size())
        std::rotate(turns.begin() + static_cast<std::ptrdiff_t>(k),
                    turns.begin() + static_cast<std::ptrdiff_t>(next),
                    turns.begin() + static_cast<std::ptrdiff_t>(next) + 1);
    }
  }

  /// Of edges, or of the vertex of a wire that is a point; of an unknown kind if there is none.
  brep::Bound read_loop(const Use& wire, const Eigen::Affine3d& move) {
    std::vector<Turn> turns;
    brep::Bound bound;
    for (const Use& use : file_.shapes[wire.shape].uses) {
      const BrepShape& shape = file_.shapes[use.shape];
      if (shape.kind != Shape::edge) continue;
      const Eigen::Affine3d place = move * use.place;
      if (shape.degenerated) {
        if (!shape.uses.empty()) bound.vertex = vertex(shape.uses.front(), place);
        continue;
      }
      Turn turn{edge(use.shape, place), (use.orientation == '-') != (wire.orientation == '-')};
      const brep::Edge& made = builder_.model().edges[turn.edge];
      turn.from = turn.back ? made.end : made.start;
      turn.to = turn.back ? made.start : made.end;
      turns.push_back(turn);
    }
    chain(turns);
    for (const Turn& turn : turns) bound.edges.push_back({turn.edge, !turn.back});
    brep::settle_kind(bound);
    return bound;
  }

  /// What a shape is at a place: the same for places that agree to rounding.
  template <class Make>
  Index placed(std::size_t shape, const Eigen::Affine3d& move, const Make& make) {
    auto& copies = made_[shape];
    for (const auto& [place, index] : copies) {
      if (place.isApprox(move, 1e-12)) return index;
    }
    const Index index = make(copies.empty());
    made_[shape].emplace_back(move, index);
    return index;
  }

  Index vertex(const Use& use, const Eigen::Affine3d& outer) {
    const Eigen::Affine3d move = outer * use.place;
    return placed(use.shape, move, [&](bool first) {
      const int name = first ? name_of(use.shape) : builder_.fresh();
      read_.sources.vertices[brep::ModelBuilder::name(name)] = {use.shape, move};
      return builder_.add_vertex(name, move * file_.shapes[use.shape].point);
    });
  }

  Index edge(std::size_t index, const Eigen::Affine3d& move) {
    return placed(index, move, [&](bool first) {
      const BrepShape& shape = file_.shapes[index];
      Index from = brep::none, to = brep::none;
      for (const Use& use : shape.uses) {
        if (file_.shapes[use.shape].kind != Shape::vertex) continue;
        if (use.orientation == '+' && from == brep::none) from = vertex(use, move);
        if (use.orientation == '-' && to == brep::none) to = vertex(use, move);
      }
      const bool whole = from != brep::none && to != brep::none && shape.geometry != 0;
      const int name = first ? name_of(index) : builder_.fresh();
      Expected<brep::CurveGeometry> geometry =
          input_error("the edge has no curve in space, or no vertices");
      if (whole)
        geometry =
            curve(file_.curves[static_cast<std::size_t>(shape.geometry) - 1], move * shape.place);
      if (!geometry) geometry.error().where = brep::ModelBuilder::name(name);
      if (from == brep::none)
        from = to != brep::none ? to : builder_.add_vertex(builder_.fresh(), move.translation());
      if (to == brep::none) to = from;
      if (whole) read_.sources.edges[brep::ModelBuilder::name(name)] = {index, move * shape.place};
      return builder_.add_edge(name, from, to, std::move(geometry));
    });
  }

  const BrepFile& file_;
  brep::ModelBuilder builder_;
  ReadModel read_;
  std::vector<Index> supports_;  // of the surfaces of the file, where they are first used
  std::map<std::size_t, Eigen::Affine3d> first_;     // where faces and groups are first used
  std::vector<Eigen::Affine3d> ways_;                // from there to where they are used again
  std::map<std::size_t, std::vector<int>> ways_of_;  // of faces: numbers of those, from 1
  std::map<std::size_t, std::vector<std::pair<Eigen::Affine3d, Index>>> made_;
  std::size_t uses_ = 0;
};

}  // namespace

ReadModel read_model(const BrepFile& file, std::string name) {
  return ModelReader(file, std::move(name)).read();
}

}  // namespace knead::occt
