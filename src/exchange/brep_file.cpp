#include "brep_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "knead/base/printable.hpp"

namespace knead::brep {
namespace {

constexpr int most = 1 << 26;

class Parser {
 public:
  Parser(std::string_view bytes, std::string_view name) : text_(bytes), words_(bytes, name, {0, bytes.size()}) {}

  Expected<BrepFile> parse() {
    const std::size_t title = text_.find("CASCADE Topology V");
    if (title == text_.npos || title + 18 >= text_.size()) return fail("this is no file of Open CASCADE's shapes");
    version_ = text_[title + 18] - '0';
    if (version_ < 1 || version_ > 3) return fail("versions 1 to 3 can be read");
    words_.go_to(std::min(text_.find('\n', title), text_.size()));
    for (const auto section :
         {&Parser::locations, &Parser::flat_curves, &Parser::curves, &Parser::polygons, &Parser::polygons_on_triangles,
          &Parser::surfaces, &Parser::triangles, &Parser::shapes}) {
      if (auto done = (this->*section)(); !done) return std::unexpected(std::move(done.error()));
    }
    return std::move(file_);
  }

 private:
  using Done = Expected<void>;

  std::unexpected<Error> fail(std::string what) const {
    return std::unexpected(words_.error(words_.place(), std::move(what), "write the file again as text"));
  }

  /// The word that begins a section, and the number of its entries.
  Expected<int> section(std::string_view word) {
    if (words_.peek() != word) return fail(fmt::format("\"{}\" should stand here in an Open CASCADE file", word));
    words_.next();
    return words_.integer(0, most, "number of entries");
  }

  Expected<int> integer(int least, int largest) { return words_.integer(least, largest, "number that can stand here"); }

  Done skip(std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      if (words_.done()) return fail("the file ends too early");
      words_.next();
    }
    return {};
  }

  template <class F>
  Done each(std::string_view name, const F& read) {
    const auto count = section(name);
    Done done = count ? Done() : std::unexpected(count.error());
    for (int k = 0; done && k < *count; ++k) done = read();
    return done;
  }

  template <class T>
  static Done keep(Expected<T> read, std::vector<T>& list) {
    if (!read) return std::unexpected(std::move(read.error()));
    list.push_back(*std::move(read));
    return {};
  }

  Expected<Eigen::Affine3d> place(int index) const {
    if (index < 0 || static_cast<std::size_t>(index) >= places_.size()) return fail("there is no such location");
    return places_[static_cast<std::size_t>(index)];
  }
  Expected<Eigen::Affine3d> place() {
    const auto index = integer(0, most);
    return index ? place(*index) : std::unexpected(index.error());
  }

  Done locations() {
    places_ = {Eigen::Affine3d::Identity()};
    return each("Locations", [&]() -> Done {
      const auto type = integer(1, 2);
      if (!type) return std::unexpected(type.error());
      Eigen::Affine3d result = Eigen::Affine3d::Identity();
      if (*type == 1) {
        const auto rows = words_.numbers(12);
        if (!rows) return std::unexpected(rows.error());
        for (int k = 0; k < 12; ++k) result.matrix()(k / 4, k % 4) = (*rows)[static_cast<std::size_t>(k)];
        if (!(std::abs(result.linear().determinant()) > 1e-12)) return fail("a location is not invertible");
      } else {
        while (true) {
          const auto index = integer(0, most);
          if (!index) return std::unexpected(index.error());
          if (*index == 0) break;
          const auto own = place(*index);
          const auto power = integer(-1000, 1000);
          if (!own || !power) return std::unexpected(!own ? own.error() : power.error());
          for (int k = 0; k < std::abs(*power); ++k) result = result * (*power > 0 ? *own : own->inverse());
        }
      }
      places_.push_back(result);
      return {};
    });
  }

  Done flat_curves() {
    std::vector<BrepCurve> unused;
    return each("Curve2ds", [&]() -> Done { return keep(read_brep_curve(words_, 2), unused); });
  }

  Done curves() {
    return each("Curves", [&]() -> Done { return keep(read_brep_curve(words_, 3), file_.curves); });
  }

  /// Number of nodes, whether they have parameters, deflection, nodes, parameters.
  Done polygons() {
    return each("Polygon3D", [&]() -> Done {
      const auto nodes = integer(0, most), parameters = nodes ? integer(0, 1) : nodes;
      if (!parameters) return std::unexpected(parameters.error());
      return skip(1 + static_cast<std::size_t>(*nodes) * (*parameters != 0 ? 4 : 3));
    });
  }

  /// Number of nodes, nodes, "p", deflection, whether they have parameters, parameters.
  Done polygons_on_triangles() {
    return each("PolygonOnTriangulations", [&]() -> Done {
      const auto nodes = integer(0, most);
      if (!nodes) return std::unexpected(nodes.error());
      if (auto done = skip(static_cast<std::size_t>(*nodes) + 2); !done) return done;
      const auto parameters = integer(0, 1);
      if (!parameters) return std::unexpected(parameters.error());
      return skip(*parameters != 0 ? static_cast<std::size_t>(*nodes) : 0);
    });
  }

  /// Numbers of nodes and triangles, whether nodes have parameters and (version 3) normals, deflection, all of them.
  Done triangles() {
    return each("Triangulations", [&]() -> Done {
      const auto nodes = integer(0, most), count = nodes ? integer(0, most) : nodes,
                 flat = count ? integer(0, 1) : count;
      const auto normals = flat && version_ == 3 ? integer(0, 1) : flat ? Expected<int>(0) : flat;
      if (!normals) return std::unexpected(normals.error());
      const std::size_t each_node = 3 + (*flat != 0 ? 2 : 0) + (*normals != 0 ? 3 : 0);
      return skip(1 + each_node * static_cast<std::size_t>(*nodes) + 3 * static_cast<std::size_t>(*count));
    });
  }

  Done surfaces() {
    return each("Surfaces", [&]() -> Done { return keep(read_brep_surface(words_), file_.surfaces); });
  }

  /// Seven digits: free, modified, checked, orientable, closed, infinite, convex.
  static bool are_flags(std::string_view word) {
    return word.size() == 7 && std::ranges::all_of(word, [](char c) { return c == '0' || c == '1'; });
  }

  /// Whether the flags of a shape come next: no parameter is followed by "*" or a use of a shape.
  bool at_flags() {
    const std::size_t here = words_.begin();
    const bool flags = are_flags(words_.words(words_.next()));
    const std::string_view after = words_.peek();
    words_.go_to(here);
    return flags && (after == "*" || (after.size() > 1 && std::string_view("+-ie").find(after[0]) != after.npos &&
                                      after.find('.') == after.npos));
  }

  Done vertex(BrepShape& shape) {
    const auto numbers = words_.numbers(4);  // tolerance, point
    if (!numbers) return std::unexpected(numbers.error());
    shape.point = Point((*numbers)[1], (*numbers)[2], (*numbers)[3]);
    while (!words_.done() && !at_flags()) words_.next();  // its places on curves and surfaces
    return {};
  }

  Done edge(BrepShape& shape) {
    const auto tolerance = words_.number();
    if (!tolerance) return std::unexpected(tolerance.error());
    if (auto done = skip(2); !done) return done;  // same parameter, same range
    const auto degenerated = integer(0, 1);
    if (!degenerated) return std::unexpected(degenerated.error());
    shape.degenerated = *degenerated != 0;
    if (words_.peek() == "1") {  // its curve in space comes first
      words_.next();
      if (auto done = geometry(shape, file_.curves.size()); !done) return done;
    }
    while (!words_.done() && !at_flags()) words_.next();  // curves in parameters, continuity, polygons
    return {};
  }

  Done geometry(BrepShape& shape, std::size_t count) {
    const auto index = integer(0, static_cast<int>(count));
    if (!index) return std::unexpected(index.error());
    const auto at = place();
    if (!at) return std::unexpected(at.error());
    shape.geometry = *index;
    shape.place = *at;
    return {};
  }

  Done face(BrepShape& shape) {
    if (auto done = skip(2); !done) return done;  // natural bounds, tolerance
    if (auto done = geometry(shape, file_.surfaces.size()); !done) return done;
    const std::size_t begin = words_.begin();
    if (words_.peek() != "2") return {};
    if (auto done = skip(2); !done) return done;
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

  Done shapes() {
    const auto count = section("TShapes");
    if (!count) return std::unexpected(count.error());
    const auto total = static_cast<std::size_t>(*count);
    for (std::size_t k = 0; k < total; ++k) {
      BrepShape shape;
      const auto kind = words_.words(words_.next());
      Done done;
      if (kind == "Ve") {
        shape.kind = Shape::vertex;
        done = vertex(shape);
      } else if (kind == "Ed") {
        shape.kind = Shape::edge;
        done = edge(shape);
      } else if (kind == "Wi") {
        shape.kind = Shape::wire;
      } else if (kind == "Fa") {
        shape.kind = Shape::face;
        done = face(shape);
      } else if (kind != "Sh" && kind != "So" && kind != "CS" && kind != "Co") {
        return fail(fmt::format("\"{}\" is no kind of shape", printable(kind)));
      }
      if (!done) return done;
      if (!are_flags(words_.words(words_.next()))) return fail("the flags of a shape should stand here");
      while (words_.peek() != "*") {
        const auto read = use(k, total);
        if (!read) return std::unexpected(read.error());
        shape.uses.push_back(*read);
      }
      words_.next();
      file_.shapes.push_back(std::move(shape));
    }
    while (!words_.done()) {
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

}  // namespace knead::brep
