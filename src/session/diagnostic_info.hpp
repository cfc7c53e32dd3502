#pragma once

#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "fixes.hpp"
#include "knead/session/session.hpp"

namespace knead {

// What errors and notes say to programs, as it is reported.

/// All values that codes have.
struct DiagnosticValues {
  std::optional<std::string> surface, body, edge, face, form, tool, hold, permission, first, second,
      other, reason;
  std::vector<std::string> surfaces, others, edges, faces;
  std::optional<double> rows, point, distance, limit, angle, size, sizes, depth, x, y, z;
};
void describe(DiagnosticValues& v, Fields& fields);

struct FixInfo {
  FixCode code = FixCode::hold_edges;
  std::vector<CommandVariant> commands;
};
void describe(FixInfo& f, Fields& fields);

struct NoteInfo {
  std::string text;
  ErrorCode code = ErrorCode::none;
  std::optional<DiagnosticValues> values;
  std::vector<FixInfo> fixes;
};
void describe(NoteInfo& n, Fields& fields);

struct ErrorInfo {
  std::string kind, what, where, place, remedy, message;
  ErrorCode code = ErrorCode::none;
  std::optional<DiagnosticValues> values;
  std::vector<FixInfo> fixes;
};
void describe(ErrorInfo& e, Fields& fields);

[[nodiscard]] NoteInfo info_of(const Note& note);

/// By their names. Asserts that they have one.
[[nodiscard]] DiagnosticValues values_of(const Diagnostic& diagnostic);
/// Those that there are, in the order of the description.
[[nodiscard]] std::vector<NamedValue> named_values(const DiagnosticValues& values);

}  // namespace knead
