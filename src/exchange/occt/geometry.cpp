#include <fmt/format.h>

#include <algorithm>

#include "file.hpp"

namespace knead::occt {
namespace {

constexpr int max_nesting = 8;
constexpr int most_poles = 1 << 26;

class GeometryReader {
 public:
  explicit GeometryReader(WordReader& words) : words_(words) {}

  /// Poles and, behind them, knots with multiplicities; a Bézier curve has none of the latter.
  Expected<std::optional<Curve>> spline(int dimension, bool bezier) {
    const auto rational = integer(0, 1);
    const auto periodic = bezier ? Expected<int>(0) : integer(0, 1);
    const auto degree = integer(1, 64);
    if (!rational || !periodic || !degree) return fail("a B-spline curve begins wrongly");
    const auto poles = bezier ? Expected<int>(*degree + 1) : integer(2, most_poles);
    const auto count = bezier ? Expected<int>(2) : integer(2, most_poles);
    if (!poles || !count) return fail("a B-spline curve has no poles or no knots");
    const auto width = static_cast<std::size_t>(dimension + *rational),
               n = static_cast<std::size_t>(*poles);
    if (n > words_.rest()) return fail("the file ends too early");
    const auto numbers = words_.numbers(n * width);
    if (!numbers) return std::unexpected(numbers.error());
    auto flat = bezier ? bezier_knots(*degree) : knots(*count);
    if (!flat) return std::unexpected(flat.error());
    if (*periodic != 0) return std::optional<Curve>();
    Points points(static_cast<Eigen::Index>(n), 3);
    std::vector<double> weights;
    for (std::size_t k = 0; k < n; ++k) {
      const double* p = &(*numbers)[k * width];
      points.row(static_cast<Eigen::Index>(k)) << p[0], p[1], dimension == 3 ? p[2] : 0;
      if (*rational != 0) weights.push_back(p[dimension]);
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
      const auto multiplicity =
          knot ? integer(1, 64) : Expected<int>(std::unexpected(knot.error()));
      if (!multiplicity) return std::unexpected(multiplicity.error());
      flat.insert(flat.end(), static_cast<std::size_t>(*multiplicity), *knot);
    }
    return flat;
  }

  Expected<BrepCurve> curve(int dimension, int depth = 0) {
    // Location and axes, then radii or the focal length; in the plane there is no axis of rotation.
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
      auto curve = spline(dimension, *type == 6);
      if (!curve) return std::unexpected(curve.error());
      result.spline = *std::move(curve);
    } else {
      if (auto status = words_.numbers(*type == 8 ? 2 : dimension == 3 ? 4 : 1); !status)
        return std::unexpected(status.error());
      auto basis = curve(dimension, depth + 1);
      if (!basis) return basis;
      result.basis = std::make_shared<const BrepCurve>(*std::move(basis));
    }
    return result;
  }

  /// Whether u and v are rational, periodic (B-splines), degrees, numbers of poles and of knots
  /// (B-splines), poles with v fast and their weights, knots of u and v.
  Expected<Expected<ListedSurface>> spline_surface(std::size_t begin, bool bezier) {
    std::array<int, 10> head = {};
    const std::size_t count = bezier ? 4 : 10;
    for (std::size_t k = 0; k < count; ++k) {
      const bool flag = k < (bezier ? 2U : 4U);
      const auto value = integer(flag ? 0 : 1, flag ? 1 : most_poles);
      if (!value) return std::unexpected(value.error());
      head[k] = *value;
    }
    ListedSurface s;
    s.u_fast = false;
    s.degree = bezier ? std::array{head[2], head[3]} : std::array{head[4], head[5]};
    s.count = bezier ? std::array{head[2] + 1, head[3] + 1} : std::array{head[6], head[7]};
    if (s.degree[0] > 64 || s.degree[1] > 64) return fail("a degree is out of range");
    const bool rational = head[0] != 0 || head[1] != 0;
    if (auto status = detail::read_points(words_, s, rational ? 4 : 3); !status)
      return std::unexpected(status.error());
    for (std::size_t d = 0; d < 2; ++d) {
      auto flat = bezier ? bezier_knots(s.degree[d]) : knots(head[8 + d]);
      if (!flat) return std::unexpected(flat.error());
      s.knots[d] = *std::move(flat);
    }
    s.block = {begin, words_.place()};
    if (!bezier && (head[2] != 0 || head[3] != 0)) {
      return Expected<ListedSurface>(std::unexpected(words_.error(
          begin, "it is periodic", "make it a surface with ends before writing the file")));
    }
    return Expected<ListedSurface>(std::move(s));
  }

  Expected<BrepSurface> surface(int depth = 0) {
    // Plane, cylinder, cone, sphere, torus: location, axis, x, y and up to two sizes. Extrusion: a
    // direction; revolution: a point and a direction; their profile follows. 8 and 9 are Bézier and
    // B-spline surfaces, 10 is trimmed and 11 is an offset.
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
      if (auto status = words_.numbers(*type == 10 ? 4 : 1); !status)
        return std::unexpected(status.error());
      auto basis = surface(depth + 1);
      return *type == 10 || !basis ? basis : Expected<BrepSurface>(std::move(result));
    }
    return result;
  }

 private:
  std::unexpected<Error> fail(std::string what) const {
    return std::unexpected(
        words_.error(words_.place(), std::move(what), "write the file again as text"));
  }
  Expected<int> integer(int least, int largest) {
    return words_.integer(least, largest, "number that can stand here");
  }

  WordReader& words_;
};

}  // namespace

Expected<BrepCurve> read_brep_curve(WordReader& words, int dimension) {
  return GeometryReader(words).curve(dimension);
}

Expected<BrepSurface> read_brep_surface(WordReader& words) {
  return GeometryReader(words).surface();
}

}  // namespace knead::occt
