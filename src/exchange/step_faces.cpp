#include "step_faces.hpp"

#include <array>
#include <string_view>
#include <unordered_map>

namespace knead::step {
namespace {

constexpr std::array<std::string_view, 3> face_kinds = {"ADVANCED_FACE", "FACE_SURFACE", "FACE"};

}  // namespace

std::optional<std::uint32_t> untrimmed(const Reader& reader, std::optional<std::uint32_t> surface) {
  constexpr int max_shell_nesting = 4;
  for (int depth = 0; depth < max_shell_nesting && surface; ++depth) {
    const char* cut = reader.is(*surface, "RECTANGULAR_TRIMMED_SURFACE") ? "RECTANGULAR_TRIMMED_SURFACE"
                      : reader.is(*surface, "CURVE_BOUNDED_SURFACE")     ? "CURVE_BOUNDED_SURFACE"
                                                                         : nullptr;
    if (cut == nullptr) break;
    const auto basis = reader.attributes(*surface, cut, 1, 1);
    surface = basis.empty() ? std::nullopt : reader.reference(basis[0]);
  }
  return surface;
}

std::vector<Face> read_faces(const Reader& reader) {
  std::vector<Face> result;
  for (const auto k : reader.file().named(face_kinds)) {
    const bool has_surface = reader.is(k, "ADVANCED_FACE") || reader.is(k, "FACE_SURFACE");
    const auto bounds = reader.attributes(k, "FACE", 1, 1);
    if (bounds.empty()) continue;
    Face face{k, bounds[0]};
    if (has_surface) {
      const auto own = reader.attributes(k, "FACE_SURFACE", 2, 2);
      const auto target = untrimmed(reader, own.empty() ? std::nullopt : reader.reference(own[0]));
      if (!target) continue;
      face.surface = *target;
      face.same_sense = reader.enumeration(own[1]) != "F";
    }
    result.push_back(face);
  }
  return result;
}

Expected<void> check_loop_uses(const Reader& reader) {
  const std::size_t records = reader.file().instances().size(), most = free_edge_uses + edge_uses_per_record * records;
  std::unordered_map<std::uint32_t, std::size_t> edges_of;  // of each bound
  std::size_t uses = 0;
  for (const auto k : reader.file().named(face_kinds)) {
    const auto bounds = reader.attributes(k, "FACE", 1, 1);
    if (bounds.empty()) continue;
    for (const auto bound : reader.references(bounds[0])) {
      const auto [known, fresh] = edges_of.try_emplace(bound, 1);
      if (fresh) {
        const auto own = reader.attributes(bound, "FACE_BOUND", 1, 2);
        const auto loop = own.empty() ? std::nullopt : reader.reference(own[0]);
        const bool of_points = loop && reader.is(*loop, "POLY_LOOP");
        const auto path = !loop ? own : reader.attributes(*loop, of_points ? "POLY_LOOP" : "PATH", 1, 1);
        if (loop && !path.empty()) known->second += reader.references(path[0]).size();
      }
      uses += known->second;
    }
    if (uses <= most) continue;
    return reader.error(k,
                        "faces up to this one repeat loops until they have " + std::to_string(uses) +
                            " edges, in a file of " + std::to_string(records) + " records",
                        "give every face loops of its own");
  }
  return {};
}

std::vector<std::uint32_t> edges_around(const Reader& reader, const Face& face) {
  std::vector<std::uint32_t> result;
  for (const auto bound : reader.references(face.bounds)) {
    const auto own = reader.attributes(bound, "FACE_BOUND", 1, 2);
    const auto loop = own.empty() ? std::nullopt : reader.reference(own[0]);
    if (!loop || !reader.is(*loop, "EDGE_LOOP")) continue;
    const auto path = reader.attributes(*loop, "PATH", 1, 1);
    if (path.empty()) continue;
    for (const auto oriented : reader.references(path[0])) {
      const auto oriented_own = reader.attributes(oriented, "ORIENTED_EDGE", 3, 2);
      const auto element = oriented_own.empty() ? std::nullopt : reader.reference(oriented_own[0]);
      if (element) result.push_back(*element);
    }
  }
  return result;
}

std::string name_of(const Reader& reader, std::uint32_t instance) {
  return "#" + std::to_string(reader.file().instance(instance).id);
}

}  // namespace knead::step
