#include "knead/brep/edge_measures.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "base/parallel_for.hpp"
#include "edge_walk.hpp"

namespace knead::brep {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double least_tolerance = 1e-6;  // of gaps, of the size
constexpr double least_share = 0.02;      // of its length that a partly smooth edge is smooth on
constexpr int box_steps = 8;

/// One time that a bound runs along an edge.
struct Use {
  Index face = none;
  bool forward = true;  ///< the face is to the left of the edge, as it runs from start to end
};

std::vector<std::vector<Use>> uses_of_edges(const Model& model) {
  std::vector<std::vector<Use>> result(model.edges.size());
  for (Index f = 0; f < model.faces.size(); ++f) {
    for (const Bound& bound : model.faces[f].bounds) {
      for (const EdgeUse& use : bound.edges) {
        if (use.edge < result.size()) result[use.edge].push_back({f, use.forward == bound.forward});
      }
    }
  }
  return result;
}

std::array<double, 3> array_of(const Point& p) { return {p.x(), p.y(), p.z()}; }

/// What is prepared once: the edges and the faces around them.
class Measurer {
 public:
  Measurer(const Model& model, const EdgeTolerances& tolerances)
      : model_(model), tolerances_(tolerances), uses_(uses_of_edges(model)) {}

  Expected<ModelMeasures> run(std::span<const std::string> ids) {
    std::vector<Index> chosen;
    std::set<std::string> wanted(ids.begin(), ids.end());
    for (Index e = 0; e < model_.edges.size(); ++e) {
      if (uses_[e].empty()) continue;
      used_.push_back(e);
      if (ids.empty() || wanted.erase(model_.edges[e].id) > 0) chosen.push_back(e);
    }
    if (!wanted.empty()) return input_error("there is no such edge of a face", *wanted.begin());
    find_scale();
    prepare(chosen);
    ModelMeasures result{.size = scale_.size, .gap_tolerance = gap_};
    result.edges.resize(chosen.size());
    detail::parallel_for(static_cast<std::ptrdiff_t>(chosen.size()), 1,
                         [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                           for (std::ptrdiff_t k = begin; k < end; ++k) {
                             const auto at = static_cast<std::size_t>(k);
                             result.edges[at] = measured(chosen[at]);
                           }
                         });
    return result;
  }

 private:
  /// The size is that of all edges, whichever are measured.
  void find_scale() {
    pieces_.resize(model_.edges.size());
    Eigen::AlignedBox3d box;
    for (const Index e : used_) {
      pieces_[e] = edge_piece(model_, e);
      if (!*pieces_[e]) continue;
      const EdgePiece& piece = **pieces_[e];
      for (int k = 0; k <= box_steps; ++k) {
        const Point p =
            piece.curve.at(std::lerp(piece.from, piece.to, static_cast<double>(k) / box_steps));
        if (p.allFinite()) box.extend(p);
      }
    }
    if (!box.isEmpty() && box.diagonal().norm() > 0) scale_.size = box.diagonal().norm();
    scale_.tangent = std::max(compared_angle, tolerances_.angle) * degree;
    double stated = 0;
    for (const Support& support : model_.supports) stated = std::max(stated, support.uncertainty);
    for (const SplineSurface& s : model_.surfaces) stated = std::max(stated, s.uncertainty);
    gap_ = tolerances_.gap.value_or(std::max(stated, least_tolerance * scale_.size));
  }

  void prepare(const std::vector<Index>& chosen) {
    std::set<Index> faces, splines;
    for (const Index e : chosen) {
      for (const Use& use : uses_[e]) faces.insert(use.face);
    }
    const auto spline_of = [&](Index f) {
      const Index support = model_.faces[f].support;
      return support == none ? none : model_.supports[support].spline;
    };
    for (const Index f : faces) {
      if (spline_of(f) != none) splines.insert(spline_of(f));
    }
    splines_.resize(model_.surfaces.size());
    faces_.resize(model_.faces.size());
    each(splines, [&](Index s) {
      // The model outlives the measuring.
      splines_[s] = CheckedSpline::create(
          std::shared_ptr<const Surface>(std::shared_ptr<void>(), &model_.surfaces[s].surface));
    });
    each(faces, [&](Index f) {
      const Index s = spline_of(f);
      if (s != none && !*splines_[s]) {
        faces_[f] = std::unexpected(splines_[s]->error());
        return;
      }
      faces_[f] = CheckedFace::create(model_, model_.faces[f], s == none ? nullptr : **splines_[s]);
    });
  }

  template <class F>
  static void each(const std::set<Index>& chosen, const F& f) {
    const std::vector<Index> list(chosen.begin(), chosen.end());
    detail::parallel_for(static_cast<std::ptrdiff_t>(list.size()), 1,
                         [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                           for (std::ptrdiff_t k = begin; k < end; ++k)
                             f(list[static_cast<std::size_t>(k)]);
                         });
  }

  EdgeMeasures measured(Index e) const {
    EdgeMeasures result;
    result.id = model_.edges[e].id;
    for (const Use& use : uses_[e]) {
      const std::string& id = model_.faces[use.face].id;
      if (std::ranges::find(result.faces, id) == result.faces.end()) result.faces.push_back(id);
    }
    if (!*pieces_[e]) {
      result.reason = pieces_[e]->error().message();
      return result;
    }
    const EdgePiece& piece = **pieces_[e];
    const auto place = [&](double share) {
      const double s = piece.backwards ? 1 - share : share;
      return array_of(piece.curve.at(std::lerp(piece.from, piece.to, s)));
    };
    result.start = place(0);
    result.middle = place(0.5);
    result.end = place(1);
    auto sides = sides_of(e, piece);
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
    fill(result, walked, e, *sides);
    return result;
  }

  /// The face is to the left of its bound, seen from the tip of its normal; the edge may run
  /// against its bound, the curve against the edge, and the normal of the surface against the
  /// face's.
  Expected<std::vector<EdgeSide>> sides_of(Index e, const EdgePiece& piece) const {
    std::vector<EdgeSide> sides;
    for (const Use& use : uses_[e]) {
      const auto& face = *faces_[use.face];
      if (!face) return std::unexpected(face.error());
      EdgeSide& side = sides.emplace_back(EdgeSide{&*face});
      for (const bool against :
           {!use.forward, piece.backwards, !model_.faces[use.face].same_sense, face->turned()}) {
        if (against) side.way = -side.way;
      }
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
        const bool again = k > 0 && sides.size() > 2 && uses_[e][k].face == uses_[e][k - 1].face;
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
    if (std::max(edge.gap->value, edge.off_curve->value) > gap_) return EdgeKind::gap;
    if (!edge.angle) return EdgeKind::unknown;
    if (edge.angle->value >= meant_smooth)
      return edge.smooth_share >= least_share ? EdgeKind::partly : EdgeKind::sharp;
    if (edge.angle->value > tolerances_.angle) return EdgeKind::g0;
    const bool bends_alike =
        edge.relative_curvature && edge.relative_curvature->value <= tolerances_.curvature;
    return bends_alike ? EdgeKind::g2 : EdgeKind::g1;
  }

  const Model& model_;
  EdgeTolerances tolerances_;
  std::vector<std::vector<Use>> uses_;  // of every edge
  std::vector<Index> used_;
  std::vector<std::optional<Expected<EdgePiece>>> pieces_;
  std::vector<std::optional<Expected<std::shared_ptr<const CheckedSpline>>>> splines_;
  std::vector<std::optional<Expected<CheckedFace>>> faces_;
  EdgeScale scale_;
  double gap_ = 0;
};

}  // namespace

Expected<ModelMeasures> measure_edges(const Model& model, const EdgeTolerances& tolerances,
                                      std::span<const std::string> ids) {
  return Measurer(model, tolerances).run(ids);
}

}  // namespace knead::brep
