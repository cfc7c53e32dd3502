#include "weights.hpp"

#include <fmt/format.h>

#include "session/acts/refining.hpp"
#include "session/acts/selection.hpp"

namespace knead {

void describe(WeightsCommand& c, Fields& fields) {
  fields.name("weights", "set weights: control points stay, the shape changes permanently");
  describe(c.points, fields);
  fields.add("weight", c.weight,
             {.help = "weight of each; 1 unless set before; this or `by`", .range = above(0)});
  fields.add("by", c.by,
             {.help = "a factor by which each weight is multiplied", .range = above(0)});
}

Expected<void> execute(const WeightsCommand& c, Act& act) {
  auto surface = selected_alone(act);
  if (!surface) return std::unexpected(surface.error());
  SceneSurface& s = **surface;
  const auto named = indices_of(c.points, s.current->net());
  if (!named) return std::unexpected(named.error());
  if (c.weight.has_value() == c.by.has_value()) {
    return input_error("one of weight and by is needed", "weight",
                       "give a weight > 0, or by, a factor");
  }
  const char* const where = c.weight ? "weight" : "by";
  const double value = c.weight ? *c.weight : *c.by;
  std::vector<double> weights(s.current->weights().begin(), s.current->weights().end());
  weights.resize(static_cast<std::size_t>(s.current->size()), 1.0);
  for (int row : *named) {
    double& weight = weights[static_cast<std::size_t>(row)];
    weight = c.weight ? value : weight * value;
    if (!(weight > 0 && weight <= largest_number)) {
      return input_error(fmt::format("the weight of control point {} would be {}", row, weight),
                         where,
                         fmt::format("weights are numbers > 0 of at most {}", largest_number));
    }
  }
  return change_basis(act, s, [&](const Surface& shape) {
    return Surface::create(shape.knots(), shape.control_points(), weights);
  });
}

}  // namespace knead
