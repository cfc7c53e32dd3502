#include "knead/base/error.hpp"

#include "knead/base/printable.hpp"

namespace knead {
namespace {

// A clause may list all commands or fields; anything longer quotes what was given.
constexpr std::size_t longest_clause = 2000, longest_path = 4096;

}  // namespace

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

}  // namespace knead
