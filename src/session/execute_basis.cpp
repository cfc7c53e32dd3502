#include <fmt/format.h>

#include <cmath>

#include "change_shapes.hpp"
#include "executor.hpp"
#include "knead/spline/extremum.hpp"
#include "named_points.hpp"

namespace knead {

template <class F>
Expected<void> Executor::change_basis(SurfaceState& surface, const F& change) {
  if (state.limit) {
    return input_error("a limit is measured on the weights and knots that the surface was opened with", "limit",
                       R"(end it first: {"do":"limit"})");
  }
  // `opened` stays what it is: deviations are measured from there.
  if (auto done = change_shapes(shapes_of(surface), change); !done) return done;
  surface.velocity.resize(0, 3);  // it is a spline on the old basis
  return surface.constraints.empty() ? Expected<void>() : check_constraints();
}

Expected<void> Executor::operator()(const WeightsCommand& c) {
  auto surface = selected_alone();
  if (!surface) return std::unexpected(surface.error());
  SurfaceState& s = **surface;
  const auto named = indices_of(c.points, s.current->net());
  if (!named) return std::unexpected(named.error());
  if (c.weight.has_value() == c.by.has_value()) {
    return input_error("one of weight and by is needed", "weight", "give a weight > 0, or by, a factor");
  }
  const char* const where = c.weight ? "weight" : "by";
  const double value = c.weight ? *c.weight : *c.by;
  const auto refused = [&](double number) {
    return input_error(fmt::format("{} is not a {}", number, c.weight ? "weight" : "factor"), where,
                       "use a finite number > 0");
  };
  if (!(std::isfinite(value) && value > 0)) return refused(value);
  std::vector<double> weights(s.current->weights().begin(), s.current->weights().end());
  weights.resize(static_cast<std::size_t>(s.current->size()), 1.0);
  for (int row : *named) {
    double& weight = weights[static_cast<std::size_t>(row)];
    weight = c.weight ? value : weight * value;
    if (!(std::isfinite(weight) && weight > 0)) {
      return input_error(fmt::format("the weight of control point {} would be {}", row, weight), where,
                         "weights are finite numbers > 0");
    }
  }
  return change_basis(
      s, [&](const Surface& shape) { return Surface::create(shape.knots(), shape.control_points(), weights); });
}

Expected<void> Executor::operator()(const KnotsCommand& c) {
  auto surface = selected_alone();
  if (!surface) return std::unexpected(surface.error());
  SurfaceState& s = **surface;
  if (c.direction != "u" && c.direction != "v") {
    return input_error(fmt::format("\"{}\" is not a direction", c.direction), "direction", "use u or v");
  }
  const int d = c.direction == "u" ? 0 : 1;
  const KnotVector& before = s.current->knots(d);
  const std::size_t count = before.knots().size();
  if (c.knots.size() != count) {
    return input_error(
        fmt::format("{} knots for {} control points of degree {}", c.knots.size(), before.count(), before.degree()),
        "knots", fmt::format("give {}; `refine` inserts knots", count));
  }
  auto made = KnotVector::create(before.degree(), c.knots);
  if (!made) return std::unexpected(made.error().within("knots"));
  const Interval is = made->domain(), was = before.domain();
  if (is.lower != was.lower || is.upper != was.upper) {
    return input_error(
        fmt::format("the domain would be [{}, {}]", is.lower, is.upper), "knots",
        fmt::format("keep it [{}, {}]: trimming and painted materials live in it", was.lower, was.upper));
  }
  if (made->max_interior_multiplicity() > made->degree()) {
    return input_error("the surface would be torn along a knot", "knots",
                       fmt::format("keep knots inside the domain to a multiplicity of {}", made->degree()));
  }
  return change_basis(s, [&](const Surface& shape) {
    std::array<KnotVector, 2> knots = shape.knots();
    knots[static_cast<std::size_t>(d)] = *made;
    return Surface::create(std::move(knots), shape.control_points(), {shape.weights().begin(), shape.weights().end()});
  });
}

}  // namespace knead
