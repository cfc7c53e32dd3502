#include "knead/exchange/mesh_writer.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "knead/spline/evaluate.hpp"
#include "knead/spline/grid_lines.hpp"

namespace knead {
namespace {

constexpr double sliver = 1e-12;     // |cross product| over the longest side squared: less is no triangle
constexpr double degenerate = 1e-9;  // |S_u × S_v| over |S_u|² + |S_v|²

struct Mesh {
  std::string name;
  Points points, normals;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

Point facet(const Points& points, const std::array<std::uint32_t, 3>& t) {
  const Point a = points.row(t[0]), b = points.row(t[1]), c = points.row(t[2]);
  return (b - a).cross(c - a);
}

bool is_triangle(const Points& points, const std::array<std::uint32_t, 3>& t) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    longest = std::max(longest, (points.row(t[k]) - points.row(t[(k + 1) % 3])).squaredNorm());
  }
  return facet(points, t).norm() > sliver * longest;
}

Expected<Mesh> mesh_of(const MeshSurface& item, int detail) {
  const GridLines u = grid_lines(item.surface.knots(0), detail), v = grid_lines(item.surface.knots(1), detail);
  const std::array<std::span<const double>, 2> grid = {u.parameters, v.parameters};
  auto jet = evaluate_grid<2>(item.surface, grid, 1);
  if (!jet) return std::unexpected(jet.error().within(item.name));
  Mesh mesh{item.name, jet->points(), Points::Zero(jet->points().rows(), 3), {}};
  const auto rows = static_cast<std::uint32_t>(u.parameters.size()),
             columns = static_cast<std::uint32_t>(v.parameters.size());
  for (std::uint32_t k = 0; k + 1 < rows; ++k) {
    for (std::uint32_t l = 0; l + 1 < columns; ++l) {
      const std::uint32_t a = k * columns + l, b = a + columns;
      for (const std::array<std::uint32_t, 3>& t : {std::array{a, b, b + 1}, std::array{a, b + 1, a + 1}}) {
        if (is_triangle(mesh.points, t)) mesh.triangles.push_back(t);
      }
    }
  }
  std::vector<bool> vanishes(static_cast<std::size_t>(mesh.points.rows()));
  for (Eigen::Index k = 0; k < mesh.points.rows(); ++k) {
    const Point a = jet->at({1, 0}).row(k), b = jet->at({0, 1}).row(k), normal = a.cross(b);
    const double length = normal.norm();
    if (length > degenerate * (a.squaredNorm() + b.squaredNorm())) {
      mesh.normals.row(k) = normal.transpose() / length;
    } else {
      vanishes[static_cast<std::size_t>(k)] = true;
    }
  }
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t corner : t) {
      if (vanishes[corner]) mesh.normals.row(corner) += facet(mesh.points, t).normalized().transpose();
    }
  }
  for (Eigen::Index k = 0; k < mesh.points.rows(); ++k) {
    if (const double length = mesh.normals.row(k).norm(); length > 0) mesh.normals.row(k) /= length;
  }
  return mesh;
}

/// Numbers as the formats have them, little endian.
template <class T>
void append(std::string& to, T value) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(bytes);
  to.append(bytes.data(), bytes.size());
}

template <class T, class Row>
void append_point(std::string& to, const Row& point) {
  for (Eigen::Index d = 0; d < 3; ++d) append(to, static_cast<T>(point[d]));
}

Expected<std::string> stl(const std::vector<Mesh>& meshes, std::size_t triangles, const std::string& unit) {
  constexpr std::size_t header = 80;
  std::string text = "Knead" + (unit.empty() ? "" : ", lengths in " + unit);
  text.resize(header, ' ');
  append(text, static_cast<std::uint32_t>(triangles));
  for (const Mesh& mesh : meshes) {
    if (mesh.points.size() > 0 && !(mesh.points.cwiseAbs().maxCoeff() <= std::numeric_limits<float>::max())) {
      return numerical_error("a coordinate is too large for STL", mesh.name, "write OBJ or PLY");
    }
    for (const auto& t : mesh.triangles) {
      append_point<float>(text, facet(mesh.points, t).normalized());
      for (const std::uint32_t corner : t) append_point<float>(text, mesh.points.row(corner));
      append(text, std::uint16_t{0});
    }
  }
  return text;
}

std::string obj(const std::vector<Mesh>& meshes, const std::string& unit) {
  std::string text = "# Knead" + (unit.empty() ? "" : ", lengths in " + unit) + "\n";
  auto out = std::back_inserter(text);
  std::size_t first = 1;
  for (const Mesh& mesh : meshes) {
    std::string name = mesh.name;
    std::ranges::replace_if(
        name, [](char c) { return static_cast<unsigned char>(c) <= ' '; }, '_');
    fmt::format_to(out, "o {}\n", name.empty() ? "surface" : name);
    for (Eigen::Index k = 0; k < mesh.points.rows(); ++k) {
      fmt::format_to(out, "v {} {} {}\n", mesh.points(k, 0), mesh.points(k, 1), mesh.points(k, 2));
    }
    for (Eigen::Index k = 0; k < mesh.normals.rows(); ++k) {
      fmt::format_to(out, "vn {:.6g} {:.6g} {:.6g}\n", mesh.normals(k, 0), mesh.normals(k, 1), mesh.normals(k, 2));
    }
    for (const auto& t : mesh.triangles) {
      fmt::format_to(out, "f {0}//{0} {1}//{1} {2}//{2}\n", first + t[0], first + t[1], first + t[2]);
    }
    first += static_cast<std::size_t>(mesh.points.rows());
  }
  return text;
}

std::string ply(const std::vector<Mesh>& meshes, std::size_t triangles, const std::string& unit) {
  Eigen::Index vertices = 0;
  for (const Mesh& mesh : meshes) vertices += mesh.points.rows();
  std::string text = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment Knead{}\nelement vertex {}\nproperty double x\nproperty double y\n"
      "property double z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face {}\n"
      "property list uchar uint vertex_indices\nend_header\n",
      unit.empty() ? "" : ", lengths in " + unit, vertices, triangles);
  for (const Mesh& mesh : meshes) {
    for (Eigen::Index k = 0; k < mesh.points.rows(); ++k) {
      append_point<double>(text, mesh.points.row(k));
      append_point<float>(text, mesh.normals.row(k));
    }
  }
  std::uint32_t first = 0;
  for (const Mesh& mesh : meshes) {
    for (const auto& t : mesh.triangles) {
      text.push_back(3);
      for (const std::uint32_t corner : t) append(text, first + corner);
    }
    first += static_cast<std::uint32_t>(mesh.points.rows());
  }
  return text;
}

}  // namespace

Expected<MeshFormat> mesh_format(std::string_view file_name) {
  const auto dot = file_name.rfind('.');
  std::string ending(dot == std::string_view::npos ? "" : file_name.substr(dot));
  for (char& c : ending) c = 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (ending == ".stl") return MeshFormat::stl;
  if (ending == ".obj") return MeshFormat::obj;
  if (ending == ".ply") return MeshFormat::ply;
  return input_error(fmt::format("\"{}\" is not a mesh file", file_name), {},
                     "use a name that ends in .stl, .obj or .ply");
}

Expected<std::string> mesh_file(std::span<const MeshSurface> surfaces, MeshFormat format, const MeshOptions& options) {
  constexpr int most_detail = 2000;
  if (surfaces.empty()) return input_error("there is no surface to write", {}, "open a file, or make a surface");
  if (options.detail < 1 || options.detail > most_detail) {
    return input_error(fmt::format("{} is not a detail", options.detail), "detail",
                       fmt::format("use a number from 1 to {}", most_detail));
  }
  std::vector<Mesh> meshes;
  std::size_t triangles = 0, vertices = 0;
  for (const MeshSurface& surface : surfaces) {
    auto mesh = mesh_of(surface, options.detail);
    if (!mesh) return std::unexpected(mesh.error());
    triangles += mesh->triangles.size();
    vertices += static_cast<std::size_t>(mesh->points.rows());
    meshes.push_back(std::move(*mesh));
  }
  if (std::max(triangles, vertices) > std::numeric_limits<std::int32_t>::max()) {
    return input_error("the mesh has more than 2^31 triangles", "detail", "use a smaller one");
  }
  switch (format) {
    case MeshFormat::stl:
      return stl(meshes, triangles, options.unit);
    case MeshFormat::obj:
      return obj(meshes, options.unit);
    case MeshFormat::ply:
      break;
  }
  return ply(meshes, triangles, options.unit);
}

}  // namespace knead
