#pragma once

#include <array>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "knead/base/error.hpp"

namespace knead {

// Descriptions of types as tables. A record states once what it is made of,
//
//   void describe(Ball& b, Fields& fields) {
//     fields.name("ball", "a round body");
//     fields.add("radius", b.radius, {.help = "of the ball", .unit = Unit::length, .range =
//     above(0)});
//   }
//
// declared beside the record and compiled in one file. `type_of<Ball>()` is its table: reading,
// writing and explaining values is one loop over (Type, void*), compiled once for all types.

/// What a value is made of.
enum class Kind {
  boolean,   ///< bool
  integer,   ///< int
  number,    ///< double
  text,      ///< std::string
  choice,    ///< an enumeration whose values have names
  optional,  ///< std::optional: no element or one
  list,      ///< std::vector
  array,     ///< fixed size: std::array, a small Eigen vector, adjacent members
  record,    ///< fields
  variant,   ///< std::variant of records, distinguished by their names
  opaque,    ///< not for people: a shared object, or what is stored in another form
};

/// What a number measures.
enum class Unit { none, length, angle, fraction };

/// Whether a field may be left out.
enum class Presence { optional, required };

/// Numbers from `least` to `most`, excluding a bound that is marked open.
struct Range {
  double least = -std::numeric_limits<double>::infinity(),
         most = std::numeric_limits<double>::infinity();
  bool open_below = false, open_above = false;

  /// False for NaN.
  [[nodiscard]] constexpr bool holds(double x) const {
    return (open_below ? x > least : x >= least) && (open_above ? x < most : x <= most);
  }
  friend bool operator==(const Range&, const Range&) = default;
};
constexpr Range at_least(double least) { return {.least = least}; }
constexpr Range above(double least) { return {.least = least, .open_below = true}; }
constexpr Range between(double least, double most) { return {.least = least, .most = most}; }

/// "from 0 to 1", "> 0", "at least 2"; empty where every number is allowed.
[[nodiscard]] std::string in_words(const Range& range);

/// A named value of an enumeration. An enumeration E is described by `std::span<const Choice>
/// choices(E)`.
struct Choice {
  std::string_view name;
  int value = 0;
  std::string_view help = {};

  constexpr Choice() = default;
  template <class E>
  requires std::is_enum_v<E>
  constexpr Choice(std::string_view choice_name, E choice, std::string_view text = {})
      : name(choice_name), value(static_cast<int>(choice)), help(text) {}
  /// A text that a field may be.
  constexpr Choice(std::string_view choice_name, std::string_view text)
      : name(choice_name), help(text) {}
};

/// The values of another field of the same record, a text, with which a field has a meaning; of no
/// field: always.
struct OnlyWith {
  std::string_view field = {};
  std::span<const std::string_view> values = {};
};

/// The description of a field besides its name and type.
struct About {
  std::string_view help = {};
  Unit unit = Unit::none;
  Range range = {};  ///< of each number in it
  Presence presence = Presence::optional;
  /// What applies when the field is left out, in words, if its default value does not say it.
  std::string_view fallback = {};
  /// The written value is this times the member: 2 for a height stored as its half.
  double factor = 1;
  /// An array of numbers that are mostly equal, or a list in which one number stands for all: it
  /// may be written alone.
  bool uniform = false;
  /// The texts that it may be, or that may be in its list; empty: any.
  std::span<const Choice> choices = {};
  /// With other values of that field, which is described before this one, it is refused.
  OnlyWith only = {};
  /// It is not written where it is empty: without a value, a text or entries.
  bool omit_empty = false;
};

struct Type;

struct Field : About {
  std::string_view name;
  const Type* type = nullptr;
  std::size_t offset = 0;  ///< in bytes, from the beginning of the record
  /// A variant whose name and fields count as those of the record itself; `name` is then the
  /// variant's tag.
  bool flat = false;

  /// The named values that it may have: its own or those of its type; empty if they have no names.
  [[nodiscard]] std::span<const Choice> named() const;
  [[nodiscard]] void* of(void* record) const { return static_cast<char*>(record) + offset; }
  [[nodiscard]] const void* of(const void* record) const {
    return static_cast<const char*>(record) + offset;
  }
};

/// The table of a type. All tables live as long as the program; functions that do not fit the kind
/// are null.
struct Type {
  Kind kind = Kind::record;
  /// Of a record; of a variant the name of its tag, the field that tells which.
  std::string_view name = {};
  std::string_view help = {};
  const void* initial = nullptr;           ///< a default-constructed value
  const Type* element = nullptr;           ///< of optionals, lists and arrays
  std::size_t length = 0;                  ///< of arrays
  std::span<const Choice> choices = {};    ///< of choices, in order of their values
  std::vector<Field> fields = {};          ///< of records
  std::vector<const Type*> variants = {};  ///< of variants: the records, in order

  std::size_t (*count)(const void*) = nullptr;  ///< number of elements: optional, list, array
  void (*resize)(void*,
                 std::size_t) = nullptr;  ///< optional (to 0 or 1, default-constructed) and list
  void* (*at)(void*, std::size_t) = nullptr;  ///< element k; of variants the held record, for any k
  int (*value)(const void*) = nullptr;        ///< of choices; of variants the index
  void (*assign)(void*,
                 int) = nullptr;  ///< of choices; default-constructs alternative k of variants

  std::size_t weight = 0;  ///< of lists: bytes that each element takes
  /// Of lists whose copies share their elements: by so many, one beside the other.
  std::size_t shared_by = 0;
  /// Of lists whose copies share their elements: element k to be read, where `at` makes it this
  /// list's own.
  const void* (*look)(const void*, std::size_t) = nullptr;
  const void* (*shared)(const void*) = nullptr;  ///< of opaque pointers: the object that is shared
  /// Of what is stored in another form: the type of that, which is made of a value and read back
  /// from; false: it is none of a value.
  const Type* form = nullptr;
  std::shared_ptr<void> (*to_form)(const void*) = nullptr;
  bool (*from_form)(void*, void*) = nullptr;

  [[nodiscard]] const void* part(const void* whole, std::size_t k = 0) const {
    if (look != nullptr) return look(whole, k);
    return at(const_cast<void*>(whole), k);  // NOLINT: `at` only adds to the address
  }
  /// The field of that name, of the record itself; null if there is none.
  [[nodiscard]] const Field* find(std::string_view field) const;
  /// The choice of that value or name; null if there is none.
  [[nodiscard]] const Choice* choice(int choice_value) const;
  [[nodiscard]] const Choice* choice(std::string_view choice_name) const;
  /// The index of the variant of that name; −1 if there is none.
  [[nodiscard]] int variant(std::string_view variant_name) const;
  /// True for numbers, and for optionals, lists and arrays of nothing else.
  [[nodiscard]] bool numeric() const;
  /// The innermost type, below optionals, lists and arrays.
  [[nodiscard]] const Type& innermost() const;
};

/// The table of T, made on the first call. A variant is described by the name of its tag,
/// `std::string_view tag_of(const Variant*)`.
template <class T>
[[nodiscard]] const Type& type_of();

/// Collects the fields of a record; the argument of `describe`.
class Fields {
 public:
  Fields(Type& type, const void* record) : type_(type), record_(static_cast<const char*>(record)) {}

  void name(std::string_view name, std::string_view help) {
    type_.name = name;
    type_.help = help;
  }
  template <class M>
  void add(std::string_view name, M& member, const About& about = {}) {
    add(name, &member, type_of<M>(), about, false);
  }
  /// Several fields of which nothing is said but their names.
  template <class M, class... More>
  void add_all(std::string_view name, M& member, More&&... more) {
    add(name, member);
    if constexpr (sizeof...(More) > 0) add_all(std::forward<More>(more)...);
  }
  /// Two members that lie side by side as one field, an array.
  template <class M>
  void add_pair(std::string_view name, M& first, M& second, const About& about = {}) {
    assert(&first + 1 == &second);
    static_cast<void>(second);
    add(name, &first, type_of<std::array<M, 2>>(), about, false);
  }
  /// A variant whose name and fields are written among those of this record.
  template <class V>
  void add_flat(V& variant, const About& about = {}) {
    const Type& type = type_of<V>();
    add(type.name, &variant, type, about, true);
  }

 private:
  void add(std::string_view name, const void* member, const Type& type, const About& about,
           bool flat);
  Type& type_;
  const char* record_;
};

/// Whether all numbers of a value, at any depth, are in the ranges of their fields. Error (input):
/// the first that is not, with the path of its field. Missing numbers (empty optionals) pass. Cost:
/// one check per number.
[[nodiscard]] Expected<void> check_ranges(const Type& type, const void* value);

/// A value as it is before anything is known of it.
template <class T>
T initial_of() {
  return T{};
}

/// Types read and written only by their owner.
template <class T>
inline constexpr bool is_opaque = false;
template <class T>
inline constexpr bool is_opaque<std::shared_ptr<T>> = true;

}  // namespace knead
