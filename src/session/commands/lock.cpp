#include "lock.hpp"

#include <algorithm>

#include "session/acts/selection.hpp"

namespace knead {

void describe(LockCommand& c, Fields& fields) {
  fields.name("lock", "protect surfaces: what is locked cannot be selected");
  fields.add("surfaces", c.surfaces, {.help = "their ids", .fallback = "the selected ones"});
  fields.add("locked", c.locked, {.help = "`false`: they can be selected again"});
}

Expected<void> execute(const LockCommand& c, Act& act) {
  std::vector<int> meant = act.state.selection();
  if (c.surfaces) {
    meant.clear();
    for (const std::string& id : *c.surfaces) {
      auto index = find_surface(act, id);
      if (!index) {
        index.error().where = "surfaces";
        return std::unexpected(index.error());
      }
      meant.push_back(*index);
    }
  } else if (auto some = selected(act); !some) {
    return std::unexpected(some.error());
  }
  for (const int k : meant) act.state.surfaces[static_cast<std::size_t>(k)].locked = c.locked;
  // What is locked is selected no longer; the first of the others takes its place.
  std::vector<int> left = act.state.selection();
  std::erase_if(left,
                [&](int k) { return act.state.surfaces[static_cast<std::size_t>(k)].locked; });
  act.state.select(left);
  return {};
}

}  // namespace knead
