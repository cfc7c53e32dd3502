#include "knead/brep/edge_measures.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <unordered_map>

#include "bare_faces.hpp"
#include "base/parallel_for.hpp"
#include "edge_meetings.hpp"
#include "edge_walk.hpp"

namespace knead::brep {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double least_tolerance = 1e-6;  // of gaps, of the size
constexpr double least_share = 0.02;      // of its length that a partly smooth edge is smooth on
constexpr int box_steps = 8;
constexpr double course_chord = 1e-3;  // of the radius: how far chords of a course are from it
constexpr double meeting = 5e-5;  // of the size: edges of one face each that come so near meet …
constexpr double parted = 10;     // … as long as they are not so many times as far apart

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

/// What is measured: an edge, or a part of one and what it meets there.
struct Measured {
  std::string id;
  Index edge = none, other = none;
  std::optional<EdgeMeeting> part = {};
};

/// What is prepared once: the edges and the faces around them.
class Measurer {
 public:
  /// \param sides of B-spline surfaces that are edges, by edge
  Measurer(const Model& model, const EdgeTolerances& tolerances,
           std::span<const std::optional<CheckedFace::Side>> sides)
      : model_(model), tolerances_(tolerances), bare_(sides), uses_(uses_of_edges(model)) {}

  Expected<ModelMeasures> run(std::span<const std::string> ids) {
    for (Index e = 0; e < model_.edges.size(); ++e) {
      if (!uses_[e].empty()) used_.push_back(e);
    }
    find_scale();
    std::vector<Measured> items = all_items();
    if (auto right = choose(items, ids); !right) return std::unexpected(right.error());
    prepare(items);
    ModelMeasures result{.size = scale_.size, .gap_tolerance = gap_};
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
  Expected<void> choose(std::vector<Measured>& items, std::span<const std::string> ids) const {
    if (ids.empty()) return {};
    const std::set<std::string> wanted(ids.begin(), ids.end());
    std::set<std::string> found;
    std::erase_if(items, [&](const Measured& item) {
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

  std::vector<Measured> all_items() const {
    std::vector<LooseEdge> loose;
    std::unordered_map<std::string, Index> part_of;
    if (model_.assembly) {
      for (Index k = 0; k < model_.assembly->parts.size(); ++k) {
        for (const auto* ids :
             {&model_.assembly->parts[k].faces, &model_.assembly->parts[k].surfaces})
          for (const std::string& id : *ids) part_of.emplace(id, k);
      }
    }
    for (const Index e : used_) {
      if (uses_[e].size() != 1 || !*pieces_[e]) continue;
      const auto part = part_of.find(model_.faces[uses_[e][0].face].id);
      loose.push_back({e, &**pieces_[e], part == part_of.end() ? none : part->second});
    }
    const auto meetings = meetings_of(loose, std::max(meeting * scale_.size, 2 * gap_), parted);
    std::vector<Measured> items;
    std::size_t next = 0;
    for (const Index e : used_) {
      const std::string& id = model_.edges[e].id;
      if (next == loose.size() || loose[next].edge != e) {
        items.push_back({id, e});
        continue;
      }
      std::map<std::string, int> times;
      const bool is_whole = meetings[next].size() == 1 && meetings[next][0].other == none;
      for (const EdgeMeeting& met : meetings[next]) {
        std::string name = id + (met.other == none ? "" : "+" + model_.edges[met.other].id);
        if (const int again = times[name]++; again > 0) name += "/" + std::to_string(again + 1);
        items.push_back({name, e, met.other, is_whole ? std::nullopt : std::optional(met)});
      }
      ++next;
    }
    return items;
  }

  Expected<EdgePiece> piece_of(Index e) const {
    if (e >= bare_.size() || !bare_[e]) return edge_piece(model_, e);
    auto curve = EdgeCurve::create(*model_.edges[e].curve);
    if (!curve) return std::unexpected(curve.error());
    const Interval whole = curve->domain().value_or(Interval{0, 1});
    return EdgePiece{.curve = *std::move(curve), .from = whole.lower, .to = whole.upper};
  }

  /// The size is that of all edges, whichever are measured.
  void find_scale() {
    pieces_.resize(model_.edges.size());
    Eigen::AlignedBox3d box;
    for (const Index e : used_) {
      pieces_[e] = piece_of(e);
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

  void prepare(const std::vector<Measured>& items) {
    std::set<Index> faces, splines;
    for (const Measured& item : items) {
      for (const Use& use : uses_[item.edge]) faces.insert(use.face);
      if (item.other != none) faces.insert(uses_[item.other][0].face);
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

  EdgeMeasures measured(const Measured& item) const {
    const Index e = item.edge;
    EdgeMeasures result;
    result.id = item.id;
    const auto add_face = [&](const Use& use) {
      const std::string& id = model_.faces[use.face].id;
      if (std::ranges::find(result.faces, id) == result.faces.end()) result.faces.push_back(id);
    };
    for (const Use& use : uses_[e]) add_face(use);
    if (item.other != none) add_face(uses_[item.other][0]);
    if (!*pieces_[e]) {
      result.reason = pieces_[e]->error().message();
      return result;
    }
    EdgePiece piece = **pieces_[e];
    if (item.part) {
      piece.from = item.part->from;
      piece.to = item.part->to;
    }
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
  Expected<std::vector<EdgeSide>> sides_of(const Measured& item, const EdgePiece& piece) const {
    std::vector<EdgeSide> sides;
    const auto add = [&](Index e, bool against_it) -> Expected<void> {
      for (const Use& use : uses_[e]) {
        const auto& face = *faces_[use.face];
        if (!face) return std::unexpected(face.error());
        EdgeSide& side = sides.emplace_back(EdgeSide{&*face});
        for (const bool against : {!use.forward, (*pieces_[e])->backwards, against_it,
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
      if (sides[0].face == sides[1].face && item.edge < bare_.size()) {
        sides[0].line = bare_[item.edge];
        sides[1].line = bare_[item.other];
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
  std::span<const std::optional<CheckedFace::Side>> bare_;
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
  if (const auto faced = with_bare_faces(model))
    return Measurer(faced->model, tolerances, faced->sides).run(ids);
  return Measurer(model, tolerances, {}).run(ids);
}

}  // namespace knead::brep
