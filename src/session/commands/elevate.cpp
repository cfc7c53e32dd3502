#include "elevate.hpp"

#include <fmt/format.h>

#include "knead/spline/spline_refinement.hpp"
#include "session/acts/refining.hpp"
#include "session/acts/selection.hpp"

namespace knead {

void describe(ElevateCommand& c, Fields& fields) {
  fields.name("elevate", "raise the degree without changing the shape");
  fields.add("by", c.by, {.help = "in u and in v", .range = at_least(0)});
}

Expected<void> execute(const ElevateCommand& c, Act& act) {
  if (auto surface = selected(act); !surface) return std::unexpected(surface.error());
  for (int index : act.state.selection()) {
    auto& s = act.state.surfaces[static_cast<std::size_t>(index)];
    auto status = change_net(act, s, [&](const Surface& shape) -> Expected<Surface> {
      Expected<Surface> result = shape;
      for (int d = 0; d < 2; ++d) {
        const int degree = shape.knots(d).degree(), times = c.by[static_cast<std::size_t>(d)];
        if (times > max_degree - degree) {
          return input_error(
              fmt::format("{} has degree {} in {}: it cannot be raised by {}", s.id, degree,
                          d == 0 ? "u" : "v", times),
              "by",
              degree < max_degree
                  ? fmt::format("degrees go to {}: use at most {}", max_degree, max_degree - degree)
                  : fmt::format("{} is the highest degree there is: use 0", max_degree));
        }
        if (result && times > 0) result = elevate_degree<2>(*result, d, times);
      }
      return result;
    });
    if (!status) return status;
  }
  return {};
}

}  // namespace knead
