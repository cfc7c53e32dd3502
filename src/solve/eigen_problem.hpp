#pragma once

#include "knead/solve/eigenmodes.hpp"

namespace knead {

/// `vibration_modes` and `buckling_modes` on the displacements x = T y of a map with 3N rows.
[[nodiscard]] Expected<std::vector<Eigenmode>> mapped_vibration_modes(const SparseMatrix& stiffness,
                                                                      const SparseMatrix& mass,
                                                                      const SparseMatrix& map,
                                                                      int count);
[[nodiscard]] Expected<std::vector<Eigenmode>> mapped_buckling_modes(const SparseMatrix& stiffness,
                                                                     const SparseMatrix& geometric,
                                                                     const SparseMatrix& map,
                                                                     int count);

}  // namespace knead
