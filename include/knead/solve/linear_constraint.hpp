#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead {

/// One linear condition on N unknown points X_i (rows of an N × 3 matrix):
///
///   Σ_k coefficient_k X_{unknown_k} = value            where `normal` is not set: three
///   conditions, one per coordinate; Σ_k coefficient_k n · X_{unknown_k} = n · value    where it
///   is.
struct LinearConstraint {
  std::string name;  ///< its name in messages ("edge u0", "pin at (0.5, 0.5)")
  std::vector<std::pair<int, double>>
      terms;  ///< (unknown, coefficient); an unknown may occur more than once
  Point value = Point::Zero();
  std::optional<Point> normal = {};  ///< any non-zero length

  friend bool operator==(const LinearConstraint&, const LinearConstraint&) = default;
};

}  // namespace knead
