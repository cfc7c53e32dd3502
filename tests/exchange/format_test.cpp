#include "knead/exchange/format.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <sstream>

#include "knead/spline/revolution.hpp"

namespace knead {
namespace {

struct Triangles {
  std::vector<std::array<Point, 3>> corners;
  std::vector<std::array<Point, 3>>
      normals;  // of corners; all three that of the facet where the format has one
};

template <class T>
T take(const std::string& bytes, std::size_t& at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  at += sizeof(T);
  return value;
}

Triangles read_stl(const std::string& bytes) {
  Triangles result;
  std::size_t at = 80;
  const auto count = take<std::uint32_t>(bytes, at);
  EXPECT_EQ(bytes.size(), 84 + 50 * static_cast<std::size_t>(count));
  const auto point = [&] {
    const float x = take<float>(bytes, at), y = take<float>(bytes, at), z = take<float>(bytes, at);
    return Point(x, y, z);
  };
  for (std::uint32_t k = 0; k < count; ++k) {
    const Point normal = point();
    std::array<Point, 3> corners;
    for (Point& p : corners) p = point();
    result.normals.push_back({normal, normal, normal});
    result.corners.push_back(corners);
    at += 2;
  }
  return result;
}

Triangles read_obj(const std::string& text) {
  Triangles result;
  std::vector<Point> points, normals;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream in(line);
    std::string kind;
    in >> kind;
    if (kind == "v" || kind == "vn") {
      Point p;
      in >> p.x() >> p.y() >> p.z();
      (kind == "v" ? points : normals).push_back(p);
    } else if (kind == "f") {
      std::array<Point, 3> corners, at;
      for (std::size_t k = 0; k < 3; ++k) {
        std::size_t v = 0, n = 0;
        char slash = 0;
        in >> v >> slash >> slash >> n;
        corners[k] = points.at(v - 1);
        at[k] = normals.at(n - 1);
      }
      result.corners.push_back(corners);
      result.normals.push_back(at);
    }
  }
  return result;
}

Triangles read_ply(const std::string& bytes) {
  Triangles result;
  const auto number = [&bytes](const std::string& key) {
    return std::stoul(bytes.substr(bytes.find(key) + key.size()));
  };
  const std::size_t vertices = number("element vertex "), faces = number("element face ");
  std::size_t at = bytes.find("end_header\n") + 11;
  std::vector<Point> points, normals;
  for (std::size_t k = 0; k < vertices; ++k) {
    const double x = take<double>(bytes, at), y = take<double>(bytes, at),
                 z = take<double>(bytes, at);
    const float a = take<float>(bytes, at), b = take<float>(bytes, at), c = take<float>(bytes, at);
    points.emplace_back(x, y, z);
    normals.emplace_back(a, b, c);
  }
  for (std::size_t k = 0; k < faces; ++k) {
    EXPECT_EQ(take<std::uint8_t>(bytes, at), 3);
    std::array<Point, 3> corners, of;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto v = take<std::uint32_t>(bytes, at);
      corners[c] = points.at(v);
      of[c] = normals.at(v);
    }
    result.corners.push_back(corners);
    result.normals.push_back(of);
  }
  EXPECT_EQ(at, bytes.size());
  return result;
}

Triangles read(const std::string& bytes, const std::string& format) {
  return format == "stl" ? read_stl(bytes) : format == "obj" ? read_obj(bytes) : read_ply(bytes);
}

Expected<std::string> mesh_file(std::span<const NamedSurface> surfaces, const std::string& format,
                                const SaveOptions& options = {}) {
  return save_surfaces(surfaces, *find_format(format), options);
}

std::vector<NamedSurface> sphere_and_torus() {
  return {{"a ball", *revolve(*circle_quarters({0, 0}, 2, -1, 2))},
          {"ring", *revolve(*circle_quarters({10, 0}, 1, 0, 4))}};
}

TEST(MeshWriter, MeshesLieOnTheirSurfacesAndLookOutward) {
  const auto surfaces = sphere_and_torus();
  for (const std::string format : {"stl", "obj", "ply"}) {
    const auto bytes = mesh_file(surfaces, format, {.detail = 40, .unit = "mm"});
    ASSERT_TRUE(bytes) << bytes.error().message();
    const Triangles mesh = read(*bytes, format);
    const double tolerance = format == "stl" ? 1e-6 : 1e-14;
    double volume = 0;
    for (std::size_t k = 0; k < mesh.corners.size(); ++k) {
      const auto& [a, b, c] = mesh.corners[k];
      volume += a.dot(b.cross(c)) / 6;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const Point& p = mesh.corners[k][corner];
        const bool ball = p.norm() < 5;
        const Point centre =
            ball ? Point(0, 0, 0) : Point(Point(p.x(), p.y(), 0).normalized() * 10);
        EXPECT_NEAR((p - centre).norm(), ball ? 2 : 1, tolerance * 11);
        const Point& normal = mesh.normals[k][corner];
        EXPECT_NEAR(normal.norm(), 1, 1e-5);
        // A facet's normal is the surface's up to half the angle between grid lines; a vertex'
        // normal is printed to six digits, so that its length is 1 to 5e-7.
        const bool facet = format == "stl", pole = std::hypot(p.x(), p.y()) < 1e-6;
        EXPECT_GT(normal.dot((p - centre).normalized()), facet ? 0.98 : pole ? 0.99 : 1 - 1e-6);
      }
    }
    // The volumes of both, less what chords leave out: near (2π/40)²/6 for the ball, both ways
    // round for the ring.
    const double exact =
        4 * std::numbers::pi / 3 * 8 + 2 * std::numbers::pi * std::numbers::pi * 10;
    EXPECT_LT(volume, exact);
    EXPECT_GT(volume, exact * (1 - 0.02));
  }
}

TEST(MeshWriter, PolesGiveNoTrianglesWithoutArea) {
  const std::vector<NamedSurface> ball = {sphere_and_torus().front()};
  const Triangles mesh = read_ply(*mesh_file(ball, "ply", {.detail = 16}));
  // 16 by 16 quads, of which those at the poles are one triangle.
  EXPECT_EQ(mesh.corners.size(), 2U * 16 * 16 - 2U * 16);
  for (const auto& [a, b, c] : mesh.corners) EXPECT_GT((b - a).cross(c - a).norm(), 1e-3);
}

TEST(MeshWriter, EveryKnotLineIsALineOfTheGrid) {
  const auto knots = *KnotVector::create(2, {0, 0, 0, 0.1, 0.7, 1, 1, 1});
  Points points(25, 3);
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) points.row(5 * i + j) << knots.greville(i), knots.greville(j), 0;
  }
  const std::vector<NamedSurface> sheet = {{"", *Surface::create({knots, knots}, points)}};
  std::set<double> lines;  // to rounding
  for (const auto& corners : read_obj(*mesh_file(sheet, "obj", {.detail = 3})).corners) {
    for (const Point& p : corners) lines.insert(std::round(p.x() * 1e12) / 1e12);
  }
  EXPECT_EQ(lines.size(), 7U) << "two pieces in each of three spans";
  for (const double knot : {0.0, 0.1, 0.7, 1.0}) {
    EXPECT_TRUE(lines.contains(knot)) << knot;
  }
}

TEST(MeshWriter, ObjectsHaveNamesWithoutSpaces) {
  const auto text = *mesh_file(sphere_and_torus(), "obj", {.detail = 8, .unit = "inch"});
  EXPECT_NE(text.find("o a_ball\n"), std::string::npos);
  EXPECT_NE(text.find("o ring\n"), std::string::npos);
  EXPECT_NE(text.find("lengths in inch\n"), std::string::npos);
}

TEST(Format, IsKnownByTheEndingOfAName) {
  const auto id = [](const char* name) {
    const auto format = format_of_name(name, FormatContent::triangles);
    return format ? std::string((*format)->id) : "none";
  };
  EXPECT_EQ(id("a.b/c.STL"), "stl");
  EXPECT_EQ(id("x.obj"), "obj");
  EXPECT_EQ(id("x.stl.Ply"), "ply");
  EXPECT_EQ(id("x.glb"), "gltf");
  for (const char* name : {"", "stl", "x.step", "x.stl.gz"}) EXPECT_EQ(id(name), "none") << name;
  EXPECT_EQ((*format_of_name("x.STP", FormatContent::surfaces))->id, "step");
  EXPECT_EQ(format_of_name("x.3mf", FormatContent::triangles).error().remedy,
            "use a name that ends in .stl, .obj, .ply or .glb");
}

TEST(Format, IsKnownByTheContentWhateverTheName) {
  const std::vector<NamedSurface> ball = {sphere_and_torus().front()};
  const auto bytes = save_surfaces(ball, *find_format("step"), {.unit = "mm", .title = "ball"});
  ASSERT_TRUE(bytes) << bytes.error().message();
  const auto source = open_source(*bytes, "ball.txt");
  ASSERT_TRUE(source) << source.error().message();
  ASSERT_EQ((*source)->surfaces().size(), 1U);
  EXPECT_EQ((*source)->surfaces()[0].name, "a ball");
  EXPECT_EQ((*source)->surfaces()[0].unit, "mm");
  const std::vector<std::shared_ptr<const Surface>> same = {(*source)->surfaces()[0].surface};
  EXPECT_EQ(*(*source)->save(same), *bytes);
}

TEST(Format, ThatNothingRecognisesIsAnErrorWithTheFormats) {
  const auto source = open_source("solid ball", "ball.stl");
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().file, "ball.stl");
  EXPECT_TRUE(source.error().remedy.starts_with(
      "open STEP (.step, .stp, .p21), IGES (.igs, .iges), Open CASCADE (.brep, .brp)"));
  // The ending names the reader that says what is wrong.
  EXPECT_NE(open_source("solid ball", "ball.step").error().message().find("ball.step:1"),
            std::string::npos);
}

TEST(Format, TableOfTheDocsIsThatOfTheList) {
  std::ifstream page(KNEAD_SOURCE_DIR "/docs/formats.md");
  const std::string text((std::istreambuf_iterator<char>(page)), {});
  EXPECT_NE(text.find(format_table()), std::string::npos)
      << "docs/formats.md should have this table:\n"
      << format_table();
}

TEST(Format, JsonHasOneObjectPerFormat) {
  const auto list = nlohmann::json::parse(format_json());
  ASSERT_EQ(list.size(), formats().size());
  for (std::size_t k = 0; k < list.size(); ++k) {
    EXPECT_EQ(list[k].at("id"), formats()[k].id);
    EXPECT_EQ(list[k].at("opens"), formats()[k].open != nullptr);
  }
}

TEST(MeshWriter, StlHasNoTrianglesThatSinglePrecisionCollapses) {
  // A ring as thin as a thousandth, of radius 1e6: points around the tube are one in single
  // precision.
  const std::vector<NamedSurface> far = {
      {"far", *revolve(*circle_quarters({1e6, 1e6}, 1e-3, -1, 2))}};
  const auto bytes = mesh_file(far, "stl", {.detail = 12});
  ASSERT_TRUE(bytes) << bytes.error().message();
  for (const auto& corners : read_stl(*bytes).corners) {
    EXPECT_NE(corners[0], corners[1]);
    EXPECT_NE(corners[1], corners[2]);
    EXPECT_NE(corners[2], corners[0]);
  }
  EXPECT_LT(read_stl(*bytes).corners.size(),
            read_obj(*mesh_file(far, "obj", {.detail = 12})).corners.size());
}

TEST(MeshWriter, RefusesWhatItCannotWrite) {
  EXPECT_NE(mesh_file({}, "stl").error().message().find("no surface"), std::string::npos);
  const auto surfaces = sphere_and_torus();
  for (const int detail : {0, -3, 2001})
    EXPECT_EQ(mesh_file(surfaces, "obj", {.detail = detail}).error().where, "detail");
  const std::vector<NamedSurface> huge = {
      {"huge", *revolve(*circle_quarters({0, 0}, 1e39, -1, 2))}};
  EXPECT_NE(mesh_file(huge, "stl").error().message().find("too large for STL"), std::string::npos);
  EXPECT_TRUE(mesh_file(huge, "ply"));
}

}  // namespace
}  // namespace knead
