#pragma once

#include <span>
#include <vector>

#include "knead/energy/stiffness.hpp"
#include "knead/solve/linear_constraint.hpp"

namespace knead {

/// An eigenvector of a structure with its eigenvalue.
struct Eigenmode {
  double value;  ///< λ
  double residual;  ///< |K x − λ M x| / |(K + s M) x| with the shift s below; |K x + λ G x| / |K x|
                    ///< of buckling
  Points shape;  ///< displacements of the control points, N × 3, the longest of length 1
};

/// The lowest eigenvalues λ of K x = λ M x on all that the constraints leave free, ascending:
/// squares of the angular frequencies of a structure with stiffness K and mass M. Rigid modes,
/// where nothing prevents them, have λ = 0 up to the rounding of K; below 0 the structure is
/// unstable.
///
/// Block Lanczos on (K + s M)⁻¹ M with full reorthogonalisation in the inner product of M (T.
/// Ericsson and A. Ruhe, *The spectral transformation Lanczos method*, Math. Comp. 35 (1980)); s =
/// 1e-9 · tr K / tr M makes the shifted matrix regular where the structure is free. Eigenvalues of
/// multiplicity up to the block's 8 vectors are all found. No random numbers but those of a fixed
/// sequence: the result is the same everywhere, to rounding.
///
/// \param stiffness, mass 3N × 3N, unknown 3 i + c coordinate c of control point i; the mass
/// positive definite. \param constraints on displacements; their values are taken as 0. \return
/// min(count, free unknowns) modes. Errors: contradictory constraints, count < 1, a mass that is
/// zero (input); a shifted matrix that cannot be factored, fewer modes than asked for to a relative
/// residual of 1e-10 among 400 vectors (numerical). Cost: one sparse factorisation, one solve per
/// vector, O(vectors² N).
[[nodiscard]] Expected<std::vector<Eigenmode>> vibration_modes(
    const SparseMatrix& stiffness, const SparseMatrix& mass,
    std::span<const LinearConstraint> constraints, int count);

/// The smallest λ > 0 at which K + λ G is singular, ascending: the factors by which the loads that
/// make the geometric stiffness G are multiplied when the structure buckles, to first order. Fewer
/// than asked for, or none, where only so many positive ones are found among 400 vectors: loads
/// that only pull never buckle.
///
/// Block Lanczos as above on −K⁻¹ G in the inner product of K. Errors: those above; a K that is not
/// positive definite (numerical).
[[nodiscard]] Expected<std::vector<Eigenmode>> buckling_modes(
    const SparseMatrix& stiffness, const SparseMatrix& geometric,
    std::span<const LinearConstraint> constraints, int count);

/// A ⊗ I₃: the same scalar operator on each coordinate.
[[nodiscard]] SparseMatrix on_coordinates(const SparseMatrix& scalar);

}  // namespace knead
