#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "knead/spline/basis.hpp"
#include "knead/spline/spline.hpp"
#include "spline/box_tree.hpp"

namespace knead {

/// A surface that moves from S₀ to S₁, both on the same knots and weights: S(u, t) = (1 − t) S₀(u)
/// + t S₁(u).
struct Motion {
  std::shared_ptr<const Surface> from, to;

  [[nodiscard]] bool moves() const { return from != to; }
};

/// A piece of a model as triangles that move evenly from one place to another.
struct Patch {
  std::vector<std::array<double, 2>> at;  ///< parameters, by point; empty where there are none
  std::vector<Point> from, to;            ///< corners, by point
  std::vector<std::array<std::uint32_t, 3>> triangles;
  double sag = 0;  ///< about how far the triangles may be from what they stand for
};

/// The spans of a moving surface, each with a box that holds it wherever it is on its way: that of
/// the (p + 1)(q + 1) control points which affect it, at the beginning and the end. Weights must be
/// positive, so that a surface lies in the hull of its net.
class SpanGrid {
 public:
  static constexpr int cells = 4;  ///< of the patch of a span, in each direction

  /// None where some weight is not positive. Requires: the same knots and weights (asserted). Cost:
  /// O(p + q) per control point.
  [[nodiscard]] static std::optional<SpanGrid> create(Motion motion);

  [[nodiscard]] const Motion& motion() const { return motion_; }
  [[nodiscard]] const std::vector<Eigen::AlignedBox3d>& boxes() const { return boxes_; }
  /// Round the spans that move; all, where none does.
  [[nodiscard]] const Eigen::AlignedBox3d& box() const { return box_; }
  /// Whether a control point of this span moves.
  [[nodiscard]] bool moves(std::size_t span) const { return moves_[span] != 0; }
  /// The tree of the boxes, made at the first call.
  [[nodiscard]] const BoxTree& tree();
  /// cells × cells squares of two triangles each, made at the first call. Its sag is estimated by
  /// second differences.
  [[nodiscard]] const Patch& patch(std::size_t span);
  /// Calls `visit(p0, p1)` for every control point of a span, where it is at first and at the end.
  template <class Visit>
  void net_of(std::size_t span, const Visit& visit) const {
    const auto columns = spans_[1].size();
    const int s = spans_[0][span / columns], t = spans_[1][span % columns];
    const int p = motion_.from->knots(0).degree(), q = motion_.from->knots(1).degree(),
              n = motion_.from->net()[1];
    for (int i = s - p; i <= s; ++i) {
      for (int j = t - q; j <= t; ++j) {
        visit(motion_.from->control_points().row(i * n + j),
              motion_.to->control_points().row(i * n + j));
      }
    }
  }
  /// How many cells lie between two places, in the direction in which there are more; across the
  /// seam of a closed surface, where that is shorter.
  [[nodiscard]] double cells_between(const std::array<double, 2>& a,
                                     const std::array<double, 2>& b) const;
  /// False only where normals of the net, before and after, are all on one side of a plane: such a
  /// surface does not come to itself unless its sides cross (Volino and Magnenat-Thalmann,
  /// "Efficient self-collision detection on smoothly discretized surface animations", 1994).
  [[nodiscard]] bool may_meet_itself() const;

 private:
  explicit SpanGrid(Motion motion) : motion_(std::move(motion)) {}
  void make_boxes();
  [[nodiscard]] Patch made_patch(std::size_t span) const;
  [[nodiscard]] double cell_of(int direction, double u) const;

  Motion motion_;
  std::array<std::vector<int>, 2> spans_;
  std::array<bool, 2> closed_ = {};
  std::vector<Eigen::AlignedBox3d> boxes_;
  Eigen::AlignedBox3d box_;
  std::vector<char> moves_;
  std::optional<BoxTree> tree_;
  std::vector<std::unique_ptr<const Patch>> patches_;
};

}  // namespace knead
