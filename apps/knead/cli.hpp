#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "knead/base/error.hpp"

namespace knead::cli {

/// The action of a sub-command once its arguments are parsed. It returns the exit code of what ran
/// well, 0 where it returns nothing.
class Action {
 public:
  template <class F>
  Action(F action) {  // NOLINT: a function is an action
    if constexpr (std::is_same_v<std::invoke_result_t<F&>, Expected<int>>) {
      action_ = std::move(action);
    } else {
      action_ = [action = std::move(action)]() -> Expected<int> {
        if (auto status = action(); !status) return std::unexpected(std::move(status.error()));
        return 0;
      };
    }
  }
  Expected<int> operator()() const { return action_(); }

 private:
  std::function<Expected<int>()> action_;
};

// Each declares its sub-command on `app` and returns its action.
Action add_info(CLI::App& app);
Action add_sculpt(CLI::App& app);
Action add_analyse(CLI::App& app);
Action add_commands(CLI::App& app);
Action add_gramian(CLI::App& app);
Action add_stiffness(CLI::App& app);
Action add_basis(CLI::App& app);
Action add_mesh(CLI::App& app);
Action add_export(CLI::App& app);
Action add_matrices(CLI::App& app);
Action add_schema(CLI::App& app);
Action add_snake(CLI::App& app);
Action add_check(CLI::App& app);
Action add_morph(CLI::App& app);

/// The end of every help text.
inline constexpr std::string_view exit_codes =
    "Exit codes: 0 success, 2 wrong usage, 3 bad input, 4 numerical failure.";

/// The help text of --method: all names, and the default.
[[nodiscard]] std::string gramian_method_help();

/// Numbers separated by commas or white space; a comma follows a number, and the last one may end
/// the text. A usage error names `option` and the entry that is not a number.
[[nodiscard]] Expected<std::vector<double>> parse_numbers(const std::string& text,
                                                          const std::string& option);

/// The items of a list, without those that are empty and blanks before them.
[[nodiscard]] std::vector<std::string> items_of(const std::string& list,
                                                std::string_view separators = ",");

/// The same value; an error of it, unless numerical, is that of the option which gave it: wrong
/// usage, at `option`.
template <class T>
[[nodiscard]] Expected<T> of_option(Expected<T> value, const std::string& option) {
  if (value || value.error().kind == ErrorKind::numerical) return value;
  Error error = value.error().within(option);
  error.kind = ErrorKind::usage;
  return std::unexpected(std::move(error));
}

/// To 17 significant digits, which give back the same double; null if not finite.
[[nodiscard]] std::string json_number(double value);

/// "1 face", "2 faces".
[[nodiscard]] std::string counted(std::size_t count, const char* one, const char* many);

}  // namespace knead::cli
