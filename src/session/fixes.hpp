#pragma once

#include <span>
#include <string>
#include <vector>

#include "describe/describe.hpp"
#include "knead/base/error_code.hpp"
#include "knead/session/command.hpp"

namespace knead {

/// What a fix does, for programs that write its words.
enum class FixCode {
  hold_edges,
  hold_rows,
  hold_nothing,
  release_all,
  release_pins,
  thaw,
  refine,
  permit_refining,
  keep_net,
  let_follow,
  let_go,
  let_open,
  let_part,
  convert_and_follow,
  select_and_follow,
  select,
  convert,
  end_limit,
  normalise,
  set_rest_shape,
  keep_smooth,
};

/// Something that can be done about an error or a note: commands, to be carried out in this order.
struct Fix {
  FixCode code = FixCode::hold_edges;
  std::vector<Command> commands;
};

/// What can be done, the most likely first; empty where nothing is known that would help. After it what was refused may
/// be asked for again.
[[nodiscard]] std::vector<Fix> fixes_for(const Diagnostic& diagnostic);

/// The names of codes, and what they say.
[[nodiscard]] std::span<const Choice> choices(ErrorCode code);
[[nodiscard]] std::span<const Choice> choices(FixCode code);

/// All codes with their values and fixes, as tables in Markdown.
[[nodiscard]] std::string diagnostics_table();

}  // namespace knead
