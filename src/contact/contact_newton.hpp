#pragma once

#include <functional>
#include <memory>

#include "solve/dissection.hpp"
#include "solve/step_inverse.hpp"
#include "tool/potential.hpp"

namespace knead {

/// How the minimisation of one step ended.
struct ContactSummary {
  int iterations = 0;  ///< Newton iterations
  int solves = 0;      ///< substitutions
  bool converged = false;
  bool finite = true;  ///< false: a number overflowed on the way
};

class ContactFactor;

/// What factors of A and a Hessian are made from, and the last of them, which serves all
/// minimisations of a step.
struct FactorSource {
  std::function<SparseMatrix()> a;          // on one coordinate, N × N
  std::function<GridPlaces()> places = {};  // of the control points
  std::shared_ptr<ContactFactor> last = nullptr;
};

/// One step as a minimisation over X = X₀ + Y:  Φ(Y) = ½ YᵀAY − Yᵀb + Ψ(x₀ + Y), Y + X₀ subject to
/// constraints.
struct StepProblem {
  std::function<Points(const Points&)> a;  // A Y
  const StepInverse& inverse;              // of A on the free unknowns
  Points b;
  Points start;       // control points x₀ at which Ψ is evaluated for Y = 0
  double energy;      // ½ X₀ᵀ K X₀: the magnitude of the terms whose difference is Φ
  bool near = false;  // Y starts close to the minimum: stiff tools are used at full stiffness
  /// Where above 0, an error of Y of this share of √(YᵀAY) is small enough.
  double accuracy = 0;
  /// For directions by a factor of A and a Hessian; null: none are.
  FactorSource* source = nullptr;
};

/// The minimum, and the potential there.
struct Minimum {
  ContactSummary summary;
  PotentialState state;
};

/// Minimises, starting from `y` (feasible), which becomes the minimum.
///
/// In a neighbourhood of the contacts where A is factored (`Minimisation`), on the whole net where
/// it is not (`KrylovMinimisation`). Cost: a few solves within the neighbourhood for each
/// direction, and one whole solve; or as many cycles on the whole net.
[[nodiscard]] Minimum minimise_step(const StepProblem& problem, Potential& potential, Points& y);

}  // namespace knead
