#include "seam_edges.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "brep/surfaces/surface_foot.hpp"
#include "hold/edge_course.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::morph {
namespace {

using Eigen::Vector2d;
using Sample = SharedEdge::Sample;

constexpr int intervals = 256;        // feet between samples are taken on chords
constexpr double near_enough = 1e-6;  // of the size of both surfaces
constexpr std::size_t least_samples = 8;

/// The fractions of a point of a side.
Vector2d on_side(SurfaceEdge side, double t) {
  const double end = side == SurfaceEdge::u1 || side == SurfaceEdge::v1 ? 1 : 0;
  return edge_across(side) == 0 ? Vector2d(end, t) : Vector2d(t, end);
}

/// The sample of a seam at a share of the first side; none where the other is not there.
class SeamCourse {
 public:
  SeamCourse(const Surface& a, const Surface& b, const Seam& seam,
             std::optional<brep::SurfaceFoot> search, double within)
      : surfaces_{a, b}, seam_(seam), search_(std::move(search)), within_(within) {}

  [[nodiscard]] Expected<std::optional<Sample>> at(double t) {
    Sample sample{.parameter = t, .point = Point::Zero(), .feet = {on_side(seam_.a.edge, t)}};
    const Surface& a = surfaces_[0];
    const auto point = evaluate_point<2>(a, parameters_of(a, sample.feet[0]));
    if (!point) return std::unexpected(point.error());
    sample.point = *point;
    if (search_) {
      const auto found = search_->nearest(sample.point, hint_, within_);
      hint_ = found.foot.parameters;
      if (found.distance > within_) return std::nullopt;
      sample.feet.push_back(*hint_);
    } else {
      sample.feet.push_back(on_side(seam_.b.edge, seam_.reversed ? 1 - t : t));
    }
    const auto tangents = tangents_at_foot(a, sample.feet[0]);
    if (!tangents) return std::unexpected(tangents.error());
    knead::look_across(surfaces_, tangents->col(1 - edge_across(seam_.a.edge)), sample);
    return sample;
  }

 private:
  std::array<Surface, 2> surfaces_;
  const Seam& seam_;
  std::optional<brep::SurfaceFoot> search_;
  std::optional<Vector2d> hint_;
  double within_;
};

double size_of(const Surface& s) {
  const Points& p = s.control_points();
  return (p.colwise().maxCoeff() - p.colwise().minCoeff()).norm();
}

/// The edge of a seam by the points of its side a.
Expected<FitEdge> edge_along_a(std::span<const Surface* const> surfaces, const Seam& seam) {
  const Surface& a = *surfaces[static_cast<std::size_t>(seam.a.patch)];
  const Surface& b = *surfaces[static_cast<std::size_t>(seam.b.patch)];
  std::optional<brep::SurfaceFoot> search;
  if (seam.kind != SeamKind::whole) {
    auto made = brep::SurfaceFoot::create(b);
    if (!made) return std::unexpected(made.error());
    search = *std::move(made);
  }
  const double within = seam.gap + near_enough * std::max(size_of(a), size_of(b));
  SeamCourse course(a, b, seam, std::move(search), within);
  FitEdge result{.course = nullptr,
                 .surfaces = {seam.a.patch, seam.b.patch},
                 .name = to_string(seam.a) + " and " + to_string(seam.b)};
  for (int k = 0; k <= intervals; ++k) {
    auto sample = course.at(static_cast<double>(k) / intervals);
    if (!sample) return std::unexpected(sample.error());
    if (*sample) result.samples.push_back(**std::move(sample));
  }
  return result;
}

Seam turned(const Seam& seam) {
  Seam result = seam;
  std::swap(result.a, result.b);
  return result;
}

}  // namespace

Expected<std::vector<FitEdge>> edges_of_seams(std::span<const Surface* const> surfaces,
                                              std::span<const Seam> seams) {
  std::vector<FitEdge> result;
  for (const Seam& seam : seams) {
    if (seam.a.patch == seam.b.patch) continue;
    auto edge = edge_along_a(surfaces, seam);
    if (!edge) return std::unexpected(edge.error());
    if (seam.kind == SeamKind::partial && edge->samples.size() <= intervals) {
      auto other = edge_along_a(surfaces, turned(seam));
      if (!other) return std::unexpected(other.error());
      if (other->samples.size() > edge->samples.size()) edge = std::move(other);
    }
    if (edge->samples.size() >= least_samples) result.push_back(*std::move(edge));
  }
  return result;
}

}  // namespace knead::morph
