#include "tool_picture.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "knead/spline/evaluate.hpp"
#include "spline/grid_lines.hpp"

namespace knead::studio {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int turns = 48;  // columns of a turned profile

class Builder {
 public:
  void point(const Point& p, const Point& normal) {
    for (int d = 0; d < 3; ++d) {
      picture_.positions.push_back(static_cast<float>(p[d]));
      picture_.normals.push_back(static_cast<float>(normal[d]));
    }
  }

  /// The quadrilateral a b c d, counterclockwise; corners may coincide.
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }

  /// Omitted if two corners coincide.
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (at(a) == at(b) || at(b) == at(c) || at(c) == at(a)) return;
    for (const std::uint32_t k : {a, b, c}) picture_.indices.push_back(k);
  }

  /// Joins a grid of points, row by row, whose outside is to the left of rows that run upwards.
  void grid(int rows, int columns, std::uint32_t first = 0) {
    const auto n = static_cast<std::uint32_t>(columns);
    for (std::uint32_t k = 0; k + 1 < static_cast<std::uint32_t>(rows); ++k) {
      for (std::uint32_t l = 0; l + 1 < n; ++l) {
        const std::uint32_t a = first + k * n + l;
        quad(a, a + 1, a + n + 1, a + n);
      }
    }
  }

  /// Normals as the area-weighted mean over the triangles that meet at a place.
  void smooth() {
    std::map<std::array<float, 3>, Point> sums;
    const auto sum_at = [&](std::size_t k) -> Point& {
      const float* p = &picture_.positions[3 * k];
      return sums.try_emplace({p[0], p[1], p[2]}, Point::Zero()).first->second;
    };
    for (std::size_t k = 0; k < picture_.indices.size(); k += 3) {
      const std::uint32_t* i = &picture_.indices[k];
      const Point normal = (at(i[1]) - at(i[0])).cross(at(i[2]) - at(i[0]));
      for (int c = 0; c < 3; ++c) sum_at(i[c]) += normal;
    }
    for (std::size_t k = 0; 3 * k < picture_.positions.size(); ++k) {
      const Point sum = sum_at(k),
                  n = sum.norm() > 0 ? Point(sum.normalized()) : Point(Point::UnitZ());
      for (int d = 0; d < 3; ++d)
        picture_.normals[3 * k + static_cast<std::size_t>(d)] = static_cast<float>(n[d]);
    }
  }

  [[nodiscard]] Point at(std::uint32_t k) const {
    const float* p = &picture_.positions[3 * static_cast<std::size_t>(k)];
    return {p[0], p[1], p[2]};
  }

  [[nodiscard]] ToolPicture take(bool open = false) {
    picture_.open = open;
    return std::move(picture_);
  }

 private:
  ToolPicture picture_;
};

/// A point (r, z) of a profile with its outward normal.
struct ProfilePoint {
  double r, z, normal_r, normal_z;
};

/// The profile, from bottom to top with the outside to the right, revolved about z.
ToolPicture turned(const std::vector<ProfilePoint>& profile, bool open = false) {
  Builder b;
  for (const ProfilePoint& p : profile) {
    for (int l = 0; l <= turns; ++l) {
      const double angle = l == turns ? 0 : 2 * pi * l / turns;
      const double c = std::cos(angle), s = std::sin(angle);
      b.point({p.r * c, p.r * s, p.z}, {p.normal_r * c, p.normal_r * s, p.normal_z});
    }
  }
  b.grid(static_cast<int>(profile.size()), turns + 1);
  return b.take(open);
}

/// Points of a circle about (r, z), from one angle to the other; the first and last exactly.
void arc(std::vector<ProfilePoint>& to, double r, double z, double radius, double from,
         double until, int pieces) {
  const double side = radius < 0 ? -1 : 1;  // a negative radius: seen from inside
  for (int k = 0; k <= pieces; ++k) {
    const double a = from + (until - from) * k / pieces;
    const double c = k % pieces == 0 && std::abs(std::cos(a)) < 1e-12 ? 0 : std::cos(a),
                 s = std::sin(a);
    to.push_back({r + std::abs(radius) * c, z + std::abs(radius) * s, side * c, side * s});
  }
}

struct PictureOf {
  ToolPicture operator()(const SphereShape& s) const {
    std::vector<ProfilePoint> profile;
    arc(profile, 0, 0, s.radius, -pi / 2, pi / 2, 24);
    return turned(profile);
  }

  ToolPicture operator()(const EllipsoidShape& s) const {
    ToolPicture picture = (*this)(SphereShape{1});
    for (std::size_t k = 0; k < picture.positions.size(); k += 3) {
      Point normal;
      for (std::size_t d = 0; d < 3; ++d) {
        normal[static_cast<Eigen::Index>(d)] = picture.normals[k + d] / s.semi_axes[d];
        picture.positions[k + d] *= static_cast<float>(s.semi_axes[d]);
      }
      normal.normalize();
      for (std::size_t d = 0; d < 3; ++d)
        picture.normals[k + d] = static_cast<float>(normal[static_cast<Eigen::Index>(d)]);
    }
    return picture;
  }

  /// A sphere of the rounding's radius whose eight octants are moved apart.
  ToolPicture operator()(const BoxShape& s) const {
    constexpr int pieces = 6;  // of a rounded edge
    Builder b;
    // Every direction between two octants occurs twice.
    std::vector<std::array<double, 2>> rows;     // angle, side of z
    std::vector<std::array<double, 3>> columns;  // angle, sides of x and y
    for (const double side : {-1.0, 1.0}) {
      for (int k = 0; k <= pieces; ++k)
        rows.push_back({pi / 2 * (side < 0 ? k - pieces : k) / pieces, side});
    }
    constexpr double sides[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    for (int q = 0; q <= 4; ++q) {
      const auto& [x, y] = sides[q % 4];
      for (int k = 0; k <= (q < 4 ? pieces : 0); ++k)
        columns.push_back({pi / 2 * (q % 4 + double(k) / pieces), x, y});
    }
    std::array<double, 3> core;
    for (std::size_t d = 0; d < 3; ++d) core[d] = s.half_sizes[d] - s.rounding;
    const auto corner = [&](double eta, double omega, double x, double y, double z) {
      const auto exact = [](double value) { return std::abs(value) < 1e-12 ? 0.0 : value; };
      const Point n(exact(std::cos(eta)) * exact(std::cos(omega)),
                    exact(std::cos(eta)) * exact(std::sin(omega)), std::sin(eta));
      b.point(Point(x * core[0], y * core[1], z * core[2]) + s.rounding * n, n);
    };
    for (const auto& [eta, z] : rows) {
      for (const auto& [omega, x, y] : columns) corner(eta, omega, x, y, z);
    }
    const auto n = static_cast<std::uint32_t>(columns.size()),
               m = static_cast<std::uint32_t>(rows.size());
    b.grid(static_cast<int>(m), static_cast<int>(n));
    constexpr std::uint32_t quarter = pieces + 1;
    const std::uint32_t top = (m - 1) * n;
    b.quad(0, 3 * quarter, 2 * quarter, quarter);
    b.quad(top, top + quarter, top + 2 * quarter, top + 3 * quarter);
    return b.take();
  }

  ToolPicture operator()(const CylinderShape& s) const {
    const double r = s.radius, h = s.half_height;
    return turned(
        {{0, -h, 0, -1}, {r, -h, 0, -1}, {r, -h, 1, 0}, {r, h, 1, 0}, {r, h, 0, 1}, {0, h, 0, 1}});
  }

  ToolPicture operator()(const ConeShape& s) const {
    const double slope = s.radius - s.top_radius, length = std::hypot(slope, s.height);
    const double out = s.height / length, up = slope / length;
    return turned({{0, 0, 0, -1},
                   {s.radius, 0, 0, -1},
                   {s.radius, 0, out, up},
                   {s.top_radius, s.height, out, up},
                   {s.top_radius, s.height, 0, 1},
                   {0, s.height, 0, 1}});
  }

  ToolPicture operator()(const CapsuleShape& s) const {
    std::vector<ProfilePoint> profile;
    arc(profile, 0, -s.half_height, s.radius, -pi / 2, 0, 12);
    arc(profile, 0, s.half_height, s.radius, 0, pi / 2, 12);
    return turned(profile);
  }

  ToolPicture operator()(const TorusShape& s) const {
    std::vector<ProfilePoint> profile;
    arc(profile, s.major, 0, s.minor, -pi, pi, 24);
    return turned(profile);
  }

  ToolPicture operator()(const PlaneShape&) const {
    Builder b;
    for (const double y : {-0.5, 0.5}) {
      for (const double x : {-0.5, 0.5}) b.point({x, y, 0}, Point::UnitZ());
    }
    b.grid(2, 2);
    ToolPicture picture = b.take(true);
    picture.unbounded = true;
    return picture;
  }

  ToolPicture operator()(const BowlShape& s) const {
    const double inner = s.radius - s.thickness;
    std::vector<ProfilePoint> profile;
    arc(profile, 0, 0, s.radius, -pi / 2, 0, 24);
    profile.push_back({s.radius, 0, 0, 1});
    profile.push_back({inner, 0, 0, 1});
    if (inner > 0) arc(profile, 0, 0, -inner, 0, -pi / 2, 24);
    return turned(profile, true);
  }

  ToolPicture operator()(const SuperellipsoidShape& s) const {
    const auto& [a, b, c] = s.semi_axes;
    return superquadric(-pi / 2, pi / 2, [&](double eta, double omega) {
      const double across = power(std::cos(eta), s.e1);
      return Point(a * across * power(std::cos(omega), s.e2),
                   b * across * power(std::sin(omega), s.e2), c * power(std::sin(eta), s.e1));
    });
  }

  ToolPicture operator()(const SupertoroidShape& s) const {
    return superquadric(-pi, pi, [&](double eta, double omega) {
      const double across = s.major + s.semi_axes[0] * power(std::cos(eta), s.e1);
      return Point(across * power(std::cos(omega), s.e2), across * power(std::sin(omega), s.e2),
                   s.semi_axes[1] * power(std::sin(eta), s.e1));
    });
  }

  ToolPicture operator()(const SplineShape& s) const {
    const std::array lines = {grid_lines(s.surface->knots(0), 32),
                              grid_lines(s.surface->knots(1), 32)};
    const auto points = evaluate_grid<2>(*s.surface, {lines[0].parameters, lines[1].parameters});
    if (!points) return {};
    Builder b;
    for (Eigen::Index k = 0; k < points->points().rows(); ++k)
      b.point(points->points().row(k).transpose(), Point::UnitZ());
    // Rows run along u: S_u × S_v is on the other side of them.
    const auto m = static_cast<std::uint32_t>(lines[0].parameters.size()),
               n = static_cast<std::uint32_t>(lines[1].parameters.size());
    for (std::uint32_t k = 0; k + 1 < m; ++k) {
      for (std::uint32_t l = 0; l + 1 < n; ++l)
        b.quad(k * n + l, (k + 1) * n + l, (k + 1) * n + l + 1, k * n + l + 1);
    }
    b.smooth();
    return b.take(true);
  }

  template <class Other>
  ToolPicture operator()(const Other& other) const {
    const auto placed = PlacedShape::create(other);
    return placed ? from_distances(*placed) : ToolPicture{};
  }

 private:
  /// sign(x) |x|^e, 0 for what is 0 up to rounding.
  static double power(double x, double e) {
    return std::abs(x) < 1e-12 ? 0 : std::copysign(std::pow(std::abs(x), e), x);
  }

  template <class Function>
  static ToolPicture superquadric(double from, double until, Function at) {
    constexpr int rows = 48;
    Builder b;
    for (int k = 0; k <= rows; ++k) {
      for (int l = 0; l <= turns; ++l) {
        b.point(at(from + (until - from) * k / rows, l == turns ? 0 : 2 * pi * l / turns),
                Point::UnitZ());
      }
    }
    b.grid(rows + 1, turns + 1);
    b.smooth();
    return b.take();
  }
};

}  // namespace

ToolPicture tool_picture(const Shape& shape) { return std::visit(PictureOf(), shape); }

ToolPicture from_distances(const PlacedShape& shape, int cells) {
  const BoundingBox box = shape.bounding_box();
  const Point extent = box.upper - box.lower;
  if (!extent.allFinite() || !(extent.maxCoeff() > 0)) return {};
  const double side = extent.maxCoeff() / cells;
  const Point origin = box.lower - Point::Constant(side);
  std::array<int, 3> n;  // points per direction, one cell beyond the box on either side
  for (int d = 0; d < 3; ++d)
    n[static_cast<std::size_t>(d)] = static_cast<int>(std::ceil(extent[d] / side)) + 3;
  const auto index = [&](int i, int j, int k) {
    return static_cast<std::size_t>((i * n[1] + j) * n[2] + k);
  };
  const auto place = [&](int i, int j, int k) { return Point(origin + side * Point(i, j, k)); };
  std::vector<double> distance(index(n[0] - 1, n[1] - 1, n[2] - 1) + 1);
  for (int i = 0; i < n[0]; ++i) {
    for (int j = 0; j < n[1]; ++j) {
      for (int k = 0; k < n[2]; ++k)
        distance[index(i, j, k)] = shape.nearest(place(i, j, k)).distance;
    }
  }
  Builder b;
  constexpr auto none = static_cast<std::uint32_t>(-1);
  std::vector<std::uint32_t> point_of(distance.size(), none);
  std::uint32_t count = 0;
  for (int i = 0; i + 1 < n[0]; ++i) {
    for (int j = 0; j + 1 < n[1]; ++j) {
      for (int k = 0; k + 1 < n[2]; ++k) {
        int inside = 0;
        for (int c = 0; c < 8; ++c)
          inside += distance[index(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))] < 0 ? 1 : 0;
        if (inside == 0 || inside == 8) continue;
        const Nearest at = shape.nearest(place(i, j, k) + Point::Constant(side / 2));
        b.point(at.point, at.normal.squaredNorm() > 0 ? at.normal : Point(Point::UnitZ()));
        point_of[index(i, j, k)] = count++;
      }
    }
  }
  // An edge of the lattice that the surface crosses: the points of the four cells around it.
  for (int i = 1; i + 1 < n[0]; ++i) {
    for (int j = 1; j + 1 < n[1]; ++j) {
      for (int k = 1; k + 1 < n[2]; ++k) {
        const bool here = distance[index(i, j, k)] < 0;
        const auto join = [&](bool there, std::size_t p, std::size_t q, std::size_t r,
                              std::size_t s) {
          if (here == there) return;
          if (here)
            b.quad(point_of[p], point_of[q], point_of[r], point_of[s]);
          else
            b.quad(point_of[s], point_of[r], point_of[q], point_of[p]);
        };
        const std::size_t o = index(i, j, k);
        join(distance[index(i + 1, j, k)] < 0, index(i, j - 1, k - 1), index(i, j, k - 1), o,
             index(i, j - 1, k));
        join(distance[index(i, j + 1, k)] < 0, index(i - 1, j, k - 1), index(i - 1, j, k), o,
             index(i, j, k - 1));
        join(distance[index(i, j, k + 1)] < 0, index(i - 1, j - 1, k), index(i, j - 1, k), o,
             index(i - 1, j, k));
      }
    }
  }
  return b.take();
}

}  // namespace knead::studio
