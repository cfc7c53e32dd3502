#include "dead_loads.hpp"

#include <algorithm>
#include <limits>

#include "base/gauss_legendre.hpp"
#include "knead/energy/loads.hpp"
#include "knead/spline/evaluate.hpp"
#include "scene/places.hpp"
#include "spline/basis_terms.hpp"

namespace knead {
namespace {

Expected<std::array<Point, 2>> tangents_at(const Surface& rest, const std::array<double, 2>& u) {
  const auto at = evaluate<2>(rest, (Parameters<2>(1, 2) << u[0], u[1]).finished(), 1);
  if (!at) return std::unexpected(at.error());
  return std::array<Point, 2>{at->at({1, 0}).row(0).transpose(), at->at({0, 1}).row(0).transpose()};
}

}  // namespace

// F_i = ∫ R_i f |S_t| dt along a side of the rest shape, by Gauss's rule in every span. |S_t| is no
// polynomial, so that the rule is not exact: p + 4 points are exact for a polynomial of degree 2p +
// 7. The sum of all F_i is f times the length that the same rule gives, since Σ R_i = 1.
Expected<Points> line_forces(const Surface& rest, SurfaceEdge edge, const Point& per_length) {
  const int along = edge_along(edge), across = edge_across(edge);
  const KnotVector& knots = rest.knots(along);
  const Interval domain = rest.knots(across).domain();
  const GaussRule rule = gauss_legendre(knots.degree() + 4);
  Points forces = Points::Zero(rest.size(), 3);
  for (int span = knots.degree(); span < knots.count(); ++span) {
    const double half = (knots[span + 1] - knots[span]) / 2;
    if (half <= 0) continue;
    for (std::size_t g = 0; g < rule.abscissae.size(); ++g) {
      std::array<double, 2> u;
      u[static_cast<std::size_t>(across)] = edge_at_end(edge) ? domain.upper : domain.lower;
      u[static_cast<std::size_t>(along)] = knots[span] + half + half * rule.abscissae[g];
      const auto tangents = tangents_at(rest, u);
      if (!tangents) return std::unexpected(tangents.error());
      const Point weighted =
          half * rule.weights[g] * (*tangents)[static_cast<std::size_t>(along)].norm() * per_length;
      for (const auto& [row, value] : basis_terms<2>(rest, u, 0))
        forces.row(row) += value * weighted.transpose();
    }
  }
  return forces;
}

Expected<Points> area_forces(const Surface& rest, const DomainScaling<2>& scaling,
                             const Point& per_area) {
  // `load_forces` integrates over the scaled domain.
  // Area per unit of the scaled domain, in lengths of the model.
  const double unit = scaling.factors[0] * scaling.factors[1] * scaling.length * scaling.length;
  return load_forces<2>(rest, scaling, [&](const std::array<double, 2>& u) -> Point {
    const auto tangents = tangents_at(rest, u);
    if (!tangents) return Point::Constant(std::numeric_limits<double>::quiet_NaN());
    return (*tangents)[0].cross((*tangents)[1]).norm() / unit * per_area;
  });
}

namespace {

/// The edge where a mirror symmetry puts one.
SurfaceEdge image_of(SurfaceEdge edge, int direction) {
  return edge_across(edge) == direction ? static_cast<SurfaceEdge>(static_cast<int>(edge) ^ 1)
                                        : edge;
}

Expected<void> add_point_force(const Surface& rest, std::span<const double> at, const Point& force,
                               Points& to) {
  const auto u = parameters_at<2>(rest, at);
  if (!u) return std::unexpected(u.error());
  for (const auto& [row, value] : basis_terms<2>(rest, *u, 0))
    to.row(row) += value * force.transpose();
  return {};
}

Expected<void> add_line_force(const Surface& rest, SurfaceEdge edge, const Point& per_length,
                              Points& to) {
  const auto forces = line_forces(rest, edge, per_length);
  if (!forces) return std::unexpected(forces.error());
  to += *forces;
  return {};
}

}  // namespace

// With a mirror symmetry a force also acts at its mirror image, reflected in the plane. Without it,
// the half that is pulled would share the force with the half that only follows. What lies on the
// plane (at 0.5, or an edge that is its own image) acts once.
Expected<Points> dead_forces(const SceneSurface& surface, const SceneForce& force, double length) {
  const Surface& rest = *surface.rest;
  const auto* line = std::get_if<LineForce>(&force.force);
  const auto* dead = std::get_if<DeadForce>(&force.force);
  const Point vector((line != nullptr ? line->vector : dead->vector).data());
  Points forces = Points::Zero(rest.size(), 3);
  std::vector<SurfaceEdge> edges;
  if (line != nullptr) {
    edges = edges_of(line->edge);
    for (SurfaceEdge edge : edges) {
      if (auto status = add_line_force(rest, edge, vector / length, forces); !status)
        return std::unexpected(status.error());
    }
  } else if (auto status = add_point_force(rest, dead->at, vector, forces); !status) {
    return std::unexpected(status.error());
  }
  for (const KeptConstraint& kept : surface.constraints) {
    const auto* symmetry = std::get_if<MirrorSymmetry>(&kept.constraint);
    if (symmetry == nullptr) continue;
    const auto plane = plane_of(*symmetry, *surface.reference);
    if (!plane) return std::unexpected(plane.error());
    const Point n = plane->normal.normalized(), image = vector - 2 * n.dot(vector) * n;
    for (SurfaceEdge edge : edges) {
      const SurfaceEdge other = image_of(edge, symmetry->direction);
      if (std::ranges::find(edges, other) != edges.end()) continue;
      if (auto status = add_line_force(rest, other, image / length, forces); !status)
        return std::unexpected(status.error());
    }
    if (dead == nullptr) continue;
    std::vector<double> at = dead->at;
    double& along = at[static_cast<std::size_t>(symmetry->direction)];
    if (along == 0.5) continue;
    along = 1 - along;
    if (auto status = add_point_force(rest, at, image, forces); !status)
      return std::unexpected(status.error());
  }
  return forces;
}

}  // namespace knead
