#include "geometry.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace knead::iges {
namespace {

constexpr int max_matrix_nesting = 8;
constexpr int max_control_points = 1 << 28;

/// `count` parameters from `first` on, each by `read`, which says nothing where a parameter is not
/// `what`.
template <class T>
Expected<std::vector<T>> values(const File& file, int number, const Parameters& parameters,
                                std::size_t first, std::size_t count,
                                std::optional<T> (*read)(std::string_view), std::string_view what) {
  if (parameters.values.size() < first + count)
    return file.error(number, "parameters are missing", "get the whole file");
  std::vector<T> result;
  result.reserve(count);
  for (std::size_t k = first; k < first + count; ++k) {
    const auto value = read(parameters.values[k]);
    if (!value)
      return file.error(number, fmt::format("parameter {} is not {}", k, what), "correct it");
    result.push_back(*value);
  }
  return result;
}

Expected<std::vector<int>> integers(const File& file, int number, const Parameters& parameters,
                                    std::size_t first, std::size_t count) {
  return values<int>(file, number, parameters, first, count, integer, "an integer");
}

/// Checks degrees and counts of one direction: K is the upper index of the control points.
bool fits(int upper, int degree) {
  return degree >= 1 && degree <= max_control_points && upper >= degree &&
         upper < max_control_points;
}

Expected<KnotVector> knots_of(const File& file, int number, const Parameters& parameters,
                              const SplineLayout& at, std::size_t direction) {
  const auto count = static_cast<std::size_t>(at.count[direction] + at.degree[direction] + 1);
  auto values = numbers(file, number, parameters, at.knots[direction], count);
  if (!values) return std::unexpected(std::move(values.error()));
  auto knots = KnotVector::create(at.degree[direction], *std::move(values));
  if (!knots) return file.error(number, "its knots: " + knots.error().message());
  return knots;
}

/// None where all are equal.
std::vector<double> weights_of(const std::vector<double>& all, std::array<int, 2> count) {
  if (std::ranges::all_of(all, [&](double w) { return w == all.front(); }) && all.front() > 0)
    return {};
  std::vector<double> result;
  for (int i = 0; i < count[0]; ++i) {
    for (int j = 0; j < count[1]; ++j)
      result.push_back(all[static_cast<std::size_t>(i + count[0] * j)]);
  }
  return result;
}

Points points_of(const std::vector<double>& all, std::array<int, 2> count,
                 const Eigen::Affine3d& move) {
  Points result(count[0] * count[1], 3);
  const bool still = move.matrix().isIdentity(0);
  for (int i = 0; i < count[0]; ++i) {
    for (int j = 0; j < count[1]; ++j) {
      const double* p = &all[3 * static_cast<std::size_t>(i + count[0] * j)];
      const Point point(p[0], p[1], p[2]);
      result.row(i * count[1] + j) = (still ? point : Point(move * point)).transpose();
    }
  }
  return result;
}

Expected<Eigen::Affine3d> with_matrices(const File& file, int number,
                                        const Eigen::Affine3d& outer) {
  const auto transform = transform_of(file, number);
  if (!transform) return std::unexpected(transform.error());
  return Eigen::Affine3d(outer * *transform);
}

}  // namespace

Expected<std::vector<double>> numbers(const File& file, int number, const Parameters& parameters,
                                      std::size_t first, std::size_t count) {
  return values<double>(file, number, parameters, first, count, real,
                        "a number that a double can hold");
}

// Entity 128: K1, K2, M1, M2, PROP1-5, K1 + M1 + 2 and K2 + M2 + 2 knots, weights, points, U0, U1,
// V0, V1. The flags (closed, polynomial, periodic) are not believed: all follow from the numbers.
Expected<SplineLayout> surface_layout(const File& file, int number, const Parameters& parameters) {
  const auto head = integers(file, number, parameters, 1, 4);  // K1, K2, M1, M2
  if (!head) return std::unexpected(head.error());
  SplineLayout at;
  for (std::size_t d = 0; d < 2; ++d) {
    at.count[d] = (*head)[d] + 1;
    at.degree[d] = (*head)[d + 2];
    if (!fits((*head)[d], at.degree[d])) {
      return file.error(number, "a degree or a number of control points is out of range");
    }
  }
  if (at.count[0] > max_control_points / at.count[1])
    return file.error(number, "it has too many control points");
  const auto n = static_cast<std::size_t>(at.count[0]) * static_cast<std::size_t>(at.count[1]);
  at.knots[0] = 10;  // after five flags
  at.knots[1] = at.knots[0] + static_cast<std::size_t>(at.count[0] + at.degree[0] + 1);
  at.weights = at.knots[1] + static_cast<std::size_t>(at.count[1] + at.degree[1] + 1);
  at.points = at.weights + n;
  at.domain = at.points + 3 * n;
  at.end = at.domain + 4;
  if (parameters.values.size() < at.domain)
    return file.error(number, "parameters are missing", "get the whole file");
  return at;
}

Expected<SplineLayout> curve_layout(const File& file, int number, const Parameters& parameters) {
  const auto head = integers(file, number, parameters, 1, 2);  // K, M
  if (!head) return std::unexpected(head.error());
  if (!fits((*head)[0], (*head)[1]))
    return file.error(number, "a degree or a number of control points is out of range");
  SplineLayout at;
  at.degree[0] = (*head)[1];
  at.count[0] = (*head)[0] + 1;
  const auto n = static_cast<std::size_t>(at.count[0]);
  at.knots[0] = 7;
  at.weights = at.knots[0] + n + static_cast<std::size_t>(at.degree[0]) + 1;
  at.points = at.weights + n;
  at.domain = at.points + 3 * n;
  at.end = at.domain + 2;
  if (parameters.values.size() < at.domain)
    return file.error(number, "parameters are missing", "get the whole file");
  return at;
}

// Entity 124: R11, R12, R13, T1, R21, …; a matrix may have one of its own, which is applied after
// it. The standard asks for rotations and reflections (forms 0 and 1); files scale by them, too, so
// that only singular ones are refused.
Expected<Eigen::Affine3d> transform_of(const File& file, int number) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  const Entity* entity = file.find(number);
  for (int depth = 0; entity != nullptr && entity->transform != 0; ++depth) {
    const int matrix = entity->transform;
    entity = file.find(matrix);
    if (depth == max_matrix_nesting || entity == nullptr || entity->type != 124) {
      return file.error(number, "its transformation matrix cannot be followed");
    }
    const auto parameters = file.parameters(matrix);
    if (!parameters) return std::unexpected(parameters.error());
    const auto rows = numbers(file, matrix, *parameters, 1, 12);
    if (!rows) return std::unexpected(rows.error());
    Eigen::Affine3d place = Eigen::Affine3d::Identity();
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 4; ++k)
        place.matrix()(i, k) = (*rows)[static_cast<std::size_t>(4 * i + k)];
    }
    const bool small = place.matrix().cwiseAbs().maxCoeff() <= largest_number;
    if (!place.matrix().allFinite() || !small ||
        !(std::abs(place.linear().determinant()) > 1e-12)) {
      return file.error(matrix, "its numbers are not those of a transformation");
    }
    result = place * result;
  }
  return result;
}

Expected<Surface> read_surface(const File& file, int number, const Eigen::Affine3d& outer) {
  const auto parameters = file.parameters(number);
  if (!parameters) return std::unexpected(parameters.error());
  const auto move = with_matrices(file, number, outer);
  if (!move) return std::unexpected(move.error());
  if (file.find(number)->type == 114) return read_power_surface(file, number, *move);
  if (file.find(number)->type == 118) return read_ruled_surface(file, number, *move);
  const auto at = surface_layout(file, number, *parameters);
  if (!at) return std::unexpected(at.error());
  auto u = knots_of(file, number, *parameters, *at, 0),
       v = knots_of(file, number, *parameters, *at, 1);
  if (!u || !v) return std::unexpected(!u ? u.error() : v.error());
  const auto n = at->points - at->weights;
  const auto weights = numbers(file, number, *parameters, at->weights, n);
  const auto points = numbers(file, number, *parameters, at->points, 3 * n);
  if (!weights || !points) return std::unexpected(!weights ? weights.error() : points.error());
  auto surface =
      Surface::create({*std::move(u), *std::move(v)}, points_of(*points, at->count, *move),
                      weights_of(*weights, at->count));
  if (!surface) return file.error(number, surface.error().message());
  return surface;
}

Expected<Curve> read_curve(const File& file, int number, const Eigen::Affine3d& outer) {
  const auto parameters = file.parameters(number);
  if (!parameters) return std::unexpected(parameters.error());
  const auto at = curve_layout(file, number, *parameters);
  if (!at) return std::unexpected(at.error());
  const auto move = with_matrices(file, number, outer);
  if (!move) return std::unexpected(move.error());
  auto knots = knots_of(file, number, *parameters, *at, 0);
  if (!knots) return std::unexpected(knots.error());
  const auto n = static_cast<std::size_t>(at->count[0]);
  const auto weights = numbers(file, number, *parameters, at->weights, n);
  const auto points = numbers(file, number, *parameters, at->points, 3 * n);
  if (!weights || !points) return std::unexpected(!weights ? weights.error() : points.error());
  const std::array<int, 2> count = {at->count[0], 1};
  auto curve = Curve::create({*std::move(knots)}, points_of(*points, count, *move),
                             weights_of(*weights, count));
  if (!curve) return file.error(number, curve.error().message());
  return curve;
}

}  // namespace knead::iges
