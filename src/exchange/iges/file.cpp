#include "file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "exchange/length_units.hpp"
#include "exchange/part21/part21_text.hpp"

namespace knead::iges {
namespace {

// Five sections of records with 80 columns: start, global, directory, parameters, terminate; the
// letter is in column 73, the number of the record behind it. An entity has two records in the
// directory, each of ten fields of eight columns, and is known by the number of the first of them,
// which is odd. Its parameters are text in free format in columns 1 to 64 of its parameter records,
// and columns 66 to 72 point back at it.
constexpr std::string_view letters = "SGDPT";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

bool is_digit(char c) { return '0' <= c && c <= '9'; }

/// The length of "5H" if a string begins there, and of what it counts.
/// A string may contain separators, terminators and the ends of records: only its count tells where
/// it ends.
std::optional<std::pair<std::size_t, std::size_t>> hollerith(std::string_view text) {
  std::size_t at = 0, count = 0;
  while (at < text.size() && is_digit(text[at]) && at < 9)
    count = 10 * count + static_cast<std::size_t>(text[at++] - '0');
  if (at == 0 || at == text.size() || text[at] != 'H') return std::nullopt;
  return std::pair(at + 1, count);
}

/// Splits free-format text into values, up to the terminator. More text is taken as it is needed.
class Lexer {
 public:
  Lexer(char separator, char terminator) : separator_(separator), terminator_(terminator) {}

  /// Takes the next piece of text; false: more is needed. Values are split where they end, strings
  /// by their count.
  bool take(std::string_view text) {
    text_ += text;
    while (at_ < text_.size()) {
      const std::size_t start = std::min(text_.find_first_not_of(" \t", at_), text_.size());
      const auto string = hollerith(std::string_view(text_).substr(start));
      const std::size_t begin = string ? start + string->first + string->second : start;
      if (begin > text_.size()) return false;
      std::size_t end = begin;
      while (end < text_.size() && text_[end] != separator_ && text_[end] != terminator_) ++end;
      if (end == text_.size()) return false;
      values_.emplace_back(
          trimmed(std::string_view(text_).substr(start, string ? begin - start : end - start)));
      if (string) values_.back() = text_.substr(start, begin - start);
      at_ = end + 1;
      if (text_[end] == terminator_) return true;
    }
    return false;
  }
  [[nodiscard]] std::vector<std::string>& values() { return values_; }
  [[nodiscard]] std::string_view rest() const { return std::string_view(text_).substr(at_); }

 private:
  char separator_, terminator_;
  std::string text_;
  std::size_t at_ = 0;
  std::vector<std::string> values_;
};

std::string unit_of(int flag, std::string name) {
  constexpr int named = 3;  // the name says it all
  for (const KnownLengthUnit& unit : known_length_units()) {
    if (flag > 0 && flag != named && unit.iges_flag == flag) return std::string(unit.name);
  }
  for (char& c : name) c = 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (name == "in") return "inch";
  if (name == "ft") return "foot";
  return name.empty() ? "unknown" : name;
}

}  // namespace

std::string_view type_name(int type) {
  constexpr std::pair<int, std::string_view> names[] = {{100, "circular arc"},
                                                        {102, "composite curve"},
                                                        {104, "conic arc"},
                                                        {106, "copious data"},
                                                        {108, "plane"},
                                                        {110, "line"},
                                                        {112, "parametric spline curve"},
                                                        {114, "parametric spline surface"},
                                                        {116, "point"},
                                                        {118, "ruled surface"},
                                                        {120, "surface of revolution"},
                                                        {122, "tabulated cylinder"},
                                                        {123, "direction"},
                                                        {124, "transformation matrix"},
                                                        {126, "B-spline curve"},
                                                        {128, "B-spline surface"},
                                                        {130, "offset curve"},
                                                        {140, "offset surface"},
                                                        {141, "boundary"},
                                                        {142, "curve on a surface"},
                                                        {143, "bounded surface"},
                                                        {144, "trimmed surface"},
                                                        {186, "manifold solid"},
                                                        {190, "plane surface"},
                                                        {192, "cylindrical surface"},
                                                        {194, "conical surface"},
                                                        {196, "spherical surface"},
                                                        {198, "toroidal surface"},
                                                        {308, "subfigure definition"},
                                                        {314, "colour"},
                                                        {402, "associativity"},
                                                        {404, "drawing"},
                                                        {406, "property"},
                                                        {408, "subfigure instance"},
                                                        {410, "view"},
                                                        {502, "vertex list"},
                                                        {504, "edge list"},
                                                        {508, "loop"},
                                                        {510, "face"},
                                                        {514, "shell"}};
  const auto found = std::ranges::find(names, type, &std::pair<int, std::string_view>::first);
  return found == std::end(names) ? std::string_view() : found->second;
}

std::optional<int> integer(std::string_view text) {
  text = trimmed(text);
  if (text.empty()) return 0;
  if (text.front() == '+') text.remove_prefix(1);
  int value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<double> real(std::string_view text) {
  text = trimmed(text);
  return text.empty() ? 0.0 : parse_real(text);
}

std::string string(std::string_view text) {
  const auto found = hollerith(text);
  return found ? std::string(trimmed(text.substr(std::min(found->first, text.size()))))
               : std::string();
}

const std::vector<Line>& File::lines(char section) const {
  return sections_[letters.find(section)];
}

const Entity* File::find(int number) const {
  const auto k = static_cast<std::size_t>(number - 1) / 2;
  return number >= 1 && number % 2 == 1 && k < entities_.size() ? &entities_[k] : nullptr;
}

std::string File::label(int number) const {
  const Entity* entity = find(number);
  const std::string_view name = entity != nullptr ? type_name(entity->type) : std::string_view();
  return fmt::format("D{}{}{}", number,
                     entity != nullptr ? fmt::format(", type {}", entity->type) : "",
                     name.empty() ? "" : fmt::format(" ({})", name));
}

std::unexpected<Error> File::error(int number, std::string what, std::string remedy) const {
  Error result{ErrorKind::input, std::move(what), label(number), std::move(remedy), name_};
  const auto k = 2 * (static_cast<std::size_t>(number - 1) / 2);
  if (k < lines('D').size()) {
    const std::string_view before = std::string_view(bytes_).substr(0, lines('D')[k].begin);
    result.line = 1 + static_cast<int>(std::ranges::count(before, '\n'));
  }
  return std::unexpected(std::move(result));
}

std::unexpected<Error> File::line_error(const Line& line, std::string what,
                                        std::string remedy) const {
  const std::string_view before = std::string_view(bytes_).substr(0, line.begin);
  return std::unexpected(Error{ErrorKind::input,
                               std::move(what),
                               {},
                               std::move(remedy),
                               name_,
                               1 + static_cast<int>(std::ranges::count(before, '\n'))});
}

Expected<File> File::parse(std::string bytes, std::string name) {
  File file;
  file.name_ = std::move(name);
  file.bytes_ = std::move(bytes);
  if (auto outcome = file.split(); !outcome) return std::unexpected(std::move(outcome.error()));
  if (auto outcome = file.read_global(); !outcome)
    return std::unexpected(std::move(outcome.error()));
  if (auto outcome = file.read_directory(); !outcome)
    return std::unexpected(std::move(outcome.error()));
  return file;
}

Expected<void> File::split() {
  const bool broken = bytes_.find('\n') != std::string::npos;
  std::size_t section = 0;
  for (std::size_t at = 0; at < bytes_.size();) {
    const std::size_t stop = broken ? std::min(bytes_.find('\n', at), bytes_.size())
                                    : std::min(at + record_columns, bytes_.size());
    Line line{static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(stop)};
    at = broken ? stop + 1 : stop;
    if (broken && line.end > line.begin && bytes_[line.end - 1] == '\r') --line.end;
    const std::string_view record = text(line);
    if (record.find_first_not_of(" \t\x1A\0") == std::string_view::npos) continue;
    const char letter = record.size() > letter_column ? record[letter_column] : ' ';
    if (letter == 'C' && at < 2 * record_columns) {
      return line_error(line, "an IGES file in compressed ASCII form",
                        "export it in fixed ASCII form");
    }
    if (letter == 'B' && at < 2 * record_columns) {
      return line_error(line, "an IGES file in binary form", "export it in fixed ASCII form");
    }
    const auto found = letters.find(letter);
    if (found == std::string_view::npos) {
      return line_error(line, "no section letter S, G, D, P or T in column 73",
                        "get the file as it was written");
    }
    if (found < section)
      return line_error(line, "its sections are out of order", "sort them as S, G, D, P, T");
    section = found;
    sections_[section].push_back(line);
  }
  if (lines('D').empty()) {
    return std::unexpected(Error{ErrorKind::input,
                                 "an IGES file without a directory section",
                                 {},
                                 "get the whole file",
                                 name_});
  }
  if (lines('D').size() % 2 != 0) {
    return line_error(lines('D').back(), "the directory has an odd number of records",
                      "get the whole file");
  }
  return {};
}

Expected<void> File::read_global() {
  std::string all;
  for (const Line& line : lines('G')) all += std::string(text(line).substr(0, letter_column));
  std::string_view rest = all;
  // Either separator may be left to its default, and may itself be the one that follows it.
  if (rest.starts_with("1H") && rest.size() > 3) {
    global_.separator = rest[2];
    rest.remove_prefix(3);
  }
  if (!rest.empty() && rest.front() == global_.separator) rest.remove_prefix(1);
  if (rest.starts_with("1H") && rest.size() > 3) {
    global_.terminator = rest[2];
    rest.remove_prefix(3);
  }
  if (!rest.empty() && rest.front() == global_.separator) rest.remove_prefix(1);
  Lexer lexer(global_.separator, global_.terminator);
  lexer.take(rest);
  const auto& values = lexer.values();  // from field 3 on
  const auto field = [&](std::size_t number) {
    return number - 3 < values.size() ? values[number - 3] : std::string();
  };
  global_.system = string(field(5));
  const double scale = real(field(13)).value_or(1);
  global_.scale = scale > 0 ? scale : 1;
  global_.unit = unit_of(integer(field(14)).value_or(field(14).empty() ? 1 : 0), string(field(15)));
  if (field(14).empty() && field(15).empty()) global_.unit = "inch";  // the standard's default
  const double resolution = real(field(19)).value_or(0);
  global_.resolution = resolution > 0 ? resolution : 0;
  return {};
}

Expected<void> File::read_directory() {
  const auto& directory = lines('D');
  entities_.reserve(directory.size() / 2);
  for (std::size_t k = 0; k + 1 < directory.size(); k += 2) {
    const auto field = [&](std::size_t line, std::size_t n) {
      const std::string_view record = text(directory[k + line]);
      const std::size_t at = 8 * n;
      return at < std::min(record.size(), letter_column) ? record.substr(at, 8)
                                                         : std::string_view();
    };
    const auto type = integer(field(0, 0)), first = integer(field(0, 1)),
               transform = integer(field(0, 6)), count = integer(field(1, 3)),
               form = integer(field(1, 4));
    if (!type || !first || !transform || !count || !form) {
      return line_error(directory[k], "a field of the directory is not a number",
                        "get the file as it was written");
    }
    Entity entity{*type, *form, std::max(*transform, 0), *first - 1, *count, false, false, {}};
    const std::string_view status = field(0, 8);
    // The status number is four pairs of digits. The second is 01 or 03 where the entity depends on
    // another; the third is how it is used, and 05 is a curve in the parameters of a surface.
    entity.dependent =
        status.size() == 8 && (status.substr(2, 2) == "01" || status.substr(2, 2) == "03");
    entity.parametric = status.size() == 8 && status.substr(4, 2) == "05";
    entity.label = std::string(trimmed(field(1, 7)));
    entities_.push_back(std::move(entity));
  }
  return {};
}

Expected<Parameters> File::parameters(int number) const {
  const Entity* entity = find(number);
  const auto& records = lines('P');
  if (entity == nullptr) return error(number, "there is no such entity");
  if (entity->first < 0 || static_cast<std::size_t>(entity->first) >= records.size()) {
    return error(number, "its parameters are not in the file", "get the whole file");
  }
  Lexer lexer(global_.separator, global_.terminator);
  Parameters result;
  for (auto k = static_cast<std::size_t>(entity->first); k < records.size(); ++k) {
    const std::string_view record = text(records[k]);
    const auto owner =
        integer(record.substr(std::min(data_columns, record.size()), letter_column - data_columns));
    // The directory may state too few records; the next entity's are not taken for its own.
    if (result.lines >= std::max(entity->lines, 1) && owner != number) break;
    ++result.lines;
    if (lexer.take(record.substr(0, data_columns))) {
      result.values = std::move(lexer.values());
      result.rest = std::string(lexer.rest());
      return result;
    }
  }
  return error(number, "its parameters do not end",
               fmt::format("end them with \"{}\"", global_.terminator));
}

}  // namespace knead::iges
