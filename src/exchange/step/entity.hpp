#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exchange/part21/part21.hpp"
#include "knead/base/error.hpp"
#include "knead/spline/spline.hpp"

namespace knead::step {

/// Reads the attributes of entities: the layer between parameters (part21.hpp) and geometry.
///
/// An entity type is found by name both in a simple record and in the parts of a complex one. In a
/// simple record the attributes of the supertypes come first (ISO 10303-21, 10.2.5.2); so an
/// attribute is specified by the entity that declares it, the number of inherited attributes before
/// those, and its place among them.
class Reader {
 public:
  explicit Reader(const Part21File& file) : file_(&file) {}

  [[nodiscard]] const Part21File& file() const { return *file_; }

  /// Reads points and directions of two coordinates, with z = 0: those of curves in the parameters
  /// of a surface.
  [[nodiscard]] Reader in_parameters() const {
    Reader result(*this);
    result.coordinates_ = 2;
    return result;
  }
  [[nodiscard]] bool is_in_parameters() const { return coordinates_ == 2; }

  /// "#12 CARTESIAN_POINT"
  [[nodiscard]] std::string label(std::uint32_t instance) const;
  /// The part of the instance (a value of kind `typed`) with this name.
  [[nodiscard]] std::optional<std::uint32_t> part(std::uint32_t instance,
                                                  std::string_view entity) const;
  /// Whether some part of the instance has this name.
  [[nodiscard]] bool is(std::uint32_t instance, std::string_view entity) const {
    return part(instance, entity).has_value();
  }

  /// The attributes that `entity` itself declares: in a complex instance the parameters of that
  /// part; in a simple one those after the first `inherited` ones. Empty if there are fewer than
  /// `count`.
  [[nodiscard]] std::vector<std::uint32_t> attributes(std::uint32_t instance,
                                                      std::string_view entity,
                                                      std::size_t inherited,
                                                      std::size_t count) const;
  /// All parameters of a simple instance; those of the part with this name of a complex one.
  [[nodiscard]] std::vector<std::uint32_t> parameters(std::uint32_t instance,
                                                      std::string_view entity) const {
    return attributes(instance, entity, 0, 0);
  }

  [[nodiscard]] std::optional<double> real(std::uint32_t value) const;
  /// A number of at most `largest_number`, of whose products with others none overflows.
  [[nodiscard]] std::optional<double> length(std::uint32_t value) const;
  [[nodiscard]] std::optional<int> integer(std::uint32_t value) const;
  /// Index of the instance referred to; none for anything but a reference within the file.
  [[nodiscard]] std::optional<std::uint32_t> reference(std::uint32_t value) const {
    const auto target = file_->target(value);
    return target == no_instance ? std::nullopt : std::optional(target);
  }
  /// The instances in a list of references; other values are omitted.
  [[nodiscard]] std::vector<std::uint32_t> references(std::uint32_t list) const;
  [[nodiscard]] std::string string(std::uint32_t value) const;            ///< decoded; empty for $
  [[nodiscard]] std::string_view enumeration(std::uint32_t value) const;  ///< without its dots
  [[nodiscard]] bool is_list(std::uint32_t value) const {
    return file_->kind(value) == Part21Kind::list;
  }

  /// Label of a REPRESENTATION_ITEM: the first parameter of a simple record.
  [[nodiscard]] std::string item_name(std::uint32_t instance) const;

  /// The values of the coordinates of a CARTESIAN_POINT with three of them.
  [[nodiscard]] Expected<std::array<std::uint32_t, 3>> coordinate_values(
      std::uint32_t instance) const;
  /// Of a CARTESIAN_POINT, CYLINDRICAL_POINT or SPHERICAL_POINT (ISO 10303-42); angles are in the
  /// unit of the contexts. Errors (input): another entity, a POLAR_POINT, which lies in a plane;
  /// numbers that are none or above `largest_number`; contexts with several units of angles where
  /// one is needed.
  [[nodiscard]] Expected<Point> point(std::uint32_t instance) const;
  [[nodiscard]] std::optional<Point> direction(std::uint32_t instance) const;
  /// The radians of the plane angle unit of the contexts. Errors (input): they have several.
  [[nodiscard]] Expected<double> angle_unit(std::uint32_t instance) const;

  /// An input error at an instance.
  [[nodiscard]] std::unexpected<Error> error(std::uint32_t instance, std::string what,
                                             std::string remedy = {}) const;

 private:
  /// Number k of a point.
  [[nodiscard]] Expected<double> coordinate(std::uint32_t instance, std::uint32_t value,
                                            std::size_t k) const;
  [[nodiscard]] Expected<Point> curved_point(std::uint32_t instance) const;
  [[nodiscard]] Expected<Point> point_in_parameters(std::uint32_t instance) const;

  const Part21File* file_;
  std::size_t coordinates_ = 3;
  mutable std::vector<double>
      angle_units_;  ///< of the contexts, in radians; found when first needed
};

}  // namespace knead::step
