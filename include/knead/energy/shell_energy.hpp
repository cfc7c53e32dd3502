#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "knead/energy/spline_field.hpp"
#include "knead/energy/stiffness.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {

/// A thin, isotropic sheet, in any consistent units (N and mm give MPa; density per volume).
struct ShellMaterial {
  double young = 1;      ///< E > 0, force per area
  double poisson = 0;    ///< ν, −1 < ν <= 1/2
  double thickness = 1;  ///< t > 0
  double density = 0;    ///< mass per volume, >= 0
  /// Where these vary: over the domain of the rest shape, every coefficient > 0. `young` and
  /// `thickness` are then what stands for them in scales, as `mean_of` the field.
  std::optional<SplineField<2>> young_field = {}, thickness_field = {};

  /// The material at one point, without fields. Error: a parameter outside the domain of a field.
  [[nodiscard]] Expected<ShellMaterial> at(const std::array<double, 2>& u) const;

  friend bool operator==(const ShellMaterial&, const ShellMaterial&) = default;
};

/// The mean over the parameter domain.
[[nodiscard]] double mean_of(const SplineField<2>& field);

/// The error names the number.
[[nodiscard]] Expected<ShellMaterial> validated(const ShellMaterial& material);

/// The weights of `ShellEnergy` in the fundamental forms themselves, in the order 11, 12, 22.
struct FundamentalMaterial {
  std::array<double, 3> w1 = {
      1, 1, 1};  ///< of the first form: energy per length⁴ and measure of the domain, >= 0
  std::array<double, 3> w2 = {1, 1, 1};  ///< of the second: energy per length² and measure, >= 0

  friend bool operator==(const FundamentalMaterial&, const FundamentalMaterial&) = default;
};

/// The error names the weight.
[[nodiscard]] Expected<FundamentalMaterial> validated_weights(const FundamentalMaterial& material);

/// The parts of the energy, in units of force times length.
struct ShellParts {
  double membrane = 0, bending = 0;
  [[nodiscard]] double sum() const { return membrane + bending; }
};

/// Stress resultants at all Gauss points, one column each: n^11, n^22, n^12 (membrane forces),
/// m^11, m^22, m^12 (bending moments), contravariant components in the rest shape's
/// parametrisation. Columns: element after element, the last direction fastest, and so the points
/// of an element.
using ShellStress = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// The Koiter (Kirchhoff–Love) shell: the elastic energy of a sheet that is bent and stretched by
/// any amount of turning and small strains (Koiter 1966; as an isogeometric element Kiendl,
/// Bletzinger, Linhard and Wüchner 2009).
///
///   W(S) = ½ ∫ t ε:C:ε + t³/12 κ:C:κ dA,    ε = ½(a − A),  κ = B − b,
///   C^αβγδ = E/(1 − ν²) (ν A^αβ A^γδ + ½(1 − ν)(A^αγ A^βδ + A^αδ A^βγ)),
///
/// a_αβ = S_α·S_β and b_αβ = S_αβ·n the fundamental forms of S, capitals those of the rest shape,
/// dA its area. W does not change under rigid motions. The unknowns are the control points x (N ×
/// 3, all rows those of the rest shape's net); in Hessians unknown 3 i + c is coordinate c of
/// control point i. Lengths are those of the rest shape.
///
/// The same integral without a material, over the parameter domain as it is, weighs the fundamental
/// forms alone (thesis Eq. 3.42; Terzopoulos, Platt, Barr and Fleischer 1987):
///
///   W(S) = ∫ Σ_αβ w1_αβ (a_αβ − A_αβ)² + w2_αβ (b_αβ − B_αβ)² du dv.
///
/// Integrated by Gauss points on every span, the same for all parts: W, gradient and Hessian are
/// consistent to rounding. p + 1 points per direction leave no zero-energy modes but the six rigid
/// ones. Where coefficients vary, on every piece of the common knots, by so many points more that
/// the energy of a small displacement of a flat sheet with straight isocurves is exact. Immutable,
/// const is thread-safe.
class ShellEnergy {
 public:
  /// \param gauss_points per span and direction; 0: degree + 1, and more where coefficients vary.
  /// Errors: a bad material, one on another domain (input); degree 1, which has no curvature
  /// (input); a rest shape without a normal at a Gauss point, a rational denominator that is not
  /// positive (numerical).
  [[nodiscard]] static Expected<ShellEnergy> create(const Surface& rest,
                                                    const ShellMaterial& material,
                                                    int gauss_points = 0);
  /// The second integral. Errors: likewise.
  [[nodiscard]] static Expected<ShellEnergy> of_forms(const Surface& rest,
                                                      const FundamentalMaterial& material,
                                                      int gauss_points = 0);

  /// W(x). Where S has no normal at a Gauss point this and all that follows is not finite. Cost:
  /// O(points p²).
  [[nodiscard]] ShellParts energy(const Points& x) const;
  /// The same, and adds ∂W/∂x to `gradient`, N × 3.
  [[nodiscard]] ShellParts energy(const Points& x, Eigen::Ref<Points> gradient) const;
  /// ∂W/∂x, the internal forces: N × 3. Cost: O(points p²).
  [[nodiscard]] Points gradient(const Points& x) const;
  /// The stress resultants t C:ε and t³/12 C:κ; of the fundamental forms 8 w1 ε and 2 w2 κ (half of
  /// both for 12).
  [[nodiscard]] ShellStress stress(const Points& x) const;
  /// Those of the strains linearised about x: C:(ε(x) + ε'(x) d). Newton's method with them in the
  /// Hessian needs fewer iterations (Magisano, Leonetti and Garcea 2017).
  [[nodiscard]] ShellStress stress(const Points& x, const Points& d) const;
  /// Their tension alone: membrane forces without negative principal values, no moments. With them
  /// the Hessian is positive semidefinite, yet as stiff against displacements out of a stretched
  /// surface as the true one.
  [[nodiscard]] ShellStress tension(const ShellStress& stress) const;
  /// ∂²W/∂x²: 3N × 3N, symmetric to the last bit, every entry of the tensor band stored. It may be
  /// indefinite. Cost: about 45 (p + 1)³ multiply-adds per Gauss point at p = q, by sum
  /// factorisation.
  [[nodiscard]] SparseMatrix hessian(const Points& x) const { return hessian(x, stress(x)); }
  /// The same with other stresses in its geometric part.
  [[nodiscard]] SparseMatrix hessian(const Points& x, const ShellStress& stress) const;

  /// ∫ R_i dA · `per_area`: the forces on the control points of a load per area of the rest shape,
  /// N × 3.
  [[nodiscard]] Points area_load(const Point& per_area) const;
  /// ∫ R_i μ dA · `acceleration`, μ as in `mass`: N × 3.
  [[nodiscard]] Points weight(const Point& acceleration) const;
  /// ∫ R_i (pressure n + (n·(wind − v)) n) dA over the present shape x, n the unit normal S_u ×
  /// S_v, v the velocity with control points `velocity`: N × 3.
  [[nodiscard]] Points normal_load(const Points& x, const Points& velocity, double pressure,
                                   const Point& wind) const;
  /// ∫ R_i R_j μ dA with μ = density · thickness (0 of the fundamental forms): N × N, the same for
  /// each coordinate, with the pattern of a stiffness. The inertia of rotations, of the order of
  /// t², is neglected.
  [[nodiscard]] SparseMatrix mass() const;
  [[nodiscard]] double area() const;
  /// 0.5 E t / (1 − ν²) · area, or ∫ Σ w1 A² du dv: the energy of a stretch of one, the scale that
  /// rounding is judged by.
  [[nodiscard]] double stretching_scale() const;

  /// E t³/(12 (1 − ν²)); of the fundamental forms 2 ∫ Σ w2 A² du dv over the area, the same for a
  /// curvature of one.
  [[nodiscard]] double bending_stiffness() const;
  /// t, or that of the shell with the same ratio of bending to stretching.
  [[nodiscard]] double effective_thickness() const;

  [[nodiscard]] int size() const;
  /// Density · thickness, a mean where that varies; 0 of the fundamental forms.
  [[nodiscard]] double mass_per_area() const;

 private:
  struct Data;
  [[nodiscard]] static Expected<ShellEnergy> with_law(const Surface& rest,
                                                      std::shared_ptr<Data> data, int gauss_points);
  explicit ShellEnergy(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

/// Stress and strain of a shell at one point, in orthonormal components of the rest shape's tangent
/// plane.
struct ShellPointResults {
  std::array<double, 2> membrane = {0,
                                    0};  ///< principal membrane forces n₁ >= n₂, force per length
  std::array<double, 2> moment = {
      0, 0};  ///< principal bending moments m₁ >= m₂, force times length per length
  std::array<double, 2> von_mises = {
      0, 0};                  ///< on the face that the normal S_u × S_v leaves, and on the other
  double bending_strain = 0;  ///< t/2 · max |κ|: the largest strain that bending adds at a face
};

/// The results of the sheet `current` that was `rest`, at parameters (rows u, v). With ε = ½(a −
/// A), κ = B − b and C as in `ShellEnergy`: n = t C:ε, m = t³/12 C:κ; the stress on the faces is
/// n/t ± 6 m/t², its von Mises stress √(σ₁² − σ₁ σ₂ + σ₂²). Not a number where one of the shapes
/// has no normal. Errors: parameters outside the domain (input), a rational denominator that is not
/// positive (numerical).
[[nodiscard]] Expected<std::vector<ShellPointResults>> shell_results(const Surface& rest,
                                                                     const Surface& current,
                                                                     const ShellMaterial& material,
                                                                     const Parameters<2>& at);

}  // namespace knead
