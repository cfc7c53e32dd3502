#include "describe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knead/base/error_code.hpp"

namespace knead {
namespace {

/// "sizes: 0 is out of range; ..." for the first number of a value that is.
std::optional<Error> wrong_number(const Field* field, const Type& type, const void* value) {
  switch (type.kind) {
    case Kind::integer:
    case Kind::number: {
      if (field == nullptr || field->range == Range{}) return std::nullopt;
      const double x = type.kind == Kind::integer
                           ? *static_cast<const int*>(value)
                           : field->factor * *static_cast<const double*>(value);
      if (field->range.holds(x)) return std::nullopt;
      return Error(ErrorKind::input, fmt::format("{} is out of range", x), std::string(field->name),
                   "use numbers " + in_words(field->range))
          .with({ErrorCode::out_of_range});
    }
    case Kind::optional:
    case Kind::list:
    case Kind::array:
      if (!type.innermost().fields.empty() || !type.innermost().variants.empty() ||
          (field != nullptr && field->range != Range{})) {
        for (std::size_t k = 0; k < type.count(value); ++k) {
          auto error = wrong_number(field, *type.element, type.part(value, k));
          if (!error) continue;
          if (field != nullptr && type.kind == Kind::list && error->where == field->name) {
            error->where += fmt::format("[{}]", k);
          }
          return error;
        }
      }
      return std::nullopt;
    case Kind::record:
      for (const Field& inner : type.fields) {
        auto error = wrong_number(&inner, *inner.type, inner.of(value));
        if (!error) continue;
        const bool nested = inner.type->innermost().kind == Kind::record;
        if (nested) error->where = std::string(inner.name) + "." + error->where;
        return error;
      }
      return std::nullopt;
    case Kind::variant: {
      const auto index = static_cast<std::size_t>(type.value(value));
      return wrong_number(nullptr, *type.variants[index], type.part(value));
    }
    default:
      return std::nullopt;
  }
}

}  // namespace

std::string in_words(const Range& range) {
  const bool below = std::isfinite(range.least), beyond = std::isfinite(range.most);
  const std::string least = fmt::format("{}", range.least), most = fmt::format("{}", range.most);
  if (below && beyond && !range.open_below && !range.open_above)
    return "from " + least + " to " + most;
  std::string text;
  if (below) text = (range.open_below ? "> " : ">= ") + least;
  if (beyond)
    text += (text.empty() ? "" : ", ") + std::string(range.open_above ? "< " : "<= ") + most;
  return text;
}

std::span<const Choice> Field::named() const {
  return choices.empty() ? type->innermost().choices : choices;
}

const Field* Type::find(std::string_view field) const {
  const auto at_field = std::ranges::find(fields, field, &Field::name);
  return at_field == fields.end() ? nullptr : &*at_field;
}

const Choice* Type::choice(int choice_value) const {
  const auto found = std::ranges::find(choices, choice_value, &Choice::value);
  return found == choices.end() ? nullptr : &*found;
}
const Choice* Type::choice(std::string_view choice_name) const {
  const auto found = std::ranges::find(choices, choice_name, &Choice::name);
  return found == choices.end() ? nullptr : &*found;
}

int Type::variant(std::string_view variant_name) const {
  const auto found =
      std::ranges::find(variants, variant_name, [](const Type* t) { return t->name; });
  return found == variants.end() ? -1 : static_cast<int>(found - variants.begin());
}

bool Type::numeric() const {
  const Kind last = innermost().kind;
  return last == Kind::number || last == Kind::integer;
}

const Type& Type::innermost() const {
  const Type* type = this;
  while (type->element != nullptr) type = type->element;
  return *type;
}

void Fields::add(std::string_view name, const void* member, const Type& type, const About& about,
                 bool flat) {
  Field field;
  static_cast<About&>(field) = about;
  field.name = name;
  field.type = &type;
  field.offset = static_cast<std::size_t>(static_cast<const char*>(member) - record_);
  field.flat = flat;
  type_.fields.push_back(field);
}

Expected<void> check_ranges(const Type& type, const void* value) {
  if (auto error = wrong_number(nullptr, type, value)) return std::unexpected(std::move(*error));
  return {};
}

}  // namespace knead
