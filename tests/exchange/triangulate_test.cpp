#include "brep/tessellation/triangulate.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "brep/tessellation/model_mesh.hpp"
#include "brep/tessellation/orientation.hpp"
#include "exchange/face_builder.hpp"
#include "exchange/mesh_measures.hpp"
#include "support/long_run.hpp"

namespace knead {
namespace {

using Eigen::Vector2d;
using Loop = std::vector<Vector2d>;

double area_of_loop(const Loop& loop) {
  long double sum = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vector2d a = loop[k] - loop[0], b = loop[(k + 1) % loop.size()] - loop[0];
    sum += static_cast<long double>(a.x()) * b.y() - static_cast<long double>(a.y()) * b.x();
  }
  return static_cast<double>(sum / 2);
}

/// The loops are the bounds of the triangles, none of which is turned over; together they cover
/// what the loops do.
void expect_filled(const std::vector<Loop>& loops) {
  const auto triangles = triangulate(loops, {});
  ASSERT_TRUE(triangles);
  Loop points;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int>
      sides;  // of the loops -1, of the triangles +1
  double wanted = 0, area = 0;
  for (const Loop& loop : loops) {
    const auto first = static_cast<std::uint32_t>(points.size()),
               n = static_cast<std::uint32_t>(loop.size());
    for (std::uint32_t k = 0; k < n; ++k) --sides[{first + k, first + (k + 1) % n}];
    points.insert(points.end(), loop.begin(), loop.end());
    wanted += area_of_loop(loop);
  }
  for (const auto& [a, b, c] : *triangles) {
    const double triangle = doubled_area(points[a], points[b], points[c]) / 2;
    EXPECT_EQ(orientation(points[a], points[b], points[c]), 1) << a << " " << b << " " << c;
    area += triangle;
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      if (const auto back = sides.find({to, from}); back != sides.end() && back->second > 0) {
        --back->second;
      } else {
        ++sides[{from, to}];
      }
    }
  }
  EXPECT_TRUE(std::ranges::all_of(sides, [](const auto& side) { return side.second == 0; }));
  EXPECT_EQ(triangles->size(), points.size() + 2 * (loops.size() - 1) - 2) << "Euler's formula";
  EXPECT_NEAR(area, wanted, 1e-9 * wanted);
}

Loop regular(Vector2d centre, double radius, int corners, double turn) {
  Loop loop;
  for (int k = 0; k < corners; ++k) {
    const double angle = turn - 2 * std::numbers::pi * k / corners;  // clockwise
    loop.push_back(centre + radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return loop;
}
Loop hole_at(double x, double y, double side) {
  return {{x, y}, {x, y + side}, {x + side, y + side}, {x + side, y}};
}

/// A plate of about 1 x 1 with 1 to 9 holes.
class Plate {
 public:
  explicit Plate(unsigned seed) : random_(seed) {
    switch (seed % 4) {
      case 0:
        loops_ = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
        break;
      case 1:  // corners along the sides
        loops_ = {{{0, 0},
                   {0.25, 0},
                   {0.5, 0},
                   {1, 0},
                   {1, 0.5},
                   {1, 1},
                   {0.5, 1},
                   {0, 1},
                   {0, 0.75},
                   {0, 0.25}}};
        break;
      case 2:  // notches between the holes
        loops_ = {{{0, 0},
                   {0.5, 0},
                   {0.5, 0.25},
                   {0.5625, 0.25},
                   {0.5625, 0},
                   {1, 0},
                   {1, 1},
                   {0.25, 1},
                   {0.25, 0.75},
                   {0.1875, 0.75},
                   {0.1875, 1},
                   {0, 1}}};
        block(0.5, 0, 0.0625, 0.25);
        block(0.1875, 0.75, 0.0625, 0.25);
        break;
      default:
        loops_ = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
        loops_[0] = regular({0.5, 0.5}, 0.75, 24, 0.1);
        std::ranges::reverse(loops_[0]);
    }
    const int holes = 1 + static_cast<int>(random_() % 9), kind = static_cast<int>(seed / 4 % 5);
    for (int tried = 0; tried < 400 && static_cast<int>(loops_.size()) <= holes; ++tried) add(kind);
    if (seed / 20 % 2 == 1)
      turn(uniform(0, 2 * std::numbers::pi));  // rounding takes them out of line a little
  }
  [[nodiscard]] const std::vector<Loop>& loops() const { return loops_; }

 private:
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }

  /// Whether a square is free, with a margin; if so, it is no longer.
  bool block(double x, double y, double width, double height) {
    constexpr double margin = 1e-8;
    for (const auto& [a, b, w, h] : blocked_) {
      if (x < a + w + margin && a < x + width + margin && y < b + h + margin &&
          b < y + height + margin)
        return false;
    }
    blocked_.push_back({x, y, width, height});
    return true;
  }

  void add(int kind) {
    const bool in_line = kind == 1 || kind == 2;  // corners share coordinates with those of others
    double side = std::pow(10.0, uniform(-6, loops_.size() == 1 ? 0 : -0.5));
    double x = uniform(0, 1 - side), y = uniform(0, 1 - side);
    if (in_line) {
      side = 0.0625 * static_cast<double>(1 + random_() % 3);
      x = 0.0625 * static_cast<double>(1 + random_() % 14);
      y = 0.0625 * static_cast<double>(1 + random_() % 14);
    }
    if (kind == 4) side = std::min(side, 0.1), y = 0.5;
    if (x <= 0 || y <= 0 || x + side >= 1 || y + side >= 1 || !block(x, y, side, side)) return;
    const Vector2d centre(x + side / 2, y + side / 2);
    if (kind == 2) {
      loops_.push_back({{x, y + side / 2},
                        {x + side / 2, y + side},
                        {x + side, y + side / 2},
                        {x + side / 2, y}});
    } else if (kind == 3) {
      loops_.push_back(
          regular(centre, side / 2, 3 + static_cast<int>(random_() % 40), uniform(0, 6)));
    } else {
      loops_.push_back(hole_at(x, y, side));
    }
    std::ranges::rotate(loops_.back(),
                        loops_.back().begin() + static_cast<std::ptrdiff_t>(random_() % 3));
  }

  void turn(double angle) {
    const Eigen::Matrix2d by = Eigen::Rotation2Dd(angle).toRotationMatrix();
    for (Loop& loop : loops_) {
      for (Vector2d& p : loop) p = by * p;
    }
  }

  std::mt19937 random_;
  std::vector<Loop> loops_;
  std::vector<std::array<double, 4>> blocked_;
};

TEST(Triangulate, PlatesWithHolesAreFilled) {
  const unsigned count = testing::long_run() ? 3000 : 200;
  for (unsigned seed = 0; seed < count && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    expect_filled(Plate(seed).loops());
  }
}

TEST(Triangulate, HolesInRowsAndColumnsAreBridgedToEachOther) {
  for (const int n : {1, 2, 3, 5, 9}) {
    std::vector<Loop> loops = {{{0, 0}, {n + 1.0, 0}, {n + 1.0, n + 1.0}, {0, n + 1.0}}};
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) loops.push_back(hole_at(i + 0.75, j + 0.75, 0.5));
    }
    expect_filled(loops);
  }
}

TEST(Triangulate, ABridgeLeavesTheCopyOfACornerThatFacesIt) {
  // The three holes on the right begin at one height; all see the same corner of the first one
  // before others.
  std::vector<Loop> loops = {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, hole_at(1, 4, 2)};
  for (const double y : {3.5, 4.0, 5.0, 6.0, 6.5}) loops.push_back(hole_at(4, y, 0.25));
  expect_filled(loops);
}

TEST(Triangulate, AHoleThatTouchesTheOutlineOrAnotherHoleIsFilledAround) {
  const Loop outline = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  const Loop in_a_corner = {{0, 0}, {1, 2}, {2, 1}}, second = {{1, 2}, {1, 3}, {2, 3}};
  for (const auto& holes :
       {std::vector<Loop>{in_a_corner}, std::vector<Loop>{in_a_corner, second}}) {
    std::vector<Loop> loops = {outline};
    loops.insert(loops.end(), holes.begin(), holes.end());
    const auto triangles = triangulate(loops, {});
    ASSERT_TRUE(triangles);
    Loop points;
    for (const Loop& loop : loops) points.insert(points.end(), loop.begin(), loop.end());
    double area = 0, wanted = 0;
    for (const auto& [a, b, c] : *triangles)
      area += doubled_area(points[a], points[b], points[c]) / 2;
    for (const Loop& loop : loops) wanted += area_of_loop(loop);
    EXPECT_NEAR(area, wanted, 1e-12);
  }
}

TEST(Triangulate, FacesOfPlatesHaveTheirArea) {
  const unsigned count = testing::long_run() ? 3000 : 60;
  for (unsigned seed = 0; seed < count && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    const std::vector<Loop> loops = Plate(seed).loops();
    testing::FaceBuilder builder;
    const int plane = builder.entity("PLANE('',#" + std::to_string(builder.frame()) + ")");
    std::vector<int> bounds;
    double wanted = 0;
    for (const Loop& loop : loops) {
      std::vector<std::array<double, 3>> corners;
      for (const Vector2d& p : loop) corners.push_back({p.x(), p.y(), 0});
      bounds.push_back(builder.polygon_bound(corners));
      wanted += area_of_loop(loop);
    }
    builder.face(plane, bounds);
    const auto model = model_faces(builder.file().model());
    ASSERT_TRUE(model) << model.error().message();
    ASSERT_EQ(model->faces.size(), 1U)
        << (model->skipped.empty() ? "" : model->skipped[0].reason.message());
    EXPECT_NEAR(testing::area_of(model->faces[0]), wanted, 1e-9 * wanted);
  }
}

TEST(Orientation, IsExactWhereRoundingCannotTell) {
  // c is moved from the line through a and b by single units in the last place (Kettner et al.
  // 2008).
  const Vector2d a(12, 12), b(24, 24);
  for (int i = -3; i <= 3; ++i) {
    for (int j = -3; j <= 3; ++j) {
      const double unit = std::ldexp(1.0, -53);
      const Vector2d c(0.5 + i * unit, 0.5 + j * unit);
      const int wanted = (c.y() > c.x()) - (c.y() < c.x());
      EXPECT_EQ(orientation(a, b, c), wanted);
      EXPECT_EQ(orientation(b, c, a), wanted);
      EXPECT_EQ(orientation(b, a, c), -wanted);
    }
  }
}

}  // namespace
}  // namespace knead
