#pragma once

#include <Eigen/Geometry>
#include <numbers>

#include "knead/hold/seams.hpp"
#include "solve/constraint_space.hpp"
#include "support/surfaces.hpp"

namespace knead::testing {

inline const std::vector<SurfaceEdge> all_edges = {SurfaceEdge::u0, SurfaceEdge::u1,
                                                   SurfaceEdge::v0, SurfaceEdge::v1};

inline std::vector<const Surface*> pointers(const std::vector<Surface>& patches) {
  std::vector<const Surface*> result;
  for (const Surface& s : patches) result.push_back(&s);
  return result;
}

inline std::vector<int> first_rows(const std::vector<Surface>& patches) {
  std::vector<int> rows{0};
  for (const Surface& s : patches) rows.push_back(rows.back() + s.size());
  return rows;
}

inline KnotVector reversed_knots(const KnotVector& knots) {
  const Interval d = knots.domain();
  std::vector<double> result;
  for (double x : knots.knots()) result.insert(result.begin(), d.lower + d.upper - x);
  return make_knots(knots.degree(), result);
}

/// The same surface with u and v exchanged.
inline Surface transposed(const Surface& s) {
  const auto [m, n] = s.net();
  Points points(s.size(), 3);
  std::vector<double> weights(s.weights().size());
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      points.row(j * m + i) = s.control_points().row(i * n + j);
      if (s.rational())
        weights[static_cast<std::size_t>(j * m + i)] =
            s.weights()[static_cast<std::size_t>(i * n + j)];
    }
  }
  return make_surface(s.knots(1), s.knots(0), points, weights);
}

/// The same surface with u (0) or v (1) run through backwards.
inline Surface turned(const Surface& s, int direction) {
  if (direction == 0) return transposed(turned(transposed(s), 1));
  const auto [m, n] = s.net();
  Points points(s.size(), 3);
  std::vector<double> weights(s.weights().size());
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      points.row(i * n + j) = s.control_points().row(i * n + n - 1 - j);
      if (s.rational())
        weights[static_cast<std::size_t>(i * n + j)] =
            s.weights()[static_cast<std::size_t>(i * n + n - 1 - j)];
    }
  }
  return make_surface(s.knots(0), reversed_knots(s.knots(1)), points, weights);
}

/// The surface with its edge u0 made the given edge, run through backwards if asked for.
inline Surface with_edge_at(Surface s, SurfaceEdge edge, bool backwards) {
  if (backwards) s = turned(s, 1);
  if (edge_at_end(edge)) s = turned(s, 0);
  return edge_across(edge) == 1 ? transposed(s) : s;
}

/// Two surfaces that meet in edge u0 of both, tangent-continuous with the ratio ρ. With weights,
/// those of the edge are random, three times as large on b, and those of the next row in proportion
/// to them on either side.
inline std::vector<Surface> smooth_pair(const KnotVector& across_a, const KnotVector& across_b,
                                        const KnotVector& along, double rho, unsigned seed,
                                        double weight_spread = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  const int n = along.count();
  const auto net = [&](int m, double side) {
    Points points(m * n, 3);
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j < n; ++j) {
        points.row(i * n + j) << side * i, 1.0 * j * 4 / n, 0.3 * value(random);
      }
    }
    return points;
  };
  Points a = net(across_a.count(), -1), b = net(across_b.count(), 1);
  // Inward derivative per parameter at a clamped start: p/(x_{p+1} − x_p) (P_1 − P_0), times
  // w_1/w_0.
  const auto speed = [](const KnotVector& k) {
    return k.degree() / (k[k.degree() + 1] - k[k.degree()]);
  };
  std::vector<double> edge_weight, wa, wb;
  const double next_a = 1.7, next_b = 0.6, factor_b = 3;
  for (int j = 0; j < n; ++j) edge_weight.push_back(std::pow(weight_spread, value(random)));
  for (int j = 0; j < n; ++j) {
    b.row(j) = a.row(j);
    const double qa = weight_spread > 1 ? next_a : 1, qb = weight_spread > 1 ? next_b : 1;
    b.row(n + j) =
        b.row(j) - (a.row(n + j) - a.row(j)) * speed(across_a) * qa / (speed(across_b) * qb * rho);
  }
  if (weight_spread > 1) {
    const auto weights = [&](int m, double next, double factor) {
      std::vector<double> w;
      for (int i = 0; i < m; ++i) {
        for (int j = 0; j < n; ++j) {
          const double e = edge_weight[static_cast<std::size_t>(j)] * factor;
          w.push_back(i == 0 ? e : i == 1 ? e * next : std::pow(weight_spread, value(random)));
        }
      }
      return w;
    };
    wa = weights(across_a.count(), next_a, 1);
    wb = weights(across_b.count(), next_b, factor_b);
  }
  return {make_surface(across_a, along, a, wa), make_surface(across_b, along, b, wb)};
}

/// Points and unit normals of both sides of a seam at 41 places.
struct Sides {
  Points a, b, normal_a, normal_b;
};
inline Sides sides(const std::vector<Surface>& patches, const Seam& seam) {
  Sides result;
  for (bool second : {false, true}) {
    const PatchEdge edge = second ? seam.b : seam.a;
    const Surface& s = patches[static_cast<std::size_t>(edge.patch)];
    const int across = edge_across(edge.edge);
    const Interval d = s.knots(across).domain(), along = s.knots(1 - across).domain();
    const double end = edge_at_end(edge.edge) ? d.upper : d.lower;
    Parameters<2> at(41, 2);
    for (int k = 0; k < 41; ++k) {
      // Not on knots, where normals may have two limits.
      const double place = k == 40 ? 1 : k / 40.3;
      const double t = second && seam.reversed ? 1 - place : place;
      at(k, across) = end;
      at(k, 1 - across) = std::clamp(along.lower + t * along.length(), along.lower, along.upper);
    }
    const auto e = evaluate<2>(s, at, 1);
    if (!e) ADD_FAILURE() << e.error().message();
    Points normal(41, 3);
    const double sign =
        (edge_at_end(edge.edge) ? -1 : 1) * (second ? -1 : 1) * (second && seam.reversed ? -1 : 1);
    const MultiIndex<2> du = across == 0 ? MultiIndex<2>{1, 0} : MultiIndex<2>{0, 1};
    const MultiIndex<2> dv = across == 0 ? MultiIndex<2>{0, 1} : MultiIndex<2>{1, 0};
    for (int k = 0; k < 41; ++k) {
      const Point in = e->at(du).row(k), run = e->at(dv).row(k);
      normal.row(k) = sign * run.cross(in);
    }
    // Beside a pole nothing is left of a normal but rounding.
    const double least = 1e-8 * normal.rowwise().norm().maxCoeff();
    for (int k = 0; k < 41; ++k)
      normal.row(k) *= normal.row(k).norm() <= least ? 0 : 1 / normal.row(k).norm();
    (second ? result.b : result.a) = e->points();
    (second ? result.normal_b : result.normal_a) = normal;
  }
  return result;
}

/// Largest change of the vector between the two sides.
inline double gap_change(const std::vector<Surface>& before, const std::vector<Surface>& after,
                         const Seam& seam) {
  const Sides x = sides(before, seam), y = sides(after, seam);
  return ((y.a - y.b) - (x.a - x.b)).rowwise().norm().maxCoeff();
}
/// Largest change of the angle between the two tangent planes.
inline double angle_change(const std::vector<Surface>& before, const std::vector<Surface>& after,
                           const Seam& seam) {
  const Sides x = sides(before, seam), y = sides(after, seam);
  const auto angle = [](const Sides& s, int k) {
    const Point a = s.normal_a.row(k), b = s.normal_b.row(k);
    return std::atan2(a.cross(b).norm(), a.dot(b));
  };
  double change = 0;
  for (int k = 0; k < 41; ++k) {
    if (x.normal_a.row(k).norm() == 0 || x.normal_b.row(k).norm() == 0) continue;
    if (y.normal_a.row(k).norm() == 0 || y.normal_b.row(k).norm() == 0) continue;
    change = std::max(change, std::abs(angle(y, k) - angle(x, k)));
  }
  return change;
}

inline std::vector<Surface> displaced(const std::vector<Surface>& patches, const Points& x) {
  std::vector<Surface> result;
  Eigen::Index row = 0;
  for (const Surface& s : patches) {
    result.push_back(*s.with_control_points(s.control_points() + x.middleRows(row, s.size())));
    row += s.size();
  }
  return result;
}

/// Patches, their seams, and the displacements that the coupling leaves.
struct Coupled {
  std::vector<Surface> patches;
  FoundSeams found;
  SeamCoupling coupling;
  ConstraintSpace space{0};

  explicit Coupled(std::vector<Surface> of, const SeamOptions& options = {},
                   double tolerance = 1e-3)
      : patches(std::move(of)) {
    const auto all = pointers(patches);
    const auto rows = first_rows(patches);
    found = *find_seams(all, tolerance);
    auto made = couple_seams(all, rows, found.seams, options);
    if (!made) ADD_FAILURE() << made.error().message();
    coupling = std::move(*made);
    auto constrained = ConstraintSpace::create(rows.back(), coupling.constraints);
    if (!constrained) ADD_FAILURE() << constrained.error().message();
    space = std::move(*constrained);
  }
  [[nodiscard]] std::vector<Surface> moved(unsigned seed, double size = 0.1) const {
    return displaced(patches, space.feasible(size * random_points(space.size(), seed)));
  }
  [[nodiscard]] const SeamReport& report(int k = 0) const {
    return coupling.reports.at(static_cast<std::size_t>(k));
  }
};

}  // namespace knead::testing
