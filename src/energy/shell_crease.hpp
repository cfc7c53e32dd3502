#pragma once

#include <array>
#include <memory>

#include "knead/energy/stiffness.hpp"

namespace knead {

/// One side of a seam of two shells.
struct CreaseSide {
  const Surface* rest = nullptr;
  int first = 0;        ///< row of its first control point among all
  int across = 0;       ///< the parameter that is constant along the edge: 0 for u, 1 for v
  bool at_end = false;  ///< whether that is at the end of its domain
};

/// What keeps the angle between two shells along a seam, however far both turn:
///
///   C(x) = ½ k ∫ (c − c₀)² + (s − s₀)² ds = k ∫ 1 − cos(θ − θ₀) ds,    c = n_a·n_b = cos θ, s =
///   (n_a × n_b)·t = sin θ,
///
/// n_a and n_b the unit normals of both sides, t the unit tangent of the seam, 0 the rest shape and
/// ds its length: a penalty in place of the bending strips of Kiendl, Bazilevs, Hsu, Wüchner and
/// Bletzinger (*The bending strip method for isogeometric analysis of Kirchhoff–Love shell
/// structures comprised of multiple patches*, 2010). A moment m per length opens the angle by m/k.
/// Both sides are taken at the same share of their parameters, as at `SeamKind::whole`. Integrated
/// by p + 1 Gauss points per span of either side. Immutable, const is thread-safe.
class ShellCrease {
 public:
  /// \param reversed whether the parameters run against each other. \param stiffness k, force times
  /// length per length. Errors: a stiffness that is not positive (input), a side without a normal,
  /// a rational denominator that is not positive (numerical).
  [[nodiscard]] static Expected<ShellCrease> create(const CreaseSide& a, const CreaseSide& b,
                                                    bool reversed, double stiffness);

  /// C(x), x the control points of all shells.
  [[nodiscard]] double energy(const Points& x) const;
  /// Adds ∂C/∂x.
  void add_gradient(const Points& x, Points& gradient) const;
  /// Appends Gauss and Newton's part of ∂²C/∂x², k ∫ δc δc + δs δs ds, which is all of it where the
  /// angle is kept; unknown 3 i + c coordinate c of control point i. The same entries at every x.
  void append_hessian(const Points& x, std::vector<Eigen::Triplet<double>>& entries) const;
  /// The largest |θ − θ₀| at the points of integration, radians.
  [[nodiscard]] double opening(const Points& x) const;

 private:
  struct Data;
  explicit ShellCrease(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

}  // namespace knead
