#include "length_units.hpp"

#include "knead/exchange/format.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace knead {
namespace {

// Prefixes: ISO 10303-41, si_prefix. Flags and names: IGES 5.3, section 2.2.4.3, parameters 14
// and 15.
constexpr std::array<KnownLengthUnit, 12> units = {
    {{"mm", 1, ".MILLI.", {}, "MM", 2},
     {"um", 1e-3, ".MICRO.", {}, "UM", 9},
     {"cm", 10, ".CENTI.", {}, "CM", 10},
     {"dm", 100, ".DECI."},
     {"m", 1000, "$", {}, "M", 6},
     {"km", 1e6, ".KILO.", {}, "KM", 7},
     {"inch", 25.4, {}, "INCH", "IN", 1},
     {"foot", 304.8, {}, "FOOT", "FT", 4},
     {"yard", 914.4, {}, "YARD"},
     {"mile", 1609344, {}, "MILE", "MI", 5},
     {"mil", 0.0254, {}, "MIL", "MIL", 8},
     {"microinch", 2.54e-5, {}, "MICROINCH", "UIN", 11}}};

}  // namespace

std::span<const KnownLengthUnit> known_length_units() { return units; }

const KnownLengthUnit* length_unit_named(std::string_view name) {
  const auto found = std::ranges::find(units, name, &KnownLengthUnit::name);
  return found == units.end() ? nullptr : &*found;
}

const KnownLengthUnit* length_unit_of(double millimetres) {
  constexpr double same = 1e-9;
  const auto found = std::ranges::find_if(units, [millimetres](const KnownLengthUnit& unit) {
    return std::abs(millimetres - unit.millimetres) <= same * unit.millimetres;
  });
  return found == units.end() ? nullptr : &*found;
}

bool is_length_unit(std::string_view name) { return length_unit_named(name) != nullptr; }

std::optional<double> millimetres_of(std::string_view unit) {
  const auto* const known = length_unit_named(unit);
  return known == nullptr ? std::nullopt : std::optional(known->millimetres);
}

std::string list_of_length_units() {
  return list_of_units([](const KnownLengthUnit&) { return true; });
}

}  // namespace knead
