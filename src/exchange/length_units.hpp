#pragma once

#include <span>
#include <string>
#include <string_view>

namespace knead {

/// A unit of length, and how formats write it.
struct KnownLengthUnit {
  std::string_view name;  ///< in all reports and options: "mm", "inch", …
  double millimetres = 0;
  /// Of the metre in STEP; empty: a CONVERSION_BASED_UNIT of so many millimetres.
  std::string_view si_prefix = {};
  std::string_view step_name = {};  ///< of that
  std::string_view iges_name = {};  ///< of the global section; empty: IGES does not know the unit
  int iges_flag = 0;
};

/// All of them, the usual ones first.
[[nodiscard]] std::span<const KnownLengthUnit> known_length_units();

/// The unit of this name; null: there is none.
[[nodiscard]] const KnownLengthUnit* length_unit_named(std::string_view name);

/// The unit of this length, to 1e-9 of it, which tells the foot (0.3048 m) from the survey foot
/// (1200/3937 m); null: there is none.
[[nodiscard]] const KnownLengthUnit* length_unit_of(double millimetres);

/// "um, mm, …, inch or foot": those that `usable` accepts, for remedies.
template <class Usable>
[[nodiscard]] std::string list_of_units(const Usable& usable) {
  std::string list, last;
  for (const KnownLengthUnit& unit : known_length_units()) {
    if (!usable(unit)) continue;
    if (!last.empty()) list += (list.empty() ? "" : ", ") + last;
    last = unit.name;
  }
  return list.empty() ? last : list + " or " + last;
}

}  // namespace knead
