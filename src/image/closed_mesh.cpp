#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "knead/image/surface_snake.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

using Corners = std::array<std::uint32_t, 3>;

std::vector<double> steps(const KnotVector& knots, int per_span, bool last) {
  std::vector<double> at;
  for (const int span : knots.spans()) {
    for (int i = 0; i < per_span; ++i)
      at.push_back(std::lerp(knots[span], knots[span + 1], i / double(per_span)));
  }
  if (last) at.push_back(knots.domain().upper);
  return at;
}

/// Which side of the plane through three points. Six times the signed volume of the tetrahedron (a,
/// b, c, p).
double side_of(const Eigen::RowVector3d& a, const Eigen::RowVector3d& b,
               const Eigen::RowVector3d& c, const Eigen::RowVector3d& p) {
  return (b - a).cross(c - a).dot(p - a);
}

/// Whether a segment goes through a triangle.
///
/// Its ends lie on different sides of the plane, and its line passes the three edges on the same
/// side. What only touches has a volume of 0 and does not count, so that a mesh that lies on itself
/// is not reported for rounding.
bool pierces(const Points& at, std::uint32_t from, std::uint32_t to, const Corners& triangle) {
  const Eigen::RowVector3d a = at.row(triangle[0]), b = at.row(triangle[1]),
                           c = at.row(triangle[2]), p = at.row(from), q = at.row(to);
  if (side_of(a, b, c, p) * side_of(a, b, c, q) >= 0) return false;
  const double x = side_of(p, q, a, b), y = side_of(p, q, b, c), z = side_of(p, q, c, a);
  return (x > 0 && y > 0 && z > 0) || (x < 0 && y < 0 && z < 0);
}

bool cross(const Points& at, const Corners& s, const Corners& t) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (pierces(at, s[k], s[(k + 1) % 3], t) || pierces(at, t[k], t[(k + 1) % 3], s)) return true;
  }
  return false;
}

/// Twice the area of (a, b, p) in the plane of the last two coordinates; exactly the negative for
/// (b, a, p).
///
/// Both triangles at an edge compute the same number, not two that differ by rounding: a line along
/// x that passes near the edge then meets exactly one of them, and crosses a closed mesh an even
/// number of times.
double area_of(const Point& a, const Point& b, double y, double z) {
  const bool swapped = std::pair(a[1], a[2]) > std::pair(b[1], b[2]);
  const Point &from = swapped ? b : a, &to = swapped ? a : b;
  const double area = (to[1] - from[1]) * (z - from[2]) - (to[2] - from[2]) * (y - from[1]);
  return swapped ? -area : area;
}

/// Whether a point on the edge from a to b counts as inside of the triangle to the left of it: of
/// two triangles that share the edge, it counts in one.
bool keeps_edge(const Point& a, const Point& b) { return a[2] == b[2] ? b[1] < a[1] : b[2] > a[2]; }

}  // namespace

// Samples of a grid of parameters with corners shared around u, and around v of a torus. On a
// sphere all samples of the first and last column are one corner each, numbered last, and the
// quadrilaterals beside it are one triangle each.
ClosedMesh closed_mesh(const ClosedSurface& snake, int per_span) {
  const bool sphere = snake.form == SurfaceForm::sphere;
  const std::vector<double> u = steps(snake.surface.knots()[0], per_span, false),
                            v = steps(snake.surface.knots()[1], per_span, sphere);
  ClosedMesh mesh;
  const auto at = evaluate_grid(snake.surface, {std::span(u), std::span(v)});
  if (!at) return mesh;  // only rational surfaces can fail
  const auto rows = static_cast<std::uint32_t>(u.size()),
             columns = static_cast<std::uint32_t>(v.size());
  const std::uint32_t between = sphere ? columns - 2 : columns;
  const auto corner = [&](std::uint32_t i, std::uint32_t j) {
    if (!sphere) return i % rows * columns + j % columns;
    return j == 0             ? rows * between
           : j == columns - 1 ? rows * between + 1
                              : i % rows * between + j - 1;
  };
  mesh.points.resize(rows * between + (sphere ? 2 : 0), 3);
  for (std::uint32_t i = 0; i < rows; ++i) {
    for (std::uint32_t j = 0; j < columns; ++j)
      mesh.points.row(corner(i, j)) = at->points().row(i * columns + j);
  }
  const std::uint32_t across = sphere ? columns - 1 : columns;
  for (std::uint32_t i = 0; i < rows; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const std::uint32_t a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1),
                          d = corner(i, j + 1);
      if (a != b) mesh.triangles.push_back({a, b, c});
      if (c != d) mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

// Sweep along x over boxes sorted by their lower ends: only triangles whose boxes overlap are
// tested.
int crossings(const ClosedMesh& mesh) {
  struct Box {
    Eigen::RowVector3d lower, upper;
  };
  std::vector<Box> boxes;
  for (const Corners& t : mesh.triangles) {
    const Eigen::RowVector3d a = mesh.points.row(t[0]), b = mesh.points.row(t[1]),
                             c = mesh.points.row(t[2]);
    boxes.push_back({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)});
  }
  std::vector<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t k) { return boxes[k].lower[0]; });
  int count = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Box& box = boxes[order[i]];
    const Corners& s = mesh.triangles[order[i]];
    for (std::size_t j = i + 1; j < order.size() && boxes[order[j]].lower[0] <= box.upper[0]; ++j) {
      const Box& other = boxes[order[j]];
      if ((other.lower.array() > box.upper.array()).any() ||
          (box.lower.array() > other.upper.array()).any())
        continue;
      const Corners& t = mesh.triangles[order[j]];
      if (std::ranges::any_of(s,
                              [&t](std::uint32_t k) { return std::ranges::find(t, k) != t.end(); }))
        continue;
      if (cross(mesh.points, s, t)) ++count;
    }
  }
  return count;
}

// Every triangle is rasterised in the plane of the lines along x; each line keeps the x at which it
// goes through the surface, sorted, and what is between the first and second, third and fourth … is
// inside. In voxels, whatever the frame: directions that are not perpendicular change nothing of
// what is inside. Cost: O(voxels + lines that triangles cover).
VolumeImage mask_of(const ClosedMesh& mesh, const std::array<int, 3>& size,
                    const VolumeFrame& frame) {
  VolumeImage mask{size, {}, frame};
  const auto lines = static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
  mask.values.assign(lines * static_cast<std::size_t>(size[0]), 0);
  std::vector<std::vector<double>> hits(lines);
  const Eigen::Matrix3d to_voxels = frame.directions.inverse();
  for (const Corners& t : mesh.triangles) {
    std::array<Point, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = to_voxels * (mesh.points.row(t[k]).transpose() - frame.origin);
    if (area_of(p[0], p[1], p[2][1], p[2][2]) < 0) std::swap(p[1], p[2]);
    const auto range = [&](Eigen::Index d) {
      const auto [low, high] = std::minmax({p[0][d], p[1][d], p[2][d]});
      const int n = size[static_cast<std::size_t>(d)];
      return std::pair{static_cast<int>(std::ceil(std::clamp(low, 0.0, double(n)))),
                       static_cast<int>(std::floor(std::clamp(high, -1.0, n - 1.0)))};
    };
    const auto [y0, y1] = range(1);
    const auto [z0, z1] = range(2);
    for (int z = z0; z <= z1; ++z) {
      for (int y = y0; y <= y1; ++y) {
        double share[3], total = 0;
        bool inside = true;
        for (std::size_t k = 0; k < 3 && inside; ++k) {
          const Point &a = p[(k + 1) % 3], &b = p[(k + 2) % 3];
          share[k] = area_of(a, b, y, z);
          inside = share[k] > 0 || (share[k] == 0 && keeps_edge(a, b));
          total += share[k];
        }
        if (!inside || !(total > 0)) continue;
        const double x = (share[0] * p[0][0] + share[1] * p[1][0] + share[2] * p[2][0]) / total;
        hits[static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) +
             static_cast<std::size_t>(y)]
            .push_back(x);
      }
    }
  }
  for (std::size_t line = 0; line < lines; ++line) {
    std::ranges::sort(hits[line]);
    double* row = mask.values.data() + line * static_cast<std::size_t>(size[0]);
    for (std::size_t k = 0; k + 1 < hits[line].size(); k += 2) {
      const double from = std::max(0.0, std::ceil(hits[line][k])),
                   to = std::min(size[0] - 1.0, hits[line][k + 1]);
      for (double x = from; x <= to; ++x) row[static_cast<std::size_t>(x)] = 1;
    }
  }
  return mask;
}

}  // namespace knead
