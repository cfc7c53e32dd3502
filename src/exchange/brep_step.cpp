#include "brep_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "part21_text.hpp"
#include "step_records.hpp"

namespace knead::brep {
namespace {

constexpr std::size_t most_uses = 1'000'000;  // of faces in groups, which may be used again and again
constexpr std::size_t most_chained = 4000;

class ViewBuilder {
 public:
  explicit ViewBuilder(const BrepFile& file)
      : file_(file), records_(static_cast<int>(file.surfaces.size() + file.shapes.size()) + 1) {}

  BrepView build() {
    const std::size_t count = file_.surfaces.size();
    view_.splines.resize(count);
    view_.places.assign(count, Eigen::Affine3d::Identity());
    placed_.assign(count, false);
    for (const Use& root : file_.roots) visit(root, Eigen::Affine3d::Identity(), false);
    for (std::size_t k = 0; k < count; ++k) {  // those without a face
      if (!placed_[k] && file_.surfaces[k].spline) put_surface(k, Eigen::Affine3d::Identity());
    }
    view_.text = records_.exchange_structure();
    return std::move(view_);
  }

 private:
  int name_of(std::size_t shape) const { return static_cast<int>(file_.surfaces.size() + shape) + 1; }

  void visit(const Use& use, const Eigen::Affine3d& outer, bool turned) {
    if (++uses_ > most_uses) return;
    const BrepShape& shape = file_.shapes[use.shape];
    const Eigen::Affine3d move = outer * use.place;
    const bool own = turned != (use.orientation == '-');
    if (shape.kind == Shape::face) return add_face(use.shape, move, own);
    if (shape.kind != Shape::group) return;
    for (const Use& part : shape.uses) visit(part, move, own);
  }

  void add_face(std::size_t index, const Eigen::Affine3d& move, bool turned) {
    const BrepShape& face = file_.shapes[index];
    if (!known_.insert(index).second) {
      ++view_.again;
      return;
    }
    if (face.geometry == 0) return;
    std::vector<int> bounds;
    for (const Use& wire : face.uses) {
      if (file_.shapes[wire.shape].kind != Shape::wire) continue;
      const int loop = add_loop(wire, move * wire.place);
      // Loops run about the normal of the surface here, and about that of the face in STEP.
      if (loop != 0) bounds.push_back(records_.add(fmt::format("FACE_BOUND('',#{},.{}.)", loop, turned ? 'F' : 'T')));
    }
    const std::size_t below = static_cast<std::size_t>(face.geometry) - 1;
    const int surface = surface_of(below, move * face.place);
    const bool same = turned == mirrored(file_.surfaces[below], move * face.place);
    if (bounds.empty()) return;
    records_.put(name_of(index),
                 fmt::format("ADVANCED_FACE('',{},#{},.{}.)", step::list_of(bounds), surface, same ? 'T' : 'F'));
  }

  /// The axes of a plane, cylinder, cone, sphere or torus may be left-handed: its normal is then that of STEP turned.
  static bool mirrored(const BrepSurface& surface, const Eigen::Affine3d& move) {
    if (surface.type > 5) return false;
    const auto axis = [&](std::size_t k) { return Point(move.linear() * at(surface.numbers, k)); };
    return axis(2).cross(axis(3)).dot(axis(1)) < 0;
  }

  /// The record of a surface at this place; another one than the first is a surface of its own, that is not sculpted.
  int surface_of(std::size_t k, const Eigen::Affine3d& move) {
    if (!placed_[k]) {
      put_surface(k, move);
      return static_cast<int>(k) + 1;
    }
    if (view_.places[k].isApprox(move, 1e-12)) return static_cast<int>(k) + 1;
    return records_.add(file_.surfaces[k].spline ? fmt::format("BREP_SURFACE_ELSEWHERE('{}')", k + 1)
                                                 : elementary(file_.surfaces[k], move));
  }

  void put_surface(std::size_t k, const Eigen::Affine3d& move) {
    placed_[k] = true;
    view_.places[k] = move;
    const BrepSurface& surface = file_.surfaces[k];
    const int name = static_cast<int>(k) + 1;
    if (!surface.spline) {
      records_.put(name, elementary(surface, move));
      return;
    }
    auto made = *surface.spline ? detail::surface_of(**surface.spline)
                                : Expected<Surface>(std::unexpected(surface.spline->error()));
    if (made && !move.matrix().isIdentity(0)) {
      Points points = made->control_points();
      for (Eigen::Index p = 0; p < points.rows(); ++p) {
        points.row(p) = (move * Point(points.row(p).transpose())).transpose();
      }
      made = made->with_control_points(std::move(points));
    }
    if (!made) {
      view_.unreadable.push_back({fmt::format("#{}", name), std::move(made.error())});
      records_.put(name, fmt::format("BREP_SURFACE_9('{}')", name));
      return;
    }
    records_.surface(name, *made, {});
    view_.splines[k] = *std::move(made);
  }

  static Point at(const std::vector<double>& v, std::size_t k) { return {v[3 * k], v[3 * k + 1], v[3 * k + 2]}; }

  std::string elementary(const BrepSurface& surface, const Eigen::Affine3d& move) {
    const auto& v = surface.numbers;
    const double scale = std::cbrt(std::abs(move.linear().determinant()));
    const auto length = [&](double value) { return format_real(value * scale); };
    const auto frame = [&] {  // location, axis, x, y
      return records_.frame(move * at(v, 0), move.linear() * at(v, 1), move.linear() * at(v, 2));
    };
    switch (surface.type) {
      case 1:
        return fmt::format("PLANE('',#{})", frame());
      case 2:
        return fmt::format("CYLINDRICAL_SURFACE('',#{},{})", frame(), length(v[12]));
      case 3:
        return fmt::format("CONICAL_SURFACE('',#{},{},{})", frame(), length(v[12]), format_real(v[13]));
      case 4:
        return fmt::format("SPHERICAL_SURFACE('',#{},{})", frame(), length(v[12]));
      case 5:
        return fmt::format("TOROIDAL_SURFACE('',#{},{},{})", frame(), length(v[12]), length(v[13]));
      case 6: {
        const int profile = curve(*surface.profile, move);
        const int vector = records_.add(fmt::format("VECTOR('',#{},1.)", records_.direction(move.linear() * at(v, 0))));
        return fmt::format("SURFACE_OF_LINEAR_EXTRUSION('',#{},#{})", profile, vector);
      }
      case 7: {
        const int profile = curve(*surface.profile, move);
        const int point = records_.point(move * at(v, 0)), axis = records_.direction(move.linear() * at(v, 1));
        const int line = records_.add(fmt::format("AXIS1_PLACEMENT('',#{},#{})", point, axis));
        return fmt::format("SURFACE_OF_REVOLUTION('',#{},#{})", profile, line);
      }
      default:
        return fmt::format("BREP_SURFACE_{}()", surface.type);
    }
  }

  int curve(const BrepCurve& own, const Eigen::Affine3d& move) {
    const auto& v = own.numbers;
    const double scale = std::cbrt(std::abs(move.linear().determinant()));
    if (own.type == 8) return curve(*own.basis, move);
    if (own.type == 1) return records_.line(move * at(v, 0), move.linear() * at(v, 1));
    if (own.type == 2 || own.type == 3) {
      const int frame = records_.frame(move * at(v, 0), move.linear() * at(v, 1), move.linear() * at(v, 2));
      const std::string radius = format_real(v[12] * scale);
      return records_.add(own.type == 2
                              ? fmt::format("CIRCLE('',#{},{})", frame, radius)
                              : fmt::format("ELLIPSE('',#{},{},{})", frame, radius, format_real(v[13] * scale)));
    }
    if (!own.spline) return records_.add(fmt::format("BREP_CURVE_{}()", own.type));
    Points points = own.spline->control_points();
    for (Eigen::Index p = 0; p < points.rows(); ++p)
      points.row(p) = (move * Point(points.row(p).transpose())).transpose();
    const auto moved = own.spline->with_control_points(std::move(points));
    return moved ? records_.curve(*moved) : records_.add("BREP_CURVE_7()");
  }

  /// An edge as a loop runs along it, and the vertices at its ends.
  struct Turn {
    int edge = 0;
    bool back = false;
    int from = 0, to = 0;
  };

  /// Wires list their edges in any order: puts each behind one that ends where it begins, and the way back along a seam
  /// behind what else begins there. Cost: quadratic in the edges of a wire, for at most `most_chained`.
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
        std::rotate(turns.begin() + static_cast<std::ptrdiff_t>(k), turns.begin() + static_cast<std::ptrdiff_t>(next),
                    turns.begin() + static_cast<std::ptrdiff_t>(next) + 1);
    }
  }

  /// An EDGE_LOOP, or a VERTEX_LOOP of a wire that is a point; 0 if there is none.
  int add_loop(const Use& wire, const Eigen::Affine3d& move) {
    std::vector<Turn> turns;
    int pole = 0;
    for (const Use& use : file_.shapes[wire.shape].uses) {
      const BrepShape& edge = file_.shapes[use.shape];
      if (edge.kind != Shape::edge) continue;
      const Eigen::Affine3d own = move * use.place;
      if (edge.degenerated) {
        if (!edge.uses.empty()) pole = vertex(edge.uses.front(), own);
        continue;
      }
      Turn turn{edge_curve(use.shape, own), (use.orientation == '-') != (wire.orientation == '-')};
      const auto [from, to] = ends_.at(turn.edge);
      turn.from = turn.back ? to : from;
      turn.to = turn.back ? from : to;
      turns.push_back(turn);
    }
    chain(turns);
    std::vector<int> oriented;
    for (const Turn& turn : turns) {
      oriented.push_back(records_.add(fmt::format("ORIENTED_EDGE('',*,*,#{},.{}.)", turn.edge, turn.back ? 'F' : 'T')));
    }
    if (!oriented.empty()) return records_.add("EDGE_LOOP(''," + step::list_of(oriented) + ")");
    return pole != 0 ? records_.add(fmt::format("VERTEX_LOOP('',#{})", pole)) : 0;
  }

  /// A record of a shape at a place: the same for places that agree to rounding.
  template <class Make>
  int placed(std::size_t shape, const Eigen::Affine3d& move, const Make& make) {
    auto& own = made_[shape];
    for (const auto& [place, record] : own) {
      if (place.isApprox(move, 1e-12)) return record;
    }
    const int record = make(own.empty());
    made_[shape].emplace_back(move, record);
    return record;
  }

  int vertex(const Use& use, const Eigen::Affine3d& outer) {
    const Eigen::Affine3d move = outer * use.place;
    return placed(use.shape, move, [&](bool) {
      const int record = records_.vertex(move * file_.shapes[use.shape].point);
      view_.sources.vertices[record] = {use.shape, move};
      return record;
    });
  }

  int edge_curve(std::size_t index, const Eigen::Affine3d& move) {
    return placed(index, move, [&](bool first) {
      const BrepShape& edge = file_.shapes[index];
      int from = 0, to = 0;
      for (const Use& use : edge.uses) {
        if (file_.shapes[use.shape].kind != Shape::vertex) continue;
        if (use.orientation == '+' && from == 0) from = vertex(use, move);
        if (use.orientation == '-' && to == 0) to = vertex(use, move);
      }
      const bool whole = from != 0 && to != 0 && edge.geometry != 0;
      const int geometry = whole ? curve(file_.curves[static_cast<std::size_t>(edge.geometry) - 1], move * edge.place)
                                 : records_.add("BREP_CURVE_0()");
      if (from == 0) from = to != 0 ? to : records_.vertex(move.translation());
      if (to == 0) to = from;
      const std::string record = fmt::format("EDGE_CURVE('',#{},#{},#{},.T.)", from, to, geometry);
      const int put = first ? name_of(index) : records_.add(record);
      if (first) records_.put(put, record);
      ends_[put] = {from, to};
      if (whole) view_.sources.edges[put] = {index, move * edge.place};
      return put;
    });
  }

  const BrepFile& file_;
  step::StepRecords records_;
  BrepView view_;
  std::vector<bool> placed_;
  std::set<std::size_t> known_;
  std::map<std::size_t, std::vector<std::pair<Eigen::Affine3d, int>>> made_;
  std::map<int, std::pair<int, int>> ends_;  // vertices of edges
  std::size_t uses_ = 0;
};

}  // namespace

BrepView step_view(const BrepFile& file) { return ViewBuilder(file).build(); }

}  // namespace knead::brep
