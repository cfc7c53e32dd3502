#include "knead/base/error.hpp"

#include <utility>

#include "knead/base/printable.hpp"

namespace knead {
namespace {

// A clause may list all commands or fields; anything longer quotes what was given.
constexpr std::size_t longest_clause = 2000, longest_path = 4096;

std::unexpected<Error> error_of(ErrorKind kind, std::string_view what, std::string_view where,
                                std::string_view remedy) {
  return std::unexpected(Error(kind, std::string(what), std::string(where), std::string(remedy)));
}

std::unexpected<Error> coded_error(ErrorKind kind, std::string_view what, std::string_view where,
                                   std::string_view remedy, Diagnostic diagnostic) {
  return std::unexpected(
      std::move(error_of(kind, what, where, remedy).error()).with(std::move(diagnostic)));
}

}  // namespace

NamedValue::NamedValue(std::string_view of, double number) : name(of), value(number) {}
NamedValue::NamedValue(std::string_view of, std::string text) : name(of), value(std::move(text)) {}
NamedValue::NamedValue(std::string_view of, std::vector<std::string> ids)
    : name(of), value(std::move(ids)) {}

Error::Error() = default;
Error::Error(ErrorKind of, std::string is, std::string at, std::string helps, std::string in,
             int in_line)
    : kind(of),
      what(std::move(is)),
      where(std::move(at)),
      remedy(std::move(helps)),
      file(std::move(in)),
      line(in_line) {}
Error::Error(const Error& other) = default;
Error::Error(Error&& other) noexcept = default;
Error& Error::operator=(const Error& other) = default;
Error& Error::operator=(Error&& other) noexcept = default;
Error::~Error() = default;

std::string Error::message() const {
  std::string text;
  if (!file.empty()) {
    text += printable(file, longest_path);
    if (line > 0) text += ":" + std::to_string(line);
    text += ": ";
  } else if (line > 0) {
    text += "line " + std::to_string(line) + ": ";
  }
  if (!where.empty()) text += printable(where, longest_clause) + ": ";
  text += printable(what, longest_clause);
  if (!remedy.empty()) text += "; " + printable(remedy, longest_clause);
  return text;
}

Error Error::within(const std::string& outer) const {
  Error error = *this;
  error.where = where.empty() ? outer : outer + ": " + where;
  return error;
}

Error Error::with(Diagnostic read) && {
  diagnostic = std::make_shared<const Diagnostic>(std::move(read));
  return std::move(*this);
}

std::unexpected<Error> input_error(std::string_view what, std::string_view where,
                                   std::string_view remedy) {
  return error_of(ErrorKind::input, what, where, remedy);
}

std::unexpected<Error> input_error(std::string_view what, std::string_view where,
                                   std::string_view remedy, Diagnostic diagnostic) {
  return coded_error(ErrorKind::input, what, where, remedy, std::move(diagnostic));
}

std::unexpected<Error> numerical_error(std::string_view what, std::string_view where,
                                       std::string_view remedy) {
  return error_of(ErrorKind::numerical, what, where, remedy);
}

std::unexpected<Error> numerical_error(std::string_view what, std::string_view where,
                                       std::string_view remedy, Diagnostic diagnostic) {
  return coded_error(ErrorKind::numerical, what, where, remedy, std::move(diagnostic));
}

std::unexpected<Error> usage_error(std::string_view what, std::string_view where,
                                   std::string_view remedy) {
  return error_of(ErrorKind::usage, what, where, remedy);
}

}  // namespace knead
