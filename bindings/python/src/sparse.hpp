#pragma once

#include "binding.hpp"
#include "knead/energy/field_assembler.hpp"

namespace knead::python {

/// (K, M, D, F, free), all on the free control points; K, M and D each as (data, indices, indptr,
/// shape), which `scipy.sparse.csc_array` takes without a copy. With the interpreter, which others
/// have meanwhile.
[[nodiscard]] py::tuple matrices_of(const Surface& shape, const MaterialFieldOf<2>& material,
                                    const Point& load, int hold, bool normalised, double tolerance);

}  // namespace knead::python
