#include "studio_context.hpp"

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "knead/exchange/context_faces.hpp"

namespace knead::studio {
namespace {

template <class T>
void append(std::string& to, const std::vector<T>& from) {
  to.append(reinterpret_cast<const char*>(from.data()), from.size() * sizeof(T));
}

}  // namespace

std::string context_bytes(const step::File& file, const Point& origin) {
  ContextFaces context;
  if (auto faces = context_faces(file)) context = *std::move(faces);
  std::vector<float> positions, normals;
  std::vector<std::uint32_t> indices;
  for (const FaceMesh& mesh : context.faces) {
    const auto first = static_cast<std::uint32_t>(positions.size() / 3);
    for (std::size_t k = 0; k < mesh.points.size(); ++k) {
      for (int d = 0; d < 3; ++d) {
        positions.push_back(static_cast<float>(mesh.points[k][d] - origin[d]));
        normals.push_back(static_cast<float>(mesh.normals[k][d]));
      }
    }
    for (const auto& triangle : mesh.triangles) {
      for (const auto k : triangle) indices.push_back(first + k);
    }
  }
  const std::vector<std::uint32_t> counts = {static_cast<std::uint32_t>(positions.size() / 3),
                                             static_cast<std::uint32_t>(indices.size() / 3)};
  std::string bytes;
  append(bytes, counts);
  append(bytes, positions);
  append(bytes, normals);
  append(bytes, indices);
  auto skipped = nlohmann::json::array();
  for (const SkippedFace& face : context.skipped) skipped.push_back({{"id", face.id}, {"reason", face.reason.what}});
  return bytes + skipped.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string trim_json(const SurfaceTrim& trim) {
  if (trim.whole) return "null";
  auto faces = nlohmann::json::array();
  for (const TrimFace& face : trim.faces) {
    auto loops = nlohmann::json::array();
    for (const TrimLoop& loop : face) {
      auto numbers = nlohmann::json::array();
      for (const auto& p : loop) {
        // A millionth of the domain is less than a pixel of any picture.
        numbers.push_back(std::round(p.x() * 1e6) / 1e6);
        numbers.push_back(std::round(p.y() * 1e6) / 1e6);
      }
      loops.push_back(std::move(numbers));
    }
    faces.push_back(std::move(loops));
  }
  return nlohmann::json{{"faces", std::move(faces)}}.dump();
}

}  // namespace knead::studio
