#include "box_tree.hpp"

#include <cmath>
#include <limits>
#include <numeric>

namespace knead {
namespace {

constexpr std::uint32_t boxes_of_a_leaf = 4;

}  // namespace

BoxTree::BoxTree(std::span<const Eigen::AlignedBox3d> boxes) : order_(boxes.size()) {
  if (boxes.empty()) return;
  std::iota(order_.begin(), order_.end(), 0U);
  nodes_.reserve(2 * boxes.size());
  nodes_.emplace_back();
  divide(0, 0, static_cast<std::uint32_t>(boxes.size()), boxes);
}

void BoxTree::divide(std::uint32_t node, std::uint32_t begin, std::uint32_t end,
                     std::span<const Eigen::AlignedBox3d> boxes) {
  Eigen::AlignedBox3d box, centres;
  for (auto k = begin; k < end; ++k) {
    box.extend(boxes[order_[k]]);
    centres.extend(boxes[order_[k]].center());
  }
  nodes_[node].box = box;
  if (end - begin <= boxes_of_a_leaf) {
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return;
  }
  Eigen::Index axis = 0;
  centres.sizes().maxCoeff(&axis);
  const auto middle = begin + (end - begin) / 2;
  const auto at = [&](std::uint32_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
  // Halves of equal number bound the depth at about log₂ n for any input, even where all centres
  // coincide; a surface-area heuristic does not, and costs more to build.
  std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
    return boxes[a].center()[axis] < boxes[b].center()[axis];
  });
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = children;
  divide(children, begin, middle, boxes);
  divide(children + 1, middle, end, boxes);
}

// A subtraction and a division round each bound: without the factor a box that is flat, or grazed
// at a corner, could be missed though a triangle in it is met.
bool BoxTree::enters(const Eigen::AlignedBox3d& box, const Ray& ray, double to) {
  constexpr double wider = 1 + 8 * std::numeric_limits<double>::epsilon();
  double from = 0;
  for (Eigen::Index d = 0; d < 3; ++d) {
    const double lower = box.min()[d] - ray.origin[d], upper = box.max()[d] - ray.origin[d];
    // 0 / 0 at a face of the box would be no number.
    if (ray.direction[d] == 0) {
      if (lower > 0 || upper < 0) return false;
      continue;
    }
    const auto [near, far] = std::minmax({lower / ray.direction[d], upper / ray.direction[d]});
    from = std::max(from, near);
    to = std::min(to, far * wider);
    if (from > to) return false;
  }
  return true;
}

TriangleTree::TriangleTree(std::vector<Point> points,
                           std::vector<std::array<std::uint32_t, 3>> triangles)
    : points_(std::move(points)), triangles_(std::move(triangles)) {
  std::vector<Eigen::AlignedBox3d> boxes(triangles_.size());
  for (std::size_t k = 0; k < triangles_.size(); ++k) {
    for (const auto corner : triangles_[k]) boxes[k].extend(points_[corner]);
  }
  tree_ = BoxTree(boxes);
}

Eigen::AlignedBox3d TriangleTree::box() const {
  Eigen::AlignedBox3d result;
  for (const Point& p : points_) result.extend(p);
  return result;
}

Point TriangleTree::facet(std::uint32_t triangle) const {
  const auto& [a, b, c] = triangles_[triangle];
  return (points_[b] - points_[a]).cross(points_[c] - points_[a]);
}

// The longest coordinate of the direction becomes the third axis, so that shears are at most 1; the
// other two swap where it is negative, which keeps the sense of triangles.
TriangleTree::Sheared::Sheared(const Ray& ray) : origin(ray.origin) {
  Eigen::Index along = 0;
  ray.direction.cwiseAbs().maxCoeff(&along);
  axes[2] = static_cast<int>(along);
  axes[0] = (axes[2] + 1) % 3;
  axes[1] = (axes[2] + 2) % 3;
  if (ray.direction[along] < 0) std::swap(axes[0], axes[1]);
  shear = Point(ray.direction[axes[0]], ray.direction[axes[1]], 1) / ray.direction[along];
}

Point TriangleTree::Sheared::of(const Point& p) const {
  const Point q = p - origin;
  const double z = q[axes[2]];
  return {q[axes[0]] - shear[0] * z, q[axes[1]] - shear[1] * z, shear[2] * z};
}

bool TriangleTree::meets(const Sheared& ray, std::uint32_t triangle, Hit& hit) const {
  const auto& corners = triangles_[triangle];
  const Point a = ray.of(points_[corners[0]]), b = ray.of(points_[corners[1]]),
              c = ray.of(points_[corners[2]]);
  // Doubled areas that the origin makes with each side. A side that two triangles share gives both
  // the same two products, and so opposite numbers exactly: no ray slips between them.
  const double u = c.x() * b.y() - c.y() * b.x(), v = a.x() * c.y() - a.y() * c.x(),
               w = b.x() * a.y() - b.y() * a.x();
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
  const double sum = u + v + w;
  if (sum == 0) return false;  // seen from its edge
  hit.weights = {u / sum, v / sum, w / sum};
  hit.distance = hit.weights[0] * a.z() + hit.weights[1] * b.z() + hit.weights[2] * c.z();
  hit.triangle = triangle;
  return hit.distance >= 0;
}

}  // namespace knead
