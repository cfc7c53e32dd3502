#include "buckling.hpp"

#include "../limits.hpp"
#include "scene/model/structural_modes.hpp"

namespace knead {

void describe(BucklingCommand& c, Fields& fields) {
  fields.name("buckling", "report the factors of the present loads at which a shell buckles");
  fields.add("count", c.count, {.help = "number of factors, the lowest first"});
}

template <>
Expected<void> Executor::execute(const BucklingCommand& c) {
  if (auto chosen = selected(); !chosen) return std::unexpected(chosen.error());
  if (auto few = check_modes(c.count); !few) return few;
  auto found = linear_buckling(state, c.count);
  if (!found) return std::unexpected(found.error());
  state.buckling.clear();
  for (Eigenmode& mode : *found) state.buckling.push_back({mode.value, mode.residual, std::move(mode.shape)});
  return {};
}

}  // namespace knead
