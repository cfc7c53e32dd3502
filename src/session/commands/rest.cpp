#include "rest.hpp"

#include "session/acts/selection.hpp"

namespace knead {

std::span<const Choice> choices(RestMode) {
  static constexpr Choice list[] = {
      {"shape", RestMode::shape,
       "the energy is that of the displacement from the rest shape, and without tools nothing "
       "moves"},
      {"none", RestMode::none,
       "that of the shape itself, as in the thesis; without forces it shrinks"}};
  return list;
}

void describe(RestCommand& c, Fields& fields) {
  fields.name("rest", "make the present shape the rest shape; what the energy acts on");
  fields.add("mode", c.mode, {.help = "of what the energy is"});
}

Expected<void> execute(const RestCommand& c, Act& act) {
  if (auto some = some_selected(act); !some) return some;
  return each_selected(act, [&](auto& s) -> Expected<void> {
    s.rest = s.reference = s.current;
    s.mode = c.mode;
    return {};
  });
}

}  // namespace knead
