#include "load.hpp"

#include "session/acts/selection.hpp"

namespace knead {

std::span<const Choice> choices(LoadMeasure) {
  static constexpr Choice list[] = {
      {"parameters", LoadMeasure::parameters, "of the domain as the model scales it"},
      {"area", LoadMeasure::area, "of the rest shape, in lengths of the model"}};
  return list;
}

void describe(LoadCommand& c, Fields& fields) {
  fields.name("load", "loads everywhere on the selected surfaces; replaces earlier ones");
  fields.add("vector", c.load.vector, {.help = "force per area"});
  fields.add("per", c.load.per,
             {.help = "which area that is, of samples and formulas too",
              .fallback = "`area` on shells, else `parameters`"});
  fields.add("gravity", c.load.gravity, {.help = "acceleration; the force is mass times this"});
  fields.add("pressure", c.load.pressure, {.help = "force per area along the normal S_u × S_v"});
  fields.add("wind", c.load.wind, {.help = "velocity of the air; the force is along the normal"});
  fields.add("counts", c.load.counts,
             {.help = "`[m, n]` samples of any load f(u, v) over the domain, its ends included"});
  fields.add("samples", c.load.samples,
             {.help = "m n forces `[x, y, z]` per area, along v first, linear in between; "
                      "integrated exactly, per area of a bent surface to 1e-10"});
  fields.add("formula", c.load.formula,
             {.help = "a force per area: a formula for each of x, y, z, of what `material` names; "
                      "as cubic splines, integrated likewise"});
  fields.add("tolerance", c.load.tolerance,
             {.help = "of these splines, in forces per area",
              .range = above(0),
              .fallback = "1e-6 of the largest of a component"});
}

Expected<void> execute(const LoadCommand& c, Act& act) {
  if (c.load.samples.empty() && c.load.counts != std::array<int, 2>{0, 0}) {
    return input_error("counts are given without samples", "samples", "give m n forces");
  }
  if (c.load.tolerance && !c.load.formula) {
    return input_error("a tolerance is given without a formula", "tolerance", "leave it out");
  }
  if (c.load.varies()) {
    auto surface = selected(act);
    if (!surface) return std::unexpected(surface.error());
    if (auto fields = load_fields(c.load, *(*surface)->reference); !fields)
      return std::unexpected(fields.error());
  }
  act.state.load = c.load;
  return {};
}

}  // namespace knead
