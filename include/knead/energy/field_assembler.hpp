#pragma once

#include <memory>
#include <vector>

#include "knead/energy/material_field.hpp"
#include "knead/energy/stiffness.hpp"
#include "knead/gramian/triple_gramian.hpp"

namespace knead {

/// The matrices of a material: K = stretch + bend, M and D, all with the pattern of
/// `Stiffness::assemble`.
template <int D>
struct FieldMatrices {
  SparseMatrix stretch, bend, mass, damping;
  double error_bound = 0;  ///< the largest of the four (`Stiffness::error_bound`)
};

/// Assembles energies with varying coefficients on one spline, repeatedly as the coefficients are
/// painted.
///
/// Polynomial splines: exact up to rounding for splines as coefficients (thesis § 5.5, see
/// `TripleGramian`), by sum factorisation, one direction after the other: in two directions
///   K[(i, j), (i', j')] += factor · Σ_l (Σ_k c_kl T_u[k, i, i']) T_v[l, j, j'].
/// The triple Gramians depend on the knots alone and are kept from one call to the next (those of
/// knots not used in the last call are dropped). Constant coefficients are handled as in
/// `Stiffness`, bit for bit where nothing varies. Rational splines: as `Stiffness`, with the field
/// at the points and in the bound, the spans cut at its knots.
///
/// The result is symmetric to the last bit and linear in every coefficient up to rounding; it is
/// positive semidefinite (up to rounding) for coefficients that `validated` accepts. Cost with net
/// n per direction, D = 2: per term about n² (2p + 1)² (p + 1) multiply-adds and the triple
/// Gramians.
template <int D>
class FieldAssembler {
 public:
  explicit FieldAssembler(Spline<D> spline, StiffnessOptions options = {})
      : spline_(std::move(spline)), options_(options) {}

  /// The matrix of one energy. Errors: a field over another domain (input), and those of
  /// `Stiffness::create`.
  [[nodiscard]] Expected<SparseMatrix> assemble(const FieldEnergy<D>& energy);

  /// All four of a material on the domain scaled by `factors` (`DomainScaling::factors`). The
  /// material is not checked.
  [[nodiscard]] Expected<FieldMatrices<D>> assemble(const MaterialFieldOf<D>& material,
                                                    const std::array<double, D>& factors);

  [[nodiscard]] const Spline<D>& spline() const { return spline_; }

 private:
  struct Kept {
    KnotVector knots;
    int a, b;
    std::shared_ptr<const TripleGramian> triple;
    bool used;
  };
  [[nodiscard]] Expected<SparseMatrix> assemble_kept(const FieldEnergy<D>& energy,
                                                     double& error_bound);
  [[nodiscard]] Expected<const TripleGramian*> triple(std::size_t direction,
                                                      const KnotVector& knots, int a, int b);
  void begin();
  void drop_unused();

  Spline<D> spline_;
  StiffnessOptions options_;
  std::array<std::vector<Kept>, D> kept_;
};

}  // namespace knead
