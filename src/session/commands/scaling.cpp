#include "scaling.hpp"

#include "session/acts/act.hpp"

namespace knead {

std::span<const Choice> choices(ScalingMode) {
  static constexpr Choice list[] = {
      {"normalised", ScalingMode::normalised, "those of [active-model.md](active-model.md)"},
      {"raw", ScalingMode::raw,
       "those of the equations on the knots as they are, K P = F; for analysis"}};
  return list;
}

void describe(ScalingCommand& c, Fields& fields) {
  fields.name("scaling", "the units that the numbers are in");
  fields.add("mode", c.mode, {.help = "in which units numbers are"});
}

Expected<void> execute(const ScalingCommand& c, Act& act) {
  act.state.scaling = c.mode;
  return {};
}

}  // namespace knead
