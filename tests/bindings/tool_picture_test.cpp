#include "tool_picture.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace knead::studio {
namespace {

Shape saddle() {
  Points points(16, 3);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) points.row(4 * i + j) << i, j, 0.3 * (i - 1.5) * (j - 1.5);
  }
  const KnotVector knots = *KnotVector::create(3, {0, 0, 0, 0, 1, 1, 1, 1});
  return SplineShape{std::make_shared<const Surface>(*Surface::create({knots, knots}, points))};
}

struct Case {
  const char* name;
  Shape shape;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"sphere", SphereShape{2}},
      {"ellipsoid", EllipsoidShape{{1, 2, 3}}},
      {"box", BoxShape{{1, 2, 3}, 0}},
      {"rounded box", BoxShape{{1, 2, 3}, 0.4}},
      {"ball of a box", BoxShape{{1, 1, 1}, 1}},
      {"cylinder", CylinderShape{1, 2}},
      {"cone", ConeShape{2, 3, 0}},
      {"frustum", ConeShape{2, 3, 0.5}},
      {"capsule", CapsuleShape{1, 2}},
      {"torus", TorusShape{2, 0.5}},
      {"bowl", BowlShape{2, 0.3}},
      {"superellipsoid", SuperellipsoidShape{{1, 2, 1.5}, 0.3, 1.5}},
      {"supertoroid", SupertoroidShape{2, {0.5, 0.3}, 0.5, 1.2}},
      {"surface", saddle()}};
  return all;
}

Point point(const std::vector<float>& of, std::size_t k) {
  return {of[3 * k], of[3 * k + 1], of[3 * k + 2]};
}

double extent(const ToolPicture& p) {
  double most = 0;
  for (const float x : p.positions) most = std::max(most, std::abs(static_cast<double>(x)));
  return most;
}

class PictureOfAShape : public testing::TestWithParam<Case> {};

TEST_P(PictureOfAShape, LiesOnTheShape) {
  const auto shape = PlacedShape::create(GetParam().shape);
  const ToolPicture p = tool_picture(GetParam().shape);
  ASSERT_GT(p.indices.size(), 30u);
  ASSERT_EQ(p.positions.size(), p.normals.size());
  for (std::size_t k = 0; 3 * k < p.positions.size(); ++k) {
    EXPECT_NEAR(shape->nearest(point(p.positions, k)).distance, 0, 2e-6 * extent(p))
        << "point " << k;
    EXPECT_NEAR(point(p.normals, k).norm(), 1, 1e-5);
  }
}

TEST_P(PictureOfAShape, LooksOutwards) {
  const auto shape = PlacedShape::create(GetParam().shape);
  const ToolPicture p = tool_picture(GetParam().shape);
  const double step = 1e-3 * extent(p);
  int inwards = 0;
  for (std::size_t k = 0; k < p.indices.size(); k += 3) {
    std::array<Point, 3> corner, normal;
    for (std::size_t c = 0; c < 3; ++c) {
      corner[c] = point(p.positions, p.indices[k + c]);
      normal[c] = point(p.normals, p.indices[k + c]);
    }
    const Point area = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    if (area.norm() < 1e-5 * extent(p) * extent(p))
      continue;  // single precision has no direction of it
    const Point middle = (corner[0] + corner[1] + corner[2]) / 3, out = area.normalized();
    const Nearest at = shape->nearest(middle);
    EXPECT_GT(shape->nearest(at.point + step * out).distance, 0) << "triangle " << k / 3;
    if (out.dot(normal[0] + normal[1] + normal[2]) <= 0) ++inwards;
  }
  EXPECT_EQ(inwards, 0);
}

TEST_P(PictureOfAShape, HasNoHoles) {
  const ToolPicture p = tool_picture(GetParam().shape);
  if (std::holds_alternative<SplineShape>(GetParam().shape)) GTEST_SKIP() << "its border is open";
  // Every edge between two places is passed as often one way as the other.
  std::map<std::array<float, 6>, int> passed;
  const auto edge = [&](std::uint32_t a, std::uint32_t b) {
    const auto at = [&](std::uint32_t k, int d) {
      return std::round(p.positions[3 * k + static_cast<std::size_t>(d)] * 1e5F) + 0.0F;
    };
    ++passed[{at(a, 0), at(a, 1), at(a, 2), at(b, 0), at(b, 1), at(b, 2)}];
  };
  for (std::size_t k = 0; k < p.indices.size(); k += 3) {
    for (std::size_t c = 0; c < 3; ++c) edge(p.indices[k + c], p.indices[k + (c + 1) % 3]);
  }
  int open = 0;
  for (const auto& [e, times] : passed) {
    const auto back = passed.find({e[3], e[4], e[5], e[0], e[1], e[2]});
    if (back == passed.end() || back->second != times) ++open;
  }
  EXPECT_EQ(open, 0);
}

TEST_P(PictureOfAShape, IsDrawnFromItsDistancesAlone) {
  const auto shape = PlacedShape::create(GetParam().shape);
  const ToolPicture p = from_distances(*shape, 24);
  if (std::holds_alternative<SplineShape>(GetParam().shape))
    GTEST_SKIP() << "an open sheet has no inside";
  ASSERT_GT(p.indices.size(), 100u);
  int inwards = 0;
  for (std::size_t k = 0; 3 * k < p.positions.size(); ++k) {
    EXPECT_NEAR(shape->nearest(point(p.positions, k)).distance, 0, 2e-6 * extent(p));
  }
  for (std::size_t k = 0; k < p.indices.size(); k += 3) {
    const Point a = point(p.positions, p.indices[k]), b = point(p.positions, p.indices[k + 1]),
                c = point(p.positions, p.indices[k + 2]);
    const Point normals = point(p.normals, p.indices[k]) + point(p.normals, p.indices[k + 1]) +
                          point(p.normals, p.indices[k + 2]);
    if ((b - a).cross(c - a).dot(normals) < 0) ++inwards;
  }
  // Where the shape is finer than a cell a few fold over.
  EXPECT_LT(inwards, 0.02 * static_cast<double>(p.indices.size()) / 3);
}

INSTANTIATE_TEST_SUITE_P(Every, PictureOfAShape, testing::ValuesIn(cases()), [](const auto& of) {
  std::string name = of.param.name;
  std::ranges::replace(name, ' ', '_');
  return name;
});

TEST(ToolPicture, OfAPlaneIsASquareThatStandsForAllOfIt) {
  const ToolPicture p = tool_picture(PlaneShape{});
  EXPECT_TRUE(p.unbounded && p.open);
  EXPECT_EQ(p.positions,
            (std::vector<float>{-0.5F, -0.5F, 0, 0.5F, -0.5F, 0, -0.5F, 0.5F, 0, 0.5F, 0.5F, 0}));
  EXPECT_EQ(p.indices, (std::vector<std::uint32_t>{0, 1, 3, 0, 3, 2}));
  EXPECT_TRUE(from_distances(*PlacedShape::create(PlaneShape{})).indices.empty());
}

TEST(ToolPicture, OfAnOpenShapeIsSeenFromBothSides) {
  EXPECT_TRUE(tool_picture(BowlShape{}).open);
  EXPECT_TRUE(tool_picture(saddle()).open);
  EXPECT_FALSE(tool_picture(BoxShape{}).open);
}

}  // namespace
}  // namespace knead::studio
