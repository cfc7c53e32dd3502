#include "file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "knead/base/printable.hpp"

namespace knead::occt {
namespace {

constexpr int most = 1 << 26;

// The text of BRepTools::Write: tables of locations, curves and surfaces, referred to by their
// numbers from 1 (0 is none), then shapes. Shapes follow those they use, and use them by their
// number counted from the end of the table, so that the last shape, the root, is 1. Tables of
// polygons and triangles are read over: a mesh is made anew from the surfaces. Words are separated
// by blanks only, and a section has no length of its own; so every entry must be understood to find
// the next one, even of forms that are not read.
class Parser {
 public:
  Parser(std::string_view bytes, std::string_view name)
      : text_(bytes), words_(bytes, name, {0, bytes.size()}) {}

  Expected<BrepFile> parse() {
    const std::size_t title = text_.find("CASCADE Topology V");
    if (title == text_.npos || title + 18 >= text_.size())
      return fail("this is no file of Open CASCADE's shapes");
    version_ = text_[title + 18] - '0';
    if (version_ < 1 || version_ > 3) return fail("versions 1 to 3 can be read");
    words_.go_to(std::min(text_.find('\n', title), text_.size()));
    for (const auto section :
         {&Parser::locations, &Parser::flat_curves, &Parser::curves, &Parser::polygons,
          &Parser::polygons_on_triangles, &Parser::surfaces, &Parser::triangles, &Parser::shapes}) {
      if (auto status = (this->*section)(); !status)
        return std::unexpected(std::move(status.error()));
    }
    return std::move(file_);
  }

 private:
  using Status = Expected<void>;

  std::unexpected<Error> fail(std::string what) const {
    return std::unexpected(
        words_.error(words_.place(), std::move(what), "write the file again as text"));
  }

  /// The word that begins a section, and the number of its entries.
  Expected<int> section(std::string_view word) {
    if (words_.peek() != word)
      return fail(fmt::format("\"{}\" should stand here in an Open CASCADE file", word));
    words_.next();
    return words_.integer(0, most, "number of entries");
  }

  Expected<int> integer(int least, int largest) {
    return words_.integer(least, largest, "number that can stand here");
  }

  Status skip(std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      if (words_.at_end()) return fail("the file ends too early");
      words_.next();
    }
    return {};
  }

  template <class F>
  Status each(std::string_view name, const F& read) {
    const auto count = section(name);
    Status status = count ? Status() : std::unexpected(count.error());
    for (int k = 0; status && k < *count; ++k) status = read();
    return status;
  }

  template <class T>
  static Status keep(Expected<T> read, std::vector<T>& list) {
    if (!read) return std::unexpected(std::move(read.error()));
    list.push_back(*std::move(read));
    return {};
  }

  Expected<Eigen::Affine3d> place(int index) const {
    if (index < 0 || static_cast<std::size_t>(index) >= places_.size())
      return fail("there is no such location");
    return places_[static_cast<std::size_t>(index)];
  }
  Expected<Eigen::Affine3d> place() {
    const auto index = integer(0, most);
    return index ? place(*index) : std::unexpected(index.error());
  }

  Status locations() {
    places_ = {Eigen::Affine3d::Identity()};
    return each("Locations", [&]() -> Status {
      const auto type = integer(1, 2);
      if (!type) return std::unexpected(type.error());
      Eigen::Affine3d result = Eigen::Affine3d::Identity();
      if (*type == 1) {
        const auto rows = words_.numbers(12);
        if (!rows) return std::unexpected(rows.error());
        for (int k = 0; k < 12; ++k)
          result.matrix()(k / 4, k % 4) = (*rows)[static_cast<std::size_t>(k)];
        if (!(std::abs(result.linear().determinant()) > 1e-12))
          return fail("a location is not invertible");
      } else {
        while (true) {
          const auto index = integer(0, most);
          if (!index) return std::unexpected(index.error());
          if (*index == 0) break;
          const auto base = place(*index);
          const auto power = integer(-1000, 1000);
          if (!base || !power) return std::unexpected(!base ? base.error() : power.error());
          // The list begins with what is applied first (TopLoc_Location): each goes to the left of
          // those before.
          const Eigen::Affine3d factor = *power > 0 ? *base : base->inverse();
          for (int k = 0; k < std::abs(*power); ++k) result = factor * result;
        }
      }
      if (!(result.matrix().cwiseAbs().maxCoeff() <= largest_number))
        return fail("a location is too large");
      places_.push_back(result);
      return {};
    });
  }

  Status flat_curves() {
    return each("Curve2ds",
                [&]() -> Status { return keep(read_brep_curve(words_, 2), file_.flat_curves); });
  }

  Status curves() {
    WordReader head = words_;
    head.next();
    file_.curve_count = head.next();
    return each("Curves", [&]() -> Status {
      const std::size_t begin = words_.begin();
      auto status = keep(read_brep_curve(words_, 3), file_.curves);
      file_.curve_blocks.push_back({begin, words_.place()});
      return status;
    });
  }

  /// Number of nodes, whether they have parameters, deflection, nodes, parameters.
  Status polygons() {
    return each("Polygon3D", [&]() -> Status {
      const auto nodes = integer(0, most), parameters = nodes ? integer(0, 1) : nodes;
      if (!parameters) return std::unexpected(parameters.error());
      return skip(1 + static_cast<std::size_t>(*nodes) * (*parameters != 0 ? 4 : 3));
    });
  }

  /// Number of nodes, nodes, "p", deflection, whether they have parameters, parameters.
  Status polygons_on_triangles() {
    return each("PolygonOnTriangulations", [&]() -> Status {
      const auto nodes = integer(0, most);
      if (!nodes) return std::unexpected(nodes.error());
      if (auto status = skip(static_cast<std::size_t>(*nodes) + 2); !status) return status;
      const auto parameters = integer(0, 1);
      if (!parameters) return std::unexpected(parameters.error());
      return skip(*parameters != 0 ? static_cast<std::size_t>(*nodes) : 0);
    });
  }

  /// Numbers of nodes and triangles, whether nodes have parameters and (version 3) normals,
  /// deflection, all of them.
  Status triangles() {
    return each("Triangulations", [&]() -> Status {
      const auto nodes = integer(0, most), count = nodes ? integer(0, most) : nodes,
                 flat = count ? integer(0, 1) : count;
      const auto normals = flat && version_ == 3 ? integer(0, 1) : flat ? Expected<int>(0) : flat;
      if (!normals) return std::unexpected(normals.error());
      const std::size_t each_node = 3 + (*flat != 0 ? 2 : 0) + (*normals != 0 ? 3 : 0);
      return skip(1 + each_node * static_cast<std::size_t>(*nodes) +
                  3 * static_cast<std::size_t>(*count));
    });
  }

  Status surfaces() {
    return each("Surfaces",
                [&]() -> Status { return keep(read_brep_surface(words_), file_.surfaces); });
  }

  /// Seven digits: free, modified, checked, orientable, closed, infinite, convex.
  static bool are_flags(std::string_view word) {
    return word.size() == 7 &&
           std::ranges::all_of(word, [](char c) { return c == '0' || c == '1'; });
  }

  /// Whether the flags of a shape come next: no parameter is followed by "*" or a use of a shape.
  bool at_flags() {
    const std::size_t here = words_.begin();
    const bool flags = are_flags(words_.words(words_.next()));
    const std::string_view after = words_.peek();
    words_.go_to(here);
    return flags && (after == "*" ||
                     (after.size() > 1 && std::string_view("+-ie").find(after[0]) != after.npos &&
                      after.find('.') == after.npos));
  }

  Status vertex(BrepShape& shape) {
    std::array<double, 4> numbers = {};  // tolerance, point
    for (std::size_t k = 0; k < 4; ++k) {
      const TextRange word = coming();
      const auto number = words_.number();
      if (!number) return std::unexpected(number.error());
      numbers[k] = *number;
      (k == 0 ? shape.tolerance_word : shape.coordinates[k - 1]) = word;
    }
    shape.tolerance = numbers[0];
    shape.point = Point(numbers[1], numbers[2], numbers[3]);
    while (!words_.at_end() && !at_flags()) words_.next();  // its places on curves and surfaces
    return {};
  }

  /// The place of the next word.
  TextRange coming() {
    const std::size_t begin = words_.begin();
    return {begin, begin + words_.peek().size()};
  }

  Status edge(BrepShape& shape) {
    shape.tolerance_word = coming();
    const auto tolerance = words_.number();
    if (!tolerance) return std::unexpected(tolerance.error());
    shape.tolerance = *tolerance;
    const auto same_parameter = integer(0, 1),
               same_range = same_parameter ? integer(0, 1) : same_parameter,
               degenerated = same_range ? integer(0, 1) : same_range;
    if (!degenerated) return std::unexpected(degenerated.error());
    shape.same_parameter = *same_parameter != 0;
    shape.degenerated = *degenerated != 0;
    while (!words_.at_end() && !at_flags()) {  // what represents it, in any order
      const std::size_t begin = words_.begin();
      const auto type = integer(0, 7);
      if (!type) return std::unexpected(type.error());
      if (*type == 0) continue;
      constexpr std::size_t words_of_polygons[] = {2, 3,
                                                   4};  // polygons, a triangulation, a location
      Status status;
      if (*type == 1) {
        status = edge_curve(shape);
      } else if (*type <= 3) {
        status = flat_curve(shape, *type == 3);
      } else if (*type == 4) {  // continuity across it, two surfaces with their locations
        status = skip(5);
      } else {
        status = skip(words_of_polygons[*type - 5]);
        shape.polygons.push_back({begin, words_.place()});
      }
      if (!status) return status;
    }
    return {};
  }

  Status edge_curve(BrepShape& shape) {
    shape.curve_word = coming();
    if (auto status = geometry(shape, file_.curves.size()); !status) return status;
    return range(shape.range);
  }

  Status range(std::array<double, 2>& result) {
    const auto ends = words_.numbers(2);
    if (!ends) return std::unexpected(ends.error());
    result = {(*ends)[0], (*ends)[1]};
    return {};
  }

  /// Curves, of a seam also the continuity across it, surface, its location, range, in version 2
  /// the end points.
  Status flat_curve(BrepShape& shape, bool seam) {
    const auto count = static_cast<int>(file_.flat_curves.size());
    BrepFlatCurve flat;
    const auto curve = integer(1, count);
    if (!curve) return std::unexpected(curve.error());
    flat.curve = *curve;
    if (seam) {  // the second and the continuity, as "2CN" or "2 CN"
      const std::string_view word = words_.words(words_.next());
      const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), flat.other);
      if (fault != std::errc() || flat.other < 1 || flat.other > count)
        return fail("there is no such curve");
      if (auto status = skip(end == word.data() + word.size() ? 1 : 0); !status) return status;
    }
    const auto surface = integer(0, static_cast<int>(file_.surfaces.size()));
    if (!surface) return std::unexpected(surface.error());
    const auto at = place();
    if (!at) return std::unexpected(at.error());
    flat.surface = *surface;
    flat.place = *at;
    if (auto status = range(flat.range); !status) return status;
    shape.flat.push_back(flat);
    return skip(version_ == 2 ? 4 : 0);
  }

  Status geometry(BrepShape& shape, std::size_t count) {
    const auto index = integer(0, static_cast<int>(count));
    if (!index) return std::unexpected(index.error());
    const auto at = place();
    if (!at) return std::unexpected(at.error());
    shape.geometry = *index;
    shape.place = *at;
    return {};
  }

  Status face(BrepShape& shape) {
    if (auto status = skip(2); !status) return status;  // natural bounds, tolerance
    if (auto status = geometry(shape, file_.surfaces.size()); !status) return status;
    const std::size_t begin = words_.begin();
    if (words_.peek() != "2") return {};
    if (auto status = skip(2); !status) return status;
    shape.triangulation = {begin, words_.place()};
    return {};
  }

  Expected<Use> use(std::size_t below, std::size_t count) {
    const auto word = words_.words(words_.next());
    if (word.size() < 2 || std::string_view("+-ie").find(word[0]) == std::string_view::npos) {
      return fail(fmt::format("\"{}\" is no reference to a shape", printable(word)));
    }
    WordReader number = words_;
    number.go_to(words_.place() - word.size() + 1);
    const auto index = number.integer(1, static_cast<int>(count), "shape");
    const auto at = place();
    if (!index || !at) return std::unexpected(!index ? index.error() : at.error());
    const std::size_t shape = count - static_cast<std::size_t>(*index);
    if (shape >= below) return fail("a shape refers to one that comes later");
    return Use{word[0], shape, *at};
  }

  /// What DRAW's command `save` writes behind the shape: the end of its list of values.
  bool at_last_zero() {
    const std::size_t here = words_.begin();
    const bool last = words_.words(words_.next()) == "0" && words_.at_end();
    if (!last) words_.go_to(here);
    return last;
  }

  Status shapes() {
    const auto count = section("TShapes");
    if (!count) return std::unexpected(count.error());
    const auto total = static_cast<std::size_t>(*count);
    for (std::size_t k = 0; k < total; ++k) {
      BrepShape shape;
      const auto kind = words_.words(words_.next());
      Status status;
      if (kind == "Ve") {
        shape.kind = Shape::vertex;
        status = vertex(shape);
      } else if (kind == "Ed") {
        shape.kind = Shape::edge;
        status = edge(shape);
      } else if (kind == "Wi") {
        shape.kind = Shape::wire;
      } else if (kind == "Fa") {
        shape.kind = Shape::face;
        status = face(shape);
      } else if (kind != "Sh" && kind != "So" && kind != "CS" && kind != "Co") {
        return fail(fmt::format("\"{}\" is no kind of shape", printable(kind)));
      }
      if (!status) return status;
      if (!are_flags(words_.words(words_.next())))
        return fail("the flags of a shape should stand here");
      while (words_.peek() != "*") {
        const auto read = use(k, total);
        if (!read) return std::unexpected(read.error());
        shape.uses.push_back(*read);
      }
      words_.next();
      file_.shapes.push_back(std::move(shape));
    }
    while (!words_.at_end()) {
      if (at_last_zero()) break;
      const auto root = use(total, total);
      if (!root) return std::unexpected(root.error());
      file_.roots.push_back(*root);
    }
    return {};
  }

  std::string_view text_;
  WordReader words_;
  BrepFile file_;
  std::vector<Eigen::Affine3d> places_;
  int version_ = 1;
};

}  // namespace

Expected<BrepFile> BrepFile::parse(std::string_view bytes, std::string_view name) {
  return Parser(bytes, name).parse();
}

}  // namespace knead::occt
