#pragma once

#include <span>
#include <string_view>

#include "executor.hpp"

// One description per command serves parsing, writing and help. `CommandInfo<C>::visit(command, visitor)` calls
//   visitor.field(name, presence, member, help)
//   visitor.choice(name, member, choices, help)
// for every field; all choices are optional.

namespace knead {

/// A name of an enumeration's value in JSON.
template <class E>
struct Choice {
  std::string_view name;
  E value;
};

/// Whether a field may be left out.
enum class Presence { required, optional };

template <class C>
struct CommandInfo;

/// Names a command, declares its `execute` and begins the function that visits its fields.
#define KNEAD_COMMAND(Type, command_name, command_help_text)         \
  template <>                                                        \
  Expected<void> Executor::execute(const Type& c);                   \
  template <>                                                        \
  struct CommandInfo<Type> {                                         \
    static constexpr std::string_view name = command_name;           \
    static constexpr std::string_view help = command_help_text;      \
    template <class C, class V>                                      \
    static void visit([[maybe_unused]] C& c, [[maybe_unused]] V& v); \
  };                                                                 \
  template <class C, class V>                                        \
  void CommandInfo<Type>::visit([[maybe_unused]] C& c, [[maybe_unused]] V& v)

// What several commands have.

inline constexpr Choice<StepWeight> step_weights[] = {{"mass", StepWeight::mass}, {"identity", StepWeight::identity}};
inline constexpr Choice<EdgeChoice> edge_choices[] = {{"all", EdgeChoice::all},
                                                      {"u0", EdgeChoice::u0},
                                                      {"u1", EdgeChoice::u1},
                                                      {"v0", EdgeChoice::v0},
                                                      {"v1", EdgeChoice::v1}};

}  // namespace knead
