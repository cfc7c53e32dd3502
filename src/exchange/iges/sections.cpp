#include "sections.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exchange/part21/part21_text.hpp"
#include "writer.hpp"

namespace knead::iges {
namespace {

constexpr std::string_view line_end = "\n";
constexpr std::size_t label_columns = 8;

std::string ascii(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7F) result += c;
    if (byte >= 0xC0) result += '?';  // the first byte of a character
  }
  return result;
}

}  // namespace

// An entity's directory number is known before its records are, so that pointers can be written as
// entities are added; whatever an entity points to is added before it. A label has eight columns:
// longer names are a property 406, form 15.
int Sections::add(int type, Values values, const Entry& entry) {
  const std::string name = ascii(entry.name);
  if (name.size() > label_columns) {
    const int property = add(406, {"1", hollerith_of(name)}, {.form = 15, .dependent = true});
    values.insert(values.end(), {"0", "1", std::to_string(property)});
  }
  values.insert(values.begin(), std::to_string(type));
  const int number = File::number(entities_++);
  const std::vector<std::string> lines = wrapped(values, global_, "");
  directory_ += fmt::format("{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}D{:>7}{}", type,
                            records_ + 1, 0, 0, 0, 0, entry.transform, 0,
                            entry.dependent ? "00010000" : "00000000", number, line_end);
  directory_ += fmt::format("{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}D{:>7}{}", type, 0,
                            -entry.colour, lines.size(), entry.form, "", "",
                            name.substr(0, label_columns), 0, number + 1, line_end);
  for (const std::string& line : lines) {
    parameters_ += fmt::format("{:<64}{:>8}P{:>7}{}", line, number, ++records_, line_end);
  }
  return number;
}

int Sections::add_colour(const Colour& colour) {
  const auto known = std::ranges::find(colours_, colour, &std::pair<Colour, int>::first);
  if (known != colours_.end()) return known->second;
  Values percent;
  for (const double part : colour) percent.push_back(format_real(100 * part));
  return colours_.emplace_back(colour, add(314, std::move(percent))).second;
}

std::string Sections::text(std::string_view title, const std::string& global) const {
  std::string result =
      fmt::format("{:<72}S{:>7}{}", ascii(title).substr(0, letter_column), 1, line_end);
  int globals = 0;
  for (std::size_t at = 0; at < global.size(); at += letter_column) {
    result += fmt::format("{:<72}G{:>7}{}", global.substr(at, letter_column), ++globals, line_end);
  }
  return result + directory_ + parameters_ +
         fmt::format("S{:>7}G{:>7}D{:>7}P{:>7}{:<40}T{:>7}{}", 1, globals, 2 * entities_, records_,
                     "", 1, line_end);
}

void append(Values& to, std::span<const double> numbers) {
  for (const double x : numbers) to.push_back(format_real(x));
}

std::string hollerith_of(std::string_view text) {
  const std::string plain = ascii(text);
  return plain.empty() ? std::string() : fmt::format("{}H{}", plain.size(), plain);
}

Expected<const KnownLengthUnit*> unit_of_new_file(const std::string& name) {
  const KnownLengthUnit* unit = length_unit_named(name.empty() ? "mm" : name);
  if (unit != nullptr && unit->iges_flag != 0) return unit;
  return input_error(
      "the unit " + name + " is not known to IGES", "unit",
      "use " + list_of_units([](const KnownLengthUnit& u) { return u.iges_flag != 0; }));
}

std::string global_section(std::string_view title, const KnownLengthUnit& unit, double largest,
                           double resolution) {
  return fmt::format(
      "1H,,1H;,{0},{0},5HKnead,5HKnead,32,38,6,308,15,{0},1.,{1},{2},1,0.1,15H20000101.000000,{3},{"
      "4},,,11,0,"
      "15H20000101.000000;",
      hollerith_of(title), unit.iges_flag, hollerith_of(unit.iges_name),
      format_shortest_real(resolution), format_real(largest));
}

}  // namespace knead::iges
