#include "binding.hpp"
#include "knead/contact/free_system.hpp"
#include "sparse.hpp"

namespace knead::python {

py::tuple columns_of(SparseMatrix matrix) {
  matrix.makeCompressed();
  const auto kept = std::make_shared<SparseMatrix>(std::move(matrix));
  const auto entries = static_cast<py::ssize_t>(kept->nonZeros()),
             columns = static_cast<py::ssize_t>(kept->cols());
  return py::make_tuple(view_of(kept, kept->valuePtr(), {entries}, false),
                        view_of(kept, kept->innerIndexPtr(), {entries}, false),
                        view_of(kept, kept->outerIndexPtr(), {columns + 1}, false),
                        py::make_tuple(kept->rows(), kept->cols()));
}

py::tuple matrices_of(const Surface& shape, const MaterialFieldOf<2>& material, const Point& load,
                      int hold, bool normalised, double tolerance) {
  const auto work =
      [&]() -> Expected<std::tuple<FieldMatrices<2>, Points, std::vector<std::int64_t>>> {
    auto free = free_unknowns(shape.net(), hold);
    if (!free) return std::unexpected(free.error());
    auto scaling =
        normalised ? normalised_scaling<2>(shape) : Expected<DomainScaling<2>>(DomainScaling<2>{});
    if (!scaling) return std::unexpected(scaling.error());
    if (auto valid = validated(material); !valid) return std::unexpected(valid.error());
    StiffnessOptions options;
    options.rational_tolerance = tolerance;
    auto made = FieldAssembler<2>(shape, options).assemble(material, scaling->factors);
    if (!made) return std::unexpected(made.error());
    auto forces = FreeSystem(shape, *free, *scaling, options).forces(load);
    if (!forces) return std::unexpected(forces.error());
    return std::tuple(*std::move(made), *std::move(forces), *std::move(free));
  };
  auto made = [&] {
    const py::gil_scoped_release others;
    return work();
  }();
  auto [all, forces, free] = value_of(std::move(made));
  SparseMatrix stiffness = std::move(all.stretch);
  stiffness += all.bend;
  all.bend = {};
  const auto rows = static_cast<py::ssize_t>(forces.rows()), count = std::ssize(free);
  return py::make_tuple(columns_of(std::move(stiffness)), columns_of(std::move(all.mass)),
                        columns_of(std::move(all.damping)),
                        view_of_own(std::move(forces), {rows, 3}),
                        view_of_own(std::move(free), {count}));
}

void bind_contact(py::module_& module) {
  // (K, M, D, F, free) of a surface, K, M and D on all unknowns.
  module.def("matrices",
             [](const Held<2>& held, const std::array<double, 3>& alpha,
                const std::array<double, 3>& beta, double mass, double damping,
                const std::array<double, 3>& load, int hold, bool normalised, double tolerance) {
               return matrices_of(*held.spline, MaterialFieldOf<2>({alpha, beta}, mass, damping),
                                  {load[0], load[1], load[2]}, hold, normalised, tolerance);
             });
}

}  // namespace knead::python
