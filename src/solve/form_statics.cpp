#include "knead/solve/form_statics.hpp"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "coordinate_map.hpp"

namespace knead {
namespace {

constexpr double smallest_damping = 1e-12, damping_growth = 100;  // of the mean of the diagonal
constexpr int most_dampings = 8, most_backtracks = 40;
constexpr double enough_descent = 1e-4;       // of what the slope promises (Armijo)
constexpr double rounding_of_energy = 1e-13;  // of the energies that are compared
constexpr double ran_away = 1e6;              // sizes of the shape
constexpr double nothing_moved = 1e-14;       // of its size

Eigen::Map<const Eigen::VectorXd> as_vector(const Points& x) { return {x.data(), x.size()}; }

Points as_points(const Eigen::VectorXd& x) { return Eigen::Map<const Points>(x.data(), x.size() / 3, 3); }

template <int D>
class FormDescent {
 public:
  FormDescent(const FormEnergy<D>& energy, const SparseMatrix& map, const Points& load, const Points& x)
      : energy_(energy), map_(map), load_(load), x_(x) {}

  [[nodiscard]] Eigen::VectorXd imbalance() const { return map_.transpose() * as_vector(load_ - energy_.gradient(x_)); }

  /// The direction of Newton's method, or of one whose matrix is positive definite. Empty: there is none.
  [[nodiscard]] Eigen::VectorXd direction(const Eigen::VectorXd& force) {
    const SparseMatrix exact = map_.transpose() * energy_.hessian(x_) * map_;
    if (positive(exact)) return solver_.solve(force);
    SparseMatrix material = map_.transpose() * energy_.material_hessian(x_) * map_;
    const double mean = material.diagonal().sum() / static_cast<double>(material.rows());
    SparseMatrix unit(material.rows(), material.cols());
    unit.setIdentity();
    double damping = smallest_damping * mean;
    for (int k = 0; k < most_dampings; ++k, damping *= damping_growth) {
      if (positive(material + damping * unit)) return solver_.solve(force);
    }
    return {};
  }

  /// Goes along d as far as the energy falls; false: it does not.
  [[nodiscard]] bool go(const Eigen::VectorXd& d, const Eigen::VectorXd& force) {
    const Points along = as_points(map_ * d);
    const double before = value(x_), slope = -force.dot(d);
    double length = 1;
    for (int k = 0; k < most_backtracks; ++k, length /= 2) {
      const Points next = x_ + length * along;
      const double now = value(next);
      if (!std::isfinite(now)) continue;
      const double rounding = rounding_of_energy * (std::abs(before) + std::abs(now));
      if (now > before + enough_descent * length * slope + rounding) continue;
      step_ = length * along.cwiseAbs().maxCoeff();
      x_ = next;
      return true;
    }
    return false;
  }

  [[nodiscard]] const Points& place() const { return x_; }
  [[nodiscard]] double last_step() const { return step_; }

 private:
  [[nodiscard]] double value(const Points& x) const { return energy_.energy(x).sum() - load_.cwiseProduct(x).sum(); }

  [[nodiscard]] bool positive(const SparseMatrix& matrix) {
    solver_.compute(matrix);
    if (solver_.info() != Eigen::Success) return false;
    const Eigen::VectorXd pivots = solver_.vectorD();
    return pivots.minCoeff() > 1e-14 * pivots.maxCoeff();
  }

  const FormEnergy<D>& energy_;
  const SparseMatrix& map_;
  const Points& load_;
  Points x_;
  double step_ = 0;
  Eigen::SimplicialLDLT<SparseMatrix> solver_;
};

/// Whether the load moves the shape as a whole along an axis in which nothing holds it.
bool drifts(const SparseMatrix& map, const Points& load) {
  constexpr double rounding = 1e-12;
  if (map.cols() == 0) return false;
  const Eigen::SimplicialLDLT<SparseMatrix> normal(SparseMatrix(map.transpose() * map));
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (std::abs(load.col(axis).sum()) <= rounding * load.cwiseAbs().sum()) continue;
    Points all = Points::Zero(load.rows(), 3);
    all.col(axis).setOnes();
    const Eigen::VectorXd free = map * normal.solve(Eigen::VectorXd(map.transpose() * as_vector(all)));
    if ((free - as_vector(all)).cwiseAbs().maxCoeff() <= rounding) return true;
  }
  return false;
}

std::unexpected<Error> drifts_away() {
  return numerical_error("nothing holds the shape against the forces", "constraints",
                         "hold a side or pin points, so that the forces cannot move all of it");
}

}  // namespace

template <int D>
Expected<FormEquilibrium> form_equilibrium(const FormEnergy<D>& energy, const Points& rest, const Points& start,
                                           std::span<const LinearConstraint> constraints, const Points& load,
                                           const FormStaticsOptions& options) {
  if (rest.rows() != energy.size() || start.rows() != energy.size() || load.rows() != energy.size()) {
    return input_error(
        fmt::format("{} control points and {} forces for an energy of {}", start.rows(), load.rows(), energy.size()),
        "load", "give one row per control point");
  }
  if (!load.allFinite()) return input_error("a force is not finite", "load", "use finite numbers");
  const auto space = ConstraintSpace::create(energy.size(), constraints);
  if (!space) return std::unexpected(space.error());
  const SparseMatrix map = coordinate_map(*space);
  if (drifts(map, load)) return drifts_away();
  const double extent = (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm();
  FormDescent<D> descent(energy, map, load, rest + space->feasible(start - rest));
  FormEquilibrium result;
  double scale = (map.transpose() * as_vector(load)).norm();
  while (map.cols() > 0) {
    const Eigen::VectorXd force = descent.imbalance();
    scale = std::max(scale, result.iterations == 0 ? force.norm() : 0.0);
    result.residual = scale > 0 ? force.norm() / scale : 0;
    result.converged = result.residual <= options.tolerance;
    if (result.converged || !std::isfinite(result.residual) || result.iterations == options.max_iterations) break;
    const Eigen::VectorXd d = descent.direction(force);
    if (d.size() == 0 || !d.allFinite() || !descent.go(d, force)) break;
    ++result.iterations;
    if ((descent.place() - rest).cwiseAbs().maxCoeff() > ran_away * extent) {
      return drifts_away();
    }
    if (descent.last_step() <= nothing_moved * extent) {
      result.converged = true;
      break;
    }
  }
  result.control_points = descent.place();
  if (!result.converged) {
    result.note =
        fmt::format("the step ended {:.1e} from balance; use smaller forces, or several steps", result.residual);
  }
  return result;
}

template Expected<FormEquilibrium> form_equilibrium<1>(const FormEnergy<1>&, const Points&, const Points&,
                                                       std::span<const LinearConstraint>, const Points&,
                                                       const FormStaticsOptions&);
template Expected<FormEquilibrium> form_equilibrium<3>(const FormEnergy<3>&, const Points&, const Points&,
                                                       std::span<const LinearConstraint>, const Points&,
                                                       const FormStaticsOptions&);

}  // namespace knead
