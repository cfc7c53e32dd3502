#include "knead/spline/curvature.hpp"

#include <algorithm>
#include <cmath>

#include "all.hpp"

namespace knead {
namespace {

/// 0 where there is no tangent plane.
template <class Take>
std::vector<double> of_each_point(const DisplayInput& input, Take take) {
  const Evaluation<2>& s = input.evaluation;
  std::vector<double> result;
  for (Eigen::Index k = 0; k < s.points().rows(); ++k) {
    const FundamentalForms forms(s.at({1, 0}).row(k), s.at({0, 1}).row(k), s.at({2, 0}).row(k),
                                 s.at({1, 1}).row(k), s.at({0, 2}).row(k), input.normals.row(k));
    result.push_back(forms.regular() ? take(forms) : 0.0);
  }
  return result;
}

Expected<std::vector<double>> mean(const DisplayInput& input) {
  return of_each_point(input, [](const FundamentalForms& forms) { return forms.mean(); });
}

Expected<std::vector<double>> gaussian(const DisplayInput& input) {
  return of_each_point(input, [](const FundamentalForms& forms) { return forms.gaussian(); });
}

/// max(|κ₁|, |κ₂|) = |H| + √(H² − K).
Expected<std::vector<double>> largest(const DisplayInput& input) {
  return of_each_point(input, [](const FundamentalForms& forms) {
    const double h = forms.mean();
    return std::abs(h) + std::sqrt(std::max(0.0, h * h - forms.gaussian()));
  });
}

}  // namespace

Display mean_curvature_display() {
  return {.name = "mean",
          .title = "Mean curvature",
          .unit = "1/length",
          .is_signed = true,
          .help = "Mean of the principal curvatures. Steps show where it is not smooth.",
          .order = 2,
          .values = mean};
}

Display gaussian_curvature_display() {
  return {.name = "gaussian",
          .title = "Gaussian curvature",
          .unit = "1/length²",
          .is_signed = true,
          .help = "Product of the principal curvatures: red is domed, blue a saddle.",
          .order = 2,
          .values = gaussian};
}

Display largest_curvature_display() {
  return {
      .name = "largest",
      .title = "Largest curvature",
      .unit = "1/length",
      .palette = DisplayPalette::rising,
      .help = "Magnitude of the stronger principal curvature; its inverse is the smallest radius.",
      .order = 2,
      .values = largest};
}

}  // namespace knead
