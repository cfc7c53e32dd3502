#pragma once

#include <span>

#include "knead/spline/evaluate.hpp"
#include "knead/spline/extremum.hpp"

namespace knead {

/// The largest |S| of a displacement field. For volumes at samples only, 2p + 3 per span.
template <int D>
double largest_of(const Spline<D>& field) {
  if constexpr (D == 2) return largest_norm(field).value;
  if constexpr (D == 1) {  // as a ruled surface that is constant along its rulings
    Points twice(2 * field.size(), 3);
    std::vector<double> weights;
    for (int i = 0; i < field.size(); ++i) {
      twice.row(2 * i) = twice.row(2 * i + 1) = field.control_points().row(i);
      if (field.rational())
        weights.insert(weights.end(), 2, field.weights()[static_cast<std::size_t>(i)]);
    }
    const auto surface =
        Surface::create({field.knots(0), *KnotVector::clamped_uniform(1, 2)}, twice, weights);
    return surface ? largest_norm(*surface).value : 0;
  }
  if constexpr (D == 3) {
    std::array<std::vector<double>, D> parameters;
    std::array<std::span<const double>, D> spans;
    for (std::size_t d = 0; d < D; ++d) {
      const KnotVector& knots = field.knots()[d];
      const int steps = 2 * knots.degree() + 3;
      for (int span : knots.spans()) {
        const double a = knots[span], b = knots[span + 1];
        for (int k = 0; k <= steps; ++k)
          parameters[d].push_back(k == steps ? b : a + (b - a) * k / steps);
      }
      spans[d] = parameters[d];
    }
    const auto grid = evaluate_grid<D>(field, spans);
    return grid ? grid->points().rowwise().norm().maxCoeff() : 0;
  }
}

/// The largest |S − S_original| over all patches, for control points that differ by `displacement`.
///
/// With rational patches a displacement of control points has the weights of the patch, so that it
/// is a spline of the same kind and is S − S_original itself.
template <int D>
double largest_displacement(std::span<const Spline<D>> patches, std::span<const int> rows,
                            const Points& displacement) {
  double largest = 0;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const auto field =
        patches[k].with_control_points(displacement.middleRows(rows[k], rows[k + 1] - rows[k]));
    if (field) largest = std::max(largest, largest_of<D>(*field));
  }
  return largest;
}

}  // namespace knead
