#include "new_file.hpp"

#include <array>

#include "exchange/length_units.hpp"
#include "exchange/part21/part21_text.hpp"
#include "knead/exchange/format.hpp"
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

std::string add_length_unit(NewFile& file, const KnownLengthUnit& unit) {
  const auto metric = [&](std::string_view prefix) {
    return file.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(" + std::string(prefix) + ",.METRE.))");
  };
  if (!unit.si_prefix.empty()) return metric(unit.si_prefix);
  const auto exponents = file.add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)");
  const auto factor =
      file.add("LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(" + format_shortest_real(unit.millimetres) +
               ")," + metric(".MILLI.") + ")");
  return file.add("(CONVERSION_BASED_UNIT('" + std::string(unit.step_name) + "'," + factor +
                  ")LENGTH_UNIT()NAMED_UNIT(" + exponents + "))");
}

}  // namespace

NewFile::NewFile(Schema schema) : schema_(schema) {
  const Protocol& protocol = protocols[static_cast<std::size_t>(schema)];
  application_ = add("APPLICATION_CONTEXT('" + std::string(protocol.application) + "')");
  add("APPLICATION_PROTOCOL_DEFINITION('international standard','" + std::string(protocol.name) +
      "'," + std::to_string(protocol.year) + "," + application_ + ")");
  product_context_ = add("PRODUCT_CONTEXT(''," + application_ + ",'mechanical')");
  design_ = add("PRODUCT_DEFINITION_CONTEXT('part definition'," + application_ + ",'design')");
}

std::string NewFile::add(const std::string& record) {
  auto name = next();
  text_ += name + "=" + record + ";\n";
  return name;
}

std::string NewFile::add_point(const double* coordinates) {
  auto name = next();
  text_ += print_point(name, coordinates) + "\n";
  return name;
}

std::string NewFile::add_context(std::string_view unit, double uncertainty) {
  const auto length = add_length_unit(*this, *length_unit_named(unit));
  const auto angle = add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
  const auto solid_angle = add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
  const auto gap =
      add("UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(" + format_shortest_real(uncertainty) +
          ")," + length + ",'distance_accuracy_value','')");
  return add("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((" + gap +
             "))GLOBAL_UNIT_ASSIGNED_CONTEXT((" + length + "," + angle + "," + solid_angle +
             "))REPRESENTATION_CONTEXT('',''))");
}

NewFile::Product NewFile::add_product(std::string_view name) {
  const auto text = encode_string(name);
  const auto product = add("PRODUCT(" + text + "," + text + ",'',(" + product_context_ + "))");
  add("PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(" + product + "))");
  const auto formation = add("PRODUCT_DEFINITION_FORMATION('',''," + product + ")");
  const auto definition = add("PRODUCT_DEFINITION('design',''," + formation + "," + design_ + ")");
  return {definition, add("PRODUCT_DEFINITION_SHAPE('',''," + definition + ")")};
}

std::string NewFile::add_origin() {
  const auto origin = add("CARTESIAN_POINT('',(0.,0.,0.))");
  const auto axis = add("DIRECTION('',(0.,0.,1.))");
  const auto direction = add("DIRECTION('',(1.,0.,0.))");
  return add("AXIS2_PLACEMENT_3D(''," + origin + "," + axis + "," + direction + ")");
}

std::string NewFile::text(const TextOptions& options) const {
  const Protocol& protocol = protocols[static_cast<std::size_t>(schema_)];
  return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME(" +
         encode_string(options.file_name) + "," + encode_string(options.time_stamp) +
         ",(''),(''),'Knead','Knead','');\n" + "FILE_SCHEMA(('" + std::string(protocol.schema) +
         "'));\nENDSEC;\nDATA;\n" + text_ + "ENDSEC;\nEND-ISO-10303-21;\n";
}

Expected<void> check_unit(const std::string& unit) {
  if (is_length_unit(unit)) return {};
  return input_error("the unit " + unit + " is not known", "unit", "use " + list_of_length_units());
}

}  // namespace knead::step
