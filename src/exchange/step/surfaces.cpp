#include "surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "knead/exchange/source.hpp"
#include "knead/spline/basis.hpp"
#include "share.hpp"

namespace knead::step {
namespace {

constexpr std::array<std::string_view, 6> forms = {
    "B_SPLINE_SURFACE_WITH_KNOTS", "BEZIER_SURFACE",  "UNIFORM_SURFACE", "QUASI_UNIFORM_SURFACE",
    "RATIONAL_B_SPLINE_SURFACE",   "B_SPLINE_SURFACE"};

// B_SPLINE_SURFACE(u_degree, v_degree, control_points_list, surface_form, u_closed, v_closed,
// self_intersect) (ISO 10303-42, clause 4.5). control_points_list is a list of rows, u the slow
// direction, as in `Surface`. The flags u_closed and v_closed, and the form, are not believed:
// closedness is found from control points. Knots follow in
// B_SPLINE_SURFACE_WITH_KNOTS(u_multiplicities, v_multiplicities, u_knots, v_knots, knot_spec), or
// are implied by the subtype; weights in RATIONAL_B_SPLINE_SURFACE(weights_data), which makes the
// record complex.
struct Net {
  int rows = 0;
  int columns = 0;
  std::vector<std::uint32_t> values;  // row by row
};

// A rectangular list of lists.
Expected<Net> read_net(const Reader& reader, std::uint32_t instance, std::uint32_t list,
                       const std::string& what) {
  if (!reader.is_list(list))
    return reader.error(instance, "its " + what + " are not a list of lists");
  Net net;
  for (const auto row : reader.file().children(list)) {
    if (!reader.is_list(row))
      return reader.error(instance, "its " + what + " are not a list of lists");
    const auto values = reader.file().children(row);
    if (net.rows > 0 && static_cast<int>(values.size()) != net.columns) {
      return reader.error(instance, "row " + std::to_string(net.rows) + " of its " + what +
                                        " has " + std::to_string(values.size()) +
                                        " entries and the rows before it " +
                                        std::to_string(net.columns));
    }
    net.columns = static_cast<int>(values.size());
    ++net.rows;
    net.values.insert(net.values.end(), values.begin(), values.end());
  }
  if (net.values.empty()) return reader.error(instance, "its " + what + " are empty");
  return net;
}

Expected<std::array<KnotVector, 2>> surface_knots(const Reader& reader, std::uint32_t instance,
                                                  std::array<int, 2> degree,
                                                  std::array<int, 2> count) {
  constexpr std::array<const char*, 2> names = {"u", "v"};
  std::vector<KnotVector> knots;
  const auto listed = knot_parameters(reader, instance);
  const auto form = implied_form(reader, instance);
  if (listed.empty() && !form) {
    return reader.error(instance, "it has no knots",
                        "write it as B_SPLINE_SURFACE_WITH_KNOTS, with multiplicities and knots");
  }
  for (std::size_t k = 0; k < 2; ++k) {
    if (!listed.empty()) {
      auto read =
          read_knots(reader, instance, degree[k], count[k], listed[k], listed[k + 2], names[k]);
      if (!read) return std::unexpected(std::move(read.error()));
      knots.push_back(*std::move(read));
    } else if (form) {
      auto implied = implied_knots(*form, degree[k], count[k]);
      if (!implied) {
        return reader.error(instance, std::string(names[k]) + ": " + implied.error().what,
                            implied.error().remedy);
      }
      knots.push_back(*std::move(implied));
    }
  }
  return std::array<KnotVector, 2>{std::move(knots[0]), std::move(knots[1])};
}

Expected<std::vector<double>> surface_weights(const Reader& reader, std::uint32_t instance,
                                              const Net& points) {
  std::vector<double> weights;
  if (!reader.is(instance, "RATIONAL_B_SPLINE_SURFACE")) return weights;
  const auto attributes =
      reader.attributes(instance, "RATIONAL_B_SPLINE_SURFACE", attributes_of_b_spline_surface, 1);
  if (attributes.empty()) return reader.error(instance, "it is rational and has no weights");
  const auto net = read_net(reader, instance, attributes[0], "weights");
  if (!net) return std::unexpected(net.error());
  if (net->rows != points.rows || net->columns != points.columns) {
    return reader.error(instance, std::to_string(net->rows) + " x " + std::to_string(net->columns) +
                                      " weights for " + std::to_string(points.rows) + " x " +
                                      std::to_string(points.columns) + " control points");
  }
  for (std::size_t k = 0; k < net->values.size(); ++k) {
    const auto weight = reader.real(net->values[k]);
    if (!weight)
      return reader.error(instance,
                          "weight " + std::to_string(k) + " is not a number a double can hold");
    weights.push_back(*weight);
  }
  return weights;
}

}  // namespace

std::vector<std::uint32_t> knot_parameters(const Reader& reader, std::uint32_t instance) {
  if (!reader.is(instance, "B_SPLINE_SURFACE_WITH_KNOTS")) return {};
  return reader.attributes(instance, "B_SPLINE_SURFACE_WITH_KNOTS", attributes_of_b_spline_surface,
                           4);
}

std::uint32_t weights_parameter(const Reader& reader, std::uint32_t instance) {
  return reader.attributes(instance, "RATIONAL_B_SPLINE_SURFACE", attributes_of_b_spline_surface, 1)
      .front();
}

const char* implied_keyword(ImpliedKnots form) {
  switch (form) {
    case ImpliedKnots::bezier:
      return "BEZIER_SURFACE";
    case ImpliedKnots::quasi_uniform:
      return "QUASI_UNIFORM_SURFACE";
    default:
      return "UNIFORM_SURFACE";
  }
}

std::optional<ImpliedKnots> implied_form(const Reader& reader, std::uint32_t instance) {
  for (const auto form :
       {ImpliedKnots::bezier, ImpliedKnots::quasi_uniform, ImpliedKnots::uniform}) {
    if (reader.is(instance, implied_keyword(form))) return form;
  }
  return std::nullopt;
}

bool is_b_spline_surface(const Reader& reader, std::uint32_t instance) {
  return std::any_of(forms.begin(), forms.end(),
                     [&](std::string_view form) { return reader.is(instance, form); });
}

std::vector<std::uint32_t> b_spline_surfaces(const Reader& reader) {
  return reader.file().named(forms);
}

Expected<ReadSurface> read_b_spline_surface(const Reader& reader, std::uint32_t instance) {
  const auto attributes = reader.attributes(instance, "B_SPLINE_SURFACE", 1, 3);
  if (attributes.empty()) return reader.error(instance, "it lacks degrees and control points");
  const auto p = reader.integer(attributes[0]);
  const auto q = reader.integer(attributes[1]);
  if (!p || !q) return reader.error(instance, "its degrees are not integers");
  if (*p < 1 || *p > max_degree || *q < 1 || *q > max_degree) {
    return reader.error(instance,
                        "its degrees are " + std::to_string(*p) + " x " + std::to_string(*q),
                        "degrees 1 to " + std::to_string(max_degree) + " can be read");
  }
  const auto net = read_net(reader, instance, attributes[2], "control points");
  if (!net) return std::unexpected(net.error());
  auto knots = surface_knots(reader, instance, {*p, *q}, {net->rows, net->columns});
  if (!knots) return std::unexpected(std::move(knots.error()));
  auto weights = surface_weights(reader, instance, *net);
  if (!weights) return std::unexpected(std::move(weights.error()));

  Points points(static_cast<Eigen::Index>(net->values.size()), 3);
  for (std::size_t k = 0; k < net->values.size(); ++k) {
    const auto target = reader.reference(net->values[k]);
    if (!target) {
      return reader.error(instance, "control point " + std::to_string(k) +
                                        " does not refer to an entity of this file");
    }
    const auto point = reader.point(*target);
    if (!point) return std::unexpected(point.error());
    points.row(static_cast<Eigen::Index>(k)) = point->transpose();
  }
  auto surface = Surface::create(*std::move(knots), std::move(points), *std::move(weights));
  if (!surface) return reader.error(instance, surface.error().what, surface.error().remedy);
  return ReadSurface{instance, *std::move(surface)};
}

std::vector<Expected<ReadSurface>> read_b_spline_surfaces(
    const Reader& reader, std::span<const std::uint32_t> instances) {
  std::vector<Expected<ReadSurface>> result(instances.size(), std::unexpected(Error{}));
  share(reader, instances.size(), [&](const Reader& worker, std::size_t k) {
    result[k] = read_b_spline_surface(worker, instances[k]);
  });
  return result;
}

std::vector<std::uint32_t> control_point_values(const Reader& reader, std::uint32_t instance) {
  std::vector<std::uint32_t> result;
  for (const auto row :
       reader.file().children(reader.attributes(instance, "B_SPLINE_SURFACE", 1, 3)[2])) {
    const auto values = reader.file().children(row);
    result.insert(result.end(), values.begin(), values.end());
  }
  return result;
}

}  // namespace knead::step
