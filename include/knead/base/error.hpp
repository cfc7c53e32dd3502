#pragma once

#include <expected>
#include <string>
#include <utility>

namespace knead {

/// The cause of a failure; the command line maps it to its exit code.
enum class ErrorKind {
  usage,      ///< The call itself is wrong (unknown option, missing argument): exit code 2.
  input,      ///< A file, a script or a value is wrong: exit code 3.
  numerical,  ///< The data are valid but the computation cannot be carried out: exit code 4.
};

/// A failure as a value: what is wrong, where, and what would be right.
///
/// `what` is a clause without a full stop ("the knots decrease"). `where` names the place inside the input: an entity
/// ("#123 B_SPLINE_SURFACE_WITH_KNOTS"), an index ("knot 7"), a JSON path ("commands[2].radius"); it may be empty.
/// `remedy` says what to do ("sort the knots"); it may be empty. `file` and `line` (1-based, 0 = unknown) locate the
/// input when there is one.
struct Error {
  ErrorKind kind = ErrorKind::input;
  std::string what;
  std::string where = {};
  std::string remedy = {};
  std::string file = {};
  int line = 0;

  /// One line: "file:line: where: what; remedy", leaving out what is empty.
  [[nodiscard]] std::string message() const;

  /// The same error with its place put inside a larger one: "outer: where".
  [[nodiscard]] Error within(const std::string& outer) const;
};

/// A value, or the reason there is none. The core never throws.
template <class T>
using Expected = std::expected<T, Error>;

/// Shorthand for returning an `Error` of kind `input` from a function that returns `Expected<T>`.
[[nodiscard]] inline std::unexpected<Error> input_error(std::string what, std::string where = {},
                                                        std::string remedy = {}) {
  return std::unexpected(Error{ErrorKind::input, std::move(what), std::move(where), std::move(remedy)});
}

/// Shorthand for returning an `Error` of kind `numerical`.
[[nodiscard]] inline std::unexpected<Error> numerical_error(std::string what, std::string where = {},
                                                            std::string remedy = {}) {
  return std::unexpected(Error{ErrorKind::numerical, std::move(what), std::move(where), std::move(remedy)});
}

/// Shorthand for returning an `Error` of kind `usage`.
[[nodiscard]] inline std::unexpected<Error> usage_error(std::string what, std::string where = {},
                                                        std::string remedy = {}) {
  return std::unexpected(Error{ErrorKind::usage, std::move(what), std::move(where), std::move(remedy)});
}

}  // namespace knead
