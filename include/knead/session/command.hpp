#pragma once

#include <memory>
#include <string_view>

namespace knead {

struct AnyCommand;

/// What a user can do, as a value: {"do": name, field: value, …} with every field in its own type. `parse_command`
/// makes one (command_json.hpp), `Session::execute` applies it. Immutable; copies share the fields.
class Command {
 public:
  /// Of one kind in src/session/commands.hpp, the list of all.
  explicit Command(AnyCommand command);

  /// What `do` calls it.
  [[nodiscard]] std::string_view name() const;
  [[nodiscard]] const AnyCommand& any() const { return *any_; }

 private:
  std::shared_ptr<const AnyCommand> any_;
};

}  // namespace knead
