#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead {

/// Points origin + t · direction, t >= 0.
struct Ray {
  Point origin = Point::Zero();
  Point direction = Point::UnitZ();  ///< of length 1
};

/// A bounding-volume hierarchy: a binary tree of boxes, divided at the median along their longest
/// extent. Building it costs O(n log n); what a ray meets is found in about O(log n).
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::span<const Eigen::AlignedBox3d> boxes);

  /// Calls `visit(index)` for every box that the ray enters before `to`, the nearer half of the
  /// tree first; `visit` may lessen `to`.
  template <class Visit>
  void along(const Ray& ray, double& to, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, 96> waiting{};  // deeper than any tree of 2³² boxes
    std::size_t count = 0;
    waiting[count++] = 0;
    while (count > 0) {
      const Node& node = nodes_[waiting[--count]];
      if (!enters(node.box, ray, to)) continue;
      if (node.count > 0) {
        for (std::uint32_t k = 0; k < node.count; ++k) visit(order_[node.first + k]);
        continue;
      }
      std::uint32_t near = node.first, far = node.first + 1;
      if (nodes_[near].box.center().dot(ray.direction) >
          nodes_[far].box.center().dot(ray.direction)) {
        std::swap(near, far);
      }
      waiting[count++] = far;
      waiting[count++] = near;
    }
  }

  /// Calls `visit(index)` for every box that has a point in common with this one.
  template <class Visit>
  void meeting(const Eigen::AlignedBox3d& box, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, 96> waiting{};  // as above
    std::size_t count = 0;
    waiting[count++] = 0;
    while (count > 0) {
      const Node& node = nodes_[waiting[--count]];
      if (!node.box.intersects(box)) continue;
      if (node.count > 0) {
        for (std::uint32_t k = 0; k < node.count; ++k) visit(order_[node.first + k]);
        continue;
      }
      waiting[count++] = node.first;
      waiting[count++] = node.first + 1;
    }
  }
  /// Calls `visit(index)` for the boxes, and perhaps for others, that are nearer to a point than
  /// `within`, the nearer half of the tree first; `visit` may lessen `within`.
  template <class Visit>
  void near(const Point& x, double& within, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::array<std::pair<std::uint32_t, double>, 96> waiting{};  // as above
    std::size_t count = 0;
    waiting[count++] = {0, nodes_[0].box.exteriorDistance(x)};
    while (count > 0) {
      const auto [at, distance] = waiting[--count];
      if (!(distance < within)) continue;
      const Node& node = nodes_[at];
      if (node.count > 0) {
        for (std::uint32_t k = 0; k < node.count; ++k) visit(order_[node.first + k]);
        continue;
      }
      std::pair one(node.first, nodes_[node.first].box.exteriorDistance(x));
      std::pair other(node.first + 1, nodes_[node.first + 1].box.exteriorDistance(x));
      if (one.second > other.second) std::swap(one, other);
      waiting[count++] = other;
      waiting[count++] = one;
    }
  }
  /// Round all boxes; empty where there is none.
  [[nodiscard]] Eigen::AlignedBox3d box() const {
    return nodes_.empty() ? Eigen::AlignedBox3d() : nodes_[0].box;
  }

  /// Whether a ray has a point in a box before `to`: the slabs of Kay and Kajiya (1986), widened by
  /// their rounding.
  [[nodiscard]] static bool enters(const Eigen::AlignedBox3d& box, const Ray& ray, double to);

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t first = 0;  ///< of its boxes in `order_`, or the first of its two children
    std::uint32_t count = 0;  ///< of its boxes; 0: it has children
  };
  void divide(std::uint32_t node, std::uint32_t begin, std::uint32_t end,
              std::span<const Eigen::AlignedBox3d> boxes);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

/// Triangles in a `BoxTree`.
class TriangleTree {
 public:
  /// Where a ray meets a triangle.
  struct Hit {
    double distance = 0;
    std::uint32_t triangle = 0;
    std::array<double, 3> weights = {};  ///< of the triangle's corners; their sum is 1
  };

  TriangleTree() = default;
  TriangleTree(std::vector<Point> points, std::vector<std::array<std::uint32_t, 3>> triangles);

  [[nodiscard]] const std::vector<std::array<std::uint32_t, 3>>& triangles() const {
    return triangles_;
  }
  [[nodiscard]] Eigen::AlignedBox3d box() const;
  /// (b − a) × (c − a).
  [[nodiscard]] Point facet(std::uint32_t triangle) const;

  /// The nearest hit before `to` that `counts(hit)`; lessens `to` to its distance. Watertight: a
  /// ray through a common side meets at least one of its triangles (Woop, Benthin, Wald,
  /// "Watertight Ray/Triangle Intersection", 2013).
  template <class Counts>
  [[nodiscard]] bool nearest(const Ray& ray, double& to, const Counts& counts) const {
    const Sheared sheared(ray);
    bool any = false;
    tree_.along(ray, to, [&](std::uint32_t k) {
      Hit hit;
      if (!meets(sheared, k, hit) || !(hit.distance < to) || !counts(std::as_const(hit))) return;
      to = hit.distance;
      any = true;
    });
    return any;
  }

 private:
  /// Coordinates in which a ray runs along the third axis from the origin.
  struct Sheared {
    explicit Sheared(const Ray& ray);
    [[nodiscard]] Point of(const Point& p) const;
    Point origin, shear;
    std::array<int, 3> axes = {};
  };
  [[nodiscard]] bool meets(const Sheared& ray, std::uint32_t triangle, Hit& hit) const;

  std::vector<Point> points_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  BoxTree tree_;
};

}  // namespace knead
