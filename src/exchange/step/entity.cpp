#include "entity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "exchange/part21/part21_text.hpp"

namespace knead::step {

std::string Reader::label(std::uint32_t instance) const {
  const auto& record = file_->instance(instance);
  return "#" + std::to_string(record.id) + " " + std::string(file_->keyword(record.first));
}

std::optional<std::uint32_t> Reader::part(std::uint32_t instance, std::string_view entity) const {
  const auto& record = file_->instance(instance);
  for (auto k = record.first; k < record.last; k = file_->value(k).next) {
    if (file_->is_named(k, entity)) return k;
  }
  return std::nullopt;
}

std::vector<std::uint32_t> Reader::attributes(std::uint32_t instance, std::string_view entity,
                                              std::size_t inherited, std::size_t count) const {
  const auto& record = file_->instance(instance);
  std::vector<std::uint32_t> result;
  if (record.complex) {
    if (const auto found = part(instance, entity)) result = file_->children(*found);
  } else {
    result = file_->children(record.first);
    if (result.size() < inherited) return {};
    result.erase(result.begin(), result.begin() + static_cast<std::ptrdiff_t>(inherited));
  }
  return result.size() < count ? std::vector<std::uint32_t>{} : result;
}

std::optional<double> Reader::real(std::uint32_t value) const {
  const auto kind = file_->kind(value);
  if (kind != Part21Kind::real && kind != Part21Kind::integer) return std::nullopt;
  return parse_real(file_->text(value));
}

// Larger numbers are refused here, once: squares and products of three, as in normals and volumes,
// would overflow everywhere else.
std::optional<double> Reader::length(std::uint32_t value) const {
  const auto read = real(value);
  return read && std::abs(*read) <= largest_number ? read : std::nullopt;
}

std::optional<int> Reader::integer(std::uint32_t value) const {
  if (file_->kind(value) != Part21Kind::integer) return std::nullopt;
  auto text = file_->text(value);
  if (text.starts_with('+')) text.remove_prefix(1);
  int result = 0;
  const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), result);
  return error == std::errc() && last == text.data() + text.size() ? std::optional(result)
                                                                   : std::nullopt;
}

std::vector<std::uint32_t> Reader::references(std::uint32_t list) const {
  std::vector<std::uint32_t> result;
  if (!is_list(list)) return result;
  for (const auto value : file_->children(list)) {
    if (const auto instance = reference(value)) result.push_back(*instance);
  }
  return result;
}

std::string Reader::string(std::uint32_t value) const {
  return file_->kind(value) == Part21Kind::string ? decode_string(file_->text(value))
                                                  : std::string();
}

std::string_view Reader::enumeration(std::uint32_t value) const {
  const auto text = file_->text(value);
  return file_->kind(value) == Part21Kind::enumeration ? text.substr(1, text.size() - 2)
                                                       : std::string_view();
}

std::string Reader::item_name(std::uint32_t instance) const {
  const auto values = attributes(instance, "REPRESENTATION_ITEM", 0, 1);
  return values.empty() ? std::string() : string(values[0]);
}

// Without a list of the children: most records of a file are points, and this is the inner loop of
// reading.
Expected<std::array<std::uint32_t, 3>> Reader::coordinate_values(std::uint32_t instance) const {
  if (!is(instance, "CARTESIAN_POINT")) return error(instance, "a CARTESIAN_POINT is needed here");
  const auto& record = file_->instance(instance);
  const auto found =
      record.complex ? part(instance, "CARTESIAN_POINT") : std::optional(record.first);
  const std::size_t inherited = record.complex ? 0 : 1;
  std::size_t count = 0;
  const auto lists = file_->first_children<2>(*found, count);
  if (count <= inherited || !is_list(lists[inherited]))
    return error(instance, "it has no list of coordinates");
  const auto coordinates = file_->first_children<3>(lists[inherited], count);
  if (count != 3) {
    return error(instance, "it has " + std::to_string(count) + " coordinates",
                 "a control point of a surface has 3");
  }
  return coordinates;
}

/// Radians per unit of plane angles, of all contexts that have units.
Expected<double> Reader::angle_unit(std::uint32_t instance) const {
  if (angle_units_.empty()) {
    for (const auto k : file_->named({"GLOBAL_UNIT_ASSIGNED_CONTEXT"})) {
      const auto context = attributes(k, "GLOBAL_UNIT_ASSIGNED_CONTEXT", 0, 1);
      if (!file_->instance(k).complex || context.empty()) continue;
      for (const std::uint32_t unit : references(context[0])) {
        if (!is(unit, "PLANE_ANGLE_UNIT")) continue;
        double radians = 1;
        if (const auto values = attributes(unit, "CONVERSION_BASED_UNIT", 1, 2); !values.empty()) {
          const auto measure = reference(values[1]);
          const auto value = measure ? attributes(*measure, "MEASURE_WITH_UNIT", 0, 2)
                                     : std::vector<std::uint32_t>();
          if (value.empty() || file_->kind(value[0]) != Part21Kind::typed) continue;
          const auto inner = file_->children(value[0]);
          radians = inner.empty() ? 0 : real(inner[0]).value_or(0);
        }
        if (radians > 0 && std::ranges::find(angle_units_, radians) == angle_units_.end())
          angle_units_.push_back(radians);
      }
    }
    if (angle_units_.empty()) angle_units_.push_back(1);
  }
  if (angle_units_.size() == 1) return angle_units_.front();
  return error(instance, "its angles may be in several units", "give the file one unit of angles");
}

Expected<double> Reader::coordinate(std::uint32_t instance, std::uint32_t value,
                                    std::size_t k) const {
  const auto read = real(value);
  if (!read)
    return error(instance, fmt::format("coordinate {} is not a number a double can hold", k));
  if (std::abs(*read) <= largest_number) return *read;
  return error(
      instance, fmt::format("coordinate {} is {}, which is too large", k, *read),
      fmt::format("correct it, or use a unit of length in which it is at most {}", largest_number));
}

/// CYLINDRICAL_POINT(name, *, r, theta, z) and SPHERICAL_POINT(name, *, r, theta, phi): the
/// coordinates are derived.
Expected<Point> Reader::curved_point(std::uint32_t instance) const {
  const bool cylindrical = is(instance, "CYLINDRICAL_POINT");
  const auto values =
      attributes(instance, cylindrical ? "CYLINDRICAL_POINT" : "SPHERICAL_POINT", 2, 3);
  if (values.empty()) return error(instance, "it has no three coordinates");
  std::array<double, 3> v{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto value = coordinate(instance, values[k], k);
    if (!value) return std::unexpected(value.error());
    v[k] = *value;
  }
  const auto unit = angle_unit(instance);
  if (!unit) return std::unexpected(unit.error());
  const double theta = v[1] * *unit;
  if (cylindrical) return Point(v[0] * std::cos(theta), v[0] * std::sin(theta), v[2]);
  const double phi = v[2] * *unit;  // theta from the z axis, phi around it
  return Point(v[0] * std::sin(theta) * std::cos(phi), v[0] * std::sin(theta) * std::sin(phi),
               v[0] * std::cos(theta));
}

Expected<Point> Reader::point_in_parameters(std::uint32_t instance) const {
  const auto values = attributes(instance, "CARTESIAN_POINT", 1, 1);
  if (!is(instance, "CARTESIAN_POINT") || values.empty() || !is_list(values[0]) ||
      file_->children(values[0]).size() != 2)
    return error(instance, "a CARTESIAN_POINT with 2 coordinates is needed here");
  Point result = Point::Zero();
  for (std::size_t k = 0; k < 2; ++k) {
    const auto value = coordinate(instance, file_->children(values[0])[k], k);
    if (!value) return std::unexpected(value.error());
    result[static_cast<Eigen::Index>(k)] = *value;
  }
  return result;
}

Expected<Point> Reader::point(std::uint32_t instance) const {
  if (is_in_parameters()) return point_in_parameters(instance);
  if (is(instance, "CYLINDRICAL_POINT") || is(instance, "SPHERICAL_POINT"))
    return curved_point(instance);
  if (is(instance, "POLAR_POINT")) {
    return error(instance, "a point of a plane where one in space is needed",
                 "write its coordinates as x, y, z");
  }
  const auto values = coordinate_values(instance);
  if (!values) return std::unexpected(values.error());
  Point result;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto value = coordinate(instance, (*values)[k], k);
    if (!value) return std::unexpected(value.error());
    result[static_cast<Eigen::Index>(k)] = *value;
  }
  return result;
}

std::optional<Point> Reader::direction(std::uint32_t instance) const {
  const auto values = attributes(instance, "DIRECTION", 1, 1);
  if (!is(instance, "DIRECTION") || values.empty() || !is_list(values[0])) return std::nullopt;
  const auto ratios = file_->children(values[0]);
  if (ratios.size() != coordinates_) return std::nullopt;
  Point result = Point::Zero();
  for (std::size_t k = 0; k < coordinates_; ++k) {
    const auto ratio = real(ratios[k]);
    if (!ratio) return std::nullopt;
    result[static_cast<Eigen::Index>(k)] = *ratio;
  }
  // Its length means nothing, but must have a square.
  const double largest = result.cwiseAbs().maxCoeff();
  const bool extreme = largest > largest_number || (largest > 0 && largest < 1 / largest_number);
  return extreme ? Point(result / largest) : result;
}

std::unexpected<Error> Reader::error(std::uint32_t instance, std::string what,
                                     std::string remedy) const {
  return std::unexpected(Error{ErrorKind::input, std::move(what), label(instance),
                               std::move(remedy), file_->name(),
                               file_->line(file_->instance(instance).bytes.begin)});
}

}  // namespace knead::step
