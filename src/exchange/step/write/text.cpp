#include "text.hpp"

#include <algorithm>
#include <array>

#include "exchange/length_units.hpp"
#include "exchange/part21/part21_text.hpp"
#include "knead/exchange/format.hpp"
#include "new_faces.hpp"
#include "print.hpp"

namespace knead::step {
namespace {

struct Protocol {
  std::string_view schema, name, application;
  int year;
};

/// By `Schema`.
constexpr std::array<Protocol, 2> protocols = {
    {{"AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }", "automotive_design",
      "core data for automotive mechanical design processes", 2000},
     {"AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF { 1 0 10303 442 1 1 4 }",
      "ap242_managed_model_based_3d_engineering", "managed model based 3d engineering", 2014}}};

// The DATA section, record by record.
class Records {
 public:
  /// Adds "#n=record;" and returns "#n".
  std::string add(const std::string& record) {
    auto name = next();
    text_ += name + "=" + record + ";\n";
    return name;
  }
  std::string add_point(const double* coordinates) {
    auto name = next();
    text_ += print_point(name, coordinates) + "\n";
    return name;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string next() { return "#" + std::to_string(++last_); }

  std::string text_;
  int last_ = 0;
};

std::string add_length_unit(const AddRecord& add, const KnownLengthUnit& unit) {
  const auto metric = [&](std::string_view prefix) {
    return add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(" + std::string(prefix) + ",.METRE.))");
  };
  if (!unit.si_prefix.empty()) return metric(unit.si_prefix);
  const auto exponents = add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)");
  const auto factor = add("LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(" + format_shortest_real(unit.millimetres) + ")," +
                          metric(".MILLI.") + ")");
  return add("(CONVERSION_BASED_UNIT('" + std::string(unit.step_name) + "'," + factor + ")LENGTH_UNIT()NAMED_UNIT(" +
             exponents + "))");
}

std::string add_surface(Records& records, const NewSurface& item) {
  const Surface& surface = item.surface;
  std::vector<std::string> names;
  for (Eigen::Index k = 0; k < surface.size(); ++k) {
    names.push_back(records.add_point(surface.control_points().row(k).data()));
  }
  return records.add(print_surface(
      surface, encode_string(item.name), [&](int k) { return names[static_cast<std::size_t>(k)]; }, "\n"));
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
  return text;
}

std::string add_curve(Records& records, const NewCurve& item) {
  std::vector<std::string> names;
  for (Eigen::Index k = 0; k < item.curve.size(); ++k) {
    names.push_back(records.add_point(item.curve.control_points().row(k).data()));
  }
  return records.add(
      print_curve(item.curve, encode_string(item.name), [&](int k) { return names[static_cast<std::size_t>(k)]; }));
}

/// Whether STEP can hold them: none is torn along a knot.
Expected<void> whole(std::span<const NewSurface> surfaces, std::span<const NewCurve> curves) {
  const auto check = [](const KnotVector& knots, const char* kind, std::size_t k) -> Expected<void> {
    if (knots.max_interior_multiplicity() <= knots.degree()) return {};
    return input_error(std::string("STEP knows no ") + kind + " that is torn along a knot",
                       kind + (" " + std::to_string(k)),
                       "keep knots inside the domain to a multiplicity of " + std::to_string(knots.degree()));
  };
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    for (const auto& knots : surfaces[k].surface.knots()) {
      if (auto can = check(knots, "surface", k); !can) return can;
    }
  }
  for (std::size_t k = 0; k < curves.size(); ++k) {
    if (auto can = check(curves[k].curve.knots(0), "curve", k); !can) return can;
  }
  return {};
}

/// The context of a representation with its units: lengths in `unit`, one of `is_length_unit`, angles in radians.
std::string print_context(std::string_view unit, const AddRecord& add) {
  constexpr double uncertainty = 1e-7;  // a length
  const auto length = add_length_unit(add, *length_unit_named(unit));
  const auto angle = add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
  const auto solid_angle = add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
  const auto gap = add("UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(" + format_shortest_real(uncertainty) + ")," +
                       length + ",'distance_accuracy_value','')");
  return add("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((" + gap +
             "))GLOBAL_UNIT_ASSIGNED_CONTEXT((" + length + "," + angle + "," + solid_angle +
             "))REPRESENTATION_CONTEXT('',''))");
}

}  // namespace

Expected<std::string> text_of(std::span<const NewSurface> surfaces, const TextOptions& options,
                              std::span<const NewCurve> curves) {
  if (!is_length_unit(options.unit)) {
    return input_error("the unit " + options.unit + " is not known", {}, "use " + list_of_length_units());
  }
  if (surfaces.empty() && curves.empty()) return input_error("there is no surface to write");
  if (auto can = whole(surfaces, curves); !can) return std::unexpected(can.error());

  Records records;
  const auto product_name = encode_string(options.product);
  const Protocol& protocol = protocols[static_cast<std::size_t>(options.schema)];
  const auto application = records.add("APPLICATION_CONTEXT('" + std::string(protocol.application) + "')");
  records.add("APPLICATION_PROTOCOL_DEFINITION('international standard','" + std::string(protocol.name) + "'," +
              std::to_string(protocol.year) + "," + application + ")");
  const auto product_context = records.add("PRODUCT_CONTEXT(''," + application + ",'mechanical')");
  const auto product = records.add("PRODUCT(" + product_name + "," + product_name + ",'',(" + product_context + "))");
  records.add("PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(" + product + "))");
  const auto formation = records.add("PRODUCT_DEFINITION_FORMATION('',''," + product + ")");
  const auto design = records.add("PRODUCT_DEFINITION_CONTEXT('part definition'," + application + ",'design')");
  const auto definition = records.add("PRODUCT_DEFINITION('design',''," + formation + "," + design + ")");
  const auto shape = records.add("PRODUCT_DEFINITION_SHAPE('',''," + definition + ")");
  const auto context = print_context(options.unit, [&](const std::string& record) { return records.add(record); });
  const auto origin = records.add("CARTESIAN_POINT('',(0.,0.,0.))");
  const auto axis = records.add("DIRECTION('',(0.,0.,1.))");
  const auto direction = records.add("DIRECTION('',(1.,0.,0.))");
  const auto placement = records.add("AXIS2_PLACEMENT_3D(''," + origin + "," + axis + "," + direction + ")");
  const auto add = [&](const std::string& record) { return records.add(record); };
  std::vector<std::string> names;
  for (const auto& surface : surfaces) names.push_back(add_surface(records, surface));
  const auto represent = [&](const char* kind, const std::string& item) {
    return records.add(std::string(kind) + "(" + product_name + ",(" + placement + "," + item + ")," + context + ")");
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
  for (const auto& curve : curves) items += (items.empty() ? "" : ",") + add_curve(records, curve);
  if (!items.empty()) {
    const bool wires = surfaces.empty() || options.faces;
    const auto set = records.add((wires ? "GEOMETRIC_CURVE_SET('',(" : "GEOMETRIC_SET('',(") + items + "))");
    const auto second = represent(wires ? "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION"
                                        : "GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION",
                                  set);
    if (!first.empty()) records.add("SHAPE_REPRESENTATION_RELATIONSHIP('',''," + first + "," + second + ")");
    if (first.empty()) first = second;
  }
  records.add("SHAPE_DEFINITION_REPRESENTATION(" + shape + "," + first + ")");
  add_colours(surfaces, names, context, add);

  return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME(" + encode_string(options.file_name) + "," +
         encode_string(options.time_stamp) + ",(''),(''),'Knead','Knead','');\n" + "FILE_SCHEMA(('" +
         std::string(protocol.schema) + "'));\nENDSEC;\nDATA;\n" + records.text() + "ENDSEC;\nEND-ISO-10303-21;\n";
}

}  // namespace knead::step
