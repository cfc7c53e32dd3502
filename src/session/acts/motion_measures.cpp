#include "motion_law.hpp"

#include <algorithm>
#include <cmath>

#include "knead/spline/evaluate.hpp"
#include "knead/spline/extremum.hpp"
#include "scene/anchors.hpp"
#include "scene/places.hpp"
#include "scene/trims.hpp"
#include "spline/basis_terms.hpp"

namespace knead {
namespace {

/// Whether all control points of an edge are one.
bool is_pole(const Surface& s, SurfaceEdge edge) {
  const auto [m, n] = s.net();
  const bool across_u = edge == SurfaceEdge::u0 || edge == SurfaceEdge::u1;
  const int count = across_u ? n : m;
  const auto row = [&](int k) {
    switch (edge) {
      case SurfaceEdge::u0:
        return k;
      case SurfaceEdge::u1:
        return (m - 1) * n + k;
      case SurfaceEdge::v0:
        return k * n;
      default:
        return k * n + n - 1;
    }
  };
  const Points& c = s.control_points();
  const double size = 1e-9 * net_size(s);
  for (int k = 1; k < count; ++k) {
    if ((c.row(row(k)) - c.row(row(0))).norm() > size) return false;
  }
  return true;
}

/// Whether both ends of a direction are one curve.
bool is_closed(const Surface& s, int direction) {
  constexpr int samples = 8;
  const Interval along = s.knots(1 - direction).domain(), across = s.knots(direction).domain();
  const BoundingBox box = bounding_box(s);
  for (int k = 0; k <= samples; ++k) {
    const double t = std::min(along.lower + along.length() * k / samples, along.upper);
    const auto at = [&](double end) {
      return evaluate_point<2>(
          s, direction == 0 ? std::array<double, 2>{end, t} : std::array<double, 2>{t, end});
    };
    const auto a = at(across.lower), b = at(across.upper);
    if (!a || !b || (*a - *b).norm() > 1e-9 * box.diagonal()) return false;
  }
  return true;
}

bool side_is_held(const SceneSurface& s, SurfaceEdge edge) {
  if (s.hold_rows > 0) return true;
  for (const KeptConstraint& kept : s.constraints) {
    const auto* hold = std::get_if<EdgeHold>(&kept.constraint);
    if (hold != nullptr && hold->edge == edge && hold->components == all_components) return true;
  }
  return false;
}

/// Whether there are edges to hold and none of them is free, or its place is held.
bool trims_are_held(const SceneSurface& s) {
  if (holds_its_place(s)) return true;
  return holds_trims(s.constraints) && s.visible && !s.visible->edges.empty() &&
         std::ranges::none_of(s.constraints, [](const KeptConstraint& kept) {
           const auto* edge = std::get_if<TrimEdgeHold>(&kept.constraint);
           return edge != nullptr && edge->order < 0 && !edge->follow;
         });
}

/// Values of a displacement at (p + 3)(q + 3) places of every span where a control point goes
/// beyond `reach`.
struct FarValues {
  std::vector<std::array<double, 2>> places;
  Points values;
};

std::optional<FarValues> values_beyond(const Surface& shape, const Points& way, double reach) {
  const auto field = shape.with_control_points(way);
  if (!field) return std::nullopt;
  const KnotVector &u = shape.knots(0), &v = shape.knots(1);
  const Eigen::VectorXd lengths = way.rowwise().norm();
  const int columns = shape.net()[1], last_u = u.degree() + 2, last_v = v.degree() + 2;
  FarValues result;
  for (const int a : u.spans()) {
    for (const int b : v.spans()) {
      double largest = 0;
      for (int i = a - u.degree(); i <= a; ++i) {
        for (int j = b - v.degree(); j <= b; ++j)
          largest = std::max(largest, lengths[i * columns + j]);
      }
      for (int i = 0; largest > reach && i <= last_u; ++i) {
        for (int j = 0; j <= last_v; ++j) {
          result.places.push_back({std::lerp(u[a], u[a + 1], static_cast<double>(i) / last_u),
                                   std::lerp(v[b], v[b + 1], static_cast<double>(j) / last_v)});
        }
      }
    }
  }
  if (result.places.empty()) return std::nullopt;
  const Eigen::Map<const Parameters<2>> at(result.places.front().data(), std::ssize(result.places),
                                           2);
  auto values = evaluate<2>(*field, Parameters<2>(at), 0);
  if (!values) return std::nullopt;
  result.values = values->points();
  return result;
}

bool is_joined(const std::vector<SeamReport>& seams, int surface, SurfaceEdge edge) {
  return std::ranges::any_of(seams, [&](const SeamReport& report) {
    if (report.continuity == SeamContinuity::none) return false;
    const auto at = [&](const PatchEdge& side) {
      return side.patch == surface && side.edge == edge;
    };
    return at(report.seam.a) || at(report.seam.b);
  });
}

}  // namespace

// From coarse to fine: the largest displacement of a control point bounds that of the surface
// (convex hull, positive weights); then samples in the spans whose control points exceed `enough`;
// then the branch and bound of `largest_distance`, where samples come within a tenth of it.
double largest_motion(const Surface& a, const Surface& b, double enough) {
  if (&a == &b) return 0;
  if (!same_basis(a, b) || std::ranges::any_of(a.weights(), [](double w) { return !(w > 0); })) {
    return largest_distance(a, b);
  }
  const Points way = a.control_points() - b.control_points();
  const double bound = way.rowwise().norm().maxCoeff();
  if (bound <= enough) return bound;
  const auto far = values_beyond(a, way, enough);
  const double sampled = far ? far->values.rowwise().norm().maxCoeff() : enough;
  // Between samples it may be a few per cent more, at high degrees up to a tenth.
  return sampled > 0.9 * enough ? largest_distance(a, b) : sampled;
}

Expected<std::shared_ptr<const Surface>> part_of_way(const Surface& from,
                                                     const std::shared_ptr<const Surface>& to,
                                                     double share) {
  const Points &start = from.control_points(), &end = to->control_points();
  if (start == end) return to;
  Points points = start + share * (end - start);
  for (Eigen::Index i = 0; i < start.rows(); ++i) {
    if (start.row(i) == end.row(i)) points.row(i) = start.row(i);
  }
  auto made = to->with_control_points(std::move(points));
  if (!made) return std::unexpected(made.error());
  return std::make_shared<const Surface>(std::move(*made));
}

// Reduces a displacement field where it is longer than `reach`, in rounds: at each sample that is
// too long the excess along its own direction is given to the control points in proportion to their
// basis functions and averaged, Σ R_i e / Σ R_i. It converges as smoothing does, slowly in the end;
// what twelve rounds leave is within the tolerance of the law, or judged by it.
Points within_reach(const Surface& shape, Points way, double reach) {
  constexpr int most_rounds = 12;
  for (int round = 0; round < most_rounds && way.rowwise().norm().maxCoeff() > reach; ++round) {
    const auto far = values_beyond(shape, way, reach);
    if (!far) break;
    Points excess = Points::Zero(way.rows(), 3);
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(way.rows());
    for (std::size_t k = 0; k < far->places.size(); ++k) {
      const Point value = far->values.row(static_cast<Eigen::Index>(k));
      const double length = value.norm();
      if (length <= reach) continue;
      for (const auto& [i, r] : basis_terms<2>(shape, far->places[k])) {
        excess.row(i) += r * (1 - reach / length) * value.transpose();
        weights[i] += r;
      }
    }
    if ((weights.array() == 0).all()) break;
    for (Eigen::Index i = 0; i < way.rows(); ++i) {
      if (weights[i] > 0 && !way.row(i).isZero(0)) way.row(i) -= excess.row(i) / weights[i];
    }
  }
  return way;
}

bool held_all_round(const Scene& scene, const std::vector<SeamReport>& seams) {
  for (const int k : scene.selection()) {
    const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(k)];
    if (trims_are_held(s)) continue;
    for (const SurfaceEdge edge :
         {SurfaceEdge::u0, SurfaceEdge::u1, SurfaceEdge::v0, SurfaceEdge::v1}) {
      const int direction = edge == SurfaceEdge::u0 || edge == SurfaceEdge::u1 ? 0 : 1;
      if (side_is_held(s, edge) || is_joined(seams, k, edge)) continue;
      if (is_pole(*s.reference, edge) || is_closed(*s.reference, direction)) continue;
      return false;
    }
  }
  return true;
}

bool only_pressed(const Scene& scene, const EvolutionPolicy& evolution) {
  if (evolution.mode == Evolution::dynamic || !scene.forces.empty() || !(scene.load == Load{}))
    return false;
  if (std::ranges::any_of(scene.tools,
                          [](const Tool& t) { return !t.collides() || t.friction > 0; }))
    return false;
  return std::ranges::all_of(scene.selection(), [&](int k) {
    const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(k)];
    return s.mode == RestMode::shape &&
           std::ranges::none_of(s.constraints, [](const KeptConstraint& kept) {
             const auto* pin = std::get_if<PointPin>(&kept.constraint);
             return pin != nullptr && pin->to;
           });
  });
}

}  // namespace knead
