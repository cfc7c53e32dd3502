// Points of meshes, and the displacements between two of them.
#include <gtest/gtest.h>

#include "exchange/field_bytes.hpp"
#include "exchange/fields/displacements.hpp"
#include "exchange/fields/mesh_points.hpp"

namespace knead {
namespace {

using namespace fields;
using namespace testing;

std::vector<Point> raised(std::vector<Point> points) {
  for (Point& p : points) p += Point(0.5 * p.y(), 0.25, p.x() * p.y());
  return points;
}

void expect_pair(const Expected<Displacements>& read, std::size_t count) {
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->points.size(), count);
  for (std::size_t k = 0; k < count; ++k)
    EXPECT_EQ(read->points[k] + read->vectors[k], raised({read->points[k]})[0]);
}

TEST(MeshPair, CornersOfStlAreJoined) {
  for (const bool first : {false, true}) {
    for (const bool second : {false, true}) {
      const auto made = [](bool text, const std::vector<Point>& corners) {
        return text ? text_stl(corners) : binary_stl(corners, "solid by a careless program");
      };
      expect_pair(mesh_pair(made(first, square), "a.stl", made(second, raised(square)), "b.stl"),
                  4);
    }
  }
}

TEST(MeshPair, ObjAndPlyAndPoints) {
  std::string
      obj = "o part\n",
      xyz,
      ply =
          "ply\nformat ascii 1.0\ncomment made\nelement vertex 4\nproperty float x\nproperty "
          "double y\n"
          "property float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Point& p : joined({"", square, {}}).points) {
    const std::string line =
        std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z());
    obj += "v " + line + "\n";
    ply += line + "\n";
    xyz += line + " 0 0 1\n";
  }
  obj += "f 1 2 3\nf -4 -3/1 -2//1 4\n";
  using Triangles = std::vector<std::array<std::uint32_t, 3>>;
  EXPECT_EQ(read_mesh_points(obj, "a.obj")->triangles,
            (Triangles{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}}));
  EXPECT_FALSE(read_mesh_points(obj + "f 1 2 5\n", "a.obj"));
  EXPECT_FALSE(read_mesh_points(obj + "f 0 1 2\n", "a.obj"));
  EXPECT_EQ(read_mesh_points(xyz, "a.xyz")->normals.size(), 4U);
  const auto to = text_stl(raised(square));
  expect_pair(mesh_pair(obj, "a.obj", to, "b.stl"), 4);
  expect_pair(mesh_pair(ply, "a.ply", to, "b.stl"), 4);
  expect_pair(mesh_pair(xyz, "a.xyz", to, "b.stl"), 4);
  const auto wrong = mesh_pair(obj, "a.obj", "0 0 0\n1 1 1\n", "b.xyz");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(
      wrong.error().message(),
      "b.xyz: it has 2 points and a.obj has 4; both must be the same mesh, with its points in "
      "the same order");
}

TEST(MeshPoints, BinaryPlyInBothByteOrders) {
  for (const bool big_endian : {false, true}) {
    std::string ply =
        "ply\nformat binary_" + std::string(big_endian ? "big" : "little") +
        "_endian 1.0\nelement camera 1\nproperty list uchar short view\nproperty "
        "float f\nelement vertex 2\nproperty double x\nproperty double y\nproperty "
        "double z\nproperty uchar red\nproperty float nx\nproperty float ny\nproperty "
        "float nz\nend_header\n";
    append_number<std::uint8_t>(ply, 2, big_endian);
    for (const std::int16_t k : {5, 6}) append_number(ply, k, big_endian);
    append_number(ply, 1.5F, big_endian);
    for (std::size_t k = 0; k < 2; ++k)
      ply += raw<double>({places[k]}, big_endian) + 'r' + raw<float>({vectors[k]}, big_endian);
    const auto read = read_mesh_points(ply, "a.ply");
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->points, places);
    EXPECT_EQ(read->normals, vectors);
    const auto cut = read_mesh_points(ply.substr(0, ply.size() - 3), "a.ply");
    ASSERT_FALSE(cut);
    EXPECT_NE(cut.error().message().find("the file ends in vertex 2 of 2"), std::string::npos)
        << cut.error().message();
  }
}

}  // namespace
}  // namespace knead
