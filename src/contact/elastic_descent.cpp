#include "elastic_descent.hpp"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/interruption.hpp"
#include "coordinate_sum.hpp"
#include "knead/solve/eigenmodes.hpp"

namespace knead {
namespace {

constexpr int max_iterations = 100;
constexpr int max_halvings = 30;
constexpr int max_parabolas = 30;
// Of the forces that meet: parabolas lead so far, or further in one step.
constexpr double near_balance = 1e-3;
// Of the imbalance: what one parabola may leave, if it is to lead further.
constexpr double kept_parabola = 0.5;
constexpr double parabola_accuracy = 1e-4;  // of the displacement towards its minimum
constexpr double armijo_share = 1e-4;
constexpr double rounding_of_phi = 1e-13;
constexpr double negligible_step = 1e-13;  // in lengths of the model: rounding is all that is left
constexpr double ran_away = 1e6;           // likewise: no minimum is so far
// A full step that lowers the imbalance so far is taken, whatever Φ does.
constexpr double halved_imbalance = 0.5;
constexpr double exact_imbalance = 1e-9;      // less asks for no iteration
constexpr double rounding_of_forces = 1e-14;  // in membrane stiffness times length

Eigen::Map<const Eigen::VectorXd> flattened(const Points& x) { return {x.data(), x.size()}; }

}  // namespace

ElasticDescent::ElasticDescent(const ElasticStepProblem& problem, Potential& potential)
    : problem_(problem), potential_(potential) {
  if (problem.inertia.rows() > 0) inertia_ = on_coordinates(problem.inertia);
}

Points ElasticDescent::inertia_times(const Points& y) const {
  return problem_.inertia.rows() > 0 ? Points(problem_.inertia * y) : Points::Zero(y.rows(), 3);
}

// Φ, its gradient and the unit of imbalances at one Y; the gradient of W(start + θ Y)/θ in Y is ∇W,
// without a θ. Cost: the energy and its gradient by quadrature, and one evaluation of contact.
ElasticDescent::Place ElasticDescent::at(Points y) const {
  Place place;
  place.contact = potential_.evaluate(problem_.start + y);
  const Points qy = inertia_times(y);
  Points elastic;
  const double value = problem_.energy.value(position(y), elastic);
  place.phi =
      value / problem_.theta - dot(problem_.b, y) + 0.5 * dot(y, qy) + place.contact.potential;
  place.pull = problem_.b - qy - elastic;
  place.imbalance = problem_.space.reduce(place.pull + place.contact.force);
  place.scale = place.contact.force.norm() + problem_.b.norm() + qy.norm() + elastic.norm();
  place.y = std::move(y);
  return place;
}

// The second derivative of W(start + θ Y)/θ is θ ∇²W.
SparseMatrix ElasticDescent::elastic(SparseMatrix hessian) const {
  if (problem_.theta != 1) hessian *= problem_.theta;
  if (inertia_.rows() > 0) hessian += inertia_;
  return hessian;
}

SparseMatrix ElasticDescent::with_contact(const Place& place, SparseMatrix hessian) const {
  CoordinateSum sum(elastic(std::move(hessian)));
  potential_.each_hessian_block(
      place.contact,
      [&](std::span<const int> points, const Eigen::MatrixXd& block) { sum.add(points, block); });
  return std::move(sum).take_sum();
}

bool ElasticDescent::factor(const SparseMatrix& system) {
  auto factored = ConstrainedCholesky::factor(system, problem_.space, problem_.restriction);
  if (!factored) return false;
  inverse_.emplace(std::move(*factored));
  parabola_.resize(0, 0);
  return true;
}

/// The Hessian, without its geometric part where that makes it indefinite, and with some more of a
/// multiple of the identity where a mechanism is left.
///
/// Three matrices in turn, each more certain to be positive definite and less like ∇²Φ: the exact
/// one, which gives quadratic convergence; the material part, as Gauss–Newton, which is positive
/// semidefinite; and this raised by 1e-10, 1e-8, … of its largest diagonal entry (Levenberg 1944,
/// Marquardt 1963). Each gives a direction of descent.
bool ElasticDescent::factor_at(const Place& place, const std::optional<Points>& before) {
  const Points x = position(place.y);
  const ElasticEnergy& energy = problem_.energy;
  if (factor(with_contact(place, before ? energy.hessian(x, *before) : energy.hessian(x))))
    return true;
  SparseMatrix system = with_contact(place, energy.material_hessian(x));
  if (factor(system)) return true;
  const Eigen::VectorXd diagonal = system.diagonal();
  const double largest = diagonal.cwiseAbs().maxCoeff();
  for (double share = 1e-10; share < 1 && !Interruption::asked_for(); share *= 100) {
    system.diagonal() = diagonal.array() + share * largest;
    if (factor(system)) return true;
  }
  return false;
}

/// Moves along d as far as lowers Φ enough, or all the way where that lowers the imbalance by much.
/// False: not at all.
///
/// Armijo's rule with `slope` = −dΦ/dt > 0, and backtracking to the minimum of a parabola within
/// 0.1 to 0.5 of the step before (Dennis and Schnabel 1983, § 6.3.2). Φ near a minimum is flat to
/// rounding where its gradient still has digits, hence the second test, on the imbalance, for full
/// steps.
bool ElasticDescent::advance(Place& place, const Points& d, double slope) const {
  const double rounding = rounding_of_phi * std::max(std::abs(place.phi), std::abs(slope));
  double t = 1;
  for (int k = 0; k < max_halvings && !Interruption::asked_for(); ++k) {
    Place next = at(place.y + t * d);
    const bool finite = std::isfinite(next.phi) && next.imbalance.allFinite();
    if (finite &&
        (next.phi <= place.phi - armijo_share * t * slope + rounding ||
         (k == 0 && next.imbalance.norm() <= halved_imbalance * place.imbalance.norm()))) {
      place = std::move(next);
      return true;
    }
    // The minimum of the parabola through both values with the slope at the beginning, within
    // reason.
    const double rise = next.phi - place.phi;
    const double best =
        finite && rise + t * slope > 0 ? 0.5 * t * t * slope / (rise + t * slope) : 0.1 * t;
    t = std::clamp(best, 0.1 * t, 0.5 * t);
  }
  return false;
}

// Relative to the forces that meet: |Tᵀ f| / (|F| + |b| + |Qy| + |∇W|). Where nothing has moved yet
// the tolerance is the tighter one, so that an interactive step from near a minimum does not stand
// still.
bool ElasticDescent::balanced(const Place& place, bool moved, double tolerance,
                              ContactSummary& summary) {
  const double size = place.imbalance.size() > 0 ? place.imbalance.norm() : 0;
  residual_ = size > rounding_of_forces ? size / place.scale : 0;
  summary.finite = summary.finite && std::isfinite(residual_);
  summary.converged =
      summary.finite && residual_ <= tolerance && (moved || residual_ <= exact_imbalance);
  return summary.converged || !summary.finite;
}

// Sequential convex minimisation: W is replaced by W(Y) + ∇Wᵀd + ½ dᵀ(θ H⁺)d, H⁺ the Hessian with
// tensile stresses alone, which is positive semidefinite, while contact stays as nonlinear as it
// is. The change of the contact set, which stops Newton's method on both at once, is thus left to
// `minimise_step`, which is made for it; and one factor of the parabola serves all its iterations.
// It is kept while each round at least halves the imbalance.
ElasticDescent::Place ElasticDescent::approach(Place place, double tolerance,
                                               ContactSummary& summary) {
  double before = std::numeric_limits<double>::infinity();
  bool fresh = false;
  for (int round = 0; round < max_parabolas; ++round) {
    if (balanced(place, round > 0, tolerance, summary) || Interruption::asked_for()) return place;
    if (parabola_.rows() == 0 || residual_ > kept_parabola * before) {
      SparseMatrix a = elastic(problem_.energy.tense_hessian(position(place.y)));
      if (!factor(a)) return place;
      parabola_ = std::move(a);
      fresh = true;
    } else {
      fresh = false;
    }
    before = residual_;
    const auto times = [&](const Points& d) {
      const Eigen::VectorXd image = parabola_ * flattened(d);
      return Points(Eigen::Map<const Points>(image.data(), d.rows(), 3));
    };
    const StepProblem parabola{
        times, *inverse_,        place.pull, problem_.start + place.y, std::abs(place.phi),
        false, parabola_accuracy};
    Points d = Points::Zero(place.y.rows(), 3);
    const Minimum minimum = minimise_step(parabola, potential_, d);
    ++summary.iterations;
    summary.solves += minimum.summary.solves;
    const double slope = dot(place.pull + place.contact.force, d);
    if (!d.allFinite() || !(slope > 0) || !advance(place, d, slope)) {
      if (fresh) return place;
      before = 0;  // another parabola
    }
  }
  return place;
}

// Newton's method on W and Ψ together, with a factor of ∇²Φ per iteration: quadratic convergence
// once the contact set has settled.
ElasticDescent::Place ElasticDescent::newton(Place place, ContactSummary& summary) {
  std::optional<Points> before;
  for (int iteration = 0;; ++iteration) {
    if (balanced(place, iteration > 0, problem_.tolerance, summary)) break;
    if (iteration == max_iterations || Interruption::asked_for() || !factor_at(place, before))
      break;
    const Points forces = place.pull + place.contact.force, d = inverse_->solve(forces);
    ++summary.iterations;
    ++summary.solves;
    const Points old = place.y;
    if (!d.allFinite() || !advance(place, d, dot(forces, d))) break;
    if ((place.y - old).cwiseAbs().maxCoeff() <= negligible_step) {
      summary.converged = true;
      break;
    }
    if (place.y.cwiseAbs().maxCoeff() > ran_away) break;
    before = position(old);
  }
  return place;
}

// Without contact, and where more than 1e-3 is asked for, parabolas gain nothing on Newton's
// method.
PotentialState ElasticDescent::run(Points& y, ContactSummary& summary) {
  Place place = at(y);
  summary.converged = false;
  if (problem_.tolerance >= near_balance || !place.contact.contacts.empty()) {
    place = approach(std::move(place), near_balance, summary);
  }
  if (summary.finite && !(summary.converged && residual_ <= problem_.tolerance)) {
    place = newton(std::move(place), summary);
  }
  y = std::move(place.y);
  return std::move(place.contact);
}

}  // namespace knead
