#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "knead/base/error.hpp"

namespace knead {

/// Bytes [begin, end) of a file.
struct ByteRange {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

/// The kind of a parameter of an exchange structure (ISO 10303-21, 6.4 and 10.2).
enum class Part21Kind : std::uint8_t {
  integer,
  real,
  string,
  binary,
  enumeration,
  reference,  ///< #12
  unset,      ///< $
  derived,    ///< *
  list,       ///< ( … )
  typed,      ///< KEYWORD( … ): a typed parameter, or one part of a record
  other,      ///< edition 3: @12 value names, #NAME and @NAME constants, <resources>
};

inline constexpr std::uint32_t no_instance = 0xFFFFFFFF;

/// One parameter, with its bytes. Parameters lie in one array in reading order: the children of a list or typed
/// parameter k are k + 1 and onwards, each at the `next` of the one before it, up to the `next` of k.
struct Part21Value {
  Part21Kind kind = Part21Kind::unset;
  ByteRange bytes;
  std::uint32_t next = 0;
  std::uint32_t target = no_instance;  ///< reference: index of the instance, `no_instance` if outside the file;
                                       ///< typed: length of the keyword
};

/// One entity instance, "#12=…;".
struct Part21Instance {
  std::uint64_t id = 0;
  ByteRange bytes;          ///< from '#' to ';' inclusive, with its &SCOPE if it has one
  ByteRange record;         ///< the record alone: KEYWORD(…), or (KEYWORD(…)KEYWORD(…)…)
  std::uint32_t first = 0;  ///< its parts (kind `typed`) are values first … last
  std::uint32_t last = 0;
  std::uint32_t scope = no_instance;  ///< the instance whose &SCOPE contains it
  std::uint32_t uses = 0;             ///< number of references to it, ANCHOR section included, export lists not
  bool complex = false;               ///< external mapping: several parts
};

/// A reference to a name that the file does not define.
struct Part21Dangling {
  std::string place;  ///< "#12 STYLED_ITEM"
  std::uint64_t id = 0;
  std::uint32_t byte = 0;
};

/// A parsed exchange structure (ISO 10303-21, editions 1 to 3): every record and parameter with its bytes.
///
/// Comments, print control directives and line breaks may occur between any two tokens; &SCOPE (edition 1), several
/// DATA sections (edition 2) and ANCHOR, REFERENCE and SIGNATURE sections (edition 3) are read. Beyond the standard,
/// these common deviations are accepted, since the bytes are kept as they are: a byte order mark, lower-case keywords,
/// reals without a digit before the point or with an exponent letter D or e, bytes above 127 in strings, NUL or ^Z at
/// the end. Errors (input), with line and entity: anything else outside the grammar; unterminated strings and comments;
/// names defined twice; names above 2^63 − 1; more than 200 nested lists; more than 4
/// GB. References to names that are not defined are `dangling`. Cost: linear in the size of the file. Immutable.
class Part21File {
 public:
  [[nodiscard]] static Expected<Part21File> parse(std::string bytes, std::string name);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  /// In the order of their '#' in the file.
  [[nodiscard]] const std::vector<Part21Instance>& instances() const { return instances_; }
  [[nodiscard]] const std::vector<Part21Value>& values() const { return values_; }
  [[nodiscard]] const Part21Value& value(std::uint32_t k) const { return values_[k]; }
  [[nodiscard]] const Part21Instance& instance(std::uint32_t k) const { return instances_[k]; }

  /// Index of the instance #id.
  [[nodiscard]] std::optional<std::uint32_t> find(std::uint64_t id) const;
  /// True if #id is taken, by an instance or by the REFERENCE section.
  [[nodiscard]] bool taken(std::uint64_t id) const { return lookup(id) != index_.end(); }
  /// The largest name taken; 0 if there is none.
  [[nodiscard]] std::uint64_t largest_id() const { return largest_id_; }

  /// The first references to nothing, in the order of the file, and the number of all. Their targets are `no_instance`;
  /// `largest_id` is no less than their names.
  [[nodiscard]] const std::vector<Part21Dangling>& dangling() const { return dangling_; }
  [[nodiscard]] std::size_t dangling_count() const { return dangling_count_; }
  static constexpr std::size_t most_dangling = 10;

  /// The records of the HEADER section: values (kind `typed`), in order.
  [[nodiscard]] const std::vector<std::uint32_t>& header() const { return header_; }

  [[nodiscard]] std::string_view text(ByteRange range) const {
    return std::string_view(bytes_).substr(range.begin, range.end - range.begin);
  }
  [[nodiscard]] std::string_view text(std::uint32_t value) const { return text(values_[value].bytes); }
  /// The keyword of a value of kind `typed`, as written.
  [[nodiscard]] std::string_view keyword(std::uint32_t value) const {
    return text(value).substr(0, values_[value].target);
  }
  /// The children of a list or typed parameter.
  [[nodiscard]] std::vector<std::uint32_t> children(std::uint32_t value) const;
  /// 1-based line of a byte. Cost: O(log lines).
  [[nodiscard]] int line(std::uint32_t byte) const;

 private:
  Part21File() = default;
  friend class Part21Parser;

  /// A name and its instance; no_instance: of the REFERENCE section.
  struct Name {
    std::uint64_t id = 0;
    std::uint32_t instance = no_instance;
    std::uint32_t byte = 0;  ///< where it is defined
  };
  [[nodiscard]] std::vector<Name>::const_iterator lookup(std::uint64_t id) const;

  std::string name_;
  std::string bytes_;
  std::vector<Part21Instance> instances_;
  std::vector<Part21Value> values_;
  std::vector<std::uint32_t> header_;
  std::vector<Part21Dangling> dangling_;
  std::size_t dangling_count_ = 0;
  std::vector<std::uint32_t> line_starts_;  // of the second line and on
  std::vector<Name> index_;  // sorted by id: no choice of names makes that slow, as it would a hash table
  std::uint64_t largest_id_ = 0;
};

}  // namespace knead
