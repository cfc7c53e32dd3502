#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "knead/spline/evaluate.hpp"
#include "morph/surface_fit.hpp"
#include "support/surfaces.hpp"

/// Models made in code, maps of space whose values are known everywhere, and what a fit is off by.
namespace knead::morph::testing {

using knead::testing::make_surface;
using knead::testing::uniform_sheet;

/// A displacement as a function of the place.
using Map = std::function<Point(const Point&)>;

struct Model {
  std::vector<FitSurface> surfaces;
  std::vector<FitEdge> edges = {};
  double size = 0;  ///< diagonal of the box of all control points
};

inline Model model_of(std::vector<Surface> surfaces, std::vector<FitEdge> edges = {}) {
  Model result;
  Eigen::AlignedBox3d box;
  for (Surface& s : surfaces) {
    for (int k = 0; k < s.size(); ++k) box.extend(Point(s.control_points().row(k).transpose()));
    result.surfaces.push_back({.surface = std::make_shared<const Surface>(std::move(s))});
  }
  result.edges = std::move(edges);
  result.size = box.diagonal().norm();
  return result;
}

/// The three maps of a model in the box −1 … 1, with displacements up to `amplitude`, and a
/// translation.
inline Map bend(double amplitude) {
  return
      [=](const Point& x) { return Point(0.1 * amplitude, 0, amplitude * std::cos(1.5 * x.x())); };
}
inline Map twist(double amplitude) {
  return [=](const Point& x) {
    const double angle = 0.7 * amplitude * x.x(), c = std::cos(angle) - 1, s = std::sin(angle);
    return Point(0, c * x.y() - s * x.z(), s * x.y() + c * x.z());
  };
}
inline Map bulge(double amplitude) {
  return [=](const Point& x) {
    return Point(amplitude * std::exp(-x.squaredNorm()) * Point(0.3, -0.5, 0.8));
  };
}

inline Point at(const Surface& s, double u, double v) {
  const Interval a = s.knots(0).domain(), b = s.knots(1).domain();
  const auto p = evaluate_point<2>(s, {std::clamp(a.lower + u * a.length(), a.lower, a.upper),
                                       std::clamp(b.lower + v * b.length(), b.lower, b.upper)});
  if (!p) ADD_FAILURE() << p.error().message();
  return p.value_or(Point::Zero());
}

/// Data at count × count points of every surface, at the middles of as many cells of the fractions
/// up to `until`; with noise of this deviation in each coordinate.
inline std::vector<Datum> data_on(const Model& model, const Map& map, int count = 24,
                                  double noise = 0, double until = 1) {
  std::vector<Datum> result;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (std::size_t s = 0; s < model.surfaces.size(); ++s) {
    const Surface& surface = *model.surfaces[s].surface;
    const Interval u = surface.knots(0).domain(), v = surface.knots(1).domain();
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        const double a = until * (i + 0.5) / count, b = (j + 0.5) / count;
        Point d = map(at(surface, a, b));
        for (int c = 0; c < 3 && noise > 0; ++c) d[c] += noise * normal(random);
        result.push_back(
            {static_cast<int>(s), {u.lower + a * u.length(), v.lower + b * v.length()}, d});
      }
    }
  }
  return result;
}

inline FitResult fit(const Model& model, std::span<const Datum> data,
                     const FitSettings& settings = {}) {
  auto result = fit_surfaces(model.surfaces, model.edges, data, settings);
  if (!result) {
    ADD_FAILURE() << result.error().message();
    return {};
  }
  return *std::move(result);
}

/// Errors of displacements at points that are between those of `data_on`, sides included.
struct Errors {
  double largest = 0, rms = 0;
};
inline Errors errors_of(const Model& model, const FitResult& result, const Map& map,
                        double until = 1) {
  Errors errors;
  int count = 0;
  if (result.surfaces.size() != model.surfaces.size()) return {1e300, 1e300};
  for (std::size_t s = 0; s < model.surfaces.size(); ++s) {
    for (int i = 0; i <= 37; ++i) {
      for (int j = 0; j <= 37; ++j) {
        const Point x = at(*model.surfaces[s].surface, until * i / 37.0, j / 37.0);
        const double error =
            (at(result.surfaces[s], until * i / 37.0, j / 37.0) - x - map(x)).norm();
        errors.largest = std::max(errors.largest, error);
        errors.rms += error * error;
        ++count;
      }
    }
  }
  errors.rms = std::sqrt(errors.rms / count);
  return errors;
}

/// The edge between u = 1 of one sheet and u = 0 of another, where both have the same points, and
/// lines u that go on with these speeds by fractions.
inline FitEdge edge_between(int a, int b, bool smooth, double speed_a = 1, double speed_b = 1) {
  FitEdge edge{.course = nullptr, .surfaces = {a, b}, .name = "between"};
  for (int k = 0; k <= 64; ++k) {
    SharedEdge::Sample sample{k / 64.0, Point(0, k / 64.0, 0), {{1, k / 64.0}, {0, k / 64.0}}};
    sample.angle = smooth ? 0 : 1;
    if (smooth) sample.across = {{1 / speed_a, 0}, {1 / speed_b, 0}};
    edge.samples.push_back(sample);
  }
  return edge;
}

/// A sheet of which u and v run over a rectangle, z a function of x that is the same for all, so
/// that sheets side by side are smooth together.
inline Surface wave(KnotVector u, KnotVector v, double x0, double x1) {
  const Surface flat = knead::testing::sheet(std::move(u), std::move(v), x1 - x0, 1);
  Points points = flat.control_points();
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    points(k, 0) += x0;
    points(k, 1) -= 0.5;
  }
  return *flat.with_control_points(points);
}

/// What parts two sheets at their edge, and the largest angle between their normals there, degrees.
struct AtEdge {
  double parting = 0, degrees = 0;
};
inline AtEdge at_edge(const Surface& a, const Surface& b) {
  AtEdge result;
  for (int k = 0; k < 97; ++k) {
    const double t = (k + 0.37) / 97;
    result.parting = std::max(result.parting, (at(a, 1, t) - at(b, 0, t)).norm());
    const auto n = normal_at_foot(a, {1, t}), m = normal_at_foot(b, {0, t});
    if (!n || !m) return {1e300, 1e300};
    result.degrees =
        std::max(result.degrees, angle_between_planes(*n, *m) * 180 / std::numbers::pi);
  }
  return result;
}

}  // namespace knead::morph::testing
