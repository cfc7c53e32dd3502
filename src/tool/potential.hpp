#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead {

inline double dot(const Points& a, const Points& b) { return a.cwiseProduct(b).sum(); }

/// A material point on which a force acts, and the derivative of that force.
struct ContactPoint {
  int patch = 0;
  std::array<int, 3> at{};  ///< Gauss point in every direction of the patch
  double factor = 0;        ///< Gauss weight / rational denominator²; the basis carries w N
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  int part = -1;  ///< the visible part of that point's cell, where an edge cuts it; −1: the Gauss
                  ///< point itself
  int grid = 0;   ///< of the patch's `ToolGrids`
};

/// A potential Ψ, its force −∇Ψ and its linearisation at one position.
struct PotentialState {
  double potential = 0;
  Points force;  ///< N × 3
  std::vector<ContactPoint> contacts;
  double entry = 0;       ///< deepest penetration of a collision tool, in sizes of that tool
  int entered = -1;       ///< the index of that tool
  double coarseness = 0;  ///< longest span in contact with a tool, in sizes of that tool
  bool limited = false;   ///< some point is restrained by a limit
  long long visited = 0;  ///< Gauss points at which what acts was asked
};

/// Some control points, and the elements of every patch that depend on no others.
struct WatchedElements {
  std::vector<int> rows;                   ///< of all control points
  std::vector<std::vector<int>> elements;  ///< by patch, ascending
};

/// Takes a matrix between the coordinates of some points: row 3 k + c is coordinate c of points[k].
using AddBlock = std::function<void(std::span<const int> points, const Eigen::MatrixXd& block)>;

/// A potential of the positions of all control points: the solver's view of tools, friction and
/// limits.
class Potential {
 public:
  virtual ~Potential() = default;

  /// At the control points x (N × 3). With `watched`, contacts of those elements only: x is read at
  /// their control points, and the cost depends on their number.
  [[nodiscard]] virtual PotentialState evaluate(const Points& x,
                                                const WatchedElements* watched = nullptr) const = 0;
  /// Whether a tool, friction or a limit acts on an element that is not among these.
  [[nodiscard]] virtual bool acts_beyond(const WatchedElements& these, const Points& x) const = 0;
  /// Adds H v to `out`: the Hessian at `state` applied to N × 3 directions, both used only where
  /// contacts act. It may be indefinite.
  virtual void apply_hessian(const PotentialState& state, const Points& v, Points& out) const = 0;
  /// Calls `add` with symmetric blocks whose sum is that Hessian.
  virtual void each_hessian_block(const PotentialState& state, const AddBlock& add) const = 0;
  /// Sets marks[i] where a contact of `state` acts on control point i: elsewhere force and Hessian
  /// are zero.
  virtual void mark(const PotentialState& state, std::vector<char>& marks) const = 0;
  /// Marks the neighbours of marked control points in their nets too.
  virtual void widen(std::vector<char>& marks) const = 0;
  /// The elements whose control points are all marked.
  [[nodiscard]] virtual WatchedElements watch(const std::vector<char>& marks) const = 0;
  /// The same potential with no spring stiffer than `cap`.
  virtual void soften(double cap) = 0;
  /// The largest stiffness of a spring.
  [[nodiscard]] virtual double stiffest() const = 0;
  /// Whether there is a limit on displacements.
  [[nodiscard]] virtual bool limits() const = 0;

 protected:
  Potential() = default;
  Potential(const Potential&) = default;
  Potential& operator=(const Potential&) = default;
};

}  // namespace knead
