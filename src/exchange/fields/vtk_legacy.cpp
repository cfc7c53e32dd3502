// Legacy files of VTK: lines of key words, each followed by numbers as text or big-endian bytes.
#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "knead/base/printable.hpp"
#include "line_reader.hpp"
#include "point_fields.hpp"
#include "raw_numbers.hpp"

namespace knead::fields {
namespace {

class LegacyReader {
 public:
  LegacyReader(std::string_view bytes, std::string_view file) : bytes_(bytes), file_(file) {}

  Expected<PointFields> read();

 private:
  using Words = std::vector<std::string_view>;

  [[nodiscard]] std::unexpected<Error> error(std::string what, std::string remedy = {}) const {
    return data_error(file_, line_, std::move(what), std::move(remedy));
  }
  [[nodiscard]] bool at_end() const { return at_ >= bytes_.size(); }
  std::string_view line();
  std::string_view word();
  void skip_space();
  Expected<std::size_t> count(const Words& words, std::size_t k, std::string_view what);
  Expected<void> skip(std::size_t numbers, std::string_view type);
  Expected<void> numbers(std::size_t count, std::string_view type, std::vector<double>& values);
  Expected<void> vectors(std::size_t count, std::string_view type, std::vector<Point>& result);
  Expected<void> attribute(std::string name, std::size_t components, std::string_view type);
  Expected<void> header();
  Expected<void> section(const Words& words);
  Expected<void> cells(const Words& words);
  Expected<void> data(const Words& words);
  Expected<void> scalars(const Words& words);
  Expected<void> field(const Words& words);

  std::string_view bytes_, file_;
  std::size_t at_ = 0;
  int line_ = 0;
  bool binary_ = false, has_points_ = false, at_points_ = false;
  std::size_t tuples_ = 0;  // of the data that are being read
  PointFields result_;
};

std::string_view LegacyReader::line() {
  const auto stop = std::min(bytes_.find('\n', at_), bytes_.size());
  const auto found = bytes_.substr(at_, stop - at_);
  at_ = std::min(stop + 1, bytes_.size());
  ++line_;
  return found;
}

void LegacyReader::skip_space() {
  while (!at_end() && trimmed(bytes_.substr(at_, 1)).empty()) line_ += bytes_[at_++] == '\n';
}

std::string_view LegacyReader::word() {
  skip_space();
  const auto begin = at_;
  while (!at_end() && !trimmed(bytes_.substr(at_, 1)).empty()) ++at_;
  return bytes_.substr(begin, at_ - begin);
}

Expected<std::size_t> LegacyReader::count(const Words& words, std::size_t k,
                                          std::string_view what) {
  if (k >= words.size()) return error(fmt::format("the number of {} is missing", what));
  return count_in(words[k], bytes_.size(), what, file_, line_);
}

Expected<void> LegacyReader::numbers(std::size_t count, std::string_view type,
                                     std::vector<double>& values) {
  const auto raw = raw_number_of(type);
  if (binary_) {
    if (!raw) return error(fmt::format("numbers of type \"{}\" are not read", printable(type, 40)));
    if (count > (bytes_.size() - at_) / raw->bytes)
      return error(fmt::format("{} numbers of {} bytes are announced and {} bytes left", count,
                               raw->bytes, bytes_.size() - at_));
    for (std::size_t k = 0; k < count; ++k, at_ += raw->bytes)
      values.push_back(read_raw(bytes_.data() + at_, *raw, true));
    return {};
  }
  for (std::size_t k = 0; k < count; ++k) {
    const auto text = word();
    if (text.empty()) return error(fmt::format("{} numbers are announced and {} there", count, k));
    double value = 0;
    if (!is_number(text, value))
      return error(fmt::format("\"{}\" is no number", printable(text, 40)));
    values.push_back(value);
  }
  return {};
}

Expected<void> LegacyReader::skip(std::size_t count, std::string_view type) {
  // VTK packs eight flags of type "bit" into a byte.
  if (binary_ && lower_case(type) == "bit") {
    at_ = std::min(bytes_.size(), at_ + (count + 7) / 8);
    return {};
  }
  if (binary_) {
    const auto raw = raw_number_of(type);
    if (!raw) return error(fmt::format("numbers of type \"{}\" are not read", printable(type, 40)));
    if (count > (bytes_.size() - at_) / raw->bytes)
      return error(fmt::format("{} numbers of {} bytes are announced and {} bytes left", count,
                               raw->bytes, bytes_.size() - at_));
    at_ += count * raw->bytes;
    return {};
  }
  for (std::size_t k = 0; k < count; ++k) {
    if (word().empty()) return error(fmt::format("{} values are announced and {} there", count, k));
  }
  return {};
}

Expected<void> LegacyReader::vectors(std::size_t count, std::string_view type,
                                     std::vector<Point>& result) {
  std::vector<double> values;
  const int before = line_;
  if (auto read = numbers(3 * count, type, values); !read) return read;
  for (std::size_t k = 0; k < count; ++k) {
    const Point vector(values[3 * k], values[3 * k + 1], values[3 * k + 2]);
    if (!vector.allFinite()) {
      return data_error(file_, before, fmt::format("item {} of what follows is not finite", k + 1),
                        "leave out points without a value");
    }
    result.push_back(vector);
  }
  return {};
}

// "%20" stands for a space in names.
static std::string decoded(std::string_view name) {
  std::string result;
  for (std::size_t k = 0; k < name.size(); ++k) {
    unsigned code = 0;
    if (name[k] == '%' && k + 2 < name.size() &&
        std::from_chars(name.data() + k + 1, name.data() + k + 3, code, 16).ptr ==
            name.data() + k + 3) {
      result += static_cast<char>(code);
      k += 2;
    } else {
      result += name[k];
    }
  }
  return result;
}

Expected<void> LegacyReader::attribute(std::string name, std::size_t components,
                                       std::string_view type) {
  if (components > bytes_.size() / std::max<std::size_t>(tuples_, 1) + 1)
    return error(fmt::format("{} components are more than the file can hold", components));
  if (!at_points_ || components != 3) {
    if (at_points_) result_.fields.push_back({decoded(name), static_cast<int>(components), {}});
    return skip(tuples_ * components, type);
  }
  PointFields::Field field{decoded(name), 3, {}};
  if (auto read = vectors(tuples_, type, field.vectors); !read) return read;
  result_.fields.push_back(std::move(field));
  return {};
}

Expected<void> LegacyReader::header() {
  static_cast<void>(line());  // "# vtk DataFile Version"
  static_cast<void>(line());  // a title
  const std::string form = lower_case(trimmed(line()));
  if (form != "ascii" && form != "binary")
    return error("the third line is neither ASCII nor BINARY");
  binary_ = form == "binary";
  return {};
}

Expected<void> LegacyReader::cells(const Words& words) {
  const auto first = count(words, 1, "cells"), second = count(words, 2, "numbers of cells");
  if (!first) return std::unexpected(first.error());
  if (!second) return std::unexpected(second.error());
  // From version 5.1 on two arrays follow, each with its type: the first number counts offsets.
  const auto mark = at_;
  const int mark_line = line_;
  const auto key = words_of(line());
  if (key.size() == 2 && key[0] == "OFFSETS") {
    if (auto read = skip(*first, key[1]); !read) return read;
    skip_space();
    const auto next = words_of(line());
    if (next.size() != 2 || next[0] != "CONNECTIVITY") return error("CONNECTIVITY is missing");
    return skip(*second, next[1]);
  }
  at_ = mark;
  line_ = mark_line;
  return skip(*second, "int");
}

Expected<void> LegacyReader::scalars(const Words& words) {
  if (words.size() < 3) return error("a name and a type must follow SCALARS");
  std::size_t components = 1;
  if (words.size() > 3) {
    const auto given = count(words, 3, "components");
    if (!given) return std::unexpected(given.error());
    components = *given;
  }
  const auto mark = at_;
  const int mark_line = line_;
  if (!lower_case(trimmed(line())).starts_with("lookup_table")) {
    at_ = mark;
    line_ = mark_line;
  }
  return attribute(std::string(words[1]), components, words[2]);
}

Expected<void> LegacyReader::field(const Words& words) {
  const auto arrays = count(words, 2, "arrays");
  if (!arrays) return std::unexpected(arrays.error());
  const bool data = tuples_ > 0;
  for (std::size_t k = 0; k < *arrays; ++k) {
    skip_space();
    auto array = words_of(line());
    while (!array.empty() && array[0] == "METADATA" && !at_end()) {
      while (!at_end() && !trimmed(line()).empty()) {
      }
      skip_space();
      array = words_of(line());
    }
    if (array.size() != 4) return error("an array is a name, two counts and a type");
    const auto components = count(array, 1, "components"), tuples = count(array, 2, "tuples");
    if (!components) return std::unexpected(components.error());
    if (!tuples) return std::unexpected(tuples.error());
    if (data && at_points_ && *tuples == tuples_) {
      if (auto read = attribute(std::string(array[0]), *components, array[3]); !read) return read;
      continue;
    }
    if (*tuples > 0 && *components > bytes_.size() / *tuples)
      return error("an array is larger than the file");
    // Texts are a line each.
    if (lower_case(array[3]) == "string") {
      for (std::size_t t = 0; t < *tuples * *components && !at_end(); ++t)
        static_cast<void>(line());
      continue;
    }
    if (auto read = skip(*tuples * *components, array[3]); !read) return read;
  }
  return {};
}

Expected<void> LegacyReader::data(const Words& words) {
  const std::string key = lower_case(words[0]);
  const auto name = [&] { return std::string(words.size() > 1 ? words[1] : ""); };
  const std::string_view type = words.size() > 2 ? words[2] : "";
  if (key == "scalars") return scalars(words);
  if (key == "vectors" || key == "normals") return attribute(name(), 3, type);
  if (key == "tensors") return attribute(name(), 9, type);
  if (key == "tensors6") return attribute(name(), 6, type);
  if (key == "texture_coordinates" || key == "color_scalars") {
    const auto components = count(words, 2, "components");
    if (!components) return std::unexpected(components.error());
    if (key == "color_scalars") return attribute(name(), *components, binary_ ? "uchar" : "float");
    return attribute(name(), *components, words.size() > 3 ? words[3] : "");
  }
  if (key == "lookup_table") {
    const auto size = count(words, 2, "colours");
    if (!size) return std::unexpected(size.error());
    return skip(4 * *size, binary_ ? "uchar" : "float");
  }
  return error(fmt::format("\"{}\" is not understood", printable(words[0], 40)));
}

Expected<void> LegacyReader::section(const Words& words) {
  const std::string key = lower_case(words[0]);
  if (key == "dataset") {
    const std::string kind = words.size() > 1 ? lower_case(words[1]) : "";
    if (kind == "polydata" || kind == "unstructured_grid" || kind == "structured_grid") return {};
    return error(fmt::format("a dataset \"{}\" has no points of its own", printable(kind, 40)),
                 "write POLYDATA or UNSTRUCTURED_GRID");
  }
  if (key == "dimensions") return {};
  if (key == "metadata") {
    while (!at_end() && !trimmed(line()).empty()) {
    }
    return {};
  }
  if (key == "points") {
    const auto points = count(words, 1, "points");
    if (!points) return std::unexpected(points.error());
    if (has_points_) return error("there are POINTS twice");
    has_points_ = true;
    return vectors(*points, words.size() > 2 ? words[2] : "", result_.points);
  }
  if (key == "cell_types") {
    const auto types = count(words, 1, "cells");
    if (!types) return std::unexpected(types.error());
    return skip(*types, "int");
  }
  if (key == "cells" || key == "vertices" || key == "lines" || key == "polygons" ||
      key == "triangle_strips")
    return cells(words);
  if (key == "point_data" || key == "cell_data") {
    const auto tuples = count(words, 1, "values");
    if (!tuples) return std::unexpected(tuples.error());
    at_points_ = key == "point_data";
    tuples_ = *tuples;
    if (at_points_ && (!has_points_ || tuples_ != result_.points.size()))
      return error(
          fmt::format("there are data at {} points of {}", tuples_, result_.points.size()));
    return {};
  }
  if (key == "field") return field(words);
  return data(words);
}

Expected<PointFields> LegacyReader::read() {
  if (auto right = header(); !right) return std::unexpected(right.error());
  for (;;) {
    skip_space();
    if (at_end()) break;
    const auto words = words_of(line());
    if (words.empty()) continue;
    if (auto right = section(words); !right) return std::unexpected(right.error());
  }
  if (!has_points_) return error("there are no POINTS");
  return std::move(result_);
}

}  // namespace

bool is_vtk_legacy(std::string_view bytes) {
  return lower_case(bytes.substr(0, 14)) == "# vtk datafile";
}

Expected<PointFields> read_vtk_legacy(std::string_view bytes, std::string_view file) {
  return LegacyReader(bytes, file).read();
}

}  // namespace knead::fields
