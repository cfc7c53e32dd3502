#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "exchange/format_list.hpp"
#include "exchange/length_units.hpp"
#include "surface_mesh.hpp"

namespace knead::detail {
namespace {

// glTF 2.0 (Khronos Group), binary container: a header, a chunk of JSON and a chunk of numbers.
constexpr std::uint32_t magic = 0x46546C67, version = 2, json_chunk = 0x4E4F534A,
                        binary_chunk = 0x004E4942;
constexpr int component_float = 5126, component_unsigned_int = 5125, target_vertices = 34962,
              target_indices = 34963;

using Json = nlohmann::ordered_json;

/// Metres per unit; glTF's lengths are metres. 1 if the unit is unknown.
double metres(std::string_view unit) {
  const KnownLengthUnit* known = length_unit_named(unit);
  return known != nullptr ? known->millimetres / 1000 : 1;
}

/// The chunk of numbers, and the JSON that describes it.
/// All numbers have four bytes, so that views need no padding between them.
struct Buffer {
  std::string bytes;
  Json views = Json::array(), accessors = Json::array();

  /// Ends a view that began at byte `begin`; returns the index of an accessor for all of it.
  int finish(std::size_t begin, int target, Json accessor) {
    accessor["bufferView"] = views.size();
    views.push_back({{"buffer", 0},
                     {"byteOffset", begin},
                     {"byteLength", bytes.size() - begin},
                     {"target", target}});
    accessors.push_back(std::move(accessor));
    return static_cast<int>(accessors.size()) - 1;
  }

  /// Vectors in single precision with the bounds of the numbers written, by which viewers place
  /// their camera.
  int vectors(const Points& points) {
    const std::size_t begin = bytes.size();
    for (Eigen::Index k = 0; k < points.rows(); ++k) append_point<float>(bytes, points.row(k));
    // Rounding is monotone: the bounds of the rounded numbers are the rounded bounds.
    std::array<float, 3> least, most;
    for (Eigen::Index d = 0; d < 3; ++d) {
      least[static_cast<std::size_t>(d)] = static_cast<float>(points.col(d).minCoeff());
      most[static_cast<std::size_t>(d)] = static_cast<float>(points.col(d).maxCoeff());
    }
    return finish(begin, target_vertices,
                  {{"componentType", component_float},
                   {"count", points.rows()},
                   {"type", "VEC3"},
                   {"min", least},
                   {"max", most}});
  }

  int indices(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    const std::size_t begin = bytes.size();
    for (const auto& t : triangles) {
      for (const std::uint32_t corner : t) append(bytes, corner);
    }
    return finish(begin, target_indices,
                  {{"componentType", component_unsigned_int},
                   {"count", 3 * triangles.size()},
                   {"type", "SCALAR"}});
  }
};

/// One material per colour. Colours of CAD files are taken for sRGB, which screens show; glTF's are
/// linear.
struct Materials {
  Json list = Json::array();

  std::size_t of(const std::optional<Colour>& colour) {
    const auto [found, fresh] = known_.try_emplace(colour, list.size());
    if (!fresh) return found->second;
    Json surface = {{"metallicFactor", 0}, {"roughnessFactor", 0.6}};
    std::string name = "surface";
    if (colour) {
      const auto linear = [](double c) {
        return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
      };
      surface["baseColorFactor"] = {linear((*colour)[0]), linear((*colour)[1]),
                                    linear((*colour)[2]), 1};
      name = fmt::format("colour {:.3g} {:.3g} {:.3g}", (*colour)[0], (*colour)[1], (*colour)[2]);
    }
    list.push_back({{"name", name}, {"doubleSided", true}, {"pbrMetallicRoughness", surface}});
    return found->second;
  }

 private:
  std::map<std::optional<Colour>, std::size_t> known_;
};

// Length, type and content. Lengths are multiples of four: JSON is filled up with blanks, numbers
// with zeros (glTF 2.0, binary glTF layout).
void append_chunk(std::string& to, std::uint32_t type, std::string content, char padding) {
  content.resize((content.size() + 3) / 4 * 4, padding);
  append(to, static_cast<std::uint32_t>(content.size()));
  append(to, type);
  to += content;
}

Expected<std::string> save_gltf(std::span<const NamedMesh> all, const SaveOptions& options) {
  Buffer buffer;
  Materials materials;
  Json meshes = Json::array(), nodes = Json::array(), children = Json::array();
  for (const NamedMesh& mesh : all) {
    if (mesh.triangles.empty()) continue;  // accessors must not be empty
    if (auto fits = fits_single_precision(mesh, "glTF"); !fits)
      return std::unexpected(fits.error());
    // The format requires unit vectors even at points of no triangle, as beside a pole.
    Points unit = mesh.normals;
    for (Eigen::Index k = 0; k < unit.rows(); ++k) {
      if (unit.row(k).isZero(0)) unit.row(k) << 0, 0, 1;
    }
    const int positions = buffer.vectors(mesh.points), normals = buffer.vectors(unit),
              indices = buffer.indices(mesh.triangles);
    meshes.push_back({{"name", mesh.name},
                      {"primitives",
                       {{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}},
                         {"indices", indices},
                         {"material", materials.of(mesh.colour)}}}}});
    children.push_back(meshes.size());
    nodes.push_back({{"name", mesh.name}, {"mesh", meshes.size() - 1}});
  }
  if (meshes.empty()) return numerical_error("the surfaces have no area", {}, "write STEP");
  // A parent node of the surfaces converts z up to y up and units to metres, so that coordinates
  // stay those of the file.
  const double scale = metres(options.unit);
  nodes.insert(nodes.begin(), Json{{"name", options.title},
                                   // A quaternion x, y, z, w: −90° about x, which takes z to y.
                                   {"rotation", {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}},
                                   {"scale", {scale, scale, scale}},
                                   {"children", children}});
  const Json document = {
      {"asset", {{"version", "2.0"}, {"generator", "Knead" + lengths_in(options.unit)}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", nodes},
      {"meshes", meshes},
      {"materials", materials.list},
      {"accessors", buffer.accessors},
      {"bufferViews", buffer.views},
      {"buffers", {{{"byteLength", buffer.bytes.size()}}}}};
  std::string chunks;
  append_chunk(chunks, json_chunk, document.dump(-1, ' ', false, Json::error_handler_t::replace),
               ' ');
  append_chunk(chunks, binary_chunk, std::move(buffer.bytes), '\0');
  constexpr std::size_t header = 12;
  std::string text;
  append(text, magic);
  append(text, version);
  append(text, static_cast<std::uint32_t>(header + chunks.size()));
  return text + chunks;
}

constexpr std::string_view gltf_endings[] = {".glb"};

}  // namespace

Format gltf_format() {
  return {.id = "gltf",
          .name = "glTF",
          .endings = gltf_endings,
          .media_type = "model/gltf-binary",
          .content = FormatContent::triangles,
          .holds =
              "triangles with normals at the points, binary, single precision, a mesh per surface; "
              "shown in metres",
          .save_meshes = save_gltf};
}

}  // namespace knead::detail
