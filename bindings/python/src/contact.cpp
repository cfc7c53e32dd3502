#include <cassert>

#include "binding.hpp"
#include "knead/contact/free_system.hpp"
#include "sparse.hpp"

namespace knead::python {

namespace {

/// Leaves the rows and columns of these numbers, ascending, in the memory that is there.
void reduce(SparseMatrix& matrix, const std::vector<std::int64_t>& free) {
  if (std::ssize(free) == matrix.rows()) return;
  std::vector<int> place(static_cast<std::size_t>(matrix.rows()), -1);
  for (std::size_t k = 0; k < free.size(); ++k)
    place[static_cast<std::size_t>(free[k])] = static_cast<int>(k);
  int* const starts = matrix.outerIndexPtr();
  int* const rows = matrix.innerIndexPtr();
  double* const values = matrix.valuePtr();
  int count = 0, columns = 0;
  for (const std::int64_t column : free) {
    const int begin = starts[column],
              end = starts[column + 1];  // what is written is at or before what is read
    starts[columns++] = count;
    for (int at = begin; at < end; ++at) {
      const int row = place[static_cast<std::size_t>(rows[at])];
      if (row < 0) continue;
      rows[count] = row;
      values[count++] = values[at];
    }
  }
  starts[columns] = count;
}

/// As arrays of Python, which share its memory.
py::tuple columns_of(SparseMatrix& matrix, py::ssize_t size) {
  const auto kept = std::make_shared<SparseMatrix>();
  kept->swap(matrix);
  const py::ssize_t entries = kept->outerIndexPtr()[size];
  return py::make_tuple(view_of(kept, kept->valuePtr(), {entries}, false),
                        view_of(kept, kept->innerIndexPtr(), {entries}, false),
                        view_of(kept, kept->outerIndexPtr(), {size + 1}, false),
                        py::make_tuple(size, size));
}

struct Made {
  SparseMatrix stiffness, mass, damping;
  Points forces;
  std::vector<std::int64_t> free;
};

/// One after the other, without copies (Eigen's matrices have no move constructor): these are most
/// of the memory. The forces first, whose integration takes as much for a while.
Expected<void> make(Made& made, const Surface& shape, const MaterialFieldOf<2>& material,
                    const Point& load, int hold, bool normalised, const StiffnessOptions& options) {
  auto free = free_unknowns(shape.net(), hold);
  if (!free) return std::unexpected(free.error());
  made.free = *std::move(free);
  auto scaling =
      normalised ? normalised_scaling<2>(shape) : Expected<DomainScaling<2>>(DomainScaling<2>{});
  if (!scaling) return std::unexpected(scaling.error());
  if (auto valid = validated(material); !valid) return std::unexpected(valid.error());
  auto forces = FreeSystem(shape, made.free, *scaling, options).forces(load);
  if (!forces) return std::unexpected(forces.error());
  made.forces = *std::move(forces);
  FieldAssembler<2> assembler(shape, options);
  const std::pair<FieldEnergy<2>, SparseMatrix*> parts[] = {
      {stretch_energy<2>(material), &made.stiffness},
      {bend_energy<2>(material), &made.stiffness},
      {weighted_mass_energy<2>(material.mass), &made.mass},
      {weighted_mass_energy<2>(material.damping), &made.damping}};
  for (const auto& [energy, matrix] : parts) {
    auto one = assembler.assemble(on_scaled_domain<2>(energy, scaling->factors));
    if (!one) return std::unexpected(one.error());
    one->makeCompressed();
    reduce(*one, made.free);
    if (matrix->size() == 0) {
      matrix->swap(*one);
      continue;
    }
    // Of the same pattern (`FieldMatrices`).
    const int count = one->outerIndexPtr()[made.free.size()];
    assert(count == matrix->outerIndexPtr()[made.free.size()]);
    for (int k = 0; k < count; ++k) matrix->valuePtr()[k] += one->valuePtr()[k];
  }
  return {};
}

}  // namespace

py::tuple matrices_of(const Surface& shape, const MaterialFieldOf<2>& material, const Point& load,
                      int hold, bool normalised, double tolerance) {
  Made made;
  StiffnessOptions options;
  options.rational_tolerance = tolerance;
  value_of(without_interpreter(
      [&] { return make(made, shape, material, load, hold, normalised, options); }));
  const auto count = std::ssize(made.free);
  auto stiffness = columns_of(made.stiffness, count), mass = columns_of(made.mass, count),
       damping = columns_of(made.damping, count);
  return py::make_tuple(stiffness, mass, damping, view_of_own(std::move(made.forces), {count, 3}),
                        view_of_own(std::move(made.free), {count}));
}

void bind_contact(py::module_& module) {
  // (K, M, D, F, free) of a surface.
  module.def("matrices",
             [](const Held<2>& held, const std::array<double, 3>& alpha,
                const std::array<double, 3>& beta, double mass, double damping,
                const std::array<double, 3>& load, int hold, bool normalised, double tolerance) {
               return matrices_of(*held.spline, MaterialFieldOf<2>({alpha, beta}, mass, damping),
                                  {load[0], load[1], load[2]}, hold, normalised, tolerance);
             });
}

}  // namespace knead::python
