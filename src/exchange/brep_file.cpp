#include "brep_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "knead/base/printable.hpp"

namespace knead::brep {
namespace {

constexpr int max_nesting = 8;
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

  /// Poles and, behind them, knots with multiplicities; a Bézier curve has none of the latter.
  Expected<std::optional<Curve>> spline(int dimension, bool bezier) {
    const auto rational = integer(0, 1);
    const auto periodic = bezier ? Expected<int>(0) : integer(0, 1);
    const auto degree = integer(1, 64);
    if (!rational || !periodic || !degree) return fail("a B-spline curve begins wrongly");
    const auto poles = bezier ? Expected<int>(*degree + 1) : integer(2, most);
    const auto count = bezier ? Expected<int>(2) : integer(2, most);
    if (!poles || !count) return fail("a B-spline curve has no poles or no knots");
    const auto width = static_cast<std::size_t>(dimension + *rational), n = static_cast<std::size_t>(*poles);
    if (n > words_.rest()) return fail("the file ends too early");
    const auto numbers = words_.numbers(n * width);
    if (!numbers) return std::unexpected(numbers.error());
    auto flat = bezier ? bezier_knots(*degree) : knots(*count);
    if (!flat) return std::unexpected(flat.error());
    if (dimension == 2 || *periodic != 0) return std::optional<Curve>();
    Points points(static_cast<Eigen::Index>(n), 3);
    std::vector<double> weights;
    for (std::size_t k = 0; k < n; ++k) {
      const double* p = &(*numbers)[k * width];
      points.row(static_cast<Eigen::Index>(k)) << p[0], p[1], p[2];
      if (*rational != 0) weights.push_back(p[3]);
    }
    auto vector = KnotVector::create(*degree, *std::move(flat));
    if (!vector) return std::optional<Curve>();  // a degree or knots that are not known here
    auto curve = Curve::create({*std::move(vector)}, std::move(points), std::move(weights));
    return curve ? std::optional<Curve>(*std::move(curve)) : std::nullopt;
  }

  static Expected<std::vector<double>> bezier_knots(int degree) {
    std::vector<double> flat(2 * static_cast<std::size_t>(degree + 1), 0.0);
    std::fill(flat.begin() + degree + 1, flat.end(), 1.0);
    return flat;
  }

  Expected<std::vector<double>> knots(int count) {
    std::vector<double> flat;
    for (int k = 0; k < count; ++k) {
      const auto knot = words_.number();
      const auto multiplicity = knot ? integer(1, 64) : Expected<int>(std::unexpected(knot.error()));
      if (!multiplicity) return std::unexpected(multiplicity.error());
      flat.insert(flat.end(), static_cast<std::size_t>(*multiplicity), *knot);
    }
    return flat;
  }

  Expected<BrepCurve> curve(int dimension, int depth = 0) {
    constexpr int sizes[2][5] = {{4, 7, 8, 7, 8}, {6, 13, 14, 13, 14}};  // of types 1 to 5
    if (depth > max_nesting) return fail("curves are nested too deeply");
    const auto type = integer(1, 9);
    if (!type) return std::unexpected(type.error());
    BrepCurve result;
    result.type = *type;
    if (*type <= 5) {
      auto numbers = words_.numbers(static_cast<std::size_t>(sizes[dimension - 2][*type - 1]));
      if (!numbers) return std::unexpected(numbers.error());
      result.numbers = *std::move(numbers);
    } else if (*type <= 7) {
      auto own = spline(dimension, *type == 6);
      if (!own) return std::unexpected(own.error());
      result.spline = *std::move(own);
    } else {
      if (auto done = words_.numbers(*type == 8 ? 2 : dimension == 3 ? 4 : 1); !done)
        return std::unexpected(done.error());
      auto basis = curve(dimension, depth + 1);
      if (!basis) return basis;
      result.basis = std::make_shared<const BrepCurve>(*std::move(basis));
    }
    return result;
  }

  Done flat_curves() {
    std::vector<BrepCurve> unused;
    return each("Curve2ds", [&]() -> Done { return keep(curve(2), unused); });
  }

  Done curves() {
    return each("Curves", [&]() -> Done { return keep(curve(3), file_.curves); });
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

  /// Whether u and v are rational, periodic (B-splines), degrees, numbers of poles and of knots (B-splines), poles with
  /// v fast and their weights, knots of u and v.
  Expected<Expected<ListedSurface>> spline_surface(std::size_t begin, bool bezier) {
    std::array<int, 10> head = {};
    const std::size_t count = bezier ? 4 : 10;
    for (std::size_t k = 0; k < count; ++k) {
      const bool flag = k < (bezier ? 2U : 4U);
      const auto value = integer(flag ? 0 : 1, flag ? 1 : most);
      if (!value) return std::unexpected(value.error());
      head[k] = *value;
    }
    ListedSurface s;
    s.u_fast = false;
    s.degree = bezier ? std::array{head[2], head[3]} : std::array{head[4], head[5]};
    s.count = bezier ? std::array{head[2] + 1, head[3] + 1} : std::array{head[6], head[7]};
    if (s.degree[0] > 64 || s.degree[1] > 64) return fail("a degree is out of range");
    const bool rational = head[0] != 0 || head[1] != 0;
    if (auto done = detail::read_points(words_, s, rational ? 4 : 3); !done) return std::unexpected(done.error());
    for (std::size_t d = 0; d < 2; ++d) {
      auto flat = bezier ? bezier_knots(s.degree[d]) : knots(head[8 + d]);
      if (!flat) return std::unexpected(flat.error());
      s.knots[d] = *std::move(flat);
    }
    s.block = {begin, words_.place()};
    if (!bezier && (head[2] != 0 || head[3] != 0)) {
      return Expected<ListedSurface>(std::unexpected(
          words_.error(begin, "it is periodic", "make it a surface with ends before writing the file")));
    }
    return Expected<ListedSurface>(std::move(s));
  }

  Expected<BrepSurface> surface(int depth = 0) {
    constexpr std::size_t sizes[] = {12, 13, 14, 13, 14, 3, 6};  // of types 1 to 7
    if (depth > max_nesting) return fail("surfaces are nested too deeply");
    const std::size_t begin = words_.begin();
    const auto type = integer(1, 11);
    if (!type) return std::unexpected(type.error());
    BrepSurface result;
    result.type = *type;
    if (*type <= 7) {
      auto numbers = words_.numbers(sizes[*type - 1]);
      if (!numbers) return std::unexpected(numbers.error());
      result.numbers = *std::move(numbers);
      if (*type < 6) return result;
      auto profile = curve(3);
      if (!profile) return std::unexpected(profile.error());
      result.profile = std::make_shared<const BrepCurve>(*std::move(profile));
    } else if (*type <= 9) {
      auto spline = spline_surface(begin, *type == 8);
      if (!spline) return std::unexpected(spline.error());
      result.spline = *std::move(spline);
    } else {
      if (auto done = words_.numbers(*type == 10 ? 4 : 1); !done) return std::unexpected(done.error());
      auto basis = surface(depth + 1);
      return *type == 10 || !basis ? basis : Expected<BrepSurface>(std::move(result));
    }
    return result;
  }

  Done surfaces() {
    return each("Surfaces", [&]() -> Done { return keep(surface(), file_.surfaces); });
  }

  /// Seven digits: free, modified, checked, orientable, closed, infinite, convex.
  static bool are_flags(std::string_view word) {
    return word.size() == 7 && std::ranges::all_of(word, [](char c) { return c == '0' || c == '1'; });
  }

  Done vertex(BrepShape& shape) {
    const auto numbers = words_.numbers(4);  // tolerance, point
    if (!numbers) return std::unexpected(numbers.error());
    shape.point = Point((*numbers)[1], (*numbers)[2], (*numbers)[3]);
    while (!words_.done() && !are_flags(words_.peek())) words_.next();  // its places on curves and surfaces
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
    while (!words_.done() && !are_flags(words_.peek())) words_.next();  // curves in parameters, continuity, polygons
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
