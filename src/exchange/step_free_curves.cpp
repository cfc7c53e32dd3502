#include "step_free_curves.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "part21_text.hpp"
#include "step_curves.hpp"

namespace knead::step {
namespace {

/// What may refer to a curve that stands for itself.
constexpr std::array<std::string_view, 13> standing_holders = {"GEOMETRIC_CURVE_SET",
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

bool holds_standing(const Reader& reader, const Part21Instance& record) {
  for (auto part = record.first; part < record.last; part = reader.file().value(part).next) {
    const std::string_view keyword = reader.file().keyword(part);
    if (std::ranges::any_of(standing_holders, [&](std::string_view name) { return same_keyword(keyword, name); }))
      return true;
  }
  return false;
}

}  // namespace

bool is_b_spline_curve(const Reader& reader, std::uint32_t instance) {
  for (const char* form : {"B_SPLINE_CURVE_WITH_KNOTS", "BEZIER_CURVE", "QUASI_UNIFORM_CURVE", "UNIFORM_CURVE"}) {
    if (reader.is(instance, form)) return true;
  }
  return false;
}

std::vector<ReadCurve> free_curves(const Reader& reader) {
  const Part21File& file = reader.file();
  const auto count = static_cast<std::uint32_t>(file.instances().size());
  std::vector<std::uint32_t> curves;
  for (std::uint32_t k = 0; k < count; ++k) {
    if (file.instance(k).uses > 0 && is_b_spline_curve(reader, k)) curves.push_back(k);
  }
  if (curves.empty()) return {};
  std::vector<std::uint32_t> held(count, 0);
  for (std::uint32_t k = 0; k < count; ++k) {
    const Part21Instance& record = file.instance(k);
    if (!holds_standing(reader, record)) continue;
    for (auto value = record.first; value < record.last; ++value) {
      if (const auto target = reader.reference(value)) ++held[*target];
    }
  }
  std::vector<ReadCurve> result;
  for (const std::uint32_t k : curves) {
    if (held[k] != file.instance(k).uses) continue;
    auto curve = read_b_spline_curve(reader, k);
    if (!curve) continue;
    const auto own = reader.attributes(k, "B_SPLINE_CURVE", 1, 2);
    result.push_back({k, *std::move(curve), file.children(own[1])});
  }
  return result;
}

}  // namespace knead::step
