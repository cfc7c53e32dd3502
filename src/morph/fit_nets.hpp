#pragma once

#include <span>
#include <vector>

#include "hold/constraint_rows.hpp"
#include "surface_fit.hpp"

namespace knead::morph {

using detail::Terms;

/// The nets of a fit, and which unknown moves each control point.
struct FitNets {
  std::vector<Surface> surfaces;
  std::vector<bool> fixed;   ///< one for each surface
  std::vector<int> first;    ///< number of the first control point of each surface, and the end
  std::vector<int> unknown;  ///< of each control point; −1: it is fixed
  int unknowns = 0;
  ConstraintList kept{0};  ///< what surfaces keep, on the unknowns

  /// Whether a side of a joint stays: −1, or a fixed surface.
  [[nodiscard]] bool stays(int surface) const {
    return surface < 0 || fixed[static_cast<std::size_t>(surface)];
  }

  /// Makes `first`, `unknown` and `unknowns` for the surfaces as they are. Control points of a pole
  /// have one unknown, and so have both ends of a closed surface whose weights there agree; those
  /// of a surface that is a curve have one across it, and those of a side that stands
  /// still at an end or over spans have one: poles stay points, closed surfaces closed, curves
  /// curves, and what stands still does, exactly.
  void number(std::span<const FitSurface> given);
  /// Makes `kept` for the unknowns as they are numbered: what surfaces keep, and the tangent planes
  /// of their poles (`keep_poles`). Errors: those of `SurfaceHolds::conditions`.
  [[nodiscard]] Expected<void> hold(std::span<const FitSurface> given);

  /// R at a point of a surface, or its derivative in a direction of its parameters (`along` 0 or
  /// 1), times `factor`, as terms of unknowns; those of fixed control points are left out. At a
  /// knot the limit from `side`. Errors: a denominator that is not positive.
  [[nodiscard]] Expected<void> add_row(int surface, const std::array<double, 2>& at, Side side,
                                       int along, double factor, Terms& to) const;

  /// The displacements of the control points of a surface; zero where they are fixed.
  [[nodiscard]] Points of_surface(int surface, const Points& unknowns) const;
};

/// Σ c X_k.
[[nodiscard]] Point value_of(const Terms& row, const Points& x);

}  // namespace knead::morph
