#include "scan.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/decompositions.hpp"
#include "base/parallel_for.hpp"
#include "spline/box_tree.hpp"

namespace knead::morph {
namespace {

constexpr double neighbour_work = 1e4;  // multiplications, of one search and a fit

BoxTree tree_of(std::span<const Point> points) {
  std::vector<Eigen::AlignedBox3d> boxes;
  boxes.reserve(points.size());
  for (const Point& p : points) boxes.emplace_back(p);
  return BoxTree(boxes);
}

/// The `count` points nearest to x, by distance and number.
std::vector<std::uint32_t> nearest(const BoxTree& tree, std::span<const Point> points,
                                   const Point& x, std::size_t count) {
  std::vector<std::pair<double, std::uint32_t>> best;
  double within = std::numeric_limits<double>::infinity();
  tree.near(x, within, [&](std::uint32_t k) {
    const std::pair candidate((points[k] - x).norm(), k);
    if (best.size() == count && !(candidate < best.back())) return;
    if (best.size() == count) best.pop_back();
    best.insert(std::ranges::upper_bound(best, candidate), candidate);
    // Points at the same distance are told apart by their numbers: they have to be seen.
    if (best.size() == count)
      within = std::nextafter(best.back().first, std::numeric_limits<double>::infinity());
  });
  std::vector<std::uint32_t> result;
  for (const auto& [distance, k] : best) result.push_back(k);
  return result;
}

/// Axes of points: those along which they extend least, more and most, as columns.
Eigen::Matrix3d axes_of(std::span<const Point> points, std::span<const std::uint32_t> numbers,
                        Point& centre) {
  centre.setZero();
  for (const auto k : numbers) centre += points[k] / static_cast<double>(numbers.size());
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const auto k : numbers) moments += (points[k] - centre) * (points[k] - centre).transpose();
  // Squares of huge coordinates may not be finite: any axes are as good then.
  const auto axes = detail::symmetric_eigen(moments);
  return axes ? axes->vectors : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

template <class Body>
void for_each(std::size_t count, const Body& body) {
  const auto n = static_cast<std::ptrdiff_t>(count);
  detail::parallel_for(
      n, detail::block_size(n, neighbour_work), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
          body(k);
      });
}

std::vector<Point> normals_of_triangles(std::span<const Point> points,
                                        std::span<const std::array<std::uint32_t, 3>> triangles) {
  std::vector<Point> result(points.size(), Point::Zero());
  std::vector<Point> facets;
  facets.reserve(triangles.size());
  for (const auto& t : triangles) {
    assert(std::ranges::all_of(t, [&](std::uint32_t k) { return k < points.size(); }));
    facets.push_back((points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]));
    for (const auto k : t) result[k] += facets.back();
  }
  std::vector<bool> apart(points.size());
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    for (const auto corner : triangles[k]) {
      const double both = facets[k].norm() * result[corner].norm();
      if (facets[k].dot(result[corner]) < std::numbers::sqrt2 / 2 * both) apart[corner] = true;
    }
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double length = result[k].norm();
    result[k] = length > 0 && !apart[k] ? Point(result[k] / length) : Point::Zero();
  }
  return result;
}

std::vector<Point> normals_of_neighbours(std::span<const Point> points) {
  constexpr std::size_t count = 12, least = 3;
  std::vector<Point> result(points.size(), Point::Zero());
  if (points.size() < least) return result;
  const BoxTree tree = tree_of(points);
  for_each(points.size(), [&](std::size_t k) {
    Point centre;
    result[k] = axes_of(points, nearest(tree, points, points[k], count), centre).col(0);
  });
  return result;
}

constexpr std::size_t most_sampled = 4000;
constexpr std::size_t neighbours = 20;  // and twice as many
constexpr Eigen::Index coefficients = 10;

/// √(Σ r² / (k − 10)) of the residuals r of the best cubic over the plane of these points.
double roughness(std::span<const Point> points, std::span<const std::uint32_t> numbers) {
  Point centre;
  const Eigen::Matrix3d axes = axes_of(points, numbers, centre);
  const auto n = static_cast<Eigen::Index>(numbers.size());
  Eigen::MatrixXd powers(n, coefficients);
  Eigen::VectorXd heights(n);
  double extent = 0;
  for (const auto k : numbers) extent = std::max(extent, (points[k] - centre).norm());
  if (!(extent > 0)) return 0;
  for (Eigen::Index row = 0; row < n; ++row) {
    const Point local =
        axes.transpose() * (points[numbers[static_cast<std::size_t>(row)]] - centre);
    const double x = local[2] / extent, y = local[1] / extent;
    heights[row] = local[0];
    powers.row(row) << 1, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
  }
  const auto cubic = detail::least_squares(powers, heights);
  if (!cubic) return 0;
  const Eigen::VectorXd rest = heights - powers * *cubic;
  return std::sqrt(rest.squaredNorm() / static_cast<double>(n - coefficients));
}

}  // namespace

Scan scan_of(std::vector<Point> points, std::vector<Point> normals,
             std::span<const std::array<std::uint32_t, 3>> triangles) {
  if (normals.size() == points.size()) {
    for (Point& n : normals) {
      const double length = n.norm();
      n = length > 0 && std::isfinite(length) ? Point(n / length) : Point::Zero();
    }
  } else {
    normals =
        triangles.empty() ? normals_of_neighbours(points) : normals_of_triangles(points, triangles);
  }
  return {std::move(points), std::move(normals)};
}

std::vector<std::array<std::uint32_t, 2>> neighbour_pairs(std::span<const Point> points) {
  if (points.size() < 2) return {};
  const BoxTree tree = tree_of(points);
  const std::size_t step = (points.size() + most_sampled - 1) / most_sampled;
  std::vector<std::array<std::uint32_t, 2>> result((points.size() + step - 1) / step);
  for_each(result.size(), [&](std::size_t k) {
    const auto own = static_cast<std::uint32_t>(k * step);
    const auto around = nearest(tree, points, points[own], 2);
    result[k] = {own, around[0] == own ? around[1] : around[0]};
  });
  return result;
}

double estimated_noise(std::span<const Point> points) {
  if (points.size() < 2 * neighbours) return 0;
  const BoxTree tree = tree_of(points);
  const std::size_t step = (points.size() + most_sampled - 1) / most_sampled;
  std::array<std::vector<double>, 2> deviations;  // of the smaller and the larger surroundings
  for (auto& each : deviations) each.resize((points.size() + step - 1) / step);
  for_each(deviations[0].size(), [&](std::size_t k) {
    const auto around = nearest(tree, points, points[k * step], 2 * neighbours);
    deviations[0][k] = roughness(points, std::span(around).first(neighbours));
    deviations[1][k] = roughness(points, around);
  });
  std::array<double, 2> squares{};
  for (std::size_t size = 0; size < 2; ++size) {
    auto& each = deviations[size];
    const auto middle = each.begin() + static_cast<std::ptrdiff_t>(each.size() / 2);
    std::nth_element(each.begin(), middle, each.end());
    const double freedom = static_cast<double>((size + 1) * neighbours) - coefficients;
    squares[size] = *middle * *middle / std::pow(1 - 2 / (9 * freedom), 3);
  }
  // s² = σ² + τ², τ the part of the fourth order, which goes with the square of the area: with
  // twice the points it is 16 τ².
  return std::sqrt(std::max(0.0, (16 * squares[0] - squares[1]) / 15));
}

std::vector<std::size_t> thinned(std::span<const Point> points, double side) {
  assert(side > 0);
  std::vector<std::pair<std::array<double, 3>, std::size_t>> cubes;
  cubes.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point cube = (points[k] / side).array().floor();
    cubes.push_back({{cube.x(), cube.y(), cube.z()}, k});
  }
  std::ranges::sort(cubes);
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < cubes.size(); ++k) {
    if (k == 0 || cubes[k].first != cubes[k - 1].first) result.push_back(cubes[k].second);
  }
  std::ranges::sort(result);
  return result;
}

}  // namespace knead::morph
