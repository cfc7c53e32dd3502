#pragma once

#include <functional>
#include <memory>

#include "knead/base/error.hpp"
#include "knead/energy/domain_scaling.hpp"
#include "knead/energy/stiffness.hpp"

namespace knead {

/// A force per measure of the (scaled) parameter domain, as a function of the parameters.
template <int D>
using LoadFunction = std::function<Point(const std::array<double, D>&)>;

/// Nodal forces of a load: F_i = ∫ R_i f dû (thesis Eq. 4.23), dû = Π factor_d du_d, one row per
/// control point. In the units of `ActiveLoads::force`; the rows go into `ActiveLoads::nodal`. A
/// constant f gives the same as `ActiveLoads::force`.

/// The load is a spline on the same domain with its own degrees and knots; its control points are
/// the coefficients of f.
///
/// Polynomial shape and polynomial load: F = Π factors (M_0 ⊗ … ⊗ M_{D−1}) f with the
/// `mixed_gramian`s M_d of both bases; exact up to rounding. A rational shape and a polynomial
/// load: to 1e-10 of max |f| ∫ R_i, by Gauss points as an error bound asks for them (`Stiffness`).
/// A rational load: by max(p, q) + 8 Gauss points per piece of the common knots, about 1e-9 for the
/// weights of circles, less accurate for weights that differ by factors of ten within a span.
/// Errors: domains that differ (input); a denominator that is not positive, weights that differ too
/// much (numerical).
template <int D>
[[nodiscard]] Expected<Points> load_forces(const Spline<D>& shape, const DomainScaling<D>& scaling,
                                           const Spline<D>& load);

/// The load is any function, integrated by Gauss quadrature: `points_per_span` points per span and
/// direction, 0 meaning p + 4. Exact up to rounding for polynomial shapes and functions that are
/// polynomials of degree p + 7 or less on every span; for a load with jumps or kinks pass a spline,
/// or more points. Errors: a value that is not finite (input); a denominator that is not positive
/// (numerical).
template <int D>
[[nodiscard]] Expected<Points> load_forces(const Spline<D>& shape, const DomainScaling<D>& scaling,
                                           const LoadFunction<D>& load, int points_per_span = 0);

/// The forces of a load per area of the shape, F_i = ∫ R_i f |S_u × S_v| du dv: per area of the
/// file, whatever the scaling. `load` is a spline on the same domain; its control points are the
/// coefficients of f.
///
/// Exact up to rounding where the area element is a polynomial on every span, as on flat sheets
/// with straight isocurves. Elsewhere two Gauss rules must agree to 1e-10 of max |f| times the area
/// of each piece of the common knots, which is halved where they do not. Errors: domains that
/// differ (input); a denominator that is not positive, pieces on which the rules never agree
/// (numerical).
[[nodiscard]] Expected<Points> area_load_forces(const Surface& shape, const Surface& load);

/// The load through samples on a uniform grid over the domain of the shape, its ends included:
/// counts[d] >= 2 samples in direction d, one row each, last direction fastest; linear between them
/// in every direction. Errors (input): a wrong number of samples, fewer than 2 in a direction, a
/// number that is not finite.
template <int D>
[[nodiscard]] Expected<Spline<D>> sampled_load(const Spline<D>& shape,
                                               const std::array<int, D>& counts, Points samples);

/// A moment per length of an edge of a surface, about the edge and following it: its virtual work
/// is
///
///   δA = ∫ m δω·t ds = −∫ m Σ_α (a^α·c) (n·δa_α) ds,   c = t × n,
///
/// t the unit tangent of the edge in the direction of its parameter, n the unit normal and a^α the
/// dual tangents of the present shape, ds the length of the rest shape. A positive one turns by the
/// right-hand rule about t. Integrated by p + 4 Gauss points per span. Immutable, const is
/// thread-safe.
class EdgeMoment {
 public:
  /// The edge on which parameter `across` (0: u, 1: v) is at the start or the end of its domain.
  /// Errors: a moment that is not finite (input); a rational denominator that is not positive
  /// (numerical). \param first row of the surface's first control point among all `size` (0: those
  /// of the surface alone).
  [[nodiscard]] static Expected<EdgeMoment> create(const Surface& rest, int across, bool at_end,
                                                   double per_length, int first = 0, int size = 0);

  /// The forces F on the control points x, N × 3.
  [[nodiscard]] Points forces(const Points& x) const;
  /// The symmetric part of ∂F/∂x, 3N × 3N, unknown 3 i + c coordinate c of control point i. Of a
  /// straight edge ∂F/∂x is symmetric: its moment has the potential −∫ m θ ds.
  [[nodiscard]] SparseMatrix stiffness(const Points& x) const;

 private:
  struct Data;
  explicit EdgeMoment(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

}  // namespace knead
