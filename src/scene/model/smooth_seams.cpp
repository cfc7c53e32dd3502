#include "smooth_seams.hpp"

#include <algorithm>

#include "base/decompositions.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

constexpr int points_per_span = 4;
// Of its length, that a direction may leave the tangent plane of the other side.
constexpr double on_plane = 1e-2;

struct EdgeJet {
  std::array<double, 2> at;
  Eigen::Matrix<double, 3, 2> jacobian;
};

/// At the fraction t of an edge.
Expected<EdgeJet> jet_at(const Surface& surface, SurfaceEdge edge, double t) {
  const auto across = static_cast<std::size_t>(edge_across(edge));
  const Interval fixed = surface.knots()[across].domain(),
                 along = surface.knots()[1 - across].domain();
  EdgeJet result;
  result.at[across] = edge_at_end(edge) ? fixed.upper : fixed.lower;
  result.at[1 - across] = std::min(along.lower + t * along.length(), along.upper);
  Parameters<2> at(1, 2);
  at << result.at[0], result.at[1];
  const auto jet = evaluate<2>(surface, at, 1);
  if (!jet) return std::unexpected(jet.error());
  result.jacobian.col(0) = jet->at({1, 0}).row(0).transpose();
  result.jacobian.col(1) = jet->at({0, 1}).row(0).transpose();
  return result;
}

/// The spans of both edges, in fractions of the first.
std::vector<double> breaks_of(std::span<const Surface* const> patches, const Seam& seam) {
  std::vector<double> breaks;
  for (const PatchEdge& side : {seam.a, seam.b}) {
    const KnotVector& knots =
        patches[static_cast<std::size_t>(side.patch)]->knots(edge_along(side.edge));
    const bool turned = seam.reversed && !(side == seam.a);
    for (int span : knots.spans()) {
      for (const double knot : {knots[span], knots[span + 1]}) {
        const double t = (knot - knots.domain().lower) / knots.domain().length();
        breaks.push_back(turned ? 1 - t : t);
      }
    }
  }
  std::ranges::sort(breaks);
  breaks.erase(
      std::unique(breaks.begin(), breaks.end(), [](double a, double b) { return b - a < 1e-9; }),
      breaks.end());
  return breaks;
}

}  // namespace

bool may_crease(const SeamReport& report) {
  return report.continuity == SeamContinuity::c0 && !report.rigid &&
         report.seam.kind == SeamKind::whole && report.angle <= smooth_seam;
}

// At points of a seam: the direction d across side a (a unit of its own parameter) and the w with
// dS_b w = dS_a d in the least-squares sense, so that dD_a d = dD_b w keeps the tangent planes
// common. Where dS_a d leaves the tangent plane of b by more than `on_plane` of its length, planes
// are not common at rest, and the point gives no condition. Spans of both sides are divided, so
// that between two points both are polynomials: four intervals leave no room for a cubic that
// vanishes at all points and not between.
Expected<CoupledEdge> smooth_seam_edge(std::span<const Surface* const> patches, const Seam& seam) {
  CoupledEdge edge{"seam " + to_string(seam.a) + " – " + to_string(seam.b), {}};
  const Surface &a = *patches[static_cast<std::size_t>(seam.a.patch)],
                &b = *patches[static_cast<std::size_t>(seam.b.patch)];
  const std::vector<double> breaks = breaks_of(patches, seam);
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    for (int i = k == 0 ? 0 : 1; i <= points_per_span; ++i) {
      const double t = breaks[k] + (breaks[k + 1] - breaks[k]) * i / points_per_span;
      const auto on_a = jet_at(a, seam.a.edge, t),
                 on_b = jet_at(b, seam.b.edge, seam.reversed ? 1 - t : t);
      if (!on_a) return std::unexpected(on_a.error());
      if (!on_b) return std::unexpected(on_b.error());
      Eigen::Vector2d d = Eigen::Vector2d::Zero();
      d[edge_across(seam.a.edge)] = 1;
      const Point way = on_a->jacobian * d;
      const auto other = detail::least_squares(on_b->jacobian, way);
      if (!other) return std::unexpected(other.error());
      if (!(way.norm() > 0) || !((on_b->jacobian * *other - way).norm() <= on_plane * way.norm()))
        continue;
      edge.points.push_back({{seam.a.patch, on_a->at}, {seam.b.patch, on_b->at}});
      edge.across.push_back({d, *other});
    }
  }
  return edge;
}

}  // namespace knead
