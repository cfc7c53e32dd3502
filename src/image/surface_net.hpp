#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "base/decompositions.hpp"
#include "knead/image/surface_snake.hpp"
#include "knead/spline/basis.hpp"

namespace knead {

/// What the parameters of a closed surface are of, and their functions: `counts` as in
/// `SnakeSettingsOf<2>::control_points`, `lengths` those of the domain in u and v.
struct SurfaceSpace {
  SurfaceForm form = SurfaceForm::sphere;
  int degree = 3;
  std::array<int, 2> counts = {0, 0};
  std::array<double, 2> lengths = {0, 0};

  [[nodiscard]] int unknowns() const { return counts[0] * counts[1]; }
  /// With all spans halved.
  [[nodiscard]] SurfaceSpace halved() const;
};

/// The space of a surface. Errors (input): knots that are not those of a `ClosedSurface`.
[[nodiscard]] Expected<SurfaceSpace> space_of(const ClosedSurface& snake);

/// The space of an active surface with its matrices. Its unknowns are the control points that
/// differ in u, (i, j) in row i counts[1] + j; at a pole those of a column are kept equal, and
/// those of the next on their polygon.
///
/// (γ M + K) c = f has counts[0] · counts[1] unknowns for each coordinate. Around u all its blocks
/// are circulant, so that a discrete Fourier transform of the rows parts it into one dense
/// symmetric system in v for each wave number 0 … n/2. Sparse factors would do as well for a torus;
/// conditions at poles, which tie whole columns, would make them dense.
class SurfaceNet {
 public:
  /// Errors: those of the knots (input).
  [[nodiscard]] static Expected<SurfaceNet> create(const SurfaceSpace& space, double alpha,
                                                   double beta);

  [[nodiscard]] const SurfaceSpace& space() const { return space_; }
  [[nodiscard]] const KnotVector& knots(std::size_t direction) const {
    return axes_[direction].knots;
  }
  /// The Gauss points of a direction; those of the surface are their grid, v fast.
  [[nodiscard]] const BasisQuadrature& quadrature(std::size_t direction) const {
    return axes_[direction].quadrature;
  }
  /// ∫ f du dv and ∫ f dΩ are sums with these over the Gauss points.
  [[nodiscard]] const Eigen::VectorXd& weights() const { return weights_; }
  [[nodiscard]] const Eigen::VectorXd& weights_on_domain() const { return weights_on_domain_; }

  /// The places at the Gauss points, or their derivatives ∂u, ∂v up to the first.
  [[nodiscard]] Points at_gauss(const Points& c, int du, int dv) const;
  /// Σ N f over the Gauss points, f with its weights: one row per unknown.
  [[nodiscard]] Points load(const Points& f) const;
  /// K c, the forces against stretch and bend.
  [[nodiscard]] Points internal(const Points& c) const;
  /// Makes `solve` that with γ M + K, or with M alone. Errors (numerical): not positive definite.
  Expected<void> factor(double gamma, bool mass_alone = false);
  [[nodiscard]] Points solve(const Points& right) const;
  /// The values of all functions at a point of the parameters, folded in u (and in v of a torus).
  [[nodiscard]] Eigen::VectorXd functions_at(double u, double v) const;

  /// Puts control points at poles where they belong: the pole at the mean of its column, the next
  /// column to the nearest affine image of a regular polygon around it.
  void keep_poles(Points& c) const;
  [[nodiscard]] Expected<ClosedSurface> surface(const Points& c) const;
  [[nodiscard]] Points unknowns_of(const Surface& surface) const;

 private:
  using Dense = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// A direction with the values and slopes of its functions at its Gauss points (rows).
  struct Axis {
    KnotVector knots;
    bool periodic;
    int count;
    BasisQuadrature quadrature;
    std::array<Dense, 2> functions;

    [[nodiscard]] static Expected<Axis> create(int degree, int count, double length, bool periodic);
  };
  /// What is left of the system for one wave number around u: a dense one in v, of the functions
  /// allowed there.
  struct Mode {
    Eigen::MatrixXd mass, internal;
  };

  SurfaceNet(SurfaceSpace space, std::array<Axis, 2> axes)
      : space_(space), axes_(std::move(axes)) {}
  Expected<void> make_modes(double alpha, double beta);
  void make_transform();
  /// The functions of v that a wave number may use, one per column.
  [[nodiscard]] Eigen::MatrixXd allowed(int wave) const;
  [[nodiscard]] const Eigen::MatrixXd& allowed_of(int wave) const {
    return allowed_[static_cast<std::size_t>(std::min(wave, 2))];
  }
  /// For each row of the transform of `right`: what `work(wave, values)` makes of its allowed part,
  /// transformed back.
  template <class Work>
  [[nodiscard]] Points by_modes(const Points& right, const Work& work) const;

  SurfaceSpace space_;
  std::array<Axis, 2> axes_;
  Eigen::VectorXd weights_, weights_on_domain_;
  Dense waves_;  ///< the orthonormal real Fourier basis of the unknowns around u, one per column
  std::vector<int> wave_;                 ///< of each column
  std::vector<Eigen::MatrixXd> allowed_;  ///< of the wave numbers 0, 1 and above
  std::vector<Mode> modes_;               ///< by wave number
  std::vector<detail::DenseCholesky> factors_;
};

/// The unknowns of places at the Gauss points of a net, by least squares on Ω.
[[nodiscard]] Expected<Points> projected(const SurfaceSpace& space, const Points& places);

/// The same surface in another space, by least squares on Ω: exact up to rounding where that
/// contains it.
[[nodiscard]] Expected<Points> projected(const SurfaceSpace& space, const ClosedSurface& snake);

}  // namespace knead
