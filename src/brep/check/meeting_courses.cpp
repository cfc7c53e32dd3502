#include "meeting_courses.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <set>

#include "base/parallel_for.hpp"
#include "brep/boundary_curve.hpp"
#include "brep/face_region.hpp"
#include "brep/surfaces/surface_foot.hpp"
#include "checked_edges.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::brep {
namespace {

using Eigen::Vector2d;
using Sample = SharedEdge::Sample;
using Side = CheckedFace::Side;

constexpr int least_intervals = 256, most_halvings = 12;
constexpr double sampling_chord = 2e-3;
// Feet between samples are taken on chords of these: off along the edge by at most this share of
// the size, so that the displacements of both sides are compared at one point.
constexpr double true_chord = 1e-6;

/// The surface on one side of a meeting.
struct MetSurface {
  Index surface = none;
  std::optional<Side> side = {};  ///< that the feet are on
};

class Courses {
 public:
  explicit Courses(const Model& model) : edges_(model, {}) {}

  std::vector<MeetingCourse> run() {
    std::vector<CheckedEdge> items = edges_.all();
    std::erase_if(items, [](const CheckedEdge& item) { return item.other == none; });
    edges_.prepare(items);
    make_searches(items);
    std::vector<std::optional<MeetingCourse>> made(items.size());
    detail::parallel_for(std::ssize(items), 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
        made[k] = course_of(items[k]);
    });
    std::vector<MeetingCourse> result;
    for (auto& course : made) {
      if (course) result.push_back(*std::move(course));
    }
    return result;
  }

 private:
  [[nodiscard]] const Surface& shape(Index surface) const {
    return edges_.model().surfaces[surface].surface;
  }

  [[nodiscard]] MetSurface met_by(Index edge) const {
    return {edges_.spline_under(edges_.uses(edge)[0].face), edges_.side(edge)};
  }

  void make_searches(const std::vector<CheckedEdge>& items) {
    std::set<Index> wanted;
    for (const CheckedEdge& item : items) {
      for (const Index edge : {item.edge, item.other}) {
        if (met_by(edge).surface != none) wanted.insert(met_by(edge).surface);
      }
    }
    const std::vector<Index> list(wanted.begin(), wanted.end());
    searches_.resize(edges_.model().surfaces.size());
    detail::parallel_for(std::ssize(list), 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
        if (auto made = SurfaceFoot::create(shape(list[k]))) searches_[list[k]] = *std::move(made);
      }
    });
  }

  /// Closed surfaces whose ends are two edges meet themselves along the line between these.
  [[nodiscard]] bool meets_itself(const CheckedEdge& item, const EdgePiece& piece,
                                  std::array<MetSurface, 2>& met) const {
    if (met[0].side && met[1].side) return true;
    const auto& face = edges_.face(edges_.uses(item.edge)[0].face);
    if (!face) return false;
    const double middle = (piece.from + piece.to) / 2;
    const auto lines = face->seam_at(piece.curve.at(middle), piece.curve.derivative(middle));
    if (!lines) return false;
    for (std::size_t k = 0; k < 2; ++k) met[k].side = (*lines)[k];
    return true;
  }

  [[nodiscard]] std::optional<MeetingCourse> course_of(const CheckedEdge& item) const {
    std::array<MetSurface, 2> met = {met_by(item.edge), met_by(item.other)};
    const EdgePiece piece = edges_.piece(item);
    if (met[0].surface != none && met[0].surface == met[1].surface &&
        !meets_itself(item, piece, met))
      return std::nullopt;
    MeetingCourse result{.id = item.id};
    std::vector<Point> points;
    for (const double t : even_parameters(piece)) {
      points.push_back(piece.curve.at(t));
      result.samples.push_back({t, points.back(), {}});
      if (!points.back().allFinite()) return std::nullopt;
    }
    std::vector<Followed> followed;
    for (std::size_t side = 0; side < 2; ++side) {
      const auto& [surface, line] = met[side];
      if (surface == none || !searches_[surface]) continue;
      result.surfaces[side] = surface;
      const Surface& s = shape(surface);
      followed.push_back(
          {s, *searches_[surface], line, on_surface * net_diagonal(s.control_points())});
      const auto feet = followed.back().search.along(points, followed.back().within).feet;
      for (std::size_t k = 0; k < feet.size(); ++k)
        result.samples[k].feet.push_back(followed.back().on_side(feet[k]));
    }
    if (followed.empty()) return std::nullopt;
    result.samples = with_true_chords(result.samples, piece, followed);
    std::vector<Surface> surfaces;
    for (const Followed& f : followed) surfaces.push_back(f.surface);
    for (Sample& sample : result.samples)
      look_across(surfaces, piece.curve.derivative(sample.parameter), sample);
    return result;
  }

  /// A surface along a meeting.
  struct Followed {
    const Surface& surface;
    const SurfaceFoot& search;
    std::optional<Side> side;
    double within = 0;

    [[nodiscard]] Vector2d on_side(Vector2d foot) const {
      if (side) foot[side->direction] = side->end;
      return foot;
    }
    [[nodiscard]] Point at(const Vector2d& foot) const {
      return evaluate_point<2>(surface, parameters_at_foot(surface, foot)).value_or(Point::Zero());
    }
  };

  static std::vector<double> even_parameters(const EdgePiece& piece) {
    const auto divided = piece.curve.subdivided(piece.from, piece.to, {sampling_chord});
    std::vector<double> result = {divided.front()};
    for (std::size_t k = 0; k + 1 < divided.size(); ++k) {
      const double share = (divided[k + 1] - divided[k]) / (piece.to - piece.from);
      const int parts = std::max(1, static_cast<int>(std::ceil(least_intervals * share - 1e-9)));
      for (int j = 1; j <= parts; ++j)
        result.push_back(std::lerp(divided[k], divided[k + 1], static_cast<double>(j) / parts));
    }
    return result;
  }

  /// Adds samples until the feet of chords are those of the curve: beside a cusp of a side its
  /// parameter is a root of the length.
  [[nodiscard]] std::vector<Sample> with_true_chords(const std::vector<Sample>& given,
                                                     const EdgePiece& piece,
                                                     std::span<const Followed> followed) const {
    std::vector<Sample> result = {given.front()};
    const std::function<void(const Sample&, int)> go_to = [&](const Sample& b, int depth) {
      const Sample a = result.back();
      Sample middle{(a.parameter + b.parameter) / 2, Point::Zero(), {}};
      middle.point = piece.curve.at(middle.parameter);
      double off = 0;
      for (std::size_t k = 0; k < followed.size(); ++k) {
        const Followed& f = followed[k];
        const Vector2d chord = (a.feet[k] + b.feet[k]) / 2;
        const double within = std::max(f.within, 2 * (f.at(a.feet[k]) - a.point).norm());
        middle.feet.push_back(f.on_side(f.search.beside(middle.point, chord, within)));
        off = std::max(off, (f.at(chord) - f.at(middle.feet[k])).norm());
      }
      if (off > true_chord * edges_.scale().size && depth < most_halvings) {
        go_to(middle, depth + 1);
        go_to(b, depth + 1);
      } else {
        result.push_back(b);
      }
    };
    for (std::size_t k = 1; k < given.size(); ++k) go_to(given[k], 0);
    return result;
  }

  CheckedEdges edges_;
  std::vector<std::optional<SurfaceFoot>> searches_;  // of every surface that is met
};

}  // namespace

std::vector<MeetingCourse> meeting_courses(const Model& model) { return Courses(model).run(); }

}  // namespace knead::brep
