#pragma once

#include <array>
#include <limits>
#include <memory>
#include <vector>

#include "interval3.hpp"
#include "knead/spline/spline.hpp"

namespace knead::detail {

/// S, S_u, S_v, S_uu, S_uv, S_vv at one parameter point.
using PatchJet = std::array<Point, 6>;
/// Boxes that contain the same six over a rectangle of parameters, and S_u and S_v divided by
/// positive functions of the parameters (the same for all coordinates), so that they do not vanish
/// at poles and cusps.
using PatchBounds = std::array<Range3, 8>;

struct ParameterRectangle {
  std::array<Range, 2> side;
  [[nodiscard]] std::array<double, 2> centre() const {
    return {0.5 * (side[0].lower + side[0].upper), 0.5 * (side[1].lower + side[1].upper)};
  }
  [[nodiscard]] bool holds(const std::array<double, 2>& at) const {
    return at[0] >= side[0].lower && at[0] <= side[0].upper && at[1] >= side[1].lower &&
           at[1] <= side[1].upper;
  }
};

/// A piece of surface, twice continuously differentiable over the rectangle `domain` (a side may
/// have length 0: a curve). First derivatives may vanish at its border (poles).
class Patch {
 public:
  explicit Patch(ParameterRectangle rectangle, double outward = 1)
      : domain(rectangle), orientation(outward) {}
  Patch(const Patch&) = delete;
  Patch& operator=(const Patch&) = delete;
  virtual ~Patch() = default;
  [[nodiscard]] virtual PatchBounds bounds(const ParameterRectangle& at) const = 0;
  [[nodiscard]] virtual PatchJet jet(double u, double v) const = 0;
  /// Called where ∂S along `side` vanishes: true if a whole side of the rectangle is one point (a
  /// pole), false if the curve itself stops (a cusp, or infinite curvature).
  [[nodiscard]] virtual bool pole(std::size_t side, const std::array<double, 2>& at) const = 0;

  ParameterRectangle domain;
  double orientation;  ///< 1 if S_u × S_v points outwards, −1 if inwards
};

/// A point of a patch where the distance to x is stationary, or smallest on the patch's border.
struct Foot {
  double squared = std::numeric_limits<double>::infinity();
  int patch = -1;
  std::array<double, 2> at{};
  PatchJet jet{};
  std::array<bool, 2>
      pressed{};        ///< the distance would decrease beyond the border in this direction
  double pressure = 0;  ///< the sine of the deviation from a right angle, to either tangent
};

/// The foot found from `start` by Newton's iteration on |x − S|² over the rectangle `within` of a
/// patch. Its `patch` is 0, or −1 if the distance decreases beyond a side of the rectangle that is
/// not the patch's border.
[[nodiscard]] Foot descended(const Point& x, const Patch& patch, const ParameterRectangle& within,
                             const std::array<double, 2>& start, double size);

struct FootResult {
  Foot best;
  /// Feet of other patches at the same place as `best`: those that meet there. Only if `best` is
  /// pressed.
  std::vector<Foot> neighbours;
  bool certified = true;
  int cells = 0;  ///< number of cells examined
};

/// The point of a set of patches that is nearest to x, by branch and bound.
///
/// A cell (a rectangle of a patch) is discarded where its box is further away than the best point
/// so far, or where the gradient of |x − S|² cannot vanish in it by interval arithmetic (then its
/// minimum lies on its border: if that is the border of the patch, the search continues there, in
/// one variable less). Where the Hessian is positive definite throughout the cell, Newton's
/// iteration finds its only minimum; all other cells are halved. Cells below 1e-6 of the size are
/// not examined further: `certified` says whether they could hide a point nearer by 1e-11 of the
/// size.
class FootSearch {
 public:
  /// \param size the length to which tolerances are relative
  FootSearch(std::vector<std::unique_ptr<Patch>> patches, double size);

  [[nodiscard]] FootResult nearest(const Point& x) const;
  [[nodiscard]] const Patch& patch(int k) const { return *patches_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] const Range3& box() const { return nodes_[static_cast<std::size_t>(root_)].box; }
  [[nodiscard]] double size() const { return size_; }

 private:
  struct Node {
    Range3 box;
    std::array<int, 2> child = {-1, -1};
    int leaf = -1;
  };
  struct Leaf {
    int patch;
    ParameterRectangle at;
    PatchBounds bounds;
  };
  struct Query;

  int build_patch(int patch, const ParameterRectangle& at, int depth);
  int join(std::vector<int> nodes);
  void examine(Query& q, int patch, ParameterRectangle at, PatchBounds bounds, int depth) const;
  void halve(Query& q, int patch, const ParameterRectangle& at, const PatchBounds& bounds,
             int depth) const;
  Foot descend(const Query& q, int patch, const ParameterRectangle& within,
               const std::array<double, 2>& start) const;
  void record(Query& q, const Foot& foot) const;

  std::vector<std::unique_ptr<Patch>> patches_;
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
  double size_;
  int root_ = 0;
};

}  // namespace knead::detail
