#pragma once

#include <optional>
#include <string>

#include "knead/tool/shape.hpp"

namespace knead {

/// How a tool acts on the surface (thesis § 4.3, § 6.4.2).
enum class ToolMode {
  proximity,  ///< the surface is drawn to the tool's surface from either side, within `range`
  collision,  ///< points inside the tool are pushed out; no others are affected
  imprint,    ///< collision whose result becomes the new rest shape
};

/// The direction in which a proximity tool acts.
enum class ToolDirection { pull, push };

/// Which part of a surface that is cut by the edges of faces a tool touches.
enum class ToolTouch {
  all,      ///< all of it, what no face shows too
  visible,  ///< what its faces show
};

/// A shaped tool: Hookean springs between the surface and the tool (thesis Eq. 4.25).
struct Tool {
  std::string name = "tool";
  PlacedShape shape;
  ToolMode mode = ToolMode::collision;
  double stiffness = 1e4;  ///< k: force per length and parameter area
  double range = 0.5;      ///< proximity: no force at this distance and beyond; unused by collision
  bool rigid = false;   ///< collision: raise k until nothing penetrates by more than `rigid_gap` of
                        ///< the tool's size
  double friction = 0;  ///< collision: Coulomb's coefficient
  /// Share of the displacement that remains when the tool is removed, 0 to 1.
  double plasticity = 0;
  ToolDirection direction = ToolDirection::pull;
  ToolTouch touches = ToolTouch::all;

  [[nodiscard]] bool collides() const { return mode != ToolMode::proximity; }
  /// The length over which its force changes, which points of integration must resolve: the
  /// smallest feature of what a shape collides with, in units of the file (infinite: a plane); but
  /// the range of a proximity tool, however thin that is: within it the force is at most stiffness
  /// times half the thickness.
  [[nodiscard]] double detail() const { return collides() ? shape.size() : range; }
};

/// Above this, the rounding of positions alone causes forces larger than those of the material: the
/// penetration is then less than 1e-9 of the surface's size anyway.
inline constexpr double max_tool_stiffness = 1e10;

/// How far anything may penetrate a rigid tool, in sizes of the tool.
inline constexpr double rigid_gap = 1e-4;

/// Checks stiffness from 0 to the maximum, range > 0 where it is used, friction >= 0, plasticity
/// from 0 to 1, all finite; the error names the field.
[[nodiscard]] Expected<Tool> validated(const Tool& tool);

/// The mirror image of a tool in the plane through `point` with this normal (of length 1); none
/// where the tool is its own image, to 1e-9 of its size. Errors: those of the shape.
[[nodiscard]] Expected<std::optional<Tool>> mirrored(const Tool& tool, const Point& point,
                                                     const Point& normal);

/// What a tool does to one point x: a potential ψ(x), the force −∇ψ of its springs, and the Hessian
/// ∂²ψ, which may be indefinite: a surface pressed against a ball is pushed sideways off its top.
///
/// With φ the signed distance of x to the tool (negative inside), n its gradient and H its Hessian:
/// collision  ψ = k/2 min(φ, 0)², force −k φ n inside;
/// proximity  ψ = −k r²/6 (1 − φ²/r²)³ within the range r, force −k φ (1 − φ²/r²)² n, which is k φ
/// near the tool and
///            falls to zero with two derivatives at the end of the range; to push, the signs are
///            flipped;
/// Hessian    ψ'' n nᵀ + ψ' H.
/// Where the nearest direction is not unique, as at the centre of a sphere, the force is zero.
struct ToolAction {
  bool active = false;
  double clear = 0;  ///< points nearer than this to x are not acted on either; 0: some may be
  double potential = 0;
  double entry = 0;  ///< collision: −φ
  Point force = Point::Zero();
  Point normal = Point::Zero();  ///< n
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

/// A tool in the coordinates of the model, (x − centre) / length with x in the file's.
class ModelTool {
 public:
  ModelTool(const Tool& tool, const Point& centre, double length);

  [[nodiscard]] const Tool& tool() const { return tool_; }
  [[nodiscard]] double stiffness() const { return tool_.stiffness; }
  void set_stiffness(double stiffness) { tool_.stiffness = stiffness; }
  /// The smallest feature of the shape, but at most 1.
  [[nodiscard]] double size() const { return size_; }
  /// `Tool::detail`.
  [[nodiscard]] double detail() const { return tool_.detail() / length_; }

  /// Collision keeps points this far from the tool (0 by default), in units of the model.
  void set_offset(double offset);
  [[nodiscard]] double offset() const { return offset_; }

  /// Signed distance to the tool itself.
  [[nodiscard]] double distance(const Point& x) const;
  [[nodiscard]] ToolAction action(const Point& x) const;
  /// A bit for every side of the tool's box that x lies beyond: no part of the tool lies between
  /// points that share a bit.
  [[nodiscard]] unsigned char sides(const double* x) const {
    unsigned result = 0;
    for (int c = 0; c < 3; ++c) {
      result |= (x[c] < lower_[c] ? 1U : 0U) << (2 * c);
      result |= (x[c] > upper_[c] ? 2U : 0U) << (2 * c);
    }
    return static_cast<unsigned char>(result);
  }
  /// The box outside which the tool acts on nothing, and a ball likewise, of infinite radius unless
  /// it is a sphere.
  [[nodiscard]] const Point& lower() const { return lower_; }
  [[nodiscard]] const Point& upper() const { return upper_; }
  [[nodiscard]] const Point& centre() const { return centre_; }
  [[nodiscard]] double radius() const { return radius_; }
  /// Whether the signed distance jumps where a collision tool is open (see `SplineShape`). Else it
  /// is 1-Lipschitz.
  [[nodiscard]] bool jumps() const {
    return tool_.collides() && std::holds_alternative<SplineShape>(tool_.shape.shape());
  }
  /// Whether the box meets the tool's own.
  [[nodiscard]] bool overlaps(const Point& lower, const Point& upper) const {
    return (upper.array() >= lower_.array()).all() && (lower.array() <= upper_.array()).all();
  }
  /// False only where the tool certainly acts on nothing in the box.
  [[nodiscard]] bool may_reach(const Point& lower, const Point& upper) const;

 private:
  Tool tool_;  // its shape moved by −centre, still in file units
  double length_, range_, size_, offset_ = 0;
  Point lower_, upper_;  // of what it acts on
  Point centre_;
  double radius_;
};

}  // namespace knead
