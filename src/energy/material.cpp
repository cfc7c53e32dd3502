#include "knead/energy/energy.hpp"

#include <fmt/format.h>

#include <cmath>

namespace knead {
namespace {

template <int D>
std::string name_of(const char* letter, int i, int j) {
  return fmt::format("{}{}{}", letter, i + 1, j + 1);
}

}  // namespace

Material thin_plate(double rigidity, double poisson) {
  return {{0, 0, 0}, {rigidity, (1 - poisson) * rigidity, rigidity}, poisson};
}

template <int D>
Expected<MaterialOf<D>> validated(const MaterialOf<D>& material) {
  constexpr auto place = MaterialOf<D>::place;
  for (int i = 0; i < D; ++i) {
    for (int j = i; j < D; ++j) {
      const double alpha = material.alpha[place(i, j)], beta = material.beta[place(i, j)];
      if (!std::isfinite(alpha)) {
        return input_error("the coefficient is not a finite number", name_of<D>("alpha", i, j));
      }
      if (!std::isfinite(beta)) {
        return input_error("the coefficient is not a finite number", name_of<D>("beta", i, j));
      }
      if (beta < 0) {
        return input_error(fmt::format("{} is negative, so the energy has no minimum", beta),
                           name_of<D>("beta", i, j), "use a value >= 0");
      }
      if (i == j && alpha < 0) {
        return input_error(fmt::format("{} is negative, so the energy has no minimum", alpha),
                           name_of<D>("alpha", i, j), "use a value >= 0");
      }
    }
  }
  for (int i = 0; i < D; ++i) {
    for (int j = i + 1; j < D; ++j) {
      const double ii = material.alpha[place(i, i)], ij = material.alpha[place(i, j)],
                   jj = material.alpha[place(j, j)];
      if (ij * ij > ii * jj) {
        return input_error(
            fmt::format("{}² exceeds alpha{}{} alpha{}{} = {}, so the energy has no minimum", ij,
                        i + 1, i + 1, j + 1, j + 1, ii * jj),
            name_of<D>("alpha", i, j),
            fmt::format("use |alpha{}{}| <= sqrt(alpha{}{} alpha{}{})", i + 1, j + 1, i + 1, i + 1,
                        j + 1, j + 1));
      }
    }
  }
  if constexpr (D == 3) {
    const auto& [a, b, c, d, e, f] = material.alpha;
    const double determinant = a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d);
    const double rounding =
        1e-15 * (a * (d * f + e * e) + std::abs(b) * (std::abs(b) * f + std::abs(c * e)) +
                 std::abs(c) * (std::abs(b * e) + std::abs(c) * d));
    if (determinant < -rounding) {
      return input_error(
          "the matrix of the alpha is not positive semidefinite, so the energy has no minimum",
          "alpha", "reduce alpha12, alpha13 and alpha23");
    }
  }
  // The matrix with 1 on its diagonal and ν elsewhere has the eigenvalues 1 − ν and 1 + (D − 1) ν.
  const double least = D == 1 ? 0 : -1.0 / (D - 1), most = D == 1 ? 0 : 1;
  if (!(material.poisson >= least && material.poisson <= most)) {
    return input_error(
        fmt::format("the energy has no minimum with a Poisson's ratio of {}", material.poisson),
        "poisson", fmt::format("use a number from {} to {}", least, most));
  }
  return material;
}

template Expected<MaterialOf<1>> validated<1>(const MaterialOf<1>&);
template Expected<MaterialOf<2>> validated<2>(const MaterialOf<2>&);
template Expected<MaterialOf<3>> validated<3>(const MaterialOf<3>&);

}  // namespace knead
