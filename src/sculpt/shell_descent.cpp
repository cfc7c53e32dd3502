#include "shell_descent.hpp"

#include <cmath>

#include "knead/solve/eigenmodes.hpp"

namespace knead {
namespace {

constexpr int max_iterations = 100;
constexpr int max_halvings = 30;
constexpr double sufficient_decrease = 1e-4;
constexpr double rounding_of_potential = 1e-13;
constexpr double negligible_step = 1e-13;  // in lengths of the model: rounding is all that is left
constexpr double halved_imbalance = 0.5;   // a full step that lowers the imbalance so far is taken, whatever Φ does
constexpr double exact_imbalance = 1e-9;   // less asks for no iteration
constexpr double singular_pivot = 1e-15;
constexpr double rounding_of_forces = 1e-14;  // in membrane stiffness times length

Eigen::Map<const Eigen::VectorXd> flattened(const Points& x) { return {x.data(), x.size()}; }

}  // namespace

ShellDescent::ShellDescent(const ShellStepProblem& problem, const Potential& potential)
    : problem_(problem), potential_(potential) {
  if (problem.inertia.rows() > 0) inertia_ = on_coordinates(problem.inertia);
}

Points ShellDescent::inertia_times(const Points& y) const {
  return problem_.inertia.rows() > 0 ? Points(problem_.inertia * y) : Points::Zero(y.rows(), 3);
}

ShellDescent::Place ShellDescent::at(Points y) const {
  Place place;
  place.contact = potential_.evaluate(problem_.start + y);
  const Points qy = inertia_times(y), elastic = problem_.structure.gradient(position(y));
  place.phi = problem_.structure.value(position(y)) / problem_.theta - dot(problem_.b, y) + 0.5 * dot(y, qy) +
              place.contact.potential;
  const Points forces = problem_.b - qy - elastic + place.contact.force;
  place.imbalance = problem_.map.transpose() * flattened(forces);
  place.scale = place.contact.force.norm() + problem_.b.norm() + qy.norm() + elastic.norm();
  place.y = std::move(y);
  return place;
}

/// Tᵀ (θ ∇²W + Q + ∇²Ψ) T.
SparseMatrix ShellDescent::reduced(const SparseMatrix& elastic, const PotentialState& contact) const {
  std::vector<Eigen::Triplet<double>> entries;
  potential_.append_hessian(contact, entries);
  SparseMatrix sum = problem_.theta * elastic;
  if (inertia_.rows() > 0) sum += inertia_;
  if (!entries.empty()) {
    SparseMatrix touched(sum.rows(), sum.cols());
    touched.setFromTriplets(entries.begin(), entries.end());
    sum += touched;
  }
  return problem_.map.transpose() * sum * problem_.map;
}

/// Whether it is positive definite.
bool ShellDescent::factor(const SparseMatrix& system) {
  if (analysed_ != system.nonZeros()) {
    solver_.analyzePattern(system);
    analysed_ = system.nonZeros();
  }
  solver_.factorize(system);
  if (solver_.info() != Eigen::Success) return false;
  const auto& pivots = solver_.vectorD();
  return pivots.size() == 0 || pivots.minCoeff() > singular_pivot * pivots.maxCoeff();
}

/// The Hessian, without its geometric part where that makes it indefinite, and with some more of a multiple of the
/// identity where a mechanism is left.
bool ShellDescent::factor_at(const Place& place, const ShellStructure::Stress& stress) {
  const ScaledStructure& structure = problem_.structure;
  const Points x = position(place.y);
  if (factor(reduced(structure.hessian(x, stress), place.contact))) return true;
  ShellStructure::Stress none = stress;
  for (ShellStress& s : none) s.setZero();
  SparseMatrix system = reduced(structure.hessian(x, none), place.contact);
  if (factor(system)) return true;
  double largest = 0;
  for (Eigen::Index i = 0; i < system.rows(); ++i) largest = std::max(largest, std::abs(system.coeff(i, i)));
  SparseMatrix identity(system.rows(), system.cols());
  identity.setIdentity();
  for (double share = 1e-10; share < 1; share *= 100) {
    if (factor(SparseMatrix(system + share * largest * identity))) return true;
  }
  return false;
}

/// Moves along d as far as lowers Φ enough, or all the way where that lowers the imbalance by much. False: not at all.
bool ShellDescent::advance(Place& place, const Points& d, double slope) const {
  const double rounding = rounding_of_potential * std::max(std::abs(place.phi), std::abs(slope));
  double t = 1;
  for (int k = 0; k < max_halvings; ++k) {
    Place next = at(place.y + t * d);
    const bool finite = std::isfinite(next.phi) && next.imbalance.allFinite();
    if (finite && (next.phi <= place.phi - sufficient_decrease * t * slope + rounding ||
                   (k == 0 && next.imbalance.norm() <= halved_imbalance * place.imbalance.norm()))) {
      place = std::move(next);
      return true;
    }
    // The minimum of the parabola through both values with the slope at the beginning, within reason.
    const double rise = next.phi - place.phi;
    const double best = finite && rise + t * slope > 0 ? 0.5 * t * t * slope / (rise + t * slope) : 0.1 * t;
    t = std::clamp(best, 0.1 * t, 0.5 * t);
  }
  return false;
}

PotentialState ShellDescent::run(Points& y, ContactSummary& summary) {
  Place place = at(y);
  ShellStructure::Stress stress = problem_.structure.stress(position(place.y));
  summary.converged = false;
  for (int iteration = 0;; ++iteration) {
    const double size = place.imbalance.size() > 0 ? place.imbalance.norm() : 0;
    residual_ = size > rounding_of_forces ? size / place.scale : 0;
    summary.finite = summary.finite && std::isfinite(residual_);
    if (!summary.finite) break;
    if (residual_ <= problem_.tolerance && (iteration > 0 || residual_ <= exact_imbalance)) {
      summary.converged = true;
      break;
    }
    if (iteration == max_iterations || !factor_at(place, stress)) break;
    const Eigen::VectorXd z = solver_.solve(place.imbalance);
    ++summary.iterations;
    ++summary.solves;
    const Eigen::VectorXd flat = problem_.map * z;
    const Points d = Eigen::Map<const Points>(flat.data(), flat.size() / 3, 3);
    const Points before = position(place.y), old = place.y;
    if (!d.allFinite() || !advance(place, d, place.imbalance.dot(z))) break;
    const Points moved = place.y - old;
    if (moved.cwiseAbs().maxCoeff() <= negligible_step) {
      summary.converged = true;
      break;
    }
    stress = problem_.structure.stress(before, problem_.theta * moved);
  }
  y = std::move(place.y);
  return std::move(place.contact);
}

}  // namespace knead
