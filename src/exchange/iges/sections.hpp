#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exchange/length_units.hpp"
#include "file.hpp"
#include "knead/exchange/format.hpp"

namespace knead::iges {

using Values = std::vector<std::string>;

/// What the directory says of an entity beside its type.
struct Entry {
  int form = 0;
  std::string name = {};   ///< a label of up to eight characters, else a property 406 form 15
  int colour = 0;          ///< directory number of an entity 314, or 0
  bool dependent = false;  ///< part of another entity
  int transform = 0;       ///< directory number of an entity 124, or 0
};

/// The entities of a file that does not exist yet, one after the other.
class Sections {
 public:
  /// Returns its directory number.
  int add(int type, Values values, const Entry& entry = {});
  /// An entity 314; the same for the same colour.
  int add_colour(const Colour& colour);
  /// The file, with this title in its start section and these parameters in its global one.
  [[nodiscard]] std::string text(std::string_view title, const std::string& global) const;

 private:
  const Global global_;
  std::string directory_, parameters_;
  std::size_t entities_ = 0;
  int records_ = 0;
  std::vector<std::pair<Colour, int>> colours_;
};

/// Numbers with 17 digits.
void append(Values& to, std::span<const double> numbers);

/// "5HKnead"; characters beyond ASCII become "?".
[[nodiscard]] std::string hollerith_of(std::string_view text);

/// The unit of a new file, mm where none is given. Errors (input): IGES does not have it.
[[nodiscard]] Expected<const KnownLengthUnit*> unit_of_new_file(const std::string& name);

/// \param largest coordinate
[[nodiscard]] std::string global_section(std::string_view title, const KnownLengthUnit& unit,
                                         double largest, double resolution);

}  // namespace knead::iges
