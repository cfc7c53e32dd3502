#include "fit_joints.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/parallel_for.hpp"
#include "hold/edge_course.hpp"
#include "knead/brep/model.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::morph {
namespace {

using Eigen::Vector2d;
using Sample = SharedEdge::Sample;

// Points in a span: as many as a polynomial of that degree has coefficients, and more of higher
// ones. Between n equidistant points a polynomial of degree p can be far larger than at them,
// unless n grows as p² (D. Coppersmith, T. Rivlin, "The growth of polynomials bounded at equally
// spaced points", 1992).
int points_per_span(const KnotVector& knots) {
  const int order = knots.degree() + 1;
  return std::max(order, order * order / 4);
}

/// A sample between two others at this share of the way. Directions across an edge without a course
/// are those of the surfaces there: by parameters they are far longer beside a pole.
Sample between(const FitEdge& edge, std::span<const Surface> surfaces, const Sample& a,
               const Sample& b, double share) {
  if (edge.course) return edge.course->at(std::lerp(a.parameter, b.parameter, share));
  Sample result{
      std::lerp(a.parameter, b.parameter, share), (1 - share) * a.point + share * b.point, {}};
  for (std::size_t k = 0; k < a.feet.size(); ++k)
    result.feet.emplace_back((1 - share) * a.feet[k] + share * b.feet[k]);
  if (a.across.empty() && b.across.empty()) return result;
  // Surfaces may stand elsewhere than the samples' points were found.
  const auto place = [&](const Sample& sample) {
    return evaluate_point<2>(surfaces[0], parameters_at_foot(surfaces[0], sample.feet[0]));
  };
  const auto from = place(a), to = place(b);
  if (from && to) look_across(surfaces, *to - *from, result);
  return result;
}

/// The samples of an edge, as many in every span that it crosses as it has coefficients.
std::vector<Sample> samples_for(const FitEdge& edge, const FitNets& nets) {
  std::vector<const Surface*> surfaces;
  std::vector<Surface> shapes;
  for (const int s : edge.surfaces) {
    surfaces.push_back(&nets.surfaces[static_cast<std::size_t>(s)]);
    if (!edge.course) shapes.push_back(*surfaces.back());
  }
  return finer_samples(edge.course ? edge.course->samples() : edge.samples, surfaces,
                       {points_per_span, [&](const Sample& a, const Sample& b, double share) {
                          return between(edge, shapes, a, b, share);
                        }});
}

bool is_smooth(const FitEdge& edge) {
  if (edge.course) return knead::is_smooth(*edge.course);
  return edge.surfaces.size() > 1 && std::ranges::all_of(edge.samples, [](const Sample& sample) {
           return sample.angle <= smooth_angle;
         });
}

/// Changes of fractions as changes of parameters.
Vector2d in_parameters(const Surface& s, const Vector2d& across) {
  return {s.knots(0).domain().length() * across.x(), s.knots(1).domain().length() * across.y()};
}

/// Derivatives by length have no bound where a side is far slower than along most of the joint, as
/// beside a cusp: rows there would drown all others. They count less, as if the derivative were by
/// a longer way, and from some ratio on nothing.
void calm_cusps(Joint& joint) {
  constexpr double calm = 30, most = 1e3;  // of the median
  std::array<double, 2> middles = {};
  for (std::size_t side = 0; side < 2; ++side) {
    std::vector<double> steps;
    for (const auto& feet : joint.points) {
      if (!feet[side].across.isZero()) steps.push_back(feet[side].across.norm());
    }
    if (steps.empty()) continue;
    const auto middle = steps.begin() + std::ssize(steps) / 2;
    std::ranges::nth_element(steps, middle);
    middles[side] = *middle;
  }
  for (auto& feet : joint.points) {
    double ratio = 0;
    for (std::size_t side = 0; side < 2; ++side) {
      if (middles[side] > 0) ratio = std::max(ratio, feet[side].across.norm() / middles[side]);
    }
    for (Joint::Foot& foot : feet) {
      if (ratio > most)
        foot.across.setZero();
      else if (ratio > calm)
        foot.across *= calm / ratio;
    }
  }
}

/// The joints of the first surface at an edge with each of the others; of a held one, of each with
/// its place.
std::vector<Joint> joints_of(const FitEdge& edge, const FitNets& nets) {
  std::vector<Joint> result;
  if (edge.surfaces.size() < 2 && !edge.held) return result;
  const std::vector<Sample> samples = samples_for(edge, nets);
  double length = 0;
  for (std::size_t k = 1; k < samples.size(); ++k)
    length += (samples[k].point - samples[k - 1].point).norm();
  for (std::size_t other = edge.held ? 0 : 1; other < edge.surfaces.size(); ++other) {
    const std::size_t first = edge.held ? other : 0;
    Joint joint{.edge = edge.course ? edge.course->id() : edge.name,
                .surfaces = {edge.surfaces[first], edge.held ? -1 : edge.surfaces[other]},
                .points = {},
                .smooth = !edge.held && is_smooth(edge),
                .length = length};
    for (const Sample& sample : samples) {
      std::array<Joint::Foot, 2> feet;
      for (std::size_t side = 0; side < (edge.held ? 1 : 2); ++side) {
        const std::size_t k = side == 0 ? first : other;
        const Surface& s = nets.surfaces[static_cast<std::size_t>(joint.surfaces[side])];
        feet[side].at = parameters_at_foot(s, sample.feet[k]);
        if (k < sample.across.size()) feet[side].across = in_parameters(s, sample.across[k]);
      }
      joint.points.push_back(feet);
    }
    calm_cusps(joint);
    result.push_back(std::move(joint));
  }
  return result;
}

/// First derivatives of a surface at the points of a joint, by fractions of its domain.
struct LineTangents {
  Points u, v;
};
Expected<LineTangents> tangents(const Surface& s, const Joint& joint, std::size_t side) {
  Parameters<2> at(static_cast<Eigen::Index>(joint.points.size()), 2);
  for (std::size_t k = 0; k < joint.points.size(); ++k) {
    const auto& foot = joint.points[k][side].at;
    at.row(static_cast<Eigen::Index>(k)) << foot[0], foot[1];
  }
  auto jet = evaluate<2>(s, at, 1, joint.sides[side]);
  if (!jet) return std::unexpected(jet.error());
  return LineTangents{s.knots(0).domain().length() * jet->at({1, 0}),
                      s.knots(1).domain().length() * jet->at({0, 1})};
}

/// The normal at a point, of unit length; zero where there is none, as beside poles.
Point normal(const LineTangents& t, std::size_t point) {
  constexpr double least_speed = 1e-5, least_sine = 1e-9;
  const Point u = t.u.row(static_cast<Eigen::Index>(point)).transpose(),
              v = t.v.row(static_cast<Eigen::Index>(point)).transpose(), n = u.cross(v);
  if (!(std::min(u.norm(), v.norm()) > least_speed * std::max(u.norm(), v.norm()) &&
        n.norm() > least_sine * u.norm() * v.norm()))
    return Point::Zero();
  return n.normalized();
}

/// Gives a line of constant parameter its directions across, where the tangent planes of both sides
/// are common; nothing where there is a crease. Returns whether it is smooth anywhere. The unit
/// vector in the first side's plane perpendicular to the line, in parameters of each side by least
/// squares.
Expected<bool> look_across(const Surface& s, int direction, Joint& joint) {
  const auto low = tangents(s, joint, 0), high = tangents(s, joint, 1);
  if (!low) return std::unexpected(low.error());
  if (!high) return std::unexpected(high.error());
  bool any = false;
  for (std::size_t k = 0; k < joint.points.size(); ++k) {
    const Point n = normal(*low, k), m = normal(*high, k);
    if (n.isZero() || m.isZero()) continue;
    if (angle_between_planes(n, m) > smooth_angle || n.dot(m) < 0) continue;  // a crease there
    const auto row = static_cast<Eigen::Index>(k);
    const Point along = (direction == 0 ? low->v : low->u).row(row).transpose();
    const Point across = n.cross(along).normalized();
    for (std::size_t side = 0; side < 2; ++side) {
      const LineTangents& t = side == 0 ? *low : *high;
      Eigen::Matrix<double, 3, 2> d;
      d << t.u.row(row).transpose(), t.v.row(row).transpose();
      const Eigen::Matrix2d gramian = d.transpose() * d;
      joint.points[k][side].across = in_parameters(s, gramian.inverse() * (d.transpose() * across));
    }
    any = true;
  }
  return any;
}

/// The line at which a direction has the parameters `low` and `high`, the same but for closed ones.
Joint line_at(const Surface& s, int surface, int direction, double low, double high) {
  Joint result{
      .edge = {}, .surfaces = {surface, surface}, .points = {}, .smooth = true, .position = false};
  if (low == high) result.sides = {Side::left, Side::right};
  const KnotVector& along = s.knots(1 - direction);
  for (const int span : along.spans()) {
    const int count = points_per_span(along);
    for (int k = 0; k < count; ++k) {
      const double t = std::lerp(along[span], along[span + 1], (k + 0.5) / count);
      std::array<Joint::Foot, 2> feet;
      for (std::size_t side = 0; side < 2; ++side) {
        const double across = side == 0 ? low : high;
        feet[side].at = direction == 0 ? std::array{across, t} : std::array{t, across};
      }
      result.points.push_back(feet);
    }
  }
  return result;
}

/// Whether the surface stands still at some points of a knot line, poles aside, but not along all
/// of it, as it comes to the line on one of its sides: no ratio of the derivatives on both sides is
/// common then, and to ask for equal ones by length would leave the net hardly any displacements.
bool stands_at_points(const Surface& s, int direction, double knot) {
  constexpr double still = 1e-6;  // of the fastest
  const detail::NetAcross net(s, direction);
  const KnotVector& knots = s.knots(direction);
  const int left = knots.find_span(knot, Side::left),
            right = knots.find_span(knot, Side::right) - knots.degree();
  const auto longest_step = [&](int j) {
    double length = 0;
    for (int row = 0; row + 1 < net.rows(); ++row)
      length = std::max(length, (net.point(row + 1, j) - net.point(row, j)).norm());
    return length;
  };
  std::vector<double> lengths;
  for (int j = 0; j < net.columns(); ++j) lengths.push_back(longest_step(j));
  const double longest = *std::ranges::max_element(lengths);
  for (const int row : {left - 1, right}) {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (int j = 0; j < net.columns(); ++j) {
      if (lengths[static_cast<std::size_t>(j)] <= still * longest) continue;  // a pole
      const double step = (net.point(row + 1, j) - net.point(row, j)).norm();
      least = std::min(least, step);
      most = std::max(most, step);
    }
    if (least <= still * most) return true;
  }
  return false;
}

/// The length of the line in the polygon of its points, on the side that is first.
Expected<double> line_length(const Surface& s, const Joint& joint) {
  Parameters<2> at(static_cast<Eigen::Index>(joint.points.size()), 2);
  for (std::size_t k = 0; k < joint.points.size(); ++k)
    at.row(static_cast<Eigen::Index>(k)) << joint.points[k][0].at[0], joint.points[k][0].at[1];
  const auto points = evaluate<2>(s, at);
  if (!points) return std::unexpected(points.error());
  double result = 0;
  for (Eigen::Index k = 1; k < at.rows(); ++k)
    result += (points->points().row(k) - points->points().row(k - 1)).norm();
  return result;
}

}  // namespace

std::vector<Joint> joints_of_edges(std::span<const FitEdge> edges, const FitNets& nets) {
  std::vector<std::vector<Joint>> each(edges.size());
  constexpr double work = 1 << 18;  // some samples' feet may be sought
  const auto count = static_cast<std::ptrdiff_t>(edges.size());
  detail::parallel_for(
      count, detail::block_size(count, work), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
          each[k] = joints_of(edges[k], nets);
      });
  std::vector<Joint> result;
  for (std::vector<Joint>& joints : each) {
    for (Joint& joint : joints) result.push_back(std::move(joint));
  }
  return result;
}

Expected<void> part_joints(std::span<Joint> joints, const FitNets& nets, double closed,
                           const std::function<Expected<Point>(const Point&)>& displacement) {
  for (Joint& joint : joints) {
    if (joint.edge.empty() || nets.stays(joint.surfaces[0]) || nets.stays(joint.surfaces[1]))
      continue;
    std::vector<Point> apart(joint.points.size(), Point::Zero());
    bool any = false;
    for (std::size_t k = 0; k < joint.points.size(); ++k) {
      std::array<Point, 2> places;
      for (std::size_t side = 0; side < 2; ++side) {
        const auto s = static_cast<std::size_t>(joint.surfaces[side]);
        const auto place = evaluate_point<2>(nets.surfaces[s], joint.points[k][side].at);
        if (!place) return std::unexpected(place.error());
        places[side] = *place;
      }
      if ((places[0] - places[1]).norm() <= closed) continue;
      const auto first = displacement(places[0]), second = displacement(places[1]);
      if (!first) return std::unexpected(first.error());
      if (!second) return std::unexpected(second.error());
      apart[k] = *first - *second;
      any = true;
    }
    if (any) joint.apart = std::move(apart);
  }
  return {};
}

// A knot of multiplicity p or more: displacements are C0 there, and a surface that is smooth there
// would get a crease. Surfaces that close have such a line where they meet themselves.
Expected<std::vector<Joint>> joints_of_lines(const FitNets& nets) {
  std::vector<Joint> result;
  for (std::size_t k = 0; k < nets.surfaces.size(); ++k) {
    if (nets.fixed[k]) continue;
    const Surface& s = nets.surfaces[k];
    const auto closed = brep::closed_directions(s);
    for (int d = 0; d < 2; ++d) {
      const KnotVector& knots = s.knots(d);
      const Interval domain = knots.domain();
      std::vector<std::array<double, 2>> lines;
      for (const int span : knots.spans()) {
        const double c = knots[span];
        const bool line = c > domain.lower && knots.multiplicity(c) >= knots.degree();
        if (line && !stands_at_points(s, d, c)) lines.push_back({c, c});
      }
      if (closed[static_cast<std::size_t>(d)]) lines.push_back({domain.upper, domain.lower});
      for (const auto& [low, high] : lines) {
        Joint line = line_at(s, static_cast<int>(k), d, low, high);
        line.position = low != high || knots.multiplicity(low) > knots.degree();
        const auto smooth = look_across(s, d, line);
        if (!smooth) return std::unexpected(smooth.error());
        if (!*smooth) continue;
        calm_cusps(line);
        const auto length = line_length(s, line);
        if (!length) return std::unexpected(length.error());
        line.length = *length;
        result.push_back(std::move(line));
      }
    }
  }
  return result;
}

Expected<JointAngle> largest_angle(const Joint& joint, std::span<const Surface> before,
                                   std::span<const Surface> after) {
  JointAngle result;
  std::array<LineTangents, 2> then, now;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto s = static_cast<std::size_t>(joint.surfaces[side]);
    auto a = tangents(before[s], joint, side), b = tangents(after[s], joint, side);
    if (!a) return std::unexpected(a.error());
    if (!b) return std::unexpected(b.error());
    then[side] = *std::move(a);
    now[side] = *std::move(b);
  }
  for (std::size_t k = 0; k < joint.points.size(); ++k) {
    if (joint.points[k][0].across.isZero() || joint.points[k][1].across.isZero()) continue;
    const Point a = normal(now[0], k), b = normal(now[1], k);
    const Point c = normal(then[0], k), d = normal(then[1], k);
    if (a.isZero() || b.isZero() || c.isZero() || d.isZero()) continue;
    const double turned = angle_between_planes(a, b) - angle_between_planes(c, d);
    const double degrees = turned * 180 / std::numbers::pi;
    if (degrees <= result.degrees) continue;
    result = {degrees, k};
  }
  return result;
}

}  // namespace knead::morph
