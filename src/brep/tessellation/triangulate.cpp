#include "triangulate.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "ear_clipping.hpp"
#include "orientation.hpp"

namespace knead {
namespace {

using Eigen::Vector2d;

constexpr std::uint32_t none = 0xFFFFFFFF;

// Positive where d lies in the circle through a, b, c (counter-clockwise).
double in_circle(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const Vector2d p = a - d, q = b - d, r = c - d;
  return p.squaredNorm() * (q.x() * r.y() - q.y() * r.x()) -
         q.squaredNorm() * (p.x() * r.y() - p.y() * r.x()) +
         r.squaredNorm() * (p.x() * q.y() - p.y() * q.x());
}

class Mesh {
 public:
  Mesh(std::vector<Vector2d> points, std::vector<Triangle> triangles)
      : points_(std::move(points)), triangles_(std::move(triangles)) {}

  // Neighbours across the sides that two triangles share; `bounds` of the loops are never flipped.
  void connect(std::span<const std::uint32_t> sizes) {
    neighbours_.assign(triangles_.size(), {none, none, none});
    std::unordered_map<std::uint64_t, std::pair<std::uint32_t, int>>
        open;  // side to the triangle that has it
    std::uint32_t at = 0;
    for (const auto size : sizes) {
      for (std::uint32_t k = 0; k < size; ++k)
        open.emplace(key(at + k, at + (k + 1) % size), std::pair(none, 0));
      at += size;
    }
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      for (int i = 0; i < 3; ++i) {
        const auto [found, fresh] =
            open.emplace(key(corner(t, i), corner(t, i + 1)), std::pair(t, i));
        if (fresh || found->second.first == none) continue;
        const auto [other, j] = found->second;
        // A third triangle on one side: degenerate, and left so.
        if (neighbours_[other][std::size_t(j)] != none) continue;
        neighbours_[other][std::size_t(j)] = t;
        neighbours_[t][std::size_t(i)] = other;
      }
    }
  }

  void flip_all() {
    std::vector<std::uint32_t> all(triangles_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) all[t] = t;
    settle(std::move(all));
  }

  void insert(const Vector2d& p) {
    const auto t = locate(p);
    const auto index = static_cast<std::uint32_t>(points_.size());
    points_.push_back(p);
    if (t == none) return;
    const auto [a, b, c] = triangles_[t];
    const auto [ab, bc, ca] = neighbours_[t];
    const auto second = static_cast<std::uint32_t>(triangles_.size()), third = second + 1;
    triangles_[t] = {a, b, index};
    triangles_.push_back({b, c, index});
    triangles_.push_back({c, a, index});
    neighbours_[t] = {ab, second, third};
    neighbours_.push_back({bc, third, t});
    neighbours_.push_back({ca, t, second});
    replace(bc, t, second);
    replace(ca, t, third);
    last_ = t;
    if (!near_.empty()) near_[cell(p)] = t;
    settle({t, second, third});
  }

  /// Prepares for so many points to be inserted.
  void expect(std::size_t count) {
    for (const Vector2d& p : points_) box_.extend(p);
    if (!(box_.sizes().minCoeff() > 0)) return;
    across_ = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count) / 4))) + 1;
    near_.assign(across_ * across_, none);
  }

  std::vector<Triangle> take() { return std::move(triangles_); }

 private:
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
  }
  std::uint32_t corner(std::uint32_t t, int i) const {
    return triangles_[t][static_cast<std::size_t>(i % 3)];
  }
  const Vector2d& place(std::uint32_t t, int i) const { return points_[corner(t, i)]; }
  void replace(std::uint32_t t, std::uint32_t from, std::uint32_t to) {
    if (t == none) return;
    for (auto& n : neighbours_[t]) {
      if (n == from) {
        n = to;
        return;
      }
    }
  }

  // Flips sides of the waiting triangles, and of those this changes, until all circles are empty.
  void settle(std::vector<std::uint32_t> waiting) {
    // Rounding might make two sides flip in turn; Delaunay needs fewer than this (Lawson: half the
    // square).
    std::size_t budget = 64 + 128 * waiting.size() + waiting.size() * waiting.size();
    while (!waiting.empty() && budget-- > 0) {
      const auto t = waiting.back();
      bool flipped = false;
      for (int i = 0; i < 3 && !flipped; ++i) {
        const auto s = neighbours_[t][static_cast<std::size_t>(i)];
        if (s == none) continue;
        int j = 0;
        while (j < 3 && neighbours_[s][static_cast<std::size_t>(j)] != t) ++j;
        if (j == 3 || !should_flip(t, i, s, j)) continue;
        flip(t, i, s, j);
        waiting.push_back(s);
        flipped = true;
      }
      if (!flipped) waiting.pop_back();
    }
  }

  // Only if both new triangles have an area: then the quadrilateral is convex. One without area is
  // flipped away whatever the circles say. Predicates are in doubles, so a flip needs a gain above
  // rounding; without it two sides with a common circle could flip in turn for ever.
  bool should_flip(std::uint32_t t, int i, std::uint32_t s, int j) const {
    const Vector2d &a = place(t, i), &b = place(t, i + 1), &c = place(t, i + 2),
                   &d = place(s, j + 2);
    const double now = std::min(doubled_area(a, b, c), doubled_area(b, a, d));
    const double then = std::min(doubled_area(c, a, d), doubled_area(c, d, b));
    const double size = (a - b).squaredNorm() + (c - d).squaredNorm();
    if (!(then > 1e-12 * size)) return false;
    if (now <= 1e-12 * size) return true;  // no area, hence no circle
    return in_circle(a, b, c, d) > 1e-10 * size * size;
  }

  // Side a b of t = (a, b, c), s = (b, a, d) becomes c d.
  void flip(std::uint32_t t, int i, std::uint32_t s, int j) {
    const auto a = corner(t, i), b = corner(t, i + 1), c = corner(t, i + 2), d = corner(s, j + 2);
    const auto side = [this](std::uint32_t of, int k) {
      return neighbours_[of][static_cast<std::size_t>(k % 3)];
    };
    const auto bc = side(t, i + 1), ca = side(t, i + 2), ad = side(s, j + 1), db = side(s, j + 2);
    triangles_[t] = {c, a, d};
    neighbours_[t] = {ca, ad, s};
    triangles_[s] = {d, b, c};
    neighbours_[s] = {db, bc, t};
    replace(ad, s, t);
    replace(bc, t, s);
  }

  bool holds(std::uint32_t t, const Vector2d& p) const {
    for (int i = 0; i < 3; ++i) {
      if (doubled_area(place(t, i), place(t, i + 1), p) < 0) return false;
    }
    return true;
  }

  // Walks from a triangle towards p, until p is in one or a bound is in the way.
  std::uint32_t walk(std::uint32_t t, const Vector2d& p, std::size_t most) const {
    for (std::size_t steps = 0; steps < most; ++steps) {
      int out = -1;
      for (int i = 0; i < 3; ++i) {
        if (doubled_area(place(t, i), place(t, i + 1), p) < 0 &&
            neighbours_[t][static_cast<std::size_t>(i)] != none)
          out = i;
      }
      if (out < 0) break;
      t = neighbours_[t][static_cast<std::size_t>(out)];
    }
    return t;
  }

  [[nodiscard]] std::size_t cell(const Vector2d& p) const {
    const auto along = [&](int d) {
      const double cells = (p[d] - box_.min()[d]) / box_.sizes()[d] * static_cast<double>(across_);
      if (!(cells > 0))
        return std::size_t{0};  // as where the box is too large for its size to be a number
      return static_cast<std::size_t>(std::min(cells, static_cast<double>(across_ - 1)));
    };
    return along(1) * across_ + along(0);
  }

  // From the last triangle, and where that is far, or a bound in the way, from where a point was
  // inserted nearby. Where neither helps, all triangles are searched.
  std::uint32_t locate(const Vector2d& p) const {
    const auto last = walk(last_ < triangles_.size() ? last_ : 0, p, 200);
    if (holds(last, p)) return last;
    if (!near_.empty()) {
      const std::size_t at = cell(p), x = at % across_, y = at / across_;
      for (const std::size_t row : {y, y - 1, y + 1}) {
        for (const std::size_t column : {x, x - 1, x + 1}) {
          if (row >= across_ || column >= across_) continue;
          const auto start = near_[row * across_ + column];
          if (start == none) continue;
          const auto t = walk(start, p, 200);
          if (holds(t, p)) return t;
        }
      }
    }
    const auto far = walk(last, p, triangles_.size() / 8);
    if (holds(far, p)) return far;
    for (std::uint32_t k = 0; k < triangles_.size(); ++k) {
      if (holds(k, p)) return k;
    }
    return none;
  }

  std::vector<Vector2d> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;  // across sides 01, 12, 20
  std::uint32_t last_ = 0;                                // where a point was inserted
  // Likewise, by the cells of a grid over all points; empty: the box has no area.
  std::vector<std::uint32_t> near_;
  Eigen::AlignedBox2d box_;
  std::size_t across_ = 0;
};

}  // namespace

std::optional<std::vector<Triangle>> triangulate(std::span<const std::vector<Vector2d>> loops,
                                                 std::span<const Vector2d> inside) {
  std::vector<Vector2d> points;
  std::vector<std::uint32_t> sizes;
  for (const auto& loop : loops) {
    points.insert(points.end(), loop.begin(), loop.end());
    sizes.push_back(static_cast<std::uint32_t>(loop.size()));
  }
  auto ears = clip_ears(points, sizes);
  if (!ears) return std::nullopt;
  Mesh mesh(std::move(points), *std::move(ears));
  mesh.connect(sizes);
  mesh.flip_all();
  mesh.expect(inside.size());
  for (const Vector2d& p : inside) mesh.insert(p);
  return mesh.take();
}

}  // namespace knead
