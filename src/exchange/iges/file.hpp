#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "knead/base/error.hpp"

namespace knead::iges {

/// Columns of a record: its text, the section's letter and number; of a parameter record's text the
/// data, with the entity's number behind.
inline constexpr std::size_t record_columns = 80, letter_column = 72, data_columns = 64;

/// One record: 80 columns, without what ends its line.
struct Line {
  std::uint32_t begin = 0, end = 0;  ///< bytes of the file; `end` is before the line break
};

/// One entity, as its two directory records have it (IGES 5.3, § 2.2.4.4).
struct Entity {
  int type = 0, form = 0;
  int transform = 0;       ///< directory number of its transformation matrix (124); 0: none
  int first = 0;           ///< its first parameter record, from 0; -1: none
  int lines = 0;           ///< the number of its parameter records that the directory states
  bool dependent = false;  ///< it is nothing without the entity of which it is a part (flag 01, 03)
  bool parametric = false;  ///< its geometry is in the parameters of a surface (entity use flag 05)
  std::string label;
};

/// The global section (§ 2.2.4.3), as far as it is needed.
struct Global {
  char separator = ',', terminator = ';';
  std::string unit;       ///< "mm", "inch", …; "unknown" if it cannot be determined
  std::string system;     ///< what wrote the file
  double scale = 1;       ///< lengths of the model over those of the real thing
  double resolution = 0;  ///< smallest discernible distance, in the file's units; 0: not given
};

/// The parameters of an entity: numbers, pointers and strings as written, without blanks around
/// them.
struct Parameters {
  std::vector<std::string> values;  ///< the first is the type; an empty one has its default
  int lines = 0;                    ///< records up to the one that holds the terminator
  std::string rest;                 ///< what follows the terminator in that record: a comment
};

/// An IGES file in fixed ASCII form (IGES 5.3, § 2.2), whose records remember their bytes.
///
/// Beyond the standard these deviations are accepted: line breaks LF and CR LF, or none at all;
/// blank start sections; parameter records beyond the count in the directory, as long as they name
/// the entity; missing fields at the end of a record; trailing blank lines. Errors (input), with
/// line: another form (compressed ASCII, binary), records without a section letter, sections out of
/// order, an odd number of directory records, numbers where there are none. Cost of reading:
/// linear; parameters are read when asked for. Immutable.
class File {
 public:
  [[nodiscard]] static Expected<File> parse(std::string bytes, std::string name);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  [[nodiscard]] const Global& global() const { return global_; }
  [[nodiscard]] const std::vector<Entity>& entities() const { return entities_; }
  /// The directory number of entity k, 2 k + 1, by which others refer to it.
  [[nodiscard]] static int number(std::size_t k) { return 2 * static_cast<int>(k) + 1; }
  /// The entity with a directory number; null if there is none.
  [[nodiscard]] const Entity* find(int number) const;
  /// Errors (input): the entity has no parameters; they do not end.
  [[nodiscard]] Expected<Parameters> parameters(int number) const;
  /// "D15, type 128 (B-spline surface)".
  [[nodiscard]] std::string label(int number) const;
  [[nodiscard]] std::unexpected<Error> error(int number, std::string what,
                                             std::string remedy = {}) const;

  /// Records of a section: 'S', 'G', 'D', 'P' or 'T'.
  [[nodiscard]] const std::vector<Line>& lines(char section) const;
  [[nodiscard]] std::string_view text(const Line& line) const {
    return std::string_view(bytes_).substr(line.begin, line.end - line.begin);
  }

 private:
  File() = default;
  [[nodiscard]] Expected<void> split();
  [[nodiscard]] Expected<void> read_global();
  [[nodiscard]] Expected<void> read_directory();
  [[nodiscard]] std::unexpected<Error> line_error(const Line& line, std::string what,
                                                  std::string remedy) const;

  std::string name_, bytes_;
  std::vector<Line> sections_[5];
  Global global_;
  std::vector<Entity> entities_;
};

/// What an entity type is called: "B-spline surface"; empty if it is not known.
[[nodiscard]] std::string_view type_name(int type);

/// An integer as written; none if it is not one. A blank is 0.
[[nodiscard]] std::optional<int> integer(std::string_view text);
/// A number, with an exponent letter E or D; none if it is not one. A blank is 0.
[[nodiscard]] std::optional<double> real(std::string_view text);
/// The content of "5HHello"; empty if it is not a string.
[[nodiscard]] std::string string(std::string_view text);

}  // namespace knead::iges
