#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "knead/energy/domain_scaling.hpp"
#include "knead/energy/stiffness.hpp"

namespace knead {

/// The unknowns that are left where `rows` rows of control points are held on each side of a net m
/// × n: the numbers i n + j of the control points (i, j) with rows <= i < m − rows and rows <= j <
/// n − rows, ascending; x, y and z have the same. Error (input): `rows` is negative, or nothing is
/// left. Cost: O(m n).
[[nodiscard]] Expected<std::vector<std::int64_t>> free_unknowns(const std::array<int, 2>& net,
                                                                int rows);

/// The discrete system of a surface, for other solvers: M ẍ + D ẋ + K x = F for each coordinate, on
/// the unknowns that are free (thesis Eqs. 4.14, 4.23). K is `of` `stretch_and_bend`, M and D are
/// `of` `mass_energy`.
class FreeSystem {
 public:
  /// On the rows and columns of a matrix that are free, in the order in which they are named.
  struct Operator {
    SparseMatrix matrix;     ///< square, as many rows as free unknowns, columns sorted
    double error_bound = 0;  ///< that of `Stiffness`
  };

  /// \param free numbers of control points, ascending, each once, from 0 to the size of the net
  /// less 1 \param scaling the units: coordinates are in `scaling.length`, parameters are
  /// multiplied by `scaling.factors`; the
  ///        default is raw
  FreeSystem(Surface shape, std::vector<std::int64_t> free, DomainScaling<2> scaling = {},
             StiffnessOptions options = {});

  [[nodiscard]] const Surface& shape() const { return shape_; }
  [[nodiscard]] const std::vector<std::int64_t>& free() const { return free_; }
  [[nodiscard]] const DomainScaling<2>& scaling() const { return scaling_; }

  /// The matrix A of a quadratic energy, E = Σ_xyz Pᵀ A P, without the held unknowns. Errors: those
  /// of `Stiffness::create`. Cost: that of `Stiffness` and its assembly; where unknowns are held, a
  /// copy too.
  [[nodiscard]] Expected<Operator> of(const Energy<2>& energy) const;

  /// F = f ∫ R_i dû of a constant force per measure of the (scaled) domain: a row x, y, z for each
  /// free unknown. Errors: those of `load_forces`.
  [[nodiscard]] Expected<Points> forces(const Point& load) const;

  /// All control points, in the unit of the scaling: a row for each unknown, free or held.
  [[nodiscard]] Points points() const { return shape_.control_points() / scaling_.length; }

 private:
  Surface shape_;
  std::vector<std::int64_t> free_;
  DomainScaling<2> scaling_;
  StiffnessOptions options_;
};

/// An energy of the system, with what files call its matrix.
struct NamedEnergy {
  std::string name, formula;  ///< "K_alpha11", "int R_i,s R_j,s"
  Energy<2> energy;
};

/// Those of K, of each of its six terms alone, of M and of D. Requires: a valid material.
[[nodiscard]] std::vector<NamedEnergy> system_energies(const Material& material, double mass,
                                                       double damping);

}  // namespace knead
