#pragma once

#include "binding.hpp"
#include "knead/energy/field_assembler.hpp"

namespace knead::python {

/// (data, indices, indptr, shape), as `scipy.sparse.csc_array` takes them, without a copy.
[[nodiscard]] py::tuple columns_of(SparseMatrix matrix);

/// (K, M, D, F, free): K, M and D on all control points, F on the free ones. With the
/// interpreter, which others have meanwhile.
[[nodiscard]] py::tuple matrices_of(const Surface& shape, const MaterialFieldOf<2>& material,
                                    const Point& load, int hold, bool normalised, double tolerance);

}  // namespace knead::python
