#include "knots.hpp"

#include <fmt/format.h>

#include "session/acts/refining.hpp"
#include "session/acts/selection.hpp"

namespace knead {

void describe(KnotsCommand& c, Fields& fields) {
  fields.name("knots", "set knots for the same control points: the shape changes permanently");
  fields.add("direction", c.direction,
             {.help = "whose", .presence = Presence::required, .choices = surface_directions});
  fields.add("knots", c.knots,
             {.help = "the whole knot vector, of the same length, with multiplicities up to the "
                      "degree inside the domain, "
                      "which does not change: trims and painted materials refer to it",
              .presence = Presence::required});
}

Expected<void> execute(const KnotsCommand& c, Act& act) {
  auto surface = selected_alone(act);
  if (!surface) return std::unexpected(surface.error());
  SceneSurface& s = **surface;
  const int d = c.direction == "u" ? 0 : 1;
  const KnotVector& before = s.current->knots(d);
  const std::size_t count = before.knots().size();
  if (c.knots.size() != count) {
    return input_error(fmt::format("{} knots for {} control points of degree {}", c.knots.size(),
                                   before.count(), before.degree()),
                       "knots", fmt::format("give {}; `refine` inserts knots", count));
  }
  auto made = KnotVector::create(before.degree(), c.knots);
  if (!made) return std::unexpected(made.error().within("knots"));
  const Interval is = made->domain(), was = before.domain();
  if (is.lower != was.lower || is.upper != was.upper) {
    return input_error(fmt::format("the domain would be [{}, {}]", is.lower, is.upper), "knots",
                       fmt::format("keep it [{}, {}]: trims and painted materials refer to it",
                                   was.lower, was.upper));
  }
  if (made->max_interior_multiplicity() > made->degree()) {
    return input_error(
        "the surface would be torn along a knot", "knots",
        fmt::format("keep knots inside the domain to a multiplicity of {}", made->degree()));
  }
  return change_basis(act, s, [&](const Surface& shape) {
    std::array<KnotVector, 2> knots = shape.knots();
    knots[static_cast<std::size_t>(d)] = *made;
    return Surface::create(std::move(knots), shape.control_points(),
                           {shape.weights().begin(), shape.weights().end()});
  });
}

}  // namespace knead
