#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/decompositions.hpp"
#include "constraint_rows.hpp"

namespace knead {
namespace {

using detail::LocalBasis;
using detail::NetAcross;
using detail::proportional;
using detail::Terms;

struct MirrorFrame {
  Point normal;
  std::array<Point, 2> tangents;
};

/// Tangents along axes if the normal is an axis: fewer coordinates are then coupled.
Expected<MirrorFrame> mirror_frame(const MirrorPlane& plane) {
  if (!plane.point.allFinite() || !plane.normal.allFinite() || !(plane.normal.norm() > 0)) {
    return input_error("the plane has no position or no direction", "plane");
  }
  const Point n = plane.normal.normalized();
  Eigen::Index least = 0;
  n.cwiseAbs().minCoeff(&least);
  const Point t = n.cross(Point::Unit(least)).normalized();
  return MirrorFrame{n, {t, n.cross(t)}};
}

struct EdgeRows {
  std::vector<Terms> position, derivative;  // for each j, coefficients of B, and of B_u − κ B
  double weight_error = 0;                  // how far W_u is from κ W
};

// D = E/W, D_u = (E_u − D W_u)/W: where W_u = κ W along the edge D_u vanishes with E_u − κ E, one
// condition for each function along it.
EdgeRows edge_rows(const NetAcross& net, bool at_end) {
  const KnotVector& knots = net.knots();
  const double c = at_end ? knots.domain().upper : knots.domain().lower;
  const LocalBasis basis(knots, knots.find_span(c, at_end ? Side::left : Side::right), c, 1);
  const auto sum = [&](int order, int j) {
    double s = 0;
    for (int i = basis.first; i <= basis.last(); ++i) s += basis.at(i, order) * net.weight(i, j);
    return s;
  };
  double kappa = 0;
  if (net.surface().rational()) {
    for (int j = 0; j < net.columns(); ++j) kappa += sum(1, j) / sum(0, j) / net.columns();
  }
  EdgeRows rows;
  for (int j = 0; j < net.columns(); ++j) {
    Terms position, derivative;
    double size = 0;
    for (int i = basis.first; i <= basis.last(); ++i) {
      const double w = net.weight(i, j);
      position.emplace_back(net.index(i, j), basis.at(i, 0) * w);
      derivative.emplace_back(net.index(i, j), (basis.at(i, 1) - kappa * basis.at(i, 0)) * w);
      size += std::abs(basis.at(i, 1) * w);
    }
    rows.weight_error = std::max(rows.weight_error, std::abs(sum(1, j) - kappa * sum(0, j)) / size);
    rows.position.push_back(std::move(position));
    rows.derivative.push_back(std::move(derivative));
  }
  return rows;
}

/// The image of knot k is a + b − x_k; this is the distance to the nearest in the list.
double distance_to_nearest(const std::vector<double>& sorted, double x) {
  const auto after = std::ranges::lower_bound(sorted, x);
  double distance = std::numeric_limits<double>::infinity();
  if (after != sorted.end()) distance = *after - x;
  if (after != sorted.begin()) distance = std::min(distance, x - *std::prev(after));
  return distance;
}

// What is missing of a knot's image is reported as a knot to insert, which changes no shape:
// symmetry of knots can always be reached so.
void compare_knots(const KnotVector& knots, double tolerance, MirrorReport& report) {
  const Interval domain = knots.domain();
  const auto all = knots.knots();
  const auto image = [&](double x) { return domain.lower + (domain.upper - x); };
  std::vector<double> inside;
  for (double x : all) {
    if (x > domain.lower && x < domain.upper) inside.push_back(x);
  }
  std::vector<double> with_ends = inside;
  with_ends.insert(with_ends.begin(), domain.lower);
  with_ends.push_back(domain.upper);
  const double near = tolerance * domain.length();
  const auto count_near = [&](double x) {
    return std::ranges::count_if(inside, [&](double y) { return std::abs(x - y) <= near; });
  };
  for (std::size_t k = 0; k < inside.size(); ++k) {
    const double mirrored = image(inside[k]);
    report.knots =
        std::max(report.knots, distance_to_nearest(with_ends, mirrored) / domain.length());
    if (k > 0 && std::abs(inside[k] - inside[k - 1]) <= near) continue;
    const auto missing = count_near(inside[k]) - count_near(mirrored);
    if (missing > 0)
      report.insert.insert(report.insert.end(), static_cast<std::size_t>(missing), mirrored);
  }
  std::ranges::sort(report.insert);
  if (!report.insert.empty()) return;
  for (std::size_t k = 0; k < all.size(); ++k) {
    report.clamp = report.clamp || std::abs(image(all[k]) - all[all.size() - 1 - k]) > near;
  }
}

// Gauss points and the ends of the domain: as many as the degree needs to tell two polynomials of a
// span apart.
Expected<std::array<Points, 2>> partners(const Surface& s, int direction) {
  std::array<std::vector<double>, 2> at, mirrored;
  for (std::size_t d = 0; d < 2; ++d) {
    const KnotVector& knots = s.knots(static_cast<int>(d));
    const Interval domain = knots.domain();
    at[d] = gauss_basis(knots, knots.degree() + 1, 0).parameters;
    at[d].insert(at[d].begin(), domain.lower);
    at[d].push_back(domain.upper);
    mirrored[d] = at[d];
    if (static_cast<int>(d) != direction) continue;
    for (double& x : mirrored[d])
      x = std::clamp(domain.lower + (domain.upper - x), domain.lower, domain.upper);
  }
  const auto here = evaluate_grid<2>(s, {at[0], at[1]}),
             there = evaluate_grid<2>(s, {mirrored[0], mirrored[1]});
  if (!here) return std::unexpected(here.error());
  if (!there) return std::unexpected(there.error());
  return std::array{here->points(), there->points()};
}

}  // namespace

// A half that a mirror completes. Order 0: the edge stays in the plane, n · D = 0. Order 1: it also
// meets it at right angles, so that both halves join smoothly: the part of D_u along the plane
// vanishes. Both require that the rest shape has the property.
Expected<void> hold_symmetry_plane(const Surface& rest, SurfaceEdge edge, const MirrorPlane& plane,
                                   int order, double tolerance, double angle, ConstraintList& to) {
  const auto frame = mirror_frame(plane);
  if (!frame) return std::unexpected(frame.error());
  if (order != 0 && order != 1)
    return input_error(fmt::format("{} is not an order", order), "symmetry", "use 0 or 1");
  for (double value : {tolerance, angle}) {
    if (auto valid = detail::check_tolerance(value, "symmetry"); !valid) return valid;
  }
  const std::string name = fmt::format("symmetry edge {}", edge_name(edge));
  const NetAcross net(rest, edge_across(edge));
  const EdgeRows rows = edge_rows(net, edge_at_end(edge));
  const auto sum = [&](const Terms& row, const Point& origin) {
    Point s = Point::Zero();
    for (const auto& [unknown, c] : row)
      s += c * (rest.control_points().row(unknown).transpose() - origin);
    return s;
  };
  double off = 0, across = 0, tilt = 0;
  for (std::size_t j = 0; j < rows.position.size(); ++j) {
    double weight = 0;
    for (const auto& [unknown, c] : rows.position[j]) weight += c;
    off = std::max(off, std::abs(frame->normal.dot(sum(rows.position[j], plane.point)) / weight));
    const Point cross = sum(rows.derivative[j], plane.point);
    across = std::max(across, cross.norm());
    tilt = std::max(tilt, (cross - frame->normal * frame->normal.dot(cross)).norm());
  }
  if (!(off <= tolerance)) {
    return input_error(fmt::format("the edge leaves the plane by {:.3g}", off), name,
                       "move the plane or the edge");
  }
  if (order == 1 && !(rows.weight_error <= proportional)) {
    return input_error(
        fmt::format(
            "the weights of the rows at the edge are not proportional: they differ by {:.3g}",
            rows.weight_error),
        name, "keep the edge in the plane only (order 0)");
  }
  if (order == 1 && !(tilt <= std::sin(std::min(angle, 1.5)) * across)) {
    return input_error(
        fmt::format(
            "the surface does not meet the plane at right angles: {:.3g} radian are missing",
            std::asin(std::min(1.0, across > 0 ? tilt / across : 1.0))),
        name, "keep the edge in the plane only (order 0)");
  }
  for (const Terms& row : rows.position) detail::append(to, name, row, frame->normal);
  if (order == 0) return {};
  for (const Terms& row : rows.derivative) {
    for (const Point& t : frame->tangents) detail::append(to, name, row, t);
  }
  return {};
}

// Three things must be symmetric for a mirror of control points to be one of the surface: knots,
// weights, and the shape itself, whose deviation is a length in space.
Expected<MirrorReport> mirror_report(const Surface& rest, int direction, const MirrorPlane& plane,
                                     double tolerance) {
  const auto frame = mirror_frame(plane);
  if (!frame) return std::unexpected(frame.error());
  if (auto valid = detail::check_tolerance(tolerance, "mirror"); !valid)
    return std::unexpected(valid.error());
  MirrorReport report;
  compare_knots(rest.knots(direction), tolerance, report);
  const auto points = partners(rest, direction);
  if (!points) return std::unexpected(points.error());
  const auto& [here, there] = *points;
  for (Eigen::Index k = 0; k < here.rows(); ++k) {
    const Point x = here.row(k).transpose();
    const Point image = x - 2 * frame->normal * frame->normal.dot(x - plane.point);
    report.shape = std::max(report.shape, (image - there.row(k).transpose()).norm());
  }
  if (report.clamp || !report.insert.empty()) return report;
  const NetAcross net(rest, direction);
  for (int i = 0; i < net.rows(); ++i) {
    for (int j = 0; j < net.columns(); ++j) {
      const double a = net.weight(i, j), b = net.weight(net.rows() - 1 - i, j);
      report.weights = std::max(report.weights,
                                a == b ? 0 : std::abs(a - b) / std::max(std::abs(a), std::abs(b)));
    }
  }
  return report;
}

// The ways between partners are all parallel to the plane's normal if it exists: the eigenvector of
// Σ way wayᵀ with the largest eigenvalue is the least-squares direction, without a sign to choose.
// The plane goes through the mean of the midpoints.
Expected<MirrorPlane> mirror_plane(const Surface& rest, int direction) {
  const auto points = partners(rest, direction);
  if (!points) return std::unexpected(points.error());
  const Points way = (*points)[1] - (*points)[0];
  const auto axes = detail::symmetric_eigen(Eigen::Matrix3d(way.transpose() * way));
  if (!axes) return std::unexpected(axes.error());
  if (!(axes->values[2] > 0)) {
    return numerical_error("partners do not lie apart, so no plane mirrors them", "mirror",
                           "name the plane");
  }
  return MirrorPlane{(0.5 * ((*points)[0] + (*points)[1])).colwise().mean().transpose(),
                     axes->vectors.col(2)};
}

// X_b = (I − 2 n nᵀ) X_a: n · (X_a + X_b) = 0 and t · (X_a − X_b) = 0 for both tangents. Exact for
// rational surfaces too, as weights are symmetric; control points on the middle row are their own
// partners.
Expected<MirrorReport> keep_mirror(const Surface& rest, int direction, const MirrorPlane& plane,
                                   double tolerance, ConstraintList& to) {
  auto report = mirror_report(rest, direction, plane, tolerance);
  if (!report) return report;
  const auto frame = mirror_frame(plane);
  const char axis = direction == 0 ? 'u' : 'v';
  if (!report->insert.empty()) {
    return input_error(
        fmt::format("the knots are not symmetric in {}: {:.3g} of the domain's length is missing",
                    axis, report->knots),
        "mirror", fmt::format("insert the knots {}", fmt::join(report->insert, ", ")));
  }
  if (report->clamp) {
    return input_error(fmt::format("the knots outside of the domain are not symmetric in {}", axis),
                       "mirror", "insert the ends of the domain until both are clamped");
  }
  if (report->weights > tolerance) {
    return input_error(fmt::format("the weights are not symmetric in {}: they differ by {:.3g}",
                                   axis, report->weights),
                       "mirror");
  }
  const NetAcross net(rest, direction);
  const std::string name = fmt::format("mirror in {}", axis);
  for (int i = 0; 2 * i < net.rows(); ++i) {
    const int partner = net.rows() - 1 - i;
    for (int j = 0; j < net.columns(); ++j) {
      const int a = net.index(i, j), b = net.index(partner, j);
      if (a == b) {
        detail::append(to, name, {{a, 1.0}}, frame->normal);
        continue;
      }
      detail::append(to, name, {{a, 1.0}, {b, 1.0}}, frame->normal);
      for (const Point& t : frame->tangents) detail::append(to, name, {{a, 1.0}, {b, -1.0}}, t);
    }
  }
  return report;
}

}  // namespace knead
