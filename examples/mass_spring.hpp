#pragma once

#include <Eigen/Core>
#include <vector>

#include "knead/energy/stiffness.hpp"

// The discrete models that came before: masses joined by springs, and finite differences.
namespace knead::examples {

/// The matrix A of the closed active contour −α v″ + β v⁗ = f (thesis Eqs. 3.46, 3.47, 3.49) by
/// central differences at n >= 5 points h apart, row by row of the equation.
[[nodiscard]] Eigen::MatrixXd differenced_contour(int n, double alpha, double beta, double h);

/// The stiffness matrix of n >= 5 masses in a ring, spring by spring: springs of constant `stretch`
/// between neighbours, energy ½ k |x_{i+1} − x_i|², and of constant `bend` over every three, energy
/// ½ k |x_{i−1} − 2 x_i + x_{i+1}|².
[[nodiscard]] Eigen::MatrixXd spring_ring(int n, double stretch, double bend);

/// The same of n masses in a row with free ends, stretch only.
[[nodiscard]] Eigen::MatrixXd spring_chain(int n, double stretch);

/// A square sheet of n × n masses on [0, 1]² whose border is fixed, heights only. Springs of
/// constant `stretch` between neighbours along the lines, and springs of constant `bend` on the
/// Laplacian of every inner mass, neighbours beyond the border being mirrored with the opposite
/// sign (a hinged border). With stretch = α and bend = β/h² this is h² times the central
/// differences of α Δ and β ΔΔ, the load of every mass h² f. Unknowns are the (n − 2)² inner
/// masses, row by row.
[[nodiscard]] SparseMatrix spring_sheet(int n, double stretch, double bend);

/// What relaxation did.
struct Relaxation {
  Eigen::VectorXd x;
  int steps = 0;
};

/// Lets masses of 1 under spring forces K and loads f swing into balance: explicit (semi-implicit
/// Euler) steps, as long as stability allows, damped critically for the slowest swing `slowest`
/// (its ω²); until |f − K x| <= tolerance |f|.
[[nodiscard]] Relaxation relax(const SparseMatrix& k, const Eigen::VectorXd& f, double slowest,
                               double tolerance);

/// Interpolation of n × n heights at the parameters `at` in both directions: control points of the
/// surface that passes through all of them, n × n. The collocation matrix is dense and factored
/// once.
class GlobalInterpolation {
 public:
  GlobalInterpolation(const KnotVector& knots, const std::vector<double>& at);
  [[nodiscard]] Eigen::MatrixXd control_points(const Eigen::MatrixXd& heights) const;
  /// The heights at the parameters, from control points.
  [[nodiscard]] Eigen::MatrixXd heights(const Eigen::MatrixXd& control_points) const;

 private:
  Eigen::MatrixXd collocation_, inverse_;
};

/// Values of the basis at parameters, one row each, dense.
[[nodiscard]] Eigen::MatrixXd basis_matrix(const KnotVector& knots, const std::vector<double>& at);

/// The cubic knots that *The NURBS Book* (Eq. 9.8) chooses for interpolation at parameters from 0
/// to 1: interior knots are means of three neighbouring parameters, so that the collocation matrix
/// is well conditioned.
[[nodiscard]] Expected<KnotVector> averaged_knots(const std::vector<double>& at);

/// n equidistant numbers from 0 to 1.
[[nodiscard]] std::vector<double> equidistant(int n);

}  // namespace knead::examples
