#pragma once

#include "../command_fields.hpp"
#include "../queries/morph_fields.hpp"

namespace knead {

/// Moves the faces of the document so that they follow data, as `morph_file` does: all of them
/// together, with their edges.
struct MorphCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
  /// What these files hold: text as it is, bytes as base64 after "base64:". Empty: none.
  std::string vectors, from, to, scan;
  MorphRequest request;
};

Expected<void> execute(const MorphCommand& c, Act& act);
void describe(MorphCommand& c, Fields& fields);

}  // namespace knead
