#include "hold.hpp"

#include <fmt/format.h>

namespace knead {

void describe(HoldCommand& c, Fields& fields) {
  fields.name("hold", "hold the outer rows of control points on every side");
  fields.add("rows", c.rows, {.help = "0 holds none"});
}

template <>
Expected<void> Executor::execute(const HoldCommand& c) {
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  if (c.rows < 0) return input_error(fmt::format("{} rows cannot be held", c.rows), "rows", "use 0 or more");
  for (int k : state.selection()) state.surfaces[static_cast<std::size_t>(k)].hold_rows = c.rows;
  return {};
}

}  // namespace knead
