#pragma once

#include <expected>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace knead {

/// The cause of a failure; the command line maps it to its exit code.
enum class ErrorKind {
  usage,      ///< The call itself is wrong (unknown option, missing argument): exit code 2.
  input,      ///< A file, a script or a value is wrong: exit code 3.
  numerical,  ///< The data are valid but the computation cannot be carried out: exit code 4.
};

/// What has happened, for programs: listed in `knead/base/error_code.hpp`.
enum class ErrorCode : unsigned short;

/// A number, an id or text, or several ids, by name.
struct NamedValue {
  std::string name;
  std::variant<double, std::string, std::vector<std::string>> value;

  NamedValue(std::string_view of, double number);
  NamedValue(std::string_view of, std::string text);
  NamedValue(std::string_view of, std::vector<std::string> ids);
};

/// What a program reads of an error or a note. The text of both is for people, and may change.
///
/// `values` are those that the code has in `knead/base/error_code.hpp`, lengths in units of the
/// file.
struct Diagnostic {
  ErrorCode code = {};
  std::vector<NamedValue> values = {};
};

/// A failure as a value: what is wrong, where, and what would be right.
///
/// `what` is a clause without a full stop ("the knots decrease"). `where` names the place inside
/// the input: an entity
/// ("#123 B_SPLINE_SURFACE_WITH_KNOTS"), an index ("knot 7"), a JSON path ("commands[2].radius");
/// it may be empty. `remedy` says what to do ("sort the knots"); it may be empty. `file` and `line`
/// (1-based, 0 = unknown) locate the input when there is one. `diagnostic` says the same to
/// programs; null if nothing but the text is known.
struct Error {
  ErrorKind kind = ErrorKind::input;
  std::string what;
  std::string where;
  std::string remedy;
  std::string file;
  int line = 0;
  std::shared_ptr<const Diagnostic> diagnostic;

  // Out of line, as every `Expected<T>` has them.
  Error();
  Error(ErrorKind of, std::string is, std::string at = {}, std::string helps = {},
        std::string in = {}, int in_line = 0);
  Error(const Error& other);
  Error(Error&& other) noexcept;
  Error& operator=(const Error& other);
  Error& operator=(Error&& other) noexcept;
  ~Error();

  /// One line: "file:line: where: what; remedy", leaving out what is empty.
  [[nodiscard]] std::string message() const;

  /// The same error with its place put inside a larger one: "outer: where".
  [[nodiscard]] Error within(const std::string& outer) const;

  /// The same error with what programs read of it.
  [[nodiscard]] Error with(Diagnostic read) &&;
};

/// A value, or the reason there is none. The core never throws.
template <class T>
using Expected = std::expected<T, Error>;

/// Shorthand for returning an `Error` of kind `input` from a function that returns `Expected<T>`.
[[nodiscard]] std::unexpected<Error> input_error(std::string_view what, std::string_view where = {},
                                                 std::string_view remedy = {});
[[nodiscard]] std::unexpected<Error> input_error(std::string_view what, std::string_view where,
                                                 std::string_view remedy, Diagnostic diagnostic);

/// Shorthand for returning an `Error` of kind `numerical`.
[[nodiscard]] std::unexpected<Error> numerical_error(std::string_view what,
                                                     std::string_view where = {},
                                                     std::string_view remedy = {});
[[nodiscard]] std::unexpected<Error> numerical_error(std::string_view what, std::string_view where,
                                                     std::string_view remedy,
                                                     Diagnostic diagnostic);

/// Shorthand for returning an `Error` of kind `usage`.
[[nodiscard]] std::unexpected<Error> usage_error(std::string_view what, std::string_view where = {},
                                                 std::string_view remedy = {});

}  // namespace knead
