#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "knead/tool/shape.hpp"
#include "support/surfaces.hpp"

/// Every shape with its surface written a second time, by trigonometric formulas, for brute force.
namespace knead::testing {

using Sheet = std::function<Point(double, double)>;  ///< a piece of surface over [0, 1]²

struct ShapeCase {
  std::string name;
  Shape shape;
  std::vector<Sheet> sheets;  ///< in the shape's frame, without scale
};

inline double spow(double x, double e) { return std::copysign(std::pow(std::abs(x), e), x); }

/// (cos^e, sin^e) once round; the angle is spread so that tan^e runs evenly in each eighth.
inline std::array<double, 2> superellipse(double t, double e) {
  const double eighth = t * 8 - std::floor(t * 8);
  const int k = static_cast<int>(std::floor(t * 8)) % 8;
  const bool odd = k % 2 == 1;
  const double s = odd ? 1 - eighth : eighth, theta = std::atan(std::pow(s, 1 / e));
  const double c = std::pow(std::cos(theta), e), n = std::pow(std::sin(theta), e);
  const double x = odd ? n : c, y = odd ? c : n;
  switch (k / 2) {
    case 0:
      return {x, y};
    case 1:
      return {-y, x};
    case 2:
      return {-x, -y};
    default:
      return {y, -x};
  }
}

/// A meridian (ρ, z)(t) turned once round z.
inline Sheet turned(std::function<std::array<double, 2>(double)> meridian) {
  return [meridian](double u, double v) {
    const auto [rho, z] = meridian(u);
    const double a = 2 * std::numbers::pi * v;
    return Point(rho * std::cos(a), rho * std::sin(a), z);
  };
}
inline Sheet turned_segment(double ra, double za, double rb, double zb) {
  return turned([=](double t) {
    return std::array<double, 2>{ra + t * (rb - ra), za + t * (zb - za)};
  });
}
inline Sheet turned_arc(double rc, double zc, double r, double from, double to) {
  return turned([=](double t) {
    const double a = std::numbers::pi * (from + t * (to - from));
    return std::array<double, 2>{rc + r * std::cos(a), zc + r * std::sin(a)};
  });
}

inline ShapeCase superellipsoid_case(std::array<double, 3> a, double e1, double e2) {
  ShapeCase c{"superellipsoid " + std::to_string(e1) + " " + std::to_string(e2),
              SuperellipsoidShape{a, e1, e2},
              {}};
  for (int half = 0; half < 2; ++half) {
    c.sheets.push_back([=](double u, double v) {
      const auto m = superellipse(u / 4 + (half == 0 ? 0 : 0.75), e1), p = superellipse(v, e2);
      return Point(a[0] * m[0] * p[0], a[1] * m[0] * p[1], a[2] * m[1]);
    });
  }
  return c;
}

inline ShapeCase supertoroid_case(double major, std::array<double, 2> a, double e1, double e2) {
  ShapeCase c{"supertoroid " + std::to_string(e1) + " " + std::to_string(e2),
              SupertoroidShape{major, a, e1, e2},
              {}};
  c.sheets.push_back([=](double u, double v) {
    const auto m = superellipse(u, e1), p = superellipse(v, e2);
    const double rho = major + a[0] * m[0];
    return Point(rho * p[0], rho * p[1], a[1] * m[1]);
  });
  return c;
}

inline ShapeCase box_case(std::array<double, 3> h, double r) {
  ShapeCase c{"box " + std::to_string(r), BoxShape{h, r}, {}};
  for (int axis = 0; axis < 3; ++axis) {
    for (double side : {-1.0, 1.0}) {
      c.sheets.push_back([=](double u, double v) {
        // A cube's face pushed out: the nearest point of the core plus the rounding along the way.
        Point x;
        x[axis] = side * h[static_cast<std::size_t>(axis)];
        const int j = (axis + 1) % 3, k = (axis + 2) % 3;
        const double hj = h[static_cast<std::size_t>(j)], hk = h[static_cast<std::size_t>(k)];
        x[j] = hj * (2 * u - 1);
        x[k] = hk * (2 * v - 1);
        if (r == 0) return x;
        Point core;
        for (int i = 0; i < 3; ++i) {
          const double limit = h[static_cast<std::size_t>(i)] - r;
          core[i] = std::clamp(x[i], -limit, limit);
        }
        return Point(core + r * (x - core).normalized());
      });
    }
  }
  return c;
}

inline ShapeCase wedge_case(double length, double angle, double height, double rounding) {
  ShapeCase c{"wedge " + std::to_string(angle) + " " + std::to_string(rounding),
              WedgeShape{length, angle, height, rounding},
              {}};
  const double a = angle / 360 * std::numbers::pi, centre = height - rounding;
  const double foot = (height + rounding * (1 / std::sin(a) - 1)) * std::tan(a);
  // Pieces of half the profile: from the foot's corner up the flank, and on to the top.
  std::vector<std::function<std::array<double, 2>(double)>> pieces = {[=](double t) {
    const double y = rounding * std::cos(a), z = centre + rounding * std::sin(a);
    return std::array<double, 2>{foot + t * (y - foot), t * z};
  }};
  if (rounding > 0) {
    pieces.push_back([=](double t) {
      const double b = a + t * (std::numbers::pi / 2 - a);
      return std::array<double, 2>{rounding * std::cos(b), centre + rounding * std::sin(b)};
    });
  }
  c.sheets.push_back(
      [=](double u, double v) { return Point(length * (u - 0.5), foot * (2 * v - 1), 0); });
  for (double side : {-1.0, 1.0}) {
    for (const auto& piece : pieces) {
      c.sheets.push_back([=](double u, double v) {
        const auto [y, z] = piece(v);
        return Point(length * (u - 0.5), side * y, z);
      });
      for (double end : {-0.5, 0.5}) {
        c.sheets.push_back([=](double u, double v) {
          const auto [y, z] = piece(v);
          return Point(end * length, side * u * y, u * z);
        });
      }
    }
  }
  return c;
}

inline std::vector<ShapeCase> shape_cases() {
  std::vector<ShapeCase> cases;
  cases.push_back({"sphere", SphereShape{0.7}, {turned_arc(0, 0, 0.7, -0.5, 0.5)}});
  cases.push_back({"ellipsoid", EllipsoidShape{{0.5, 1.2, 0.8}}, {[](double u, double v) {
                     const double a = std::numbers::pi * (u - 0.5), b = 2 * std::numbers::pi * v;
                     return Point(0.5 * std::cos(a) * std::cos(b), 1.2 * std::cos(a) * std::sin(b),
                                  0.8 * std::sin(a));
                   }}});
  cases.push_back(box_case({0.5, 1, 0.7}, 0));
  cases.push_back(box_case({0.5, 1, 0.7}, 0.2));
  cases.push_back({"cylinder",
                   CylinderShape{0.6, 0.9},
                   {turned_segment(0, -0.9, 0.6, -0.9), turned_segment(0.6, -0.9, 0.6, 0.9),
                    turned_segment(0.6, 0.9, 0, 0.9)}});
  cases.push_back({"cone",
                   ConeShape{0.6, 1.1, 0},
                   {turned_segment(0, 0, 0.6, 0), turned_segment(0.6, 0, 0, 1.1)}});
  cases.push_back({"frustum",
                   ConeShape{0.6, 1.1, 0.9},
                   {turned_segment(0, 0, 0.6, 0), turned_segment(0.6, 0, 0.9, 1.1),
                    turned_segment(0.9, 1.1, 0, 1.1)}});
  cases.push_back({"capsule",
                   CapsuleShape{0.5, 0.8},
                   {turned_arc(0, 0.8, 0.5, 0, 0.5), turned_segment(0.5, 0.8, 0.5, -0.8),
                    turned_arc(0, -0.8, 0.5, -0.5, 0)}});
  cases.push_back({"torus", TorusShape{1, 0.3}, {turned_arc(1, 0, 0.3, 0, 2)}});
  cases.push_back({"bowl",
                   BowlShape{1, 0.2},
                   {turned_arc(0, 0, 1, -0.5, 0), turned_arc(0, 0, 0.8, -0.5, 0),
                    turned_segment(0.8, 0, 1, 0)}});
  for (auto [e1, e2] : {std::pair{1.0, 1.0},
                        {0.1, 0.1},
                        {0.1, 1.0},
                        {1.0, 0.3},
                        {0.5, 1.5},
                        {2.0, 2.0},
                        {1.3, 0.7},
                        {3.0, 3.0},
                        {2.5, 0.2},
                        {0.3, 3.0},
                        {1.0, 2.0}}) {
    cases.push_back(superellipsoid_case({0.6, 1, 0.8}, e1, e2));
    cases.push_back(supertoroid_case(1, {0.3, 0.4}, e1, e2));
  }
  cases.push_back(wedge_case(2.2, 60, 0.9, 0.15));
  cases.push_back(wedge_case(1.2, 100, 0.7, 0));
  cases.push_back(wedge_case(1.5, 90, 0.5, 1.5));  // all but round from foot to foot
  return cases;
}

struct Posed {
  Placement placement;
  [[nodiscard]] Point out(const Point& local) const {
    return placement.position + placement.rotation * Point(local.x() * placement.scale[0],
                                                           local.y() * placement.scale[1],
                                                           local.z() * placement.scale[2]);
  }
};

/// The least distance from x to the sheets: a grid of samples, the best dozen of which are improved
/// by compass search.
class BruteForce {
 public:
  BruteForce(const std::vector<Sheet>& sheets, const Posed& pose, int steps = 64) : steps_(steps) {
    for (const Sheet& sheet : sheets) {
      sheets_.push_back([sheet, pose](double u, double v) { return pose.out(sheet(u, v)); });
      for (int i = 0; i <= steps; ++i) {
        for (int j = 0; j <= steps; ++j) {
          const double u = double(i) / steps, v = double(j) / steps;
          samples_.push_back({sheets_.size() - 1, u, v, sheets_.back()(u, v)});
        }
      }
    }
  }
  [[nodiscard]] double distance(const Point& x, std::size_t improved = 12) const {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t k = 0; k < samples_.size(); ++k)
      order.push_back({(samples_[k].point - x).squaredNorm(), k});
    improved = std::min(improved, order.size());
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(improved),
                      order.end());
    double best = std::sqrt(order.front().first);
    for (std::size_t k = 0; k < improved; ++k)
      best = std::min(best, improve(x, samples_[order[k].second]));
    return best;
  }

 private:
  struct Sample {
    std::size_t sheet;
    double u, v;
    Point point;
  };
  [[nodiscard]] double improve(const Point& x, const Sample& s) const {
    double u = s.u, v = s.v, best = (s.point - x).norm();
    for (double h = 1.0 / steps_; h > 1e-12;) {
      bool better = false;
      for (int k = 0; k < 8; ++k) {
        const double a = std::numbers::pi / 4 * k;
        const double tu = std::clamp(u + h * std::cos(a), 0.0, 1.0),
                     tv = std::clamp(v + h * std::sin(a), 0.0, 1.0);
        const double d = (sheets_[s.sheet](tu, tv) - x).norm();
        if (d < best) {
          best = d;
          u = tu;
          v = tv;
          better = true;
          break;
        }
      }
      if (!better) h *= 0.5;
    }
    return best;
  }

  int steps_;
  std::vector<Sheet> sheets_;
  std::vector<Sample> samples_;
};

/// Three numbers, drawn one after the other, the last coordinate first: compilers differ in the
/// order in which they evaluate arguments.
template <class Distribution>
Point drawn(Distribution& numbers, std::mt19937_64& random) {
  const double z = numbers(random), y = numbers(random), x = numbers(random);
  return {x, y, z};
}

inline Placement random_placement(std::mt19937_64& random, bool unequal) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> factor(-0.7, 0.7), decade(-3, 3);
  Placement p;
  const Point vector = drawn(normal, random);
  const double scalar = normal(random);
  p.rotation = Eigen::Quaterniond(scalar, vector.x(), vector.y(), vector.z()).normalized();
  const double s = std::pow(10.0, decade(random));
  for (double& c : p.scale) c = unequal ? s * std::exp(factor(random)) : s;
  p.position = s * drawn(normal, random);
  return p;
}

}  // namespace knead::testing
