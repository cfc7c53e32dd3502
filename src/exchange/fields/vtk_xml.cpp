// XML files of VTK (VTU, VTP): elements <Piece> with <Points> and <PointData>, in which <DataArray>
// holds numbers as text, in base64, or by their offset within <AppendedData>.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "knead/base/printable.hpp"
#include "line_reader.hpp"
#include "point_fields.hpp"
#include "raw_numbers.hpp"

namespace knead::fields {
namespace {

/// A start tag, an end tag, or an element without content.
struct Tag {
  std::string_view name;
  std::map<std::string, std::string_view, std::less<>> attributes;
  bool ends = false, empty = false;
  int line = 0;

  [[nodiscard]] std::string_view get(std::string_view key) const {
    const auto found = attributes.find(key);
    return found == attributes.end() ? std::string_view() : found->second;
  }
};

/// Tags of a text, one after the other; comments, declarations and character data are passed over.
class TagReader {
 public:
  TagReader(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  /// The next tag; none at the end. Errors (input): a tag that does not end.
  Expected<std::optional<Tag>> next();
  /// The text from here to the next tag.
  [[nodiscard]] std::string_view content() const {
    return text_.substr(at_, std::min(text_.find('<', at_), text_.size()) - at_);
  }
  [[nodiscard]] std::size_t place() const { return at_; }
  [[nodiscard]] int line() const { return line_; }

 private:
  void go_to(std::size_t place) {
    line_ += static_cast<int>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_),
                                         text_.begin() + static_cast<std::ptrdiff_t>(place), '\n'));
    at_ = place;
  }
  std::string_view text_, file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

std::size_t end_of_tag(std::string_view text, std::size_t begin) {
  char quote = '\0';
  for (std::size_t k = begin; k < text.size(); ++k) {
    if (quote != '\0') {
      if (text[k] == quote) quote = '\0';
    } else if (text[k] == '"' || text[k] == '\'') {
      quote = text[k];
    } else if (text[k] == '>') {
      return k;
    }
  }
  return text.npos;
}

void read_attributes(std::string_view text, Tag& tag) {
  while (!text.empty()) {
    const auto equals = text.find('=');
    if (equals == text.npos) return;
    const auto begin = text.find_first_of("\"'", equals);
    if (begin == text.npos) return;
    const auto end = text.find(text[begin], begin + 1);
    if (end == text.npos) return;
    tag.attributes.insert_or_assign(std::string(trimmed(text.substr(0, equals))),
                                    text.substr(begin + 1, end - begin - 1));
    text.remove_prefix(end + 1);
  }
}

Expected<std::optional<Tag>> TagReader::next() {
  for (;;) {
    const auto begin = text_.find('<', at_);
    if (begin == text_.npos) return std::nullopt;
    go_to(begin);
    const bool comment = text_.substr(at_).starts_with("<!--");
    const auto end = comment ? text_.find("-->", at_) : end_of_tag(text_, at_);
    if (end == text_.npos) return data_error(file_, line_, "a tag does not end");
    if (comment || text_[at_ + 1] == '?' || text_[at_ + 1] == '!') {
      go_to(end + 1);
      continue;
    }
    Tag tag;
    tag.line = line_;
    std::string_view inside = text_.substr(at_ + 1, end - at_ - 1);
    if (inside.starts_with('/')) tag.ends = true, inside.remove_prefix(1);
    if (inside.ends_with('/')) tag.empty = true, inside.remove_suffix(1);
    const auto name = std::min(inside.find_first_of(" \t\r\n"), inside.size());
    tag.name = inside.substr(0, name);
    read_attributes(inside.substr(name), tag);
    go_to(end + 1);
    return tag;
  }
}

/// A <DataArray>: its tag, and the text of the element.
struct DataArray {
  Tag tag;
  std::string_view content;
};

class XmlReader {
 public:
  XmlReader(std::string_view bytes, std::string_view file) : bytes_(bytes), file_(file) {}
  Expected<PointFields> read();

 private:
  struct Piece {
    std::size_t points = 0;
    int line = 0;
    std::optional<DataArray> place;
    std::vector<DataArray> fields;
  };

  [[nodiscard]] std::unexpected<Error> error(int line, std::string what,
                                             std::string remedy = {}) const {
    return data_error(file_, line, std::move(what), std::move(remedy));
  }
  Expected<void> structure();
  Expected<void> file_tag(const Tag& tag);
  Expected<void> open(const Tag& tag, TagReader& tags);
  Expected<std::string> payload(const DataArray& array, std::size_t bytes) const;
  Expected<std::vector<Point>> vectors(const DataArray& array, std::size_t count) const;
  Expected<std::vector<Point>> from_text(const DataArray& array, std::size_t count) const;
  Expected<void> add(const Piece& piece, bool first);

  std::string_view bytes_, file_;
  bool big_endian_ = false, appended_base64_ = false;
  std::size_t header_ = 4;     // bytes of a length
  std::string_view appended_;  // what follows the underscore
  std::string section_;        // "Points" or "PointData" within a piece
  std::vector<Piece> pieces_;
  PointFields result_;
};

Expected<void> XmlReader::file_tag(const Tag& tag) {
  const auto kind = tag.get("type");
  if (kind != "UnstructuredGrid" && kind != "PolyData")
    return error(
        tag.line,
        fmt::format("a file of type \"{}\" has no points that are read", printable(kind, 40)),
        "write a VTU or VTP file");
  if (const auto by = tag.get("compressor"); !by.empty())
    return error(tag.line, fmt::format("its blocks are compressed by {}", printable(by, 40)),
                 "write it without compression");
  big_endian_ = tag.get("byte_order") == "BigEndian";
  if (const auto type = tag.get("header_type"); !type.empty()) {
    const auto raw = raw_number_of(type);
    if (!raw || raw->kind != RawNumber::Kind::natural || raw->bytes < 4)
      return error(tag.line, fmt::format("a header of type \"{}\" is neither UInt32 nor UInt64",
                                         printable(type, 40)));
    header_ = raw->bytes;
  }
  return {};
}

Expected<void> XmlReader::open(const Tag& tag, TagReader& tags) {
  if (tag.name == "VTKFile") return file_tag(tag);
  if (tag.name == "Piece") {
    Piece piece;
    piece.line = tag.line;
    const auto given = tag.get("NumberOfPoints");
    if (given.empty()) return error(tag.line, "a piece does not say its NumberOfPoints");
    const auto points = count_in(given, bytes_.size(), "points", file_, tag.line);
    if (!points) return std::unexpected(points.error());
    piece.points = *points;
    pieces_.push_back(std::move(piece));
    return {};
  }
  if (tag.name == "Points" || tag.name == "PointData") {
    section_ = tag.empty ? "" : std::string(tag.name);
    return {};
  }
  if (tag.name != "DataArray" || pieces_.empty()) return {};
  DataArray array{tag, tag.empty ? std::string_view() : tags.content()};
  if (section_ == "Points")
    pieces_.back().place = std::move(array);
  else if (section_ == "PointData")
    pieces_.back().fields.push_back(std::move(array));
  return {};
}

Expected<void> XmlReader::structure() {
  TagReader tags(bytes_, file_);
  bool known = false;
  for (;;) {
    const auto tag = tags.next();
    if (!tag) return std::unexpected(tag.error());
    if (!*tag) break;
    if ((*tag)->ends) {
      if ((*tag)->name == section_) section_.clear();
      continue;
    }
    known |= (*tag)->name == "VTKFile";
    // What is appended may hold any byte.
    if ((*tag)->name == "AppendedData") {
      appended_base64_ = (*tag)->get("encoding") == "base64";
      const auto mark = bytes_.find('_', tags.place());
      if (mark == bytes_.npos) return error((*tag)->line, "no underscore begins the data");
      appended_ = bytes_.substr(mark + 1);
      break;
    }
    if (auto right = open(**tag, tags); !right) return right;
  }
  if (!known) return error(0, "there is no element VTKFile");
  return {};
}

// The bytes of an array, of which `bytes` are wanted, without the length before them.
Expected<std::string> XmlReader::payload(const DataArray& array, std::size_t bytes) const {
  const bool appended = array.tag.get("format") == "appended";
  std::string_view text = array.content;
  if (appended) {
    const auto offset =
        count_in(array.tag.get("offset"), appended_.size(), "bytes", file_, array.tag.line);
    if (!offset) return std::unexpected(offset.error());
    text = appended_.substr(*offset);
  }
  std::string decoded;
  std::string_view data = text;
  if (!appended || appended_base64_) {
    // One array ends where the next one begins, or at the end of the element.
    const auto stop = std::min(text.find('<'), text.size());
    const std::size_t most = std::min(header_ + bytes, stop);
    auto made = base64_decoded(text.substr(0, stop), most);
    if (!made) return error(array.tag.line, "there is a character that is not base64");
    decoded = *std::move(made);
    data = decoded;
  }
  if (data.size() < header_) return error(array.tag.line, "the length of the array is missing");
  const double length = read_raw(data.data(), {RawNumber::Kind::natural, header_}, big_endian_);
  data.remove_prefix(header_);
  if (length < static_cast<double>(bytes) || data.size() < bytes)
    return error(array.tag.line, fmt::format("{} bytes are needed and {:.0f} there", bytes,
                                             std::min(length, static_cast<double>(data.size()))));
  return std::string(data.substr(0, bytes));
}

Expected<std::vector<Point>> XmlReader::from_text(const DataArray& array, std::size_t count) const {
  std::vector<Point> result;
  LineReader lines(array.content);
  Point vector;
  Eigen::Index k = 0;
  while (result.size() < count && lines.next()) {
    const int line = array.tag.line + lines.number() - 1;
    for (const auto word : words_of(lines.line())) {
      const auto value = finite_number(word, file_, line);
      if (!value) return std::unexpected(value.error());
      vector[k++] = *value;
      if (k == 3) result.push_back(vector), k = 0;
    }
  }
  if (result.size() != count)
    return error(array.tag.line,
                 fmt::format("{} vectors are announced and {} there", count, result.size()));
  return result;
}

Expected<std::vector<Point>> XmlReader::vectors(const DataArray& array, std::size_t count) const {
  const auto format = array.tag.get("format");
  if (format == "ascii" || format.empty()) return from_text(array, count);
  const auto type = raw_number_of(array.tag.get("type"));
  if (!type)
    return error(array.tag.line, fmt::format("numbers of type \"{}\" are not read",
                                             printable(array.tag.get("type"), 40)));
  if (count > bytes_.size() / 3)
    return error(array.tag.line, "more points are announced than the file can hold");
  const auto data = payload(array, 3 * count * type->bytes);
  if (!data) return std::unexpected(data.error());
  std::vector<Point> result(count);
  for (std::size_t k = 0; k < 3 * count; ++k)
    result[k / 3][static_cast<Eigen::Index>(k % 3)] =
        read_raw(data->data() + k * type->bytes, *type, big_endian_);
  for (std::size_t k = 0; k < count; ++k) {
    if (!result[k].allFinite())
      return error(array.tag.line,
                   fmt::format("vector {} of array \"{}\" is not finite", k + 1,
                               printable(array.tag.get("Name"), 40)),
                   "leave out points without a value");
  }
  return result;
}

Expected<void> XmlReader::add(const Piece& piece, bool first) {
  if (piece.points == 0) return {};
  if (!piece.place) return error(piece.line, "a piece has no Points");
  const auto points = vectors(*piece.place, piece.points);
  if (!points) return std::unexpected(points.error());
  result_.points.insert(result_.points.end(), points->begin(), points->end());
  for (const DataArray& array : piece.fields) {
    std::size_t components = 1;
    if (const auto given = array.tag.get("NumberOfComponents"); !given.empty()) {
      const auto count = count_in(given, 1'000'000, "components", file_, array.tag.line);
      if (!count) return std::unexpected(count.error());
      components = *count;
    }
    const std::string name(array.tag.get("Name"));
    auto field = std::ranges::find(result_.fields, name, &PointFields::Field::name);
    if (field == result_.fields.end()) {
      if (!first) continue;  // it is not in all pieces
      result_.fields.push_back({name, static_cast<int>(components), {}});
      field = result_.fields.end() - 1;
    }
    if (components != 3 || field->components != 3) continue;
    const auto values = vectors(array, piece.points);
    if (!values) return std::unexpected(values.error());
    field->vectors.insert(field->vectors.end(), values->begin(), values->end());
  }
  return {};
}

Expected<PointFields> XmlReader::read() {
  if (auto right = structure(); !right) return std::unexpected(right.error());
  bool first = true;
  for (const Piece& piece : pieces_) {
    if (auto right = add(piece, first); !right) return std::unexpected(right.error());
    first &= piece.points == 0;
  }
  // A field that a piece lacks is no field of all points.
  std::erase_if(result_.fields, [&](const PointFields::Field& field) {
    return field.components == 3 && field.vectors.size() != result_.points.size();
  });
  if (result_.points.empty()) return error(0, "there are no points");
  return std::move(result_);
}

}  // namespace

bool is_vtk_xml(std::string_view bytes) {
  return bytes.substr(0, 4096).find("<VTKFile") != std::string_view::npos;
}

Expected<PointFields> read_vtk_xml(std::string_view bytes, std::string_view file) {
  return XmlReader(bytes, file).read();
}

}  // namespace knead::fields
