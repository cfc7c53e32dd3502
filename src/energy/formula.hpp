#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knead/base/error.hpp"

namespace knead {

/// An arithmetic expression of named variables, like `1 + 4 * exp(-40 * ((s - 0.5)^2 + (t -
/// 0.5)^2))`.
///
/// Numbers as in C (`2`, `.5`, `1e-3`), the constants `pi` and `e`, parentheses, `+ - * /`, and `^`
/// for powers, which binds tighter than a sign before it and to the right: −2^2 = −4, 2^3^2 = 512.
/// Functions of one argument: `abs`, `sign` (−1, 0 or 1), `sqrt`, `cbrt`, `exp`, `log` (natural),
/// `log2`, `log10`, `sin`, `cos`, `tan`, `asin`, `acos`, `atan`, `sinh`, `cosh`, `tanh`, `floor`,
/// `ceil`; of two: `min`, `max`, `atan2(y, x)`, `hypot`, `step(edge, x)` (0 below the edge, else
/// 1); of three: `clamp(x, lower, upper)`, `smoothstep(lower, upper, x)` (3 r² − 2 r³ with r = (x −
/// lower) / (upper − lower) clamped to [0, 1]), `mix(a, b, r)` = a + r (b − a). Angles are in
/// radians.
///
/// Immutable. Values are those of the C library's functions in double precision; places where a
/// function has none (the root of a negative number, division by zero) give NaN or an infinity.
class Formula {
 public:
  static constexpr std::size_t max_length = 4096;  ///< characters
  static constexpr int max_depth = 64;  ///< values that wait for an operation, and open parentheses

  /// Cost: linear in the length. Errors (input): what is not understood and at which character,
  /// counted from 1; longer than `max_length`; nested deeper than `max_depth`.
  [[nodiscard]] static Expected<Formula> parse(std::string_view text,
                                               std::span<const std::string_view> variables);

  /// Its value, given those of the variables in the order of `parse`.
  [[nodiscard]] double operator()(std::span<const double> values) const;

  /// Whether the value depends on that variable.
  [[nodiscard]] bool uses(std::size_t variable) const;

  friend bool operator==(const Formula&, const Formula&) = default;

 private:
  friend class FormulaParser;
  /// One operation of a stack machine: pushes a number or a variable, or replaces the topmost
  /// values by a function's.
  struct Operation {
    int code;      ///< < 0: the number; otherwise an index into the table of functions, or
                   ///< `first_variable` + k
    double value;  ///< of a number

    friend bool operator==(const Operation&, const Operation&) = default;
  };
  std::vector<Operation> operations_;
};

}  // namespace knead
