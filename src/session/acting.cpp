#include <algorithm>
#include <utility>

#include "commands.hpp"
#include "same_scene.hpp"
#include "session_state.hpp"

namespace knead {
namespace {

template <class... C>
bool is_one_of(const Command& command) {
  return ((fields_of<C>(command) != nullptr) || ...);
}

bool travels(const Command& command) { return is_one_of<UndoCommand, RedoCommand>(command); }

/// Whether all that it can change is compared by `same_scene`.
bool may_change_nothing(const Command& command) {
  if (const auto* material = fields_of<MaterialCommand>(command))
    return !material->region && !material->coefficient;
  return is_one_of<StepCommand, EvolveCommand, LoadCommand, HoldCommand, SelectCommand,
                   LimitCommand, SeamsCommand>(command);
}

}  // namespace

Session::Before Session::before(std::span<const Command> commands, bool joined) const {
  // As far back as the act can reach: what it joins, what it undoes. An entry is not copied for
  // less.
  const auto undone = static_cast<std::size_t>(std::ranges::count_if(
      commands, [](const Command& c) { return fields_of<UndoCommand>(c) != nullptr; }));
  Before before;
  before.position = position_;
  before.first = position_ - std::min(position_ - floor_, undone + (joined ? 1 : 0));
  const auto from = static_cast<std::ptrdiff_t>(before.first);
  before.states.assign(states_.begin() + from, states_.end());
  before.entries.assign(entries_.begin() + from, entries_.end());
  return before;
}

void Session::go_back(Before before) {
  states_.resize(before.first);
  entries_.resize(before.first);
  std::ranges::move(before.states, std::back_inserter(states_));
  std::ranges::move(before.entries, std::back_inserter(entries_));
  position_ = before.position;
}

Expected<bool> Session::act(std::span<const Command> commands, const ActOptions& options,
                            const Progress& progress, const GoOn& go_on) {
  Before before = this->before(commands, options.join);
  bool joins = options.join;
  for (const Command& command : commands) {
    const std::size_t place = position_;
    if (auto status = execute(command, progress, go_on); !status) {
      go_back(std::move(before));
      return std::unexpected(std::move(status.error()));
    }
    if (travels(command)) {
      joins = false;
    } else if (position_ > place) {  // commands that only look have made no entry
      if (joins) join();
      joins = true;
    }
  }
  if (options.join || options.keep || !std::ranges::all_of(commands, may_change_nothing))
    return true;
  if (!same_scene(*before.states[before.position - before.first], state())) return true;
  go_back(std::move(before));
  return false;
}

Expected<void> Session::run(std::span<const Command> commands, const ErrorAt& at,
                            const Progress& progress, const GoOn& go_on) {
  bool stopped = false;
  const auto goes = [&stopped](bool on) {
    stopped = stopped || !on;
    return on;
  };
  const auto told = [&](int steps, int count) { return goes(!progress || progress(steps, count)); };
  const auto within = [&] { return goes(!go_on || go_on()); };
  Before before = this->before(commands);
  for (std::size_t k = 0; k < commands.size() && !stopped; ++k) {
    auto status = execute(commands[k], told, within);
    if (stopped || status) continue;
    Error error = at(std::move(status.error()), k);
    go_back(std::move(before));
    return std::unexpected(std::move(error));
  }
  return {};
}

void Session::drop_unchanged() {
  if (!can_undo() || !std::ranges::all_of(entries_[position_ - 1], may_change_nothing) ||
      !same_scene(*states_[position_ - 1], state()))
    return;
  --position_;
  states_.resize(position_ + 1);
  entries_.resize(position_);
}

void Session::begin_history() {
  floor_ = position_;
  states_.resize(position_ + 1);
  entries_.resize(position_);
}

void Session::begin_history_after(std::size_t commands) {
  floor_ = 0;
  std::size_t count = earlier_.size();
  while (floor_ < position_ && count < commands) count += entries_[floor_++].size();
}

std::size_t Session::opening_commands() const {
  std::size_t count = earlier_.size();
  for (std::size_t k = 0; k < floor_; ++k) count += entries_[k].size();
  return count;
}

}  // namespace knead
