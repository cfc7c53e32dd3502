#include "text.hpp"

#include <algorithm>

#include "exchange/format_list.hpp"
#include "exchange/part21/part21_text.hpp"
#include "knead/exchange/format.hpp"
#include "new_faces.hpp"
#include "new_file.hpp"
#include "print.hpp"

namespace knead::step {
namespace {

std::string add_surface(NewFile& file, const NewSurface& item) {
  const Surface& surface = item.surface;
  std::vector<std::string> names;
  for (Eigen::Index k = 0; k < surface.size(); ++k) {
    names.push_back(file.add_point(surface.control_points().row(k).data()));
  }
  return file.add(print_surface(
      surface, encode_string(item.name), [&](int k) { return names[static_cast<std::size_t>(k)]; },
      "\n"));
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
  return text;
}

std::string add_curve(NewFile& file, const NewCurve& item) {
  std::vector<std::string> names;
  for (Eigen::Index k = 0; k < item.curve.size(); ++k) {
    names.push_back(file.add_point(item.curve.control_points().row(k).data()));
  }
  return file.add(print_curve(item.curve, encode_string(item.name),
                              [&](int k) { return names[static_cast<std::size_t>(k)]; }));
}

/// Whether STEP can hold them: none is torn along a knot.
Expected<void> whole(std::span<const NewSurface> surfaces, std::span<const NewCurve> curves) {
  const auto check = [](const KnotVector& knots, const char* kind,
                        const std::string& name) -> Expected<void> {
    if (knots.max_interior_multiplicity() <= knots.degree()) return {};
    return input_error(
        std::string("STEP knows no ") + kind + " that is torn along a knot", name,
        "keep knots inside the domain to a multiplicity of " + std::to_string(knots.degree()));
  };
  for (const NewSurface& item : surfaces) {
    for (const auto& knots : item.surface.knots()) {
      if (auto can = check(knots, "surface", item.id.empty() ? item.name : item.id); !can)
        return can;
    }
  }
  for (const NewCurve& item : curves) {
    if (auto can = check(item.curve.knots(0), "curve", item.id.empty() ? item.name : item.id); !can)
      return can;
  }
  return {};
}

constexpr double stated_uncertainty = 1e-7;  // a length

}  // namespace

Expected<std::string> text_of(std::span<const NewSurface> surfaces, const TextOptions& options,
                              std::span<const NewCurve> curves) {
  if (auto known = check_unit(options.unit); !known)
    return std::unexpected(std::move(known.error()));
  if (surfaces.empty() && curves.empty()) return detail::nothing_to_write();
  if (auto can = whole(surfaces, curves); !can) return std::unexpected(can.error());

  NewFile file(options.schema);
  const auto product_name = encode_string(options.product);
  const auto shape = file.add_product(options.product).shape;
  const auto context = file.add_context(options.unit, stated_uncertainty);
  const auto placement = file.add_origin();
  const auto add = [&](const std::string& record) { return file.add(record); };
  std::vector<std::string> names;
  for (const auto& surface : surfaces) names.push_back(add_surface(file, surface));
  const auto represent = [&](const char* kind, const std::string& item) {
    return file.add(std::string(kind) + "(" + product_name + ",(" + placement + "," + item + ")," +
                    context + ")");
  };
  std::string first;
  if (options.faces && !surfaces.empty()) {
    auto faces = add_faces(surfaces, names, add);
    if (!faces) return std::unexpected(std::move(faces.error()));
    first = represent("MANIFOLD_SURFACE_SHAPE_REPRESENTATION", faces->model);
    names = std::move(faces->faces);
  }
  std::string items;
  if (!options.faces) items = joined(names);
  for (const auto& curve : curves) items += (items.empty() ? "" : ",") + add_curve(file, curve);
  if (!items.empty()) {
    const bool wires = surfaces.empty() || options.faces;
    const auto set =
        file.add((wires ? "GEOMETRIC_CURVE_SET('',(" : "GEOMETRIC_SET('',(") + items + "))");
    const auto second = represent(wires ? "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION"
                                        : "GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION",
                                  set);
    if (!first.empty())
      file.add("SHAPE_REPRESENTATION_RELATIONSHIP('',''," + first + "," + second + ")");
    if (first.empty()) first = second;
  }
  file.add("SHAPE_DEFINITION_REPRESENTATION(" + shape + "," + first + ")");
  std::vector<Coloured> coloured;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    if (surfaces[k].colour) coloured.push_back({names[k], *surfaces[k].colour});
  }
  add_colours(coloured, context, add);
  return file.text(options);
}

}  // namespace knead::step
