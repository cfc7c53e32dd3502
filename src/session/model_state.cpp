#include <fmt/format.h>

#include <algorithm>

#include "knead/sculpt/loads.hpp"
#include "knead/spline/extremum.hpp"
#include "surface_model.hpp"

namespace knead {
namespace {

constexpr double symmetry_tolerance = 1e-6;
constexpr double symmetry_angle = 1e-3;

}  // namespace

Expected<MirrorPlane> plane_of(const SymmetryCommand& c, const Surface& surface) {
  if (!c.normal || !c.point) return mirror_plane(surface, c.mirror == "u" ? 0 : 1);
  return MirrorPlane{Point((*c.point)[0], (*c.point)[1], (*c.point)[2]),
                     Point((*c.normal)[0], (*c.normal)[1], (*c.normal)[2])};
}

std::vector<SurfaceEdge> edges_of(EdgeChoice which) {
  switch (which) {
    case EdgeChoice::u0:
      return {SurfaceEdge::u0};
    case EdgeChoice::u1:
      return {SurfaceEdge::u1};
    case EdgeChoice::v0:
      return {SurfaceEdge::v0};
    case EdgeChoice::v1:
      return {SurfaceEdge::v1};
    case EdgeChoice::all:
      break;
  }
  return {SurfaceEdge::u0, SurfaceEdge::u1, SurfaceEdge::v0, SurfaceEdge::v1};
}

Expected<void> symmetry_constraints(const SurfaceState& surface, const SymmetryCommand& c, ConstraintList& list) {
  MirrorPlane plane;
  const double size = bounding_box(*surface.reference).diagonal();
  if (c.normal) plane.normal = Point((*c.normal)[0], (*c.normal)[1], (*c.normal)[2]);
  if (c.point) plane.point = Point((*c.point)[0], (*c.point)[1], (*c.point)[2]);
  if (c.edge) {
    for (SurfaceEdge edge : edges_of(*c.edge)) {
      auto done =
          hold_symmetry_plane(*surface.reference, edge, plane, 1, symmetry_tolerance * size, symmetry_angle, list);
      if (!done) return done;
    }
    return {};
  }
  const int direction = c.mirror == "u" ? 0 : 1;
  const auto own = plane_of(c, *surface.reference);
  if (!own) return std::unexpected(own.error());
  const auto report = keep_mirror(*surface.reference, direction, *own, 1e-9, list);
  if (!report) return std::unexpected(report.error());
  return {};
}

Expected<std::array<double, 2>> parameters_at(const Surface& surface, const Fractions& at, const char* where) {
  std::array<double, 2> u;
  for (std::size_t d = 0; d < 2; ++d) {
    if (!(at[d] >= 0 && at[d] <= 1)) {
      return input_error(fmt::format("{} is not a fraction of the domain", at[d]), where, "use numbers from 0 to 1");
    }
    const Interval domain = surface.knots()[d].domain();
    u[d] = std::min(domain.lower + at[d] * domain.length(), domain.upper);
  }
  return u;
}

Expected<std::array<Interval, 2>> region_at(const Surface& surface, const std::array<Fractions, 2>& region) {
  const auto lower = parameters_at(surface, {region[0][0], region[1][0]}, "region");
  const auto upper = parameters_at(surface, {region[0][1], region[1][1]}, "region");
  if (!lower) return std::unexpected(lower.error());
  if (!upper) return std::unexpected(upper.error());
  std::array<Interval, 2> result;
  for (std::size_t d = 0; d < 2; ++d) {
    if ((*upper)[d] < (*lower)[d]) {
      return input_error("a side of the region decreases", "region",
                         "write [[s0, s1], [t0, t1]] with s0 <= s1, t0 <= t1");
    }
    result[d] = {(*lower)[d], (*upper)[d]};
  }
  return result;
}

std::vector<std::pair<int, double>> basis_terms(const Surface& surface, const std::array<double, 2>& u, int first) {
  std::array<std::array<double, max_degree + 1>, 2> n;
  std::array<int, 2> span;
  for (std::size_t d = 0; d < 2; ++d) {
    span[d] = surface.knots()[d].find_span(u[d]);
    basis_values(surface.knots()[d], span[d], u[d], n[d].data());
  }
  const int p = surface.knots(0).degree(), q = surface.knots(1).degree(), columns = surface.net()[1];
  std::vector<std::pair<int, double>> terms;
  double sum = 0;
  for (int r = 0; r <= p; ++r) {
    for (int c = 0; c <= q; ++c) {
      const int row = (span[0] - p + r) * columns + span[1] - q + c;
      const double w = surface.rational() ? surface.weights()[static_cast<std::size_t>(row)] : 1;
      terms.emplace_back(first + row, w * n[0][static_cast<std::size_t>(r)] * n[1][static_cast<std::size_t>(c)]);
      sum += terms.back().second;
    }
  }
  for (auto& term : terms) term.second /= sum;
  return terms;
}

ActiveState active_state(const SessionState& state) {
  Eigen::Index size = 0, at = 0;
  bool moving = false;
  for (int k : state.selection()) {
    const SurfaceState& s = state.surfaces[static_cast<std::size_t>(k)];
    size += s.current->size();
    moving = moving || s.velocity.rows() > 0;
  }
  ActiveState result;
  result.control_points.resize(size, 3);
  result.rest.resize(size, 3);
  if (moving) result.velocity = Points::Zero(size, 3);
  for (int k : state.selection()) {
    const SurfaceState& s = state.surfaces[static_cast<std::size_t>(k)];
    const Eigen::Index n = s.current->size();
    result.control_points.middleRows(at, n) = s.current->control_points();
    result.rest.middleRows(at, n) = s.rest->control_points();
    if (s.velocity.rows() > 0) result.velocity.middleRows(at, n) = s.velocity;
    at += n;
  }
  return result;
}

Expected<Surface> load_field(const LoadCommand& load, const Surface& surface) {
  Points samples(static_cast<Eigen::Index>(load.samples.size()), 3);
  for (std::size_t k = 0; k < load.samples.size(); ++k) {
    samples.row(static_cast<Eigen::Index>(k)) << load.samples[k][0], load.samples[k][1], load.samples[k][2];
  }
  auto field = sampled_load<2>(surface, load.counts, std::move(samples));
  if (!field) return std::unexpected(field.error().within("samples"));
  return field;
}

Expected<ActiveLoads> active_loads(const SessionState& state, const ActiveSurface& model) {
  const auto vector = [](const Vector3& v) { return Point(v[0], v[1], v[2]); };
  ActiveLoads loads;
  loads.force = vector(state.load.vector);
  loads.gravity = vector(state.load.gravity);
  loads.pressure = state.load.pressure;
  loads.wind = vector(state.load.wind);
  if (!state.load.samples.empty()) {
    loads.nodal.resize(model.rows().back(), 3);
    int patch = 0;
    for (int k : state.selection()) {
      const Surface& surface = *state.surfaces[static_cast<std::size_t>(k)].reference;
      const auto field = load_field(state.load, surface);
      if (!field) return std::unexpected(field.error());
      const auto nodal = load_forces<2>(surface, model.scaling(patch), *field);
      if (!nodal) return std::unexpected(nodal.error());
      loads.nodal.middleRows(model.rows()[static_cast<std::size_t>(patch)], surface.size()) = *nodal;
      ++patch;
    }
  }
  for (const auto& [f, surface] : state.forces) {
    int first = 0;
    bool selected = false;
    for (int k : state.selection()) {
      selected = k == surface;
      if (selected) break;
      first += state.surfaces[static_cast<std::size_t>(k)].current->size();
    }
    if (!selected) continue;
    const SurfaceState& s = state.surfaces[static_cast<std::size_t>(surface)];
    const auto u = parameters_at(*s.current, f.at);
    if (!u) return std::unexpected(u.error());
    PointForce force;
    force.kind = f.kind == PointForceKind::spring ? PointForce::Kind::spring : PointForce::Kind::volcano;
    force.terms = basis_terms(*s.current, *u, first);
    force.to = vector(f.to);
    force.strength = f.strength;
    force.core = f.core;
    for (const KeptConstraint& kept : s.constraints) {  // and its mirror images
      const auto* symmetry = std::get_if<SymmetryCommand>(&kept.request);
      if (symmetry == nullptr || !symmetry->mirror) continue;
      const auto plane = plane_of(*symmetry, *s.reference);
      if (!plane) return std::unexpected(plane.error());
      Fractions at = f.at;
      double& along = at[*symmetry->mirror == "u" ? 0 : 1];
      if (along == 0.5) continue;
      along = 1 - along;
      const auto there = parameters_at(*s.current, at);
      if (!there) return std::unexpected(there.error());
      PointForce image = force;
      image.terms = basis_terms(*s.current, *there, 0);
      const Point n = plane->normal.normalized();
      image.to -= 2 * n.dot(image.to - plane->point) * n;
      loads.points.push_back(std::move(image));
    }
    loads.points.push_back(std::move(force));
  }
  if (state.limit) {
    loads.limit = *state.limit;
    Eigen::Index size = 0;
    for (int k : state.selection()) size += state.surfaces[static_cast<std::size_t>(k)].opened->size();
    loads.original.resize(size, 3);
    Eigen::Index at = 0;
    for (int k : state.selection()) {
      const Points& opened = state.surfaces[static_cast<std::size_t>(k)].opened->control_points();
      loads.original.middleRows(at, opened.rows()) = opened;
      at += opened.rows();
    }
  }
  return loads;
}

}  // namespace knead
