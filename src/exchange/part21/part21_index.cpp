#include <algorithm>
#include <limits>

#include "base/large_memory.hpp"
#include "part21.hpp"
#include "part21_lexer.hpp"
#include "part21_parser.hpp"
#include "part21_text.hpp"

namespace knead {
namespace {

constexpr std::uint32_t count_block = 128;
// Bytes, at the beginnings of which the lines are known.
constexpr std::uint32_t line_block = 32 * count_block;

bool holds_others(Part21Kind kind) { return kind == Part21Kind::list || kind == Part21Kind::typed; }

/// LF, CRLF and lone CR all end a line; the byte behind the last one is looked at.
std::uint32_t line_ends(const char* bytes, std::size_t count) {
  std::uint32_t result = 0;
  for (std::size_t k = 0; k < count; ++k) {
    result += static_cast<std::uint32_t>((bytes[k] == '\n') |
                                         ((bytes[k] == '\r') & (bytes[k + 1] != '\n')));
  }
  return result;
}

// What bounds the numbers of values, lists, records and lines before anything is parsed.
struct Marks {
  std::size_t commas = 0, lists = 0, records = 0, lines = 0;
};

/// Of at most 255 bytes, which lets the compiler count 16 at a time.
void count_marks(const char* bytes, std::size_t count, Marks& marks) {
  std::uint8_t commas = 0, lists = 0, records = 0, lines = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const char c = bytes[k];
    commas = static_cast<std::uint8_t>(commas + (c == ','));
    lists = static_cast<std::uint8_t>(lists + (c == '('));
    records = static_cast<std::uint8_t>(records + (c == '='));
    lines =
        static_cast<std::uint8_t>(lines + ((c == '\n') | ((c == '\r') & (bytes[k + 1] != '\n'))));
  }
  marks.commas += commas;
  marks.lists += lists;
  marks.records += records;
  marks.lines += lines;
}

}  // namespace

// One pass over the bytes counts marks, so that the tables get their size at once: a list that
// grows holds its old and its new copy together, which files of gigabytes do not allow. The counts
// are bounds from above (marks also stand in strings) and are capped by the shortest text of a
// record or value. The same pass keeps the number of lines before each block, so that the line of
// an error costs one block.
void Part21File::reserve(bool names_only) {
  const std::size_t size = bytes_.size();
  lines_before_.reserve(size / line_block + 1);
  Marks marks;
  for (std::size_t first = 0; first < size; first += count_block) {
    if (first % line_block == 0) lines_before_.push_back(static_cast<std::uint32_t>(marks.lines));
    count_marks(bytes_.data() + first, std::min<std::size_t>(count_block, size - first), marks);
  }
  const std::size_t records = std::min(marks.records, size / 12);
  if (names_only) return detail::reserve_large(index_, records);
  // In front of every value but the first of a list there is a comma; strings may hold any number
  // of those.
  detail::reserve_large(values_, std::min(marks.commas + 2 * marks.lists, size / 3));
  detail::reserve_large(instances_, records);
}

// Most values keep their length. Lists, typed values, references and what is too long for the field
// do not: their end is found by reading again, of a list from the end of its last value, which is a
// path down the nesting instead of the whole text.
std::uint32_t Part21File::end_of(std::uint32_t value) const {
  const Stored& stored = values_[value];
  const auto kind = static_cast<Part21Kind>(stored.kind);
  if (!holds_others(kind) && kind != Part21Kind::reference && stored.content != too_much)
    return stored.begin + stored.content;
  Part21Lexer lexer(bytes_);
  lexer.set_position(stored.begin);
  auto token = lexer.next();
  if (!holds_others(kind)) return token.end;
  if (kind == Part21Kind::typed) token = lexer.next();  // its parenthesis
  std::uint32_t last = value;
  for (auto k = value + 1; k < next_of(value); k = next_of(k)) last = k;
  lexer.set_position(last == value ? token.end : end_of(last));
  return lexer.next().end;
}

std::string_view Part21File::keyword(std::uint32_t value) const {
  const std::uint32_t begin = values_[value].begin;
  return text(ByteRange{begin, Part21Lexer(bytes_).end_of_keyword(begin)});
}

bool Part21File::is_named(std::uint32_t value, std::string_view keyword) const {
  const std::uint32_t begin = values_[value].begin;
  const auto end = begin + static_cast<std::uint32_t>(keyword.size());
  return end <= bytes_.size() && same_keyword(text(ByteRange{begin, end}), keyword) &&
         Part21Lexer(bytes_).end_of_keyword(begin) == end;
}

std::vector<std::uint32_t> Part21File::named(std::span<const std::string_view> keywords) const {
  std::vector<std::uint32_t> result;
  for (const auto keyword : keywords) {
    const auto known = std::ranges::lower_bound(keywords_, keyword, KeywordOrder(),
                                                [this](const Keyword& k) { return text(k.bytes); });
    if (known == keywords_.end() || !same_keyword(text(known->bytes), keyword)) continue;
    result.insert(result.end(), named_.begin() + known->first, named_.begin() + known->last);
  }
  if (!std::ranges::is_sorted(result)) std::ranges::sort(result);
  const auto again = std::ranges::unique(result);
  result.erase(again.begin(), again.end());
  return result;
}

std::vector<std::string_view> Part21File::keywords() const {
  std::vector<std::string_view> result;
  for (const Keyword& keyword : keywords_) result.push_back(text(keyword.bytes));
  return result;
}

std::optional<std::uint32_t> Part21File::find(std::uint64_t id) const {
  const auto found = lookup(id);
  return found == no_instance ? std::nullopt : found;
}

std::optional<std::uint32_t> Part21File::lookup(std::uint64_t id) const {
  const auto in = [id](const auto& names) -> std::size_t {
    // Most files number their entities without gaps.
    if (!names.empty() && id - names.front().id < names.size()) {
      const auto guess = static_cast<std::size_t>(id - names.front().id);
      if (names[guess].id == id) return guess;
    }
    const auto found =
        std::ranges::lower_bound(names, id, {}, [](const auto& name) { return name.id; });
    const auto place = static_cast<std::size_t>(found - names.begin());
    return place < names.size() && found->id == id ? place : names.size();
  };
  if (index_.empty()) {
    const std::size_t k = in(instances_);
    return k < instances_.size() ? std::optional(static_cast<std::uint32_t>(k)) : std::nullopt;
  }
  const std::size_t k = in(index_);
  return k < index_.size() ? std::optional(index_[k].instance) : std::nullopt;
}

Expected<Part21Names> Part21Names::parse(std::string& bytes, std::string name) {
  Part21File file;
  file.name_ = std::move(name);
  file.bytes_.swap(bytes);
  file.reserve(true);
  auto parsed = Part21Parser(file, true).parse();
  file.bytes_.swap(bytes);
  if (!parsed) return std::unexpected(std::move(parsed.error()));
  Part21Names result;
  result.bytes_ = bytes;
  result.names_ = std::move(file.index_);
  return result;
}

// Only names and where their records begin are kept; the end of a record is found by tokens, as a
// semicolon may stand in a string.
std::optional<std::string_view> Part21Names::record(std::uint64_t id) const {
  const auto found = std::ranges::lower_bound(names_, id, {}, &Part21File::Name::id);
  if (found == names_.end() || found->id != id) return std::nullopt;
  Part21Lexer lexer(bytes_);
  lexer.set_position(found->byte);
  for (auto token = lexer.next();
       token.kind != Part21Token::Kind::end && token.kind != Part21Token::Kind::bad;
       token = lexer.next()) {
    if (token.kind == Part21Token::Kind::symbol && bytes_[token.begin] == ';')
      return bytes_.substr(found->byte, token.end - found->byte);
  }
  return std::nullopt;
}

std::vector<std::uint32_t> Part21File::children(std::uint32_t value) const {
  std::vector<std::uint32_t> result;
  const auto end = next_of(value);
  for (auto k = value + 1; k < end; k = next_of(k)) result.push_back(k);
  return result;
}

int Part21File::line(std::uint32_t byte) const {
  if (lines_before_.empty()) return 1;
  const auto known = std::min<std::size_t>(byte / line_block, lines_before_.size() - 1);
  return static_cast<int>(lines_before_[known] + line_ends(bytes_.data() + known * line_block,
                                                           byte - known * line_block)) +
         1;
}

}  // namespace knead
