#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
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

/// One parameter. Parameters lie in one array in reading order: the children of a list or typed
/// parameter k are k + 1 and onwards, each at the `next` of the one before it, up to the `next` of
/// k.
struct Part21Value {
  Part21Kind kind = Part21Kind::unset;
  std::uint32_t next = 0;
  /// Reference: index of the instance, `no_instance` if outside the file.
  std::uint32_t target = no_instance;
};

/// One entity instance, "#12=…;".
struct Part21Instance {
  std::uint64_t id = 0;
  ByteRange bytes;          ///< from '#' to ';' inclusive, with its &SCOPE if it has one
  ByteRange record;         ///< the record alone: KEYWORD(…), or (KEYWORD(…)KEYWORD(…)…)
  std::uint32_t first = 0;  ///< its parts (kind `typed`) are values first … last
  std::uint32_t last = 0;
  std::uint32_t scope = no_instance;  ///< the instance whose &SCOPE contains it
  /// Number of references to it, ANCHOR section included, export lists not.
  std::uint32_t uses : 31 = 0;
  std::uint32_t complex : 1 = 0;  ///< external mapping: several parts
};

/// A reference to a name that the file does not define.
struct Part21Dangling {
  std::string place;  ///< "#12 STYLED_ITEM"
  std::uint64_t id = 0;
  std::uint32_t byte = 0;
};

/// A parsed exchange structure (ISO 10303-21, editions 1 to 3): every record and parameter with its
/// bytes.
///
/// Comments, print control directives and line breaks may occur between any two tokens; &SCOPE
/// (edition 1), several DATA sections (edition 2) and ANCHOR, REFERENCE and SIGNATURE sections
/// (edition 3) are read. Beyond the standard, these common deviations are accepted, since the bytes
/// are kept as they are: a byte order mark, lower-case keywords, reals without a digit before the
/// point or with an exponent letter D or e, bytes above 127 in strings, NUL or ^Z at the end.
/// Errors (input), with line and entity: anything else outside the grammar; unterminated strings
/// and comments; names defined twice; names above 2^63 − 1; more than 200 nested lists; more than
/// 2^28 − 2 entities; more than 4 GB. References to names that are not defined are `dangling`.
/// Cost: linear in the size of the file; besides the bytes, 8 bytes per parameter and 52 per
/// entity, and 16 more where their names do not ascend. Immutable.
class Part21File {
 public:
  [[nodiscard]] static Expected<Part21File> parse(std::string bytes, std::string name);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  /// In the order of their '#' in the file.
  [[nodiscard]] const std::vector<Part21Instance>& instances() const { return instances_; }
  [[nodiscard]] Part21Value value(std::uint32_t k) const {
    return {kind(k), next_of(k), target(k)};
  }
  [[nodiscard]] Part21Kind kind(std::uint32_t value) const {
    return static_cast<Part21Kind>(values_[value].kind);
  }
  /// The instance that a reference leads to; `no_instance` for one outside the file, and for all
  /// other values.
  [[nodiscard]] std::uint32_t target(std::uint32_t value) const {
    const Stored& stored = values_[value];
    const bool leads =
        static_cast<Part21Kind>(stored.kind) == Part21Kind::reference && stored.content != too_much;
    return leads ? stored.content : no_instance;
  }
  /// The values that a list or typed parameter holds itself, of which no more than the `Most` first
  /// are told.
  template <std::size_t Most>
  [[nodiscard]] std::array<std::uint32_t, Most> first_children(std::uint32_t value,
                                                               std::size_t& count) const {
    std::array<std::uint32_t, Most> result{};
    count = 0;
    const auto end = next_of(value);
    for (auto k = value + 1; k < end; k = next_of(k), ++count) {
      if (count < Most) result[count] = k;
    }
    return result;
  }
  /// Of a list or typed parameter in time linear in what it holds.
  [[nodiscard]] ByteRange range(std::uint32_t value) const {
    return {values_[value].begin, end_of(value)};
  }
  [[nodiscard]] const Part21Instance& instance(std::uint32_t k) const { return instances_[k]; }

  /// Whether a value of kind `typed` has this keyword, in upper or lower case.
  [[nodiscard]] bool is_named(std::uint32_t value, std::string_view keyword) const;
  /// The instances with a part of one of these names, in the order of the file. Cost: linear in
  /// their number.
  [[nodiscard]] std::vector<std::uint32_t> named(std::span<const std::string_view> keywords) const;
  [[nodiscard]] std::vector<std::uint32_t> named(
      std::initializer_list<std::string_view> keywords) const {
    return named(std::span(keywords.begin(), keywords.size()));
  }
  /// Names of parts that occur, as first written, in no particular order.
  [[nodiscard]] std::vector<std::string_view> keywords() const;

  /// Index of the instance #id.
  [[nodiscard]] std::optional<std::uint32_t> find(std::uint64_t id) const;
  /// The bytes, which the file then no longer has.
  [[nodiscard]] std::string take_bytes() && { return std::move(bytes_); }
  /// True if #id is taken, by an instance or by the REFERENCE section.
  [[nodiscard]] bool taken(std::uint64_t id) const { return lookup(id).has_value(); }
  /// The largest name taken; 0 if there is none.
  [[nodiscard]] std::uint64_t largest_id() const { return largest_id_; }

  /// The first references to nothing, in the order of the file, and the number of all. Their
  /// targets are `no_instance`; `largest_id` is no less than their names.
  [[nodiscard]] const std::vector<Part21Dangling>& dangling() const { return dangling_; }
  [[nodiscard]] std::size_t dangling_count() const { return dangling_count_; }
  static constexpr std::size_t most_dangling = 10;

  /// The records of the HEADER section: values (kind `typed`), in order.
  [[nodiscard]] const std::vector<std::uint32_t>& header() const { return header_; }

  [[nodiscard]] std::string_view text(ByteRange range) const {
    return std::string_view(bytes_).substr(range.begin, range.end - range.begin);
  }
  [[nodiscard]] std::string_view text(std::uint32_t value) const { return text(range(value)); }
  /// The keyword of a value of kind `typed`, as written.
  [[nodiscard]] std::string_view keyword(std::uint32_t value) const;
  /// The children of a list or typed parameter.
  [[nodiscard]] std::vector<std::uint32_t> children(std::uint32_t value) const;
  /// 1-based line of a byte. Cost: O(log lines).
  [[nodiscard]] int line(std::uint32_t byte) const;

 private:
  Part21File() = default;
  friend class Part21Parser;
  friend class Part21Names;

  /// A name and its instance; no_instance: of the REFERENCE section.
  struct Name {
    std::uint64_t id = 0;
    std::uint32_t instance = no_instance;
    std::uint32_t byte = 0;  ///< where it is defined
  };
  /// The instance of a name; `no_instance` if it is one of the REFERENCE section.
  [[nodiscard]] std::optional<std::uint32_t> lookup(std::uint64_t id) const;

  /// Room for what the bytes can hold at most, and the lines before each block of them.
  void reserve(bool names_only = false);

  /// A parameter in 8 bytes. `content` is, by kind, the instance a reference leads to, the number
  /// of values that a list or typed parameter takes, itself included, or else the number of bytes;
  /// `too_much` where that is more.
  struct Stored {
    std::uint32_t begin = 0;
    std::uint32_t kind : 4 = 0;
    std::uint32_t content : 28 = 0;
  };
  static constexpr std::uint32_t too_much = (1U << 28U) - 1;
  [[nodiscard]] std::uint32_t next_of(std::uint32_t value) const {
    const Stored& stored = values_[value];
    const auto kind = static_cast<Part21Kind>(stored.kind);
    if (kind != Part21Kind::list && kind != Part21Kind::typed) return value + 1;
    return stored.content != too_much ? value + stored.content : wide_.at(value);
  }
  [[nodiscard]] std::uint32_t end_of(std::uint32_t value) const;

  /// A name of parts, and its share of `named_`.
  struct Keyword {
    ByteRange bytes;  ///< where it stands first
    std::uint32_t first = 0, last = 0;
  };

  std::string name_;
  std::string bytes_;
  std::vector<Part21Instance> instances_;
  std::vector<Stored> values_;
  std::map<std::uint32_t, std::uint32_t> wide_;  // next of the values for which that is too much
  std::vector<std::uint32_t> header_;
  std::vector<Part21Dangling> dangling_;
  std::size_t dangling_count_ = 0;
  std::vector<std::uint32_t> lines_before_;  // before each block of bytes
  // Sorted by id, which no choice of names makes slow as it would a hash table; empty where those
  // of the instances ascend.
  std::vector<Name> index_;
  std::vector<Keyword> keywords_;     // sorted, whatever their case
  std::vector<std::uint32_t> named_;  // the instances with each of them
  std::uint64_t largest_id_ = 0;
};

/// The names in an exchange structure, and nothing else of it; but its whole grammar has been
/// checked, as by `Part21File::parse`, except that references may lead anywhere. Memory: 16 bytes
/// per entity.
class Part21Names {
 public:
  /// \param bytes are referred to for as long as the object lives, and must not move
  [[nodiscard]] static Expected<Part21Names> parse(std::string& bytes, std::string name);
  /// The text of #id, from its '#' to its ';'; one with a &SCOPE ends in that.
  [[nodiscard]] std::optional<std::string_view> record(std::uint64_t id) const;

 private:
  std::string_view bytes_;
  std::vector<Part21File::Name> names_;
};

}  // namespace knead
