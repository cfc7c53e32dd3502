#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "knead/exchange/format.hpp"
#include "knead/spline/revolution.hpp"

namespace knead {
namespace {

using Json = nlohmann::json;

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

/// A binary glTF, taken apart by the rules of the specification.
struct Container {
  Json document;
  std::string numbers;

  explicit Container(const std::string& bytes) {
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(number_at<std::uint32_t>(bytes, 4), 2U);
    EXPECT_EQ(number_at<std::uint32_t>(bytes, 8), bytes.size());
    const auto json = number_at<std::uint32_t>(bytes, 12);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    EXPECT_EQ(json % 4, 0U);
    document = Json::parse(bytes.substr(20, json));
    const auto binary = number_at<std::uint32_t>(bytes, 20 + json);
    EXPECT_EQ(bytes.substr(24 + json, 4), std::string("BIN\0", 4));
    EXPECT_EQ(binary % 4, 0U);
    EXPECT_EQ(28 + json + binary, bytes.size());
    numbers = bytes.substr(28 + json);
    EXPECT_EQ(document["buffers"][0]["byteLength"], binary);
  }

  /// The bytes of an accessor; checks that it fits its view, and the view its buffer.
  [[nodiscard]] std::string bytes_of(int accessor, std::size_t element) const {
    const Json& a = document["accessors"][static_cast<std::size_t>(accessor)];
    const Json& view = document["bufferViews"][a["bufferView"].get<std::size_t>()];
    const auto offset = view["byteOffset"].get<std::size_t>(),
               length = view["byteLength"].get<std::size_t>();
    EXPECT_EQ(offset % 4, 0U);
    EXPECT_EQ(a["count"].get<std::size_t>() * element, length);
    EXPECT_LE(offset + length, numbers.size());
    return numbers.substr(offset, length);
  }
  [[nodiscard]] std::vector<Eigen::Vector3f> vectors(int accessor) const {
    const Json& a = document["accessors"][static_cast<std::size_t>(accessor)];
    EXPECT_EQ(a["type"], "VEC3");
    EXPECT_EQ(a["componentType"], 5126);
    const std::string bytes = bytes_of(accessor, 12);
    std::vector<Eigen::Vector3f> result;
    for (std::size_t at = 0; at < bytes.size(); at += 12) {
      result.emplace_back(number_at<float>(bytes, at), number_at<float>(bytes, at + 4),
                          number_at<float>(bytes, at + 8));
    }
    return result;
  }
  [[nodiscard]] std::vector<std::uint32_t> indices(int accessor) const {
    const Json& a = document["accessors"][static_cast<std::size_t>(accessor)];
    EXPECT_EQ(a["type"], "SCALAR");
    EXPECT_EQ(a["componentType"], 5125);
    const std::string bytes = bytes_of(accessor, 4);
    std::vector<std::uint32_t> result;
    for (std::size_t at = 0; at < bytes.size(); at += 4)
      result.push_back(number_at<std::uint32_t>(bytes, at));
    return result;
  }
};

std::vector<NamedSurface> ball_and_ring() {
  return {{"a ball", *revolve(*circle_quarters({0, 0}, 2, -1, 2))},
          {"ring", *revolve(*circle_quarters({10, 0}, 1, 0, 4))}};
}

std::string file_of(const char* format, const std::string& unit) {
  const auto bytes = save_surfaces(ball_and_ring(), *find_format(format),
                                   {.detail = 24, .unit = unit, .title = "both"});
  EXPECT_TRUE(bytes) << bytes.error().message();
  return bytes.value_or("");
}

/// The areas of the triangles of each object of an OBJ file, in order.
std::vector<std::vector<double>> areas_of_obj(const std::string& text) {
  std::vector<std::vector<double>> areas;
  std::vector<Point> points;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream in(line);
    std::string kind;
    in >> kind;
    if (kind == "o") areas.emplace_back();
    if (kind == "v") {
      Point p;
      in >> p.x() >> p.y() >> p.z();
      points.push_back(p);
    }
    if (kind == "f") {
      std::array<Point, 3> corner;
      for (Point& c : corner) {
        std::string reference;
        in >> reference;
        c = points.at(std::stoul(reference) - 1);
      }
      areas.back().push_back((corner[1] - corner[0]).cross(corner[2] - corner[0]).norm() / 2);
    }
  }
  return areas;
}

TEST(Gltf, HasAMeshPerSurfaceWithTheTrianglesOfTheObjFile) {
  const Container file(file_of("gltf", "mm"));
  const auto expected = areas_of_obj(file_of("obj", "mm"));
  EXPECT_EQ(file.document["asset"]["version"], "2.0");
  ASSERT_EQ(file.document["meshes"].size(), 2U);
  EXPECT_EQ(file.document["meshes"][0]["name"], "a ball");
  EXPECT_EQ(file.document["meshes"][1]["name"], "ring");
  for (std::size_t m = 0; m < 2; ++m) {
    const Json& primitive = file.document["meshes"][m]["primitives"][0];
    const auto points = file.vectors(primitive["attributes"]["POSITION"]);
    const auto normals = file.vectors(primitive["attributes"]["NORMAL"]);
    const auto indices = file.indices(primitive["indices"]);
    EXPECT_EQ(points.size(), normals.size());
    for (const auto& n : normals) EXPECT_NEAR(n.norm(), 1, 1e-6);
    ASSERT_EQ(indices.size(), 3 * expected[m].size());
    for (std::size_t t = 0; t < expected[m].size(); ++t) {
      std::array<Point, 3> c;
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_LT(indices[3 * t + k], points.size());
        c[k] = points[indices[3 * t + k]].cast<double>();
      }
      // Coordinates up to 11 in single precision: 5e-7 each, on sides of up to 3.
      EXPECT_NEAR((c[1] - c[0]).cross(c[2] - c[0]).norm() / 2, expected[m][t], 1e-5);
      EXPECT_GT((c[1] - c[0]).cross(c[2] - c[0]).dot(normals[indices[3 * t]].cast<double>()), 0);
    }
  }
}

TEST(Gltf, BoundsAreExactlyThoseOfTheNumbersInTheFile) {
  const Container file(file_of("gltf", "mm"));
  for (const Json& mesh : file.document["meshes"]) {
    for (const char* name : {"POSITION", "NORMAL"}) {
      const int accessor = mesh["primitives"][0]["attributes"][name];
      Eigen::Vector3f least = Eigen::Vector3f::Constant(1e30F), most = -least;
      for (const auto& p : file.vectors(accessor)) {
        least = least.cwiseMin(p);
        most = most.cwiseMax(p);
      }
      const Json& a = file.document["accessors"][static_cast<std::size_t>(accessor)];
      for (int d = 0; d < 3; ++d) {
        EXPECT_EQ(a["min"][static_cast<std::size_t>(d)].get<float>(), least[d]);
        EXPECT_EQ(a["max"][static_cast<std::size_t>(d)].get<float>(), most[d]);
      }
    }
  }
}

TEST(Gltf, RootTurnsZUpIntoYUpAndUnitsIntoMetres) {
  for (const auto& [unit, metres] :
       {std::pair("mm", 1e-3), std::pair("inch", 0.0254), std::pair("", 1.0)}) {
    const Container file(file_of("gltf", unit));
    const Json& root =
        file.document["nodes"][file.document["scenes"][0]["nodes"][0].get<std::size_t>()];
    EXPECT_EQ(root["name"], "both");
    ASSERT_EQ(root["children"].size(), 2U);
    for (const Json& child : root["children"]) {
      EXPECT_TRUE(file.document["nodes"][child.get<std::size_t>()].contains("mesh"));
    }
    const Json& r = root["rotation"];
    const Eigen::Quaterniond turn(r[3].get<double>(), r[0].get<double>(), r[1].get<double>(),
                                  r[2].get<double>());
    EXPECT_LT((turn * Point::UnitZ() - Point::UnitY()).norm(), 1e-15);
    EXPECT_LT((turn * Point::UnitX() - Point::UnitX()).norm(), 1e-15);
    for (int d = 0; d < 3; ++d) EXPECT_EQ(root["scale"][static_cast<std::size_t>(d)], metres);
  }
}

}  // namespace
}  // namespace knead
