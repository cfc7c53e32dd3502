#include "knead/contact/free_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "knead/energy/loads.hpp"

namespace knead {
namespace {

/// Rows and columns of the unknowns that are free.
SparseMatrix reduced_to(const SparseMatrix& matrix, const std::vector<std::int64_t>& free) {
  if (static_cast<Eigen::Index>(free.size()) == matrix.rows()) return matrix;
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<int> place(static_cast<std::size_t>(matrix.rows()), -1);
  for (std::size_t k = 0; k < free.size(); ++k)
    place[static_cast<std::size_t>(free[k])] = static_cast<int>(k);
  for (int column = 0; column < matrix.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator at(matrix, column); at; ++at) {
      const int i = place[static_cast<std::size_t>(at.row())],
                j = place[static_cast<std::size_t>(column)];
      if (i >= 0 && j >= 0) entries.emplace_back(i, j, at.value());
    }
  }
  SparseMatrix result(static_cast<Eigen::Index>(free.size()),
                      static_cast<Eigen::Index>(free.size()));
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace

Expected<std::vector<std::int64_t>> free_unknowns(const std::array<int, 2>& net, int rows) {
  const auto [m, n] = net;
  if (rows < 0 || 2 * static_cast<std::int64_t>(rows) >= std::min(m, n)) {
    return input_error(fmt::format("{} rows on each side leave nothing of {} x {}", rows, m, n), {},
                       "hold fewer");
  }
  std::vector<std::int64_t> free;
  for (int i = rows; i < m - rows; ++i) {
    for (int j = rows; j < n - rows; ++j) free.push_back(static_cast<std::int64_t>(i) * n + j);
  }
  return free;
}

FreeSystem::FreeSystem(Surface shape, std::vector<std::int64_t> free, DomainScaling<2> scaling,
                       StiffnessOptions options)
    : shape_(std::move(shape)), free_(std::move(free)), scaling_(scaling), options_(options) {}

Expected<FreeSystem::Operator> FreeSystem::of(const Energy<2>& energy) const {
  const auto made =
      Stiffness<2>::create(shape_, on_scaled_domain<2>(energy, scaling_.factors), options_);
  if (!made) return std::unexpected(made.error());
  return Operator{reduced_to(made->assemble(), free_), made->error_bound()};
}

Expected<Points> FreeSystem::forces(const Point& load) const {
  const auto nodal =
      load_forces<2>(shape_, scaling_, [&](const std::array<double, 2>&) { return load; });
  if (!nodal) return std::unexpected(nodal.error());
  Points result(static_cast<Eigen::Index>(free_.size()), 3);
  for (std::size_t k = 0; k < free_.size(); ++k) {
    result.row(static_cast<Eigen::Index>(k)) = nodal->row(static_cast<Eigen::Index>(free_[k]));
  }
  return result;
}

// A term of K on its own is the energy with its coefficient 1 and all others 0: K is linear in the
// coefficients. β12's matrix has the 2 of 2β12|S_st|² in it.
std::vector<NamedEnergy> system_energies(const Material& material, double mass, double damping) {
  constexpr std::array<std::array<const char*, 2>, 6> terms = {
      {{"K_alpha11", "int R_i,s R_j,s"},
       {"K_alpha12", "int R_i,s R_j,t + R_i,t R_j,s"},
       {"K_alpha22", "int R_i,t R_j,t"},
       {"K_beta11", "int R_i,ss R_j,ss"},
       {"K_beta12", "2 int R_i,st R_j,st"},
       {"K_beta22", "int R_i,tt R_j,tt"}}};
  std::vector<NamedEnergy> list = {
      {"K", "the sum of the terms below, each times its coefficient", stretch_and_bend(material)}};
  for (std::size_t k = 0; k < terms.size(); ++k) {
    Material one;
    one.alpha = one.beta = {0, 0, 0};
    (k < 3 ? one.alpha : one.beta)[k % 3] = 1;
    list.push_back({terms[k][0], terms[k][1], stretch_and_bend(one)});
  }
  list.push_back({"M", "mass int R_i R_j", mass_energy<2>(mass)});
  list.push_back({"D", "damping int R_i R_j", mass_energy<2>(damping)});
  return list;
}

}  // namespace knead
