#include "all.hpp"

namespace knead {
namespace {

struct Curvatures {
  double mean = 0, gaussian = 0;
};

/// From the first and second fundamental forms; 0 where S_u and S_v are parallel.
template <class Take>
std::vector<double> of_each_point(const DisplayInput& input, Take take) {
  const Evaluation<2>& s = input.evaluation;
  std::vector<double> result;
  for (Eigen::Index k = 0; k < s.points().rows(); ++k) {
    const Point u = s.at({1, 0}).row(k), v = s.at({0, 1}).row(k), n = input.normals.row(k);
    const double e = u.dot(u), f = u.dot(v), g = v.dot(v);
    const double l = n.dot(s.at({2, 0}).row(k)), m = n.dot(s.at({1, 1}).row(k)), o = n.dot(s.at({0, 2}).row(k));
    const double area = e * g - f * f;
    Curvatures at;
    if (area > 1e-18 * (e + g) * (e + g)) {
      at = {.mean = (e * o - 2 * f * m + g * l) / (2 * area), .gaussian = (l * o - m * m) / area};
    }
    result.push_back(take(at));
  }
  return result;
}

Expected<std::vector<double>> mean(const DisplayInput& input) {
  return of_each_point(input, [](const Curvatures& at) { return at.mean; });
}

Expected<std::vector<double>> gaussian(const DisplayInput& input) {
  return of_each_point(input, [](const Curvatures& at) { return at.gaussian; });
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

}  // namespace knead
