#include "mask.hpp"

#include <algorithm>
#include <cmath>

#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

constexpr double insertion_error = 1e-12;  // of weights that knots were inserted into

std::vector<double> greville_of(const KnotVector& knots) {
  const Interval domain = knots.domain();
  std::vector<double> result;
  for (int i = 0; i < knots.count(); ++i)
    result.push_back(std::clamp(knots.greville(i), domain.lower, domain.upper));
  return result;
}

/// Mean, largest or smallest of the weights within the radius of every sample.
/// The mean is weighted by area times falloff, so that it does not depend on how the net is spaced.
/// Every pair of control points is compared, O(n²): n is a few thousand, and the command is given
/// by hand.
std::vector<double> spread(const std::vector<double>& mask, const BrushSamples& at,
                           MaskChange change, double radius) {
  std::vector<double> result(mask.size());
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    double sum = 0, total = 0, most = mask[i], least = mask[i];
    for (std::size_t j = 0; j < mask.size(); ++j) {
      const auto other = static_cast<Eigen::Index>(j);
      const double square = (at.points.row(row) - at.points.row(other)).squaredNorm();
      if (square >= radius * radius) continue;
      const double weight = brush_falloff(std::sqrt(square), radius, 0) * at.areas[other];
      sum += weight * mask[j];
      total += weight;
      most = std::max(most, mask[j]);
      least = std::min(least, mask[j]);
    }
    if (change == MaskChange::blur) {
      result[i] = total > 0 ? sum / total : mask[i];
    } else {
      result[i] = change == MaskChange::grow ? most : least;
    }
  }
  return result;
}

}  // namespace

std::vector<bool> masked_points(const SceneSurface& surface) {
  std::vector<bool> held;
  if (std::ranges::find(surface.mask, 1.) == surface.mask.end()) return held;
  for (double m : surface.mask) held.push_back(m == 1);
  return held;
}

Expected<Surface> mask_field(const SceneSurface& surface) {
  Points weights = Points::Zero(surface.current->size(), 3);
  for (Eigen::Index i = 0; i < weights.rows(); ++i)
    weights(i, 0) = surface.mask[static_cast<std::size_t>(i)];
  return surface.current->with_control_points(std::move(weights));
}

// Values at Greville abscissae are taken as coefficients: the variation-diminishing approximation
// of Schoenberg. It is not interpolation, but it never leaves [0, 1] and reproduces linear masks; a
// mask that interpolates would overshoot and hold points that nobody masked.
Expected<std::vector<double>> mask_on(const Surface& field, const Surface& shape) {
  const std::vector<double> us = greville_of(shape.knots(0)), vs = greville_of(shape.knots(1));
  const auto values =
      evaluate_grid<2>(field, {std::span<const double>(us), std::span<const double>(vs)}, 0);
  if (!values) return std::unexpected(values.error());
  std::vector<double> mask;
  for (Eigen::Index i = 0; i < values->points().rows(); ++i) {
    const double m = std::clamp(values->points()(i, 0), 0., 1.);
    // A weight of exactly 1 holds a control point, and must survive the rounding of an insertion.
    mask.push_back(m > 1 - insertion_error ? 1 : m < insertion_error ? 0 : m);
  }
  return mask;
}

Expected<void> change_mask(SceneSurface& surface, MaskChange change, double radius) {
  std::vector<double>& mask = surface.mask;
  if (change == MaskChange::clear) mask.clear();
  if (change == MaskChange::clear ||
      (mask.empty() && change != MaskChange::fill && change != MaskChange::invert)) {
    return {};
  }
  const auto count = static_cast<std::size_t>(surface.current->size());
  if (mask.empty()) mask.assign(count, 0);
  if (change == MaskChange::fill) {
    mask.assign(count, 1);
  } else if (change == MaskChange::invert) {
    for (double& m : mask) m = 1 - m;
  } else {
    const auto values = SiteValues<2>::create(*surface.current, Sites::chebyshev);
    if (!values) return std::unexpected(values.error());
    BrushSamples samples;
    if (auto status = samples.append(*surface.current, *values); !status) return status;
    mask = spread(mask, samples, change, radius);
  }
  if (std::ranges::all_of(mask, [](double m) { return m == 0; })) mask.clear();
  return {};
}

}  // namespace knead
