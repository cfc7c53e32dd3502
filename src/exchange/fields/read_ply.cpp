// PLY: a header that lists elements and their properties, then the elements, as lines or bytes.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "knead/base/printable.hpp"
#include "line_reader.hpp"
#include "mesh_points.hpp"
#include "raw_numbers.hpp"

namespace knead::fields {
namespace {

struct Property {
  std::string name;
  RawNumber type;
  std::optional<RawNumber> count = {};  // of lists
};
struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

bool is_corners(const Property& property) {
  return property.count && (property.name == "vertex_indices" || property.name == "vertex_index");
}

class PlyReader {
 public:
  PlyReader(std::string_view bytes, std::string_view file)
      : bytes_(bytes), file_(file), lines_(bytes) {}
  Expected<MeshPoints> read();

 private:
  [[nodiscard]] std::unexpected<Error> error(std::string what) const {
    return data_error(file_, lines_.number(), std::move(what));
  }
  Expected<void> header();
  Expected<void> header_line(const std::vector<std::string_view>& words);
  Expected<void> text_row(const Element& element, std::vector<double>& row);
  Expected<void> binary_row(const Element& element, std::size_t number, std::vector<double>& row);
  Expected<void> vertices(const Element& element);
  Expected<void> faces(const Element& element);
  Expected<void> row(const Element& element, std::size_t number, std::vector<double>& row) {
    return text_ ? text_row(element, row) : binary_row(element, number, row);
  }

  std::string_view bytes_, file_;
  LineReader lines_;
  std::size_t at_ = 0;
  bool text_ = true, big_endian_ = false;
  std::vector<Element> elements_;
  std::vector<double> corners_;  // of the last row's list of the points of a face
  MeshPoints result_{.format = "PLY"};
};

Expected<void> PlyReader::header_line(const std::vector<std::string_view>& words) {
  const auto type = [&](std::size_t k) {
    return k < words.size() ? raw_number_of(words[k]) : std::nullopt;
  };
  if (words[0] == "format") {
    const auto format = words.size() > 1 ? words[1] : std::string_view();
    if (format != "ascii" && format != "binary_little_endian" && format != "binary_big_endian")
      return error(fmt::format("there is no format \"{}\" of PLY", printable(format, 40)));
    text_ = format == "ascii";
    big_endian_ = format == "binary_big_endian";
  } else if (words[0] == "element") {
    if (words.size() != 3) return error("an element has a name and a number");
    const auto count = count_in(words[2], bytes_.size(), "elements", file_, lines_.number());
    if (!count) return std::unexpected(count.error());
    elements_.push_back({std::string(words[1]), *count, {}});
  } else if (words[0] == "property") {
    if (elements_.empty()) return error("a property belongs to no element");
    const bool list = words.size() > 1 && words[1] == "list";
    if (words.size() != (list ? 5 : 3)) return error("a property has a type and a name");
    const auto values = type(list ? 3 : 1), counts = list ? type(2) : std::nullopt;
    if (!values || (list && (!counts || counts->kind == RawNumber::Kind::real)))
      return error("a property has an unknown type");
    elements_.back().properties.push_back({std::string(words.back()), *values, counts});
  } else if (words[0] != "comment" && words[0] != "obj_info" && words[0] != "ply") {
    return error(fmt::format("\"{}\" is no line of a PLY header", printable(words[0], 40)));
  }
  return {};
}

Expected<void> PlyReader::header() {
  while (lines_.next()) {
    const auto words = words_of(lines_.line());
    if (words.empty()) continue;
    if (words[0] == "end_header") {
      at_ = lines_.end();
      return {};
    }
    if (auto right = header_line(words); !right) return right;
  }
  return error("the header does not end");
}

Expected<void> PlyReader::text_row(const Element& element, std::vector<double>& row) {
  do {
    if (!lines_.next()) return error(fmt::format("the file ends among the {}s", element.name));
  } while (trimmed(lines_.line()).empty());
  const auto words = words_of(lines_.line());
  std::size_t k = 0;
  row.clear();
  for (const Property& property : element.properties) {
    double value = 0;
    if (k >= words.size()) return error("a line has too few numbers");
    if (!is_number(words[k++], value))
      return error(fmt::format("\"{}\" is no number", printable(words[k - 1], 40)));
    row.push_back(value);
    if (!property.count) continue;
    if (!(value >= 0 && value <= static_cast<double>(words.size() - k)))
      return error("a list is longer than its line");
    const bool corners = is_corners(property);
    for (const std::size_t end = k + static_cast<std::size_t>(value); k < end; ++k) {
      double corner = 0;
      if (corners && !is_number(words[k], corner))
        return error(fmt::format("\"{}\" is no number", printable(words[k], 40)));
      if (corners) corners_.push_back(corner);
    }
  }
  return {};
}

Expected<void> PlyReader::binary_row(const Element& element, std::size_t number,
                                     std::vector<double>& row) {
  row.clear();
  const auto cut = [&] {
    return error(
        fmt::format("the file ends in {} {} of {}", element.name, number + 1, element.count));
  };
  for (const Property& property : element.properties) {
    const RawNumber& first = property.count ? *property.count : property.type;
    if (bytes_.size() - at_ < first.bytes) return cut();
    const double value = read_raw(bytes_.data() + at_, first, big_endian_);
    at_ += first.bytes;
    row.push_back(value);
    if (!property.count) continue;
    const auto most = (bytes_.size() - at_) / property.type.bytes;
    if (!(value >= 0 && value <= static_cast<double>(most))) return cut();
    const bool corners = is_corners(property);
    for (auto left = static_cast<std::size_t>(value); left > 0; --left) {
      if (corners) corners_.push_back(read_raw(bytes_.data() + at_, property.type, big_endian_));
      at_ += property.type.bytes;
    }
  }
  return {};
}

Expected<void> PlyReader::faces(const Element& element) {
  if (element.properties.empty()) return {};
  std::vector<double> values;
  for (std::size_t k = 0; k < element.count; ++k) {
    corners_.clear();
    if (auto read = row(element, k, values); !read) return read;
    if (element.name != "face" || result_.points.empty()) continue;
    if (auto added = add_face(corners_, 0, file_, lines_.number(), result_); !added) return added;
  }
  return {};
}

Expected<void> PlyReader::vertices(const Element& element) {
  std::array<std::size_t, 6> columns{};
  static constexpr std::array<std::string_view, 6> names = {"x", "y", "z", "nx", "ny", "nz"};
  const auto& properties = element.properties;
  for (std::size_t k = 0; k < 6; ++k) {
    const auto found = std::ranges::find(properties, names[k], &Property::name);
    columns[k] = static_cast<std::size_t>(found - properties.begin());
    if (k < 3 && (found == properties.end() || found->count))
      return error(fmt::format("its vertices have no {}", names[k]));
  }
  const bool normals = *std::max_element(columns.begin(), columns.end()) < properties.size();
  std::vector<double> values;
  for (std::size_t k = 0; k < element.count; ++k) {
    if (auto read = row(element, k, values); !read) return read;
    const Point point(values[columns[0]], values[columns[1]], values[columns[2]]);
    if (!point.allFinite())
      return error(fmt::format("a coordinate of vertex {} is not finite", k + 1));
    result_.points.push_back(point);
    if (normals)
      result_.normals.emplace_back(values[columns[3]], values[columns[4]], values[columns[5]]);
  }
  return {};
}

Expected<MeshPoints> PlyReader::read() {
  if (auto right = header(); !right) return std::unexpected(right.error());
  for (const Element& element : elements_) {
    const bool wanted = element.name == "vertex";
    // What comes before the points is passed over; so are faces then, and what follows them.
    if (auto right = wanted ? vertices(element) : faces(element); !right)
      return std::unexpected(right.error());
    if (element.name == "face" && !result_.points.empty()) break;
  }
  if (result_.points.empty()) return error("there are no vertices");
  return std::move(result_);
}

}  // namespace

Expected<MeshPoints> read_ply(std::string_view bytes, std::string_view file) {
  return PlyReader(bytes, file).read();
}

}  // namespace knead::fields
