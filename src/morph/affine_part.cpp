#include "affine_part.hpp"

#include <algorithm>
#include <limits>

#include "base/decompositions.hpp"

namespace knead::morph {
namespace {

constexpr double least_extent = 1e-5;  // of the largest

/// The pseudoinverse of Σ w y yᵀ, without the directions in which there is no extent, or none
/// beyond this moment.
Expected<Eigen::Matrix3d> inverse_of_moments(const Eigen::Matrix3d& moments, double rounding) {
  const auto eigen = detail::symmetric_eigen<Eigen::MatrixXd>(moments);
  if (!eigen) return std::unexpected(eigen.error());
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  const double least = std::max(least_extent * least_extent * eigen->values[2], rounding);
  for (int k = 0; k < 3; ++k) {
    if (eigen->values[k] <= least) continue;
    result += eigen->vectors.col(k) * eigen->vectors.col(k).transpose() / eigen->values[k];
  }
  return result;
}

}  // namespace

// Both solves are by normal equations, whose error is the rounding of the data times the square of
// the ratio of extents, at most 1e10; what that leaves of affine data is affine itself, and the
// second solve takes it away.
Expected<AffinePart> best_affine(const Points& points, const Points& displacements,
                                 std::span<const double> weights) {
  AffinePart result;
  double total = 0;
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    const double w = weights[static_cast<std::size_t>(k)];
    result.centre += w * points.row(k).transpose();
    total += w;
  }
  if (!(total > 0)) return result;
  result.centre /= total;
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    const Point y = points.row(k).transpose() - result.centre;
    moments += weights[static_cast<std::size_t>(k)] * y * y.transpose();
  }
  const double rounding =
      16 * std::numeric_limits<double>::epsilon() * points.cwiseAbs().maxCoeff();
  const auto inverse = inverse_of_moments(moments, total * rounding * rounding);
  if (!inverse) return std::unexpected(inverse.error());
  for (int solve = 0; solve < 2; ++solve) {
    Eigen::Matrix3d mixed = Eigen::Matrix3d::Zero();
    Point mean = Point::Zero();
    for (Eigen::Index k = 0; k < points.rows(); ++k) {
      const double w = weights[static_cast<std::size_t>(k)];
      const Point x = points.row(k).transpose();
      const Point rest = displacements.row(k).transpose() - result.at(x);
      mean += w * rest;
      mixed += w * rest * (x - result.centre).transpose();
    }
    result.shift += mean / total;
    result.linear += mixed * *inverse;
  }
  return result;
}

}  // namespace knead::morph
