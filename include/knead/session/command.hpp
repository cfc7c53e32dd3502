#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "knead/base/error.hpp"

namespace knead {

struct AnyCommand;

/// A user action as a value: {"do": name, field: value, …}, every field in its own type.
/// `parse_command` makes one (command_json.hpp), `Session::execute` applies it. Immutable; copies
/// share the fields.
class Command {
 public:
  /// Of one of the kinds listed in src/session/commands.hpp.
  explicit Command(AnyCommand command);

  /// Its name under `do`.
  [[nodiscard]] std::string_view name() const;
  [[nodiscard]] const AnyCommand& any() const { return *any_; }

 private:
  std::shared_ptr<const AnyCommand> any_;
};

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
  unlock,
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

/// What can be done, the most likely first; empty where nothing is known that would help. After it
/// what was refused may be asked for again.
[[nodiscard]] std::vector<Fix> fixes_for(const Diagnostic& diagnostic);

}  // namespace knead
