#pragma once

#include <string>
#include <string_view>

#include "text.hpp"

namespace knead::step {

/// The records of a file that does not exist yet, with the frame that every file has: application,
/// contexts, products.
class NewFile {
 public:
  explicit NewFile(Schema schema);

  /// Adds "#n=record;" and returns "#n".
  std::string add(const std::string& record);
  std::string add_point(const double* coordinates);
  /// The context of a representation with its units: lengths in `unit`, one of `is_length_unit`,
  /// angles in radians.
  std::string add_context(std::string_view unit, double uncertainty);

  struct Product {
    std::string definition, shape;  ///< PRODUCT_DEFINITION and PRODUCT_DEFINITION_SHAPE
  };
  /// \param name UTF-8
  Product add_product(std::string_view name);
  /// At the origin, along the axes.
  std::string add_origin();

  /// The exchange structure.
  [[nodiscard]] std::string text(const TextOptions& options) const;

 private:
  std::string next() { return "#" + std::to_string(++last_); }

  Schema schema_;
  std::string text_, application_, product_context_, design_;
  int last_ = 0;
};

/// Error (input), at "unit": it is none of `is_length_unit`.
[[nodiscard]] Expected<void> check_unit(const std::string& unit);

}  // namespace knead::step
