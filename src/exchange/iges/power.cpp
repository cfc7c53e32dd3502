#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry.hpp"

namespace knead::iges {
namespace {

// Entity 114: CTYPE, PTYPE, M, N, M + 1 and N + 1 breakpoints, and for each patch 16 coefficients
// of x, of y and of z, Σ p_ab s^a t^b with s and t from the patch's lower breakpoints. Each patch
// becomes Bézier, of degree 3 × 3, and patches share the control points at their common sides: a
// surface of 3 M + 1 by 3 N + 1 control points with triple knots. That is exact but for rounding
// whatever the smoothness between them; fewer knots would assume what the file does not say.
constexpr int most_patches = 1 << 22;
constexpr std::size_t coefficients = 16, per_patch = 3 * coefficients;

/// Control points of the polynomial Σ p_ab s^a t^b over 0 ≤ s ≤ width, 0 ≤ t ≤ height: entry a + 4
/// b.
std::array<double, coefficients> bezier(const double* p, double width, double height) {
  // c_k = Σ_a≤k binomial(k, a) / binomial(3, a) p_a h^a
  constexpr double share[4][4] = {
      {1, 0, 0, 0}, {1, 1.0 / 3, 0, 0}, {1, 2.0 / 3, 1.0 / 3, 0}, {1, 1, 1, 1}};
  std::array<double, coefficients> in_u{}, result{};
  const std::array<double, 4> u = {1, width, width * width, width * width * width},
                              v = {1, height, height * height, height * height * height};
  for (std::size_t b = 0; b < 4; ++b) {
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t a = 0; a <= k; ++a) in_u[k + 4 * b] += share[k][a] * p[a + 4 * b] * u[a];
    }
  }
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t b = 0; b <= k; ++b)
        result[a + 4 * k] += share[k][b] * in_u[a + 4 * b] * v[b];
    }
  }
  return result;
}

/// Triple inside, so that patches meet without smoothness that nothing promises.
Expected<KnotVector> knots_of(const std::vector<double>& breaks) {
  std::vector<double> knots = {breaks.front()};
  for (const double x : breaks) knots.insert(knots.end(), 3, x);
  knots.push_back(breaks.back());
  return KnotVector::create(3, std::move(knots));
}

}  // namespace

Expected<Surface> read_power_surface(const File& file, int number, const Eigen::Affine3d& move) {
  const auto parameters = file.parameters(number);
  if (!parameters) return std::unexpected(parameters.error());
  const auto head = numbers(file, number, *parameters, 1,
                            4);  // kind, whether patches are Cartesian products, M, N
  if (!head) return std::unexpected(head.error());
  const double rows = (*head)[2], columns = (*head)[3];
  if (!(rows >= 1 && columns >= 1 && rows * columns <= most_patches) || rows != std::floor(rows) ||
      columns != std::floor(columns)) {
    return file.error(number, "its number of patches is out of range");
  }
  const auto m = static_cast<std::size_t>(rows), n = static_cast<std::size_t>(columns);
  const auto u = numbers(file, number, *parameters, 5, m + 1),
             v = numbers(file, number, *parameters, 6 + m, n + 1);
  if (!u || !v) return std::unexpected(!u ? u.error() : v.error());
  // Of each row of patches, and of the last patch, an additional one without meaning.
  const std::size_t first = 7 + m + n, needed = per_patch * ((m - 1) * (n + 1) + n);
  const auto all = numbers(file, number, *parameters, first, needed);
  if (!all) return std::unexpected(all.error());
  auto in_u = knots_of(*u), in_v = knots_of(*v);
  if (!in_u || !in_v)
    return file.error(number,
                      "its breakpoints: " + (!in_u ? in_u.error() : in_v.error()).message());

  const auto across = static_cast<Eigen::Index>(3 * n + 1);
  Points points = Points::Constant(static_cast<Eigen::Index>(3 * m + 1) * across, 3, NAN);
  double apart = 0;
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const double* patch = &(*all)[per_patch * (i * (n + 1) + j)];
      for (std::size_t c = 0; c < 3; ++c) {
        const auto corner =
            bezier(patch + coefficients * c, (*u)[i + 1] - (*u)[i], (*v)[j + 1] - (*v)[j]);
        for (std::size_t k = 0; k < coefficients; ++k) {
          const auto row = static_cast<Eigen::Index>(3 * i + k % 4) * across +
                           static_cast<Eigen::Index>(3 * j + k / 4);
          double& x = points(row, static_cast<Eigen::Index>(c));
          // Up to four patches give the same point; the first is kept, and the distance of the
          // others is tested in the end.
          if (!std::isnan(x)) apart = std::max(apart, std::abs(x - corner[k]));
          if (std::isnan(x)) x = corner[k];
        }
      }
    }
  }
  const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
  if (apart > std::max(file.global().resolution, 1e-9 * size)) {
    return file.error(number,
                      fmt::format("its patches are {:.2g} apart where they should meet", apart));
  }
  for (Eigen::Index k = 0; k < points.rows(); ++k)
    points.row(k) = (move * Point(points.row(k).transpose())).transpose();
  auto surface = Surface::create({*std::move(in_u), *std::move(in_v)}, std::move(points));
  if (!surface) return file.error(number, surface.error().message());
  return surface;
}

}  // namespace knead::iges
