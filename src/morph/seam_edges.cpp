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
constexpr double least_speed = 1e-5;  // of a derivative as a share of the other one, and the sine

/// The fractions of a point of a side.
Vector2d on_side(SurfaceEdge side, double t) {
  const double end = side == SurfaceEdge::u1 || side == SurfaceEdge::v1 ? 1 : 0;
  return edge_across(side) == 0 ? Vector2d(end, t) : Vector2d(t, end);
}

/// A surface at fractions, with its derivatives by them.
struct Jet {
  Point point;
  Eigen::Matrix<double, 3, 2> tangents;
};
Expected<Jet> jet_at(const Surface& s, const Vector2d& foot) {
  const auto at = parameters_of(s, foot);
  Parameters<2> here(1, 2);
  here << at[0], at[1];
  const auto jet = evaluate<2>(s, here, 1);
  if (!jet) return std::unexpected(jet.error());
  Jet result;
  result.point = jet->points().row(0).transpose();
  result.tangents.col(0) = s.knots(0).domain().length() * jet->at({1, 0}).row(0).transpose();
  result.tangents.col(1) = s.knots(1).domain().length() * jet->at({0, 1}).row(0).transpose();
  return result;
}

/// The angle between the tangent planes of both sides, and the directions across the edge, in which
/// `along` points; nothing where one has no plane.
void look_across(const std::array<Jet, 2>& jets, const Point& along, Sample& sample) {
  std::array<Point, 2> normals;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& t = jets[k].tangents;
    normals[k] = t.col(0).cross(t.col(1));
    const double u = t.col(0).norm(), v = t.col(1).norm();
    // Beside a pole the direction of the shorter derivative is rounding.
    if (!(std::min(u, v) > least_speed * std::max(u, v) && normals[k].norm() > least_speed * u * v))
      return;
    normals[k].normalize();
  }
  sample.angle = angle_between_planes(normals[0], normals[1]);
  const Point mean = normals[0].dot(normals[1]) < 0 ? Point(normals[0] - normals[1])
                                                    : Point(normals[0] + normals[1]);
  const Point across = mean.cross(along).normalized();
  for (const Jet& jet : jets) {
    const Eigen::Matrix2d gramian = jet.tangents.transpose() * jet.tangents;
    sample.across.emplace_back(gramian.inverse() * (jet.tangents.transpose() * across));
  }
}

/// The sample of a seam at a share of the first side; none where the other is not there.
class SeamCourse {
 public:
  SeamCourse(const Surface& a, const Surface& b, const Seam& seam,
             std::optional<brep::SurfaceFoot> search, double within)
      : a_(a), b_(b), seam_(seam), search_(std::move(search)), within_(within) {}

  [[nodiscard]] Expected<std::optional<Sample>> at(double t) {
    Sample sample{.parameter = t, .point = Point::Zero(), .feet = {on_side(seam_.a.edge, t)}};
    const auto first = jet_at(a_, sample.feet[0]);
    if (!first) return std::unexpected(first.error());
    sample.point = first->point;
    if (search_) {
      const auto found = search_->nearest(sample.point, hint_, within_);
      hint_ = found.foot.parameters;
      if (found.distance > within_) return std::nullopt;
      sample.feet.push_back(*hint_);
    } else {
      sample.feet.push_back(on_side(seam_.b.edge, seam_.reversed ? 1 - t : t));
    }
    const auto second = jet_at(b_, sample.feet[1]);
    if (!second) return std::unexpected(second.error());
    const Point along = first->tangents.col(1 - edge_across(seam_.a.edge));
    look_across({*first, *second}, along, sample);
    return sample;
  }

 private:
  const Surface& a_;
  const Surface& b_;
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
