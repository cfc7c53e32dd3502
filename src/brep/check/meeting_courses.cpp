#include "meeting_courses.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "base/parallel_for.hpp"
#include "brep/boundary_curve.hpp"
#include "brep/face_region.hpp"
#include "brep/surfaces/surface_foot.hpp"
#include "checked_edges.hpp"

namespace knead::brep {
namespace {

using Eigen::Vector2d;
using Sample = SharedEdge::Sample;
using Side = CheckedFace::Side;

constexpr int least_intervals = 256;  // feet between samples are taken on chords
constexpr double sampling_chord = 2e-3;

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
    const auto divided = piece.curve.subdivided(piece.from, piece.to, {sampling_chord});
    std::vector<Point> points;
    for (std::size_t k = 0; k + 1 < divided.size(); ++k) {
      const double share = (divided[k + 1] - divided[k]) / (piece.to - piece.from);
      const int parts = std::max(1, static_cast<int>(std::ceil(least_intervals * share - 1e-9)));
      for (int j = k == 0 ? 0 : 1; j <= parts; ++j) {
        const double t = std::lerp(divided[k], divided[k + 1], static_cast<double>(j) / parts);
        result.samples.push_back({t, piece.curve.at(t), {}});
        points.push_back(result.samples.back().point);
        if (!points.back().allFinite()) return std::nullopt;
      }
    }
    std::vector<Surface> followed;
    for (std::size_t side = 0; side < 2; ++side) {
      const auto& [surface, line] = met[side];
      if (surface == none || !searches_[surface]) continue;
      result.surfaces[side] = surface;
      followed.push_back(shape(surface));
      const double within = on_surface * net_diagonal(followed.back().control_points());
      const auto feet = searches_[surface]->along(points, within).feet;
      for (std::size_t k = 0; k < feet.size(); ++k) {
        Vector2d foot = feet[k];
        if (line) foot[line->direction] = line->end;
        result.samples[k].feet.push_back(foot);
      }
    }
    if (followed.empty()) return std::nullopt;
    for (Sample& sample : result.samples)
      look_across(followed, piece.curve.derivative(sample.parameter), sample);
    return result;
  }

  CheckedEdges edges_;
  std::vector<std::optional<SurfaceFoot>> searches_;  // of every surface that is met
};

}  // namespace

std::vector<MeetingCourse> meeting_courses(const Model& model) { return Courses(model).run(); }

}  // namespace knead::brep
