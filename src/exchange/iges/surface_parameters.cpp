#include "surface_parameters.hpp"

#include <bit>

#include "exchange/part21/part21_text.hpp"
#include "geometry.hpp"
#include "model.hpp"
#include "text.hpp"

namespace knead::iges {
namespace {

bool same_number(const std::string& text, double value) {
  const auto old = real(text);
  return old && std::bit_cast<std::uint64_t>(*old) == std::bit_cast<std::uint64_t>(value);
}

/// The number as it stands at this place, or with 17 digits.
std::string value_at(const std::vector<std::string>& old, std::size_t at, double value) {
  return at < old.size() && same_number(old[at], value) ? old[at] : format_real(value);
}

/// The parameters of an entity with another surface.
Expected<std::vector<std::string>> values_of(const File& file, int number, const Surface& s,
                                             const Parameters& parameters) {
  const auto at = surface_layout(file, number, parameters);
  const auto outer = outer_transform(file, number);
  const auto transform = transform_of(file, number);
  if (!at || !outer || !transform)
    return std::unexpected(!at ? at.error() : !outer ? outer.error() : transform.error());
  const Eigen::Affine3d move = *outer * *transform, back = move.inverse();
  const auto before = read_surface(file, number, *outer);
  if (!before) return std::unexpected(before.error());
  const bool still = move.matrix().isIdentity(0);
  const auto [m, n] = s.net();
  const std::vector<std::string>& old = parameters.values;
  const bool same_net = s.net() == before->net();

  std::vector<std::string> result = {old[0]};
  const auto integer_at = [&](std::size_t k, int value) {
    return integer(old[k]) == value ? old[k] : std::to_string(value);
  };
  result.push_back(integer_at(1, m - 1));
  result.push_back(integer_at(2, n - 1));
  for (const std::size_t d : {0U, 1U}) result.push_back(integer_at(3 + d, s.knots()[d].degree()));
  for (std::size_t k = 5; k < 10; ++k) result.push_back(old[k]);
  if (s.rational()) result[7] = integer_at(7, 0);
  for (const std::size_t d : {0U, 1U}) {
    const bool same_count = s.knots()[d].knots().size() == before->knots()[d].knots().size();
    std::size_t k = same_count ? at->knots[d] : old.size();
    for (const double x : s.knots()[d].knots()) result.push_back(value_at(old, k++, x));
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < m; ++i) {
      const std::size_t place = at->weights + (same_net ? static_cast<std::size_t>(i + m * j) : 0);
      result.push_back(
          !s.rational() ? old[place]
                        : value_at(old, place, s.weights()[static_cast<std::size_t>(i * n + j)]));
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < m; ++i) {
      const Point p = s.control_points().row(i * n + j).transpose();
      const std::size_t place =
          same_net ? at->points + 3 * static_cast<std::size_t>(i + m * j) : old.size();
      const bool kept =
          same_net && !still && p == Point(before->control_points().row(i * n + j).transpose());
      const Point q = still ? p : Point(back * p);
      for (std::size_t c = 0; c < 3; ++c) {
        result.push_back(kept ? old[place + c]
                              : value_at(old, place + c, q[static_cast<Eigen::Index>(c)]));
      }
    }
  }
  for (std::size_t k = at->domain; k < old.size(); ++k) result.push_back(old[k]);
  return result;
}

/// One after the last parameter that describes a surface of this type, which may become a B-spline
/// surface; 0: it may not. Form 1 of 190 to 198 has a reference direction. Behind it are pointers
/// to associativities and properties.
std::size_t end_of_surface(const File& file, int number, const Parameters& parameters) {
  const Entity& entity = *file.find(number);
  const std::size_t reference = entity.form == 1 ? 1 : 0;
  switch (entity.type) {
    case 108:
      return 10;
    case 114: {
      const auto m = integer(parameters.values[3]).value_or(0),
                 n = integer(parameters.values[4]).value_or(0);
      return 7 + static_cast<std::size_t>(m + n) +
             std::size_t{48} * static_cast<std::size_t>(m + 1) * static_cast<std::size_t>(n + 1);
    }
    case 118:
    case 120:
    case 122:
      return 5;
    case 190:
      return 3 + reference;
    case 192:
      return 4 + reference;
    case 194:
    case 198:
      return 5 + reference;
    case 196:
      return 3 + 2 * reference;
    default:
      return 0;
  }
}

/// The parameters that make a surface of another type a B-spline surface (128), with what others
/// add to them.
Expected<std::vector<std::string>> spline_values(const File& file, int number,
                                                 const Surface& surface,
                                                 const Parameters& parameters) {
  const auto outer = outer_transform(file, number);
  const auto transform = transform_of(file, number);
  if (!outer || !transform) return std::unexpected(!outer ? outer.error() : transform.error());
  const Eigen::Affine3d move = *outer * *transform, back = move.inverse();
  Points points = surface.control_points();
  if (!move.matrix().isIdentity(0)) {
    for (Eigen::Index k = 0; k < points.rows(); ++k)
      points.row(k) = (back * Point(points.row(k).transpose())).transpose();
  }
  const auto moved = surface.with_control_points(points);
  if (!moved) return std::unexpected(moved.error());
  std::vector<std::string> values = surface_values(*moved);
  values.insert(values.begin(), "128");
  for (std::size_t k = end_of_surface(file, number, parameters); k < parameters.values.size(); ++k)
    values.push_back(parameters.values[k]);
  return values;
}

}  // namespace

Expected<std::vector<std::string>> surface_values(const File& file, int number,
                                                  const Surface& surface,
                                                  const Parameters& parameters) {
  if (file.find(number)->type == 128) return values_of(file, number, surface, parameters);
  if (end_of_surface(file, number, parameters) == 0)
    return file.error(number, "it is no surface that can become a B-spline surface");
  return spline_values(file, number, surface, parameters);
}

}  // namespace knead::iges
