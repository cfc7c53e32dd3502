#include "knead/brep/edge_measures.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "base/parallel_for.hpp"
#include "checked_edges.hpp"

namespace knead::brep {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double least_share = 0.02;   // of its length that a partly smooth edge is smooth on
constexpr double course_chord = 1e-3;  // of the radius: how far chords of a course are from it

std::array<double, 3> array_of(const Point& p) { return {p.x(), p.y(), p.z()}; }

class Measurer {
 public:
  Measurer(CheckedEdges& edges, const EdgeTolerances& tolerances)
      : edges_(edges), model_(edges.model()), tolerances_(tolerances), scale_(edges.scale()) {}

  Expected<ModelMeasures> run(std::span<const std::string> ids) {
    std::vector<CheckedEdge> items = edges_.all();
    if (auto right = choose(items, ids); !right) return std::unexpected(right.error());
    edges_.prepare(items);
    ModelMeasures result{.size = scale_.size, .gap_tolerance = edges_.gap()};
    result.edges.resize(items.size());
    detail::parallel_for(static_cast<std::ptrdiff_t>(items.size()), 1,
                         [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                           for (std::ptrdiff_t k = begin; k < end; ++k) {
                             const auto at = static_cast<std::size_t>(k);
                             result.edges[at] = measured(items[at]);
                           }
                         });
    return result;
  }

 private:
  /// Those with these ids, or of edges with them; an empty list: all.
  Expected<void> choose(std::vector<CheckedEdge>& items, std::span<const std::string> ids) const {
    if (ids.empty()) return {};
    const std::set<std::string> wanted(ids.begin(), ids.end());
    std::set<std::string> found;
    std::erase_if(items, [&](const CheckedEdge& item) {
      bool chosen = false;
      const auto look = [&](const std::string& id) {
        if (wanted.contains(id)) {
          found.insert(id);
          chosen = true;
        }
      };
      look(item.id);
      look(model_.edges[item.edge].id);
      if (item.other != none) look(model_.edges[item.other].id);
      return !chosen;
    });
    for (const std::string& id : wanted) {
      if (!found.contains(id)) return input_error("there is no such edge of a face", id);
    }
    return {};
  }

  EdgeMeasures measured(const CheckedEdge& item) const {
    const Index e = item.edge;
    EdgeMeasures result;
    result.id = item.id;
    const auto add_face = [&](const FaceUse& use) {
      const std::string& id = model_.faces[use.face].id;
      if (std::ranges::find(result.faces, id) == result.faces.end()) result.faces.push_back(id);
    };
    for (const FaceUse& use : edges_.uses(e)) add_face(use);
    if (item.other != none) add_face(edges_.uses(item.other)[0]);
    if (!edges_.piece(e)) {
      result.reason = edges_.piece(e).error().message();
      return result;
    }
    const EdgePiece piece = edges_.piece(item);
    const auto place = [&](double share) {
      const double s = piece.backwards ? 1 - share : share;
      return array_of(piece.curve.at(std::lerp(piece.from, piece.to, s)));
    };
    result.start = place(0);
    result.middle = place(0.5);
    result.end = place(1);
    auto sides = sides_of(item, piece);
    if (!sides) {
      result.reason = sides.error().message();
      return result;
    }
    const EdgeWalk walked = walk(piece, *sides, scale_);
    result.length = walked.length;
    result.samples = static_cast<int>(walked.samples.size());
    if (!std::isfinite(walked.length)) {
      result.reason = "its curve is not finite";
      result.length = 0;
      return result;
    }
    result.course = course_of(piece);
    fill(result, walked, e, *sides);
    if (item.part && item.part->several && result.kind != EdgeKind::unknown)
      result.kind = EdgeKind::non_manifold;
    return result;
  }

  static std::vector<std::array<double, 3>> course_of(const EdgePiece& piece) {
    std::vector<std::array<double, 3>> course;
    for (const double t : piece.curve.subdivided(piece.from, piece.to, {course_chord}))
      course.push_back(array_of(piece.curve.at(t)));
    if (piece.backwards) std::ranges::reverse(course);
    return course;
  }

  /// The face is to the left of its bound, seen from the tip of its normal; the edge may run
  /// against its bound, the curve against the edge, and the normal of the surface against the
  /// face's.
  Expected<std::vector<EdgeSide>> sides_of(const CheckedEdge& item, const EdgePiece& piece) const {
    std::vector<EdgeSide> sides;
    const auto add = [&](Index e, bool against_it) -> Expected<void> {
      for (const FaceUse& use : edges_.uses(e)) {
        const auto& face = edges_.face(use.face);
        if (!face) return std::unexpected(face.error());
        EdgeSide& side = sides.emplace_back(EdgeSide{&*face});
        for (const bool against : {!use.forward, edges_.piece(e)->backwards, against_it,
                                   !model_.faces[use.face].same_sense, face->turned()}) {
          if (against) side.way = -side.way;
        }
      }
      return {};
    };
    if (auto added = add(item.edge, false); !added) return std::unexpected(added.error());
    if (item.other != none) {
      if (auto added = add(item.other, !item.part->same_way); !added)
        return std::unexpected(added.error());
      if (sides[0].face == sides[1].face && edges_.side(item.edge)) {
        sides[0].line = edges_.side(item.edge);
        sides[1].line = edges_.side(item.other);
      }
      return sides;
    }
    if (sides.size() == 2 && sides[0].face == sides[1].face && sides[0].way != sides[1].way) {
      const double middle = (piece.from + piece.to) / 2;
      const auto lines = sides[0].face->seam_at(piece.curve.at(middle),
                                                sides[0].way * piece.curve.derivative(middle));
      for (std::size_t k = 0; lines && k < 2; ++k) sides[k].line = (*lines)[k];
    }
    return sides;
  }

  void fill(EdgeMeasures& result, const EdgeWalk& walked, Index e,
            const std::vector<EdgeSide>& sides) const {
    const bool alone = sides.size() == 1;
    const auto figure = [&](Measure m, double unit = 1) -> std::optional<EdgeFigure> {
      const EdgeSample& top = walked.largest[static_cast<std::size_t>(m)];
      if (top[m] < 0) return std::nullopt;
      EdgeFigure made{top[m] / unit, {array_of(top.point), {}}};
      for (std::size_t k = 0; k < sides.size(); ++k) {
        // A face is listed once, but for the two sides of a seam.
        const bool again =
            k > 0 && sides.size() > 2 && edges_.uses(e)[k].face == edges_.uses(e)[k - 1].face;
        if (!again) made.at.parameters.push_back(sides[k].face->told(top.feet[k]));
      }
      return made;
    };
    result.gap = figure(Measure::gap);
    result.off_curve = figure(Measure::off_curve);
    if (!alone) result.angle = figure(Measure::angle, degree);
    if (!alone) result.curvature = figure(Measure::curvature);
    if (!alone) result.relative_curvature = figure(Measure::relative_curvature);
    for (const EdgeSample& sample : walked.samples) {
      const double angle = sample[Measure::angle] / degree;
      if (angle >= 0) result.least_angle = std::min(result.least_angle.value_or(angle), angle);
    }
    result.smooth_share = smooth_share(walked);
    result.kind = kind_of(result, sides);
    if (result.kind == EdgeKind::unknown) result.reason = "its faces have no tangent plane there";
  }

  double smooth_share(const EdgeWalk& walked) const {
    double smooth = 0, all = 0;
    const auto is_smooth = [&](const EdgeSample& s) {
      return s[Measure::angle] >= 0 && s[Measure::angle] <= tolerances_.angle * degree;
    };
    for (std::size_t k = 0; k + 1 < walked.samples.size(); ++k) {
      const EdgeSample &a = walked.samples[k], &b = walked.samples[k + 1];
      const double chord = (b.point - a.point).norm();
      all += chord;
      smooth += chord * (is_smooth(a) + is_smooth(b)) / 2;
    }
    return all > 0 ? smooth / all : 0;
  }

  EdgeKind kind_of(const EdgeMeasures& edge, const std::vector<EdgeSide>& sides) const {
    if (!edge.gap || !edge.off_curve) return EdgeKind::unknown;
    if (sides.size() == 1) return EdgeKind::open;
    if (sides.size() > 2) return EdgeKind::non_manifold;
    if (sides[0].face == sides[1].face) return EdgeKind::seam;
    if (std::max(edge.gap->value, edge.off_curve->value) > edges_.gap()) return EdgeKind::gap;
    if (!edge.angle) return EdgeKind::unknown;
    if (edge.angle->value >= meant_smooth)
      return edge.smooth_share >= least_share ? EdgeKind::partly : EdgeKind::sharp;
    if (edge.angle->value > tolerances_.angle) return EdgeKind::g0;
    const bool bends_alike =
        edge.relative_curvature && edge.relative_curvature->value <= tolerances_.curvature;
    return bends_alike ? EdgeKind::g2 : EdgeKind::g1;
  }

  CheckedEdges& edges_;
  const Model& model_;
  EdgeTolerances tolerances_;
  EdgeScale scale_;
};

}  // namespace

Expected<ModelMeasures> measure_edges(const Model& model, const EdgeTolerances& tolerances,
                                      std::span<const std::string> ids) {
  CheckedEdges edges(model, tolerances);
  return Measurer(edges, tolerances).run(ids);
}

}  // namespace knead::brep
