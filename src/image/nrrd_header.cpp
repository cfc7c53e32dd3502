#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "base/read_double.hpp"
#include "knead/base/printable.hpp"
#include "knead/image/volume.hpp"

namespace knead {
namespace {

// As doubles a gigabyte, before splines and flows of it are made.
constexpr double most_voxels = 1 << 27;
constexpr std::size_t longest_header = 1 << 20;

std::string_view without_blanks(std::string_view text) {
  const auto from = text.find_first_not_of(" \t\r");
  return from == std::string_view::npos
             ? std::string_view()
             : text.substr(from, text.find_last_not_of(" \t\r") + 1 - from);
}

std::string in_lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}

std::vector<std::string_view> words_in(std::string_view text) {
  std::vector<std::string_view> result;
  while (!(text = without_blanks(text)).empty()) {
    const auto end = std::min(text.find_first_of(" \t"), text.size());
    result.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return result;
}

std::optional<double> number_in(std::string_view text) {
  text = without_blanks(text);
  double value = 0;
  const auto [stop, code] = read_double(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || stop != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

std::optional<long> whole_in(std::string_view text) {
  long value = 0;
  const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

/// "(1,0,0)", the parenthesis at the beginning of the text, which is shortened by it.
std::optional<Point> take_vector(std::string_view& text) {
  text = without_blanks(text);
  const auto end = text.find(')');
  if (!text.starts_with('(') || end == std::string_view::npos) return std::nullopt;
  std::string_view inside = text.substr(1, end - 1);
  text.remove_prefix(end + 1);
  Point result;
  for (Eigen::Index d = 0; d < 3; ++d) {
    const auto comma = inside.find(',');
    if ((comma == std::string_view::npos) != (d == 2)) return std::nullopt;
    const auto value = number_in(inside.substr(0, comma));
    if (!value) return std::nullopt;
    result[d] = *value;
    if (d < 2) inside.remove_prefix(comma + 1);
  }
  return result;
}

struct TypeNames {
  NrrdHeader::Type type;
  std::string_view names;  // each between bars
};
constexpr TypeNames types[] = {
    {NrrdHeader::Type::int8, "|signed char|int8|int8_t|"},
    {NrrdHeader::Type::uint8, "|uchar|unsigned char|uint8|uint8_t|"},
    {NrrdHeader::Type::int16, "|short|short int|signed short|signed short int|int16|int16_t|"},
    {NrrdHeader::Type::uint16, "|ushort|unsigned short|unsigned short int|uint16|uint16_t|"},
    {NrrdHeader::Type::int32, "|int|signed int|int32|int32_t|"},
    {NrrdHeader::Type::uint32, "|uint|unsigned int|uint32|uint32_t|"},
    {NrrdHeader::Type::int64,
     "|longlong|long long|long long int|signed long long|signed long long int|int64|int64_t|"},
    {NrrdHeader::Type::uint64,
     "|ulonglong|unsigned long long|unsigned long long int|uint64|uint64_t|"},
    {NrrdHeader::Type::single, "|float|"},
    {NrrdHeader::Type::real, "|double|"}};

/// The fields of a header by their names, with their lines.
class HeaderFields {
 public:
  struct Entry {
    std::string value;
    int line = 0;
  };

  /// Reads the lines up to the empty one, or to the file of the data. Errors (input): a line that
  /// is neither a field, a key nor a comment; a field that comes twice; no end.
  Expected<void> read(std::string_view bytes, NrrdHeader& header) {
    std::size_t at = 0;
    for (int line = 1; at < std::min(bytes.size(), longest_header); ++line) {
      const auto end = std::min(bytes.find('\n', at), bytes.size());
      const std::string_view text = without_blanks(bytes.substr(at, end - at));
      at = std::min(end + 1, bytes.size());
      header.data_at = at;
      if (line == 1) continue;  // the version
      if (text.empty()) return {};
      if (text.starts_with('#')) continue;
      const auto colon = text.find(':');
      if (colon == std::string_view::npos)
        return wrong(line, "the line is no field", "write \"name: value\"");
      if (text.substr(colon).starts_with(":=")) continue;
      std::string name = in_lower_case(without_blanks(text.substr(0, colon)));
      if (name == "datafile") name = "data file";
      if (name == "centerings") name = "centers";
      const Entry entry{std::string(without_blanks(text.substr(colon + 1))), line};
      if (!fields_.emplace(name, entry).second)
        return wrong(line, "it comes twice", "leave one", printable(name));
    }
    if (find("data file") != nullptr) return {};  // a detached header may end with its last field
    return wrong(0, "the header does not end", "end it by an empty line");
  }

  [[nodiscard]] const Entry* find(const std::string& name) const {
    const auto found = fields_.find(name);
    return found == fields_.end() ? nullptr : &found->second;
  }
  [[nodiscard]] std::string text(const std::string& name) const {
    const Entry* entry = find(name);
    return entry == nullptr ? std::string() : entry->value;
  }

  [[nodiscard]] static std::unexpected<Error> wrong(int line, std::string what,
                                                    std::string remedy = {},
                                                    std::string where = {}) {
    return std::unexpected(
        Error{ErrorKind::input, std::move(what), std::move(where), std::move(remedy), "", line});
  }
  /// What is wrong with a field, or that it is missing.
  [[nodiscard]] std::unexpected<Error> wrong(const std::string& name, std::string what,
                                             std::string remedy = {}) const {
    const Entry* entry = find(name);
    return wrong(entry == nullptr ? 0 : entry->line, std::move(what), std::move(remedy), name);
  }

 private:
  std::map<std::string, Entry> fields_;
};

Expected<void> read_type(const HeaderFields& fields, NrrdHeader& header) {
  const std::string name = in_lower_case(fields.text("type"));
  const auto found = std::ranges::find_if(types, [&](const TypeNames& t) {
    return !name.empty() && t.names.find("|" + name + "|") != std::string::npos;
  });
  if (found == std::end(types)) {
    return fields.wrong("type",
                        name.empty() ? "the type is missing"
                                     : fmt::format("\"{}\" is no type of numbers", printable(name)),
                        "use int8 to uint64, float or double");
  }
  header.type = found->type;
  const std::string encoding = in_lower_case(fields.text("encoding")),
                    endian = in_lower_case(fields.text("endian"));
  if (encoding != "raw") {
    return fields.wrong("encoding",
                        encoding.empty()
                            ? "it is missing"
                            : fmt::format("data in \"{}\" are not read", printable(encoding)),
                        "save the file with raw encoding (unu save -f nrrd -e raw)");
  }
  const bool one_byte =
      header.type == NrrdHeader::Type::int8 || header.type == NrrdHeader::Type::uint8;
  if (endian != "little" && endian != "big" && !(endian.empty() && one_byte)) {
    return fields.wrong("endian", "the order of the bytes is not said", "use little or big");
  }
  header.big_endian = endian == "big";
  return {};
}

Expected<void> read_sizes(const HeaderFields& fields, NrrdHeader& header) {
  if (fields.text("dimension") != "3") {
    return fields.wrong("dimension",
                        fmt::format("\"{}\" is not 3", printable(fields.text("dimension"))),
                        "give one number per voxel of a volume");
  }
  const std::string text = fields.text("sizes");
  const auto list = words_in(text);
  if (list.size() != 3)
    return fields.wrong("sizes", "there are not three sizes", "write \"sizes: 64 64 32\"");
  double all = 1;
  for (std::size_t d = 0; d < 3; ++d) {
    const auto size = whole_in(list[d]);
    if (!size || *size < 1 || *size > 1 << 20) {
      return fields.wrong("sizes",
                          fmt::format("\"{}\" is no size", printable(std::string(list[d]))),
                          "use 1 or more");
    }
    header.size[d] = static_cast<int>(*size);
    all *= static_cast<double>(*size);
  }
  if (all > most_voxels) {
    return fields.wrong("sizes", fmt::format("{} voxels are too many", all),
                        "crop or shrink it to 2^27 voxels");
  }
  return {};
}

/// Directions and origin in space.
Expected<void> read_space(const HeaderFields& fields, NrrdHeader& header) {
  header.space = fields.text("space");
  if (fields.find("space dimension") != nullptr && fields.text("space dimension") != "3") {
    return fields.wrong("space dimension", "space has three dimensions here", "use 3");
  }
  if (in_lower_case(header.space).ends_with("time"))
    return fields.wrong("space", "it has time", "cut a volume of one time");
  const std::string directions = fields.text("space directions"),
                    origin = fields.text("space origin");
  std::string_view rest = directions;
  for (Eigen::Index d = 0; d < 3; ++d) {
    const auto direction = take_vector(rest);
    if (!direction) {
      return fields.wrong("space directions", "there are not three directions",
                          "write \"(1,0,0) (0,1,0) (0,0,1)\"");
    }
    header.frame.directions.col(d) = *direction;
  }
  if (!without_blanks(rest).empty())
    return fields.wrong("space directions", "there are more than three", "give three");
  if (origin.empty()) return {};
  rest = origin;
  const auto at = take_vector(rest);
  if (!at || !without_blanks(rest).empty())
    return fields.wrong("space origin", "it is no place", "write \"(0,0,0)\"");
  header.frame.origin = *at;
  return {};
}

/// One number for each axis of a field; empty if there is no such field.
Expected<std::vector<double>> per_axis(const HeaderFields& fields, const std::string& name) {
  std::vector<double> result;
  const std::string text = fields.text(name);
  for (const std::string_view word : words_in(text)) {
    const auto value = number_in(word);
    if (!value)
      return fields.wrong(name, fmt::format("\"{}\" is no number", printable(std::string(word))),
                          "give one per axis");
    result.push_back(*value);
  }
  if (fields.find(name) != nullptr && result.size() != 3) {
    return fields.wrong(name, "there are not three numbers", "give one per axis");
  }
  return result;
}

/// Spacings, and where the axes begin.
///
/// A minimum of cells is half a step before the first centre, one of nodes is the centre: a file
/// that does not say which is refused, since either guess would shift the volume.
Expected<void> read_axes(const HeaderFields& fields, NrrdHeader& header) {
  const auto spacings = per_axis(fields, "spacings"), mins = per_axis(fields, "axis mins");
  if (!spacings) return std::unexpected(spacings.error());
  if (!mins) return std::unexpected(mins.error());
  for (std::size_t d = 0; d < spacings->size(); ++d) {
    header.frame.directions(static_cast<Eigen::Index>(d), static_cast<Eigen::Index>(d)) =
        (*spacings)[d];
  }
  if (mins->empty()) return {};
  const std::string text = in_lower_case(fields.text("centers"));
  const auto centres = words_in(text);
  for (std::size_t d = 0; d < 3; ++d) {
    const auto k = static_cast<Eigen::Index>(d);
    const bool cell = centres.size() == 3 && centres[d] == "cell",
               node = centres.size() == 3 && centres[d] == "node";
    if (!cell && !node) {
      return fields.wrong("axis mins", "it is not said whether they are of cells or of nodes",
                          "add \"centers: cell cell cell\", or leave them out");
    }
    header.frame.origin[k] = (*mins)[d] + (cell ? header.frame.directions(k, k) / 2 : 0);
  }
  return {};
}

Expected<void> read_data_place(const HeaderFields& fields, NrrdHeader& header) {
  header.data_file = fields.text("data file");
  if (fields.find("data file") != nullptr) {
    const bool many =
        header.data_file.starts_with("LIST") || header.data_file.find('%') != std::string::npos;
    if (header.data_file.empty() || many) {
      return fields.wrong("data file", "data in several files are not read", "join them in one");
    }
  }
  for (const char* name : {"line skip", "byte skip"}) {
    if (fields.find(name) == nullptr) continue;
    const bool lines = std::string_view(name) == "line skip";
    const auto count = whole_in(fields.text(name));
    if (!count || *count < (lines ? 0 : -1) || *count > 1 << 30) {
      return fields.wrong(name, "it is no number of them", "use 0 or more");
    }
    (lines ? header.skipped_lines : header.skipped_bytes) = *count;
  }
  return {};
}

}  // namespace

bool is_nrrd(std::string_view bytes) { return bytes.starts_with("NRRD"); }

// Space directions take precedence over spacings.
Expected<NrrdHeader> parse_nrrd_header(std::string_view bytes, std::string name) {
  NrrdHeader header;
  HeaderFields fields;
  const auto read = [&]() -> Expected<void> {
    const std::string_view version =
        without_blanks(bytes.substr(0, std::min(bytes.find('\n'), std::size_t{64})));
    if (version.size() != 8 || !version.starts_with("NRRD000") || version[7] < '1' ||
        version[7] > '5') {
      return HeaderFields::wrong(1, "it is no NRRD file of the versions NRRD0001 to NRRD0005");
    }
    if (auto status = fields.read(bytes, header); !status) return status;
    if (auto status = read_type(fields, header); !status) return status;
    if (auto status = read_sizes(fields, header); !status) return status;
    if (auto status = read_data_place(fields, header); !status) return status;
    const bool in_space = fields.find("space directions") != nullptr;
    return in_space ? read_space(fields, header) : read_axes(fields, header);
  };
  if (auto status = read(); !status) {
    Error error = status.error();
    error.file = std::move(name);
    return std::unexpected(std::move(error));
  }
  return header;
}

}  // namespace knead
