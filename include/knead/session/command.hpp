#pragma once

#include <memory>
#include <string_view>

namespace knead {

struct AnyCommand;

/// A user action as a value: {"do": name, field: value, …}, every field in its own type. `parse_command`
/// makes one (command_json.hpp), `Session::execute` applies it. Immutable; copies share the fields.
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

}  // namespace knead
