#include "free_curves.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "curves.hpp"

namespace knead::step {
namespace {

/// What may refer to a curve that stands for itself.
constexpr std::array<std::string_view, 13> standing_holders = {
    "GEOMETRIC_CURVE_SET",
    "GEOMETRIC_SET",
    "REPRESENTATION",
    "SHAPE_REPRESENTATION",
    "CONSTRUCTIVE_GEOMETRY_REPRESENTATION",
    "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION",
    "GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION",
    "MANIFOLD_SURFACE_SHAPE_REPRESENTATION",
    "ADVANCED_BREP_SHAPE_REPRESENTATION",
    "DRAUGHTING_MODEL",
    "STYLED_ITEM",
    "OVER_RIDING_STYLED_ITEM",
    "PRESENTATION_LAYER_ASSIGNMENT"};

constexpr std::array<std::string_view, 4> curve_forms = {
    "B_SPLINE_CURVE_WITH_KNOTS", "BEZIER_CURVE", "QUASI_UNIFORM_CURVE", "UNIFORM_CURVE"};

}  // namespace

bool is_b_spline_curve(const Reader& reader, std::uint32_t instance) {
  return std::ranges::any_of(curve_forms,
                             [&](std::string_view form) { return reader.is(instance, form); });
}

std::vector<ReadCurve> free_curves(const Reader& reader, std::vector<UnreadableCurve>* unreadable) {
  const Part21File& file = reader.file();
  const auto count = static_cast<std::uint32_t>(file.instances().size());
  std::vector<std::uint32_t> curves;
  for (const auto k : file.named(curve_forms)) {
    if (file.instance(k).uses > 0) curves.push_back(k);
  }
  if (curves.empty()) return {};
  std::vector<std::uint32_t> held(count, 0);
  for (const auto k : file.named(standing_holders)) {
    const Part21Instance& record = file.instance(k);
    for (auto value = record.first; value < record.last; ++value) {
      if (const auto target = reader.reference(value)) ++held[*target];
    }
  }
  std::vector<ReadCurve> result;
  for (const std::uint32_t k : curves) {
    if (held[k] != file.instance(k).uses) continue;
    auto curve = read_b_spline_curve(reader, k);
    const auto attributes = reader.attributes(k, "B_SPLINE_CURVE", 1, 2);
    auto points = curve ? file.children(attributes[1]) : std::vector<std::uint32_t>();
    if (curve && std::ssize(points) != curve->size())
      curve = reader.error(k, "a basis function is zero everywhere");
    if (curve)
      result.push_back({k, *std::move(curve), std::move(points)});
    else if (unreadable != nullptr)
      unreadable->push_back({k, std::move(curve.error())});
  }
  return result;
}

}  // namespace knead::step
