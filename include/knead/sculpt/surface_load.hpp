#pragma once

#include <span>
#include <vector>

#include "knead/sculpt/domain_scaling.hpp"
#include "knead/sculpt/tool.hpp"
#include "knead/spline/basis.hpp"

namespace knead {

/// The forces of shaped tools on a surface, integrated over it: F_i = ∫ R_i f(S) dû dv̂ (thesis Eqs. 4.23, 4.25), by
/// Gauss points of the parameter domain, R_i the (rational) basis. Everything is in the units of a `DomainScaling`.
///
/// The Gauss grid belongs to the surface's knots and weights and to the size of the tools, and is kept from step to
/// step: at least p + 1 points per span, and as many more as make points lie closer than a sixth of the smallest tool.
/// Only patches whose control points come near a tool are evaluated (the surface lies in their convex hull; with a
/// weight that is not positive it need not, and all are), so that the cost follows the contact, not the grid.
class SurfaceLoad {
 public:
  /// \param surface the rest surface, in file units; its spans are measured to choose the number of points.
  /// \param detail  the length to resolve, in file units (smallest radius or range of the tools); infinite: p + 1
  ///                points per span.
  /// Error (input): the tool is so small that more than 100,000 points would be needed in a direction.
  [[nodiscard]] static Expected<SurfaceLoad> create(const Surface& surface, const DomainScaling& scaling,
                                                    double detail);

  /// Potential and force of the tools (given in normalised units) on control points x (normalised), and the
  /// linearisation there. Only points in contact are kept.
  class State {
   public:
    [[nodiscard]] double potential() const { return potential_; }
    /// F, N × 3.
    [[nodiscard]] const Points& force() const { return force_; }
    [[nodiscard]] std::size_t contacts() const { return contacts_.size(); }

   private:
    friend class SurfaceLoad;
    struct Contact {
      int ku, kv;
      double factor;  // Gauss weight / rational denominator²; the basis carries w N
      double normal, tangential;
      Point direction;
    };
    double potential_ = 0;
    Points force_;
    std::vector<Contact> contacts_;
  };

  [[nodiscard]] State evaluate(const Points& x, std::span<const Tool> tools) const;

  /// H V: the Hessian of the potential at `state`, applied to N × 3 directions. It may be indefinite.
  [[nodiscard]] Points apply_hessian(const State& state, const Points& v) const;

  [[nodiscard]] int points() const { return quadrature_[0].basis.size() * quadrature_[1].basis.size(); }

 private:
  struct Patch;

  SurfaceLoad() = default;

  [[nodiscard]] Point gather(int ku, int kv, const Points& v) const;
  void scatter(int ku, int kv, const Point& f, Points& out) const;
  void evaluate_patch(const Patch& patch, const Points& x, std::span<const Tool> tools, State& state) const;

  std::array<int, 2> net_{};
  std::array<BasisQuadrature, 2> quadrature_;
  std::array<std::vector<int>, 2> spans_;  // first Gauss point of every span, and the end
  std::vector<double> weights_;            // of the control points; empty for a polynomial surface
  bool in_hull_ = true;                    // no weight is negative or zero
};

}  // namespace knead
