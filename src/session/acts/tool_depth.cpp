#include <algorithm>
#include <cmath>
#include <limits>

#include "knead/spline/evaluate.hpp"
#include "motion_law.hpp"
#include "spline/grid_lines.hpp"

namespace knead {
namespace {

// How deep a tool is in a surface: the yardstick for what it may move. `deepest` is the largest
// −d(S(u)), d the tool's signed distance; `standing` is more where a tool has passed through. Both
// take the best of a grid of samples and refine it by a compass search with halved steps. Distances
// have kinks, and a tool's deepest place may be a ridge, so that no derivative is used.
constexpr int halvings = 10;  // of the distance of samples, by the search for the deepest place

/// A surface as one tool meets it.
struct Meeting {
  const Surface& shape;
  const Tool& tool;
  const VisibleRegion* visible;
  BoundingBox box = tool.shape.bounding_box();

  /// False only where no point of the surface is in the tool: it lies in the box of its net, whose
  /// weights are positive.
  [[nodiscard]] bool may_touch() const {
    if (std::ranges::any_of(shape.weights(), [](double w) { return !(w > 0); })) return true;
    const Points& net = shape.control_points();
    const Point lower = net.colwise().minCoeff().transpose(),
                upper = net.colwise().maxCoeff().transpose();
    return (lower.array() <= box.upper.array()).all() && (upper.array() >= box.lower.array()).all();
  }
  [[nodiscard]] double depth(const Point& x) const {
    if ((x.array() < box.lower.array()).any() || (x.array() > box.upper.array()).any()) return 0;
    return std::max(0.0, -tool.shape.nearest(x).distance);
  }
  [[nodiscard]] bool sees(const std::array<double, 2>& u) const {
    if (visible == nullptr) return true;
    Eigen::Vector2d at;
    for (int d = 0; d < 2; ++d) {
      const Interval domain = shape.knots(d).domain();
      at[d] = (u[static_cast<std::size_t>(d)] - domain.lower) / domain.length();
    }
    return visible->contains(at);
  }
  /// The depth at a place, 0 where it is not visible.
  [[nodiscard]] double depth_at(const std::array<double, 2>& u) const {
    const auto x = evaluate_point<2>(shape, u);
    return x && sees(u) ? depth(*x) : 0;
  }

  [[nodiscard]] auto jet_at(const std::array<double, 2>& u) const {
    return evaluate<2>(shape, Parameters<2>(Eigen::Map<const Parameters<2>>(u.data(), 1, 2)), 1);
  }
  [[nodiscard]] static Point normal_of(const Evaluation<2>& jet) {
    const Point a = jet.at({1, 0}).row(0), b = jet.at({0, 1}).row(0);
    return a.stableNormalized().cross(b.stableNormalized()).stableNormalized();
  }

  [[nodiscard]] double deepest(int pieces) const {
    const std::array<std::vector<double>, 2> at = {even_parameters(shape.knots(0), pieces),
                                                   even_parameters(shape.knots(1), pieces)};
    const auto grid =
        evaluate_grid<2>(shape, {std::span<const double>(at[0]), std::span<const double>(at[1])});
    if (!grid) return 0;
    double best = 0;
    std::array<double, 2> place{};
    for (Eigen::Index k = 0; k < grid->points().rows(); ++k) {
      const double here = depth(grid->points().row(k));
      const std::array<double, 2> u = {at[0][static_cast<std::size_t>(k) / at[1].size()],
                                       at[1][static_cast<std::size_t>(k) % at[1].size()]};
      if (here <= best || !sees(u)) continue;
      best = here;
      place = u;
    }
    return best > 0 ? refined(best, place, at,
                              [this](const std::array<double, 2>& u) { return depth_at(u); })
                    : 0;
  }

  /// How far the tool stands in the surface: the shorter of the longest way along the normal, to
  /// the nearer side, out of the tool, and of the shortest translation that takes the surface out
  /// of it.
  [[nodiscard]] double standing(int pieces) const {
    constexpr std::size_t most = 400;
    const std::array<std::vector<double>, 2> at = {even_parameters(shape.knots(0), pieces),
                                                   even_parameters(shape.knots(1), pieces)};
    const auto grid =
        evaluate_grid<2>(shape, {std::span<const double>(at[0]), std::span<const double>(at[1])});
    if (!grid) return 0;
    std::vector<std::size_t> inside;
    for (Eigen::Index k = 0; k < grid->points().rows(); ++k) {
      if (depth(grid->points().row(k)) > 0) inside.push_back(static_cast<std::size_t>(k));
    }
    const auto way = [this](const std::array<double, 2>& u) { return way_out(u); };
    double longest = 0;
    std::array<double, 2> place{};
    for (std::size_t i = 0; i < inside.size(); i += 1 + inside.size() / most) {
      const std::array<double, 2> u = {at[0][inside[i] / at[1].size()],
                                       at[1][inside[i] % at[1].size()]};
      const double here = way(u);
      if (here <= longest) continue;
      longest = here;
      place = u;
    }
    if (!(longest > 0)) return 0;
    std::vector<Point> directions = {
        tool.shape.nearest(deepest_point(grid->points(), inside, at)).normal};
    for (std::size_t i = 0; i < inside.size(); i += 1 + inside.size() / most_normals) {
      const std::array<double, 2> u = {at[0][inside[i] / at[1].size()],
                                       at[1][inside[i] % at[1].size()]};
      const auto jet = jet_at(u);
      if (!jet) continue;
      const Point normal = normal_of(*jet);
      directions.insert(directions.end(), {normal, -normal});
    }
    return shortest_translation(grid->points(), directions, refined(longest, place, at, way));
  }

 private:
  static constexpr std::size_t most_normals = 8;  // of which translations are tried

  /// The deepest of samples, refined.
  [[nodiscard]] Point deepest_point(const Points& points, const std::vector<std::size_t>& rows,
                                    const std::array<std::vector<double>, 2>& at) const {
    const auto at_row = [&](std::size_t k) {
      return depth(points.row(static_cast<Eigen::Index>(k)));
    };
    const std::size_t deepest = *std::ranges::max_element(rows, {}, at_row);
    std::array<double, 2> place = {at[0][deepest / at[1].size()], at[1][deepest % at[1].size()]};
    refined(at_row(deepest), place, at,
            [this](const std::array<double, 2>& u) { return depth_at(u); });
    const auto x = evaluate_point<2>(shape, place);
    return x ? *x : Point(points.row(static_cast<Eigen::Index>(deepest)));
  }

  /// The least over these directions of the way after which no point is in the tool; `known`, where
  /// none is shorter.
  [[nodiscard]] double shortest_translation(const Points& points, std::span<const Point> directions,
                                            double known) const {
    constexpr Eigen::Index most = 600;
    const Eigen::Index stride = 1 + points.rows() / most;
    for (const Point& direction : directions) {
      if (!direction.allFinite() || direction.isZero(0)) continue;
      double longest = 0;
      for (Eigen::Index k = 0; k < points.rows() && longest < known; k += stride) {
        longest = std::max(longest, last_inside(points.row(k), direction));
      }
      known = std::min(known, longest);
    }
    return known;
  }

  /// How far along a ray the tool is left for good; found from beyond it, by steps as long as the
  /// distance from it.
  /// Sphere tracing (Hart, 1996) backwards from where the ray leaves the tool's box: a step as long
  /// as the distance from the tool cannot cross its side. 64 steps; a ray that runs along the side
  /// needs more, and ends a little too far out, which errs to the side of more room.
  [[nodiscard]] double last_inside(const Point& from, const Point& direction) const {
    constexpr int most_steps = 64;
    constexpr double touching = 1e-3;  // of the tool's size
    double enters = 0, way = std::numeric_limits<double>::infinity();
    for (int c = 0; c < 3; ++c) {
      if (direction[c] == 0) {
        if (from[c] < box.lower[c] || from[c] > box.upper[c]) return 0;
        continue;
      }
      const double a = (box.lower[c] - from[c]) / direction[c],
                   b = (box.upper[c] - from[c]) / direction[c];
      enters = std::max(enters, std::min(a, b));
      way = std::min(way, std::max(a, b));
    }
    if (!std::isfinite(way)) return way;
    for (int k = 0; k < most_steps && way > enters; ++k) {
      const double outside = tool.shape.nearest(from + way * direction).distance;
      if (outside <= touching * tool.shape.size()) return way;
      way -= outside;
    }
    return way > enters ? way : 0;
  }
  /// By steps as long as the distance from the tool's side, within which nothing is outside.
  [[nodiscard]] double way_along(const Point& from, const Point& direction) const {
    constexpr int most_steps = 64;
    constexpr double outside = 1e-3;  // of the tool's size
    double way = 0;
    for (int k = 0; k < most_steps; ++k) {
      const double here = depth(from + way * direction);
      way += here;
      if (here <= outside * tool.shape.size()) break;
    }
    return way;
  }
  /// At a pole, which has no normal, the distance from the nearest side: no way out is shorter.
  [[nodiscard]] double way_out(const std::array<double, 2>& u) const {
    const auto jet = jet_at(u);
    if (!jet) return 0;
    const Point x = jet->points().row(0), normal = normal_of(*jet);
    if (normal.isZero(0)) return depth(x);
    return std::min(way_along(x, normal), way_along(x, -normal));
  }

  template <class F>
  double refined(double best, std::array<double, 2>& place,
                 const std::array<std::vector<double>, 2>& at, const F& value) const {
    for (double h = 0.5; h > std::ldexp(1.0, -halvings); h /= 2) {
      for (std::size_t d = 0; d < 2; ++d) {
        const Interval domain = shape.knots()[d].domain();
        const double step = domain.length() / static_cast<double>(at[d].size());
        for (const double sign : {-1.0, 1.0}) {
          std::array<double, 2> u = place;
          u[d] = std::clamp(u[d] + sign * h * step, domain.lower, domain.upper);
          const double here = value(u);
          if (here <= best) continue;
          best = here;
          place = u;
        }
      }
    }
    return best;
  }
};

}  // namespace

// A tool between samples has depth 0 at all of them: it is looked for again with more samples, as
// many per span as a spline of this degree may have extremes.
double depth_in(const Surface& shape, std::span<const Tool> tools, const VisibleRegion* visible) {
  double deepest = 0;
  for (const Tool& tool : tools) {
    const Meeting meeting{shape, tool, visible};
    if (!tool.collides() || !meeting.may_touch()) continue;
    double here = meeting.deepest(1);
    if (here == 0)
      here = meeting.deepest(std::max(shape.knots(0).degree(), shape.knots(1).degree()) + 1);
    deepest = std::max(deepest, here);
  }
  return deepest;
}

double standing_in(const Surface& shape, std::span<const Tool> tools) {
  constexpr int pieces = 4;
  double longest = 0;
  for (const Tool& tool : tools) {
    const Meeting meeting{shape, tool, nullptr};
    if (tool.collides() && meeting.may_touch())
      longest = std::max(longest, meeting.standing(pieces));
  }
  return longest;
}

}  // namespace knead
