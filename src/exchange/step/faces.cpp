#include "faces.hpp"

#include <array>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

namespace knead::step {
namespace {

constexpr std::array<std::string_view, 3> face_kinds = {"ADVANCED_FACE", "FACE_SURFACE", "FACE"};
constexpr std::array<std::string_view, 2> turned_shell_kinds = {"ORIENTED_CLOSED_SHELL", "ORIENTED_OPEN_SHELL"};
constexpr std::array<std::string_view, 3> solid_kinds = {"MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS", "FACETED_BREP"};

/// The faces of shells that are used turned, such as those round the hollows of a solid, and by no solid as they are.
std::unordered_set<std::uint32_t> turned_faces(const Reader& reader) {
  std::unordered_map<std::uint32_t, bool> turned;  // shells
  for (const auto k : reader.file().named(turned_shell_kinds)) {
    for (const auto kind : turned_shell_kinds) {
      const auto own = reader.attributes(k, kind, 2, 2);
      const auto shell = own.empty() ? std::nullopt : reader.reference(own[0]);
      if (shell) turned.try_emplace(*shell, true).first->second &= reader.enumeration(own[1]) == "F";
    }
  }
  std::unordered_set<std::uint32_t> result;
  if (turned.empty()) return result;
  for (const auto k : reader.file().named(solid_kinds)) {
    const auto own = reader.attributes(k, "MANIFOLD_SOLID_BREP", 1, 1);
    const auto shell = own.empty() ? std::nullopt : reader.reference(own[0]);
    if (shell) turned.erase(*shell);
  }
  for (const auto& [shell, is_turned] : turned) {
    const auto own = is_turned ? reader.attributes(shell, "CONNECTED_FACE_SET", 1, 1) : std::vector<std::uint32_t>();
    if (own.empty()) continue;
    for (const auto face : reader.references(own[0])) result.insert(face);
  }
  return result;
}

// The basis surface trimmed by a RECTANGULAR_TRIMMED_SURFACE or CURVE_BOUNDED_SURFACE.
std::optional<std::uint32_t> cut_surface(const Reader& reader, std::uint32_t instance,
                                         const std::unordered_map<std::uint32_t, std::size_t>& index,
                                         const std::vector<brep::SplineSurface>& surfaces) {
  if (reader.is(instance, "CURVE_BOUNDED_SURFACE")) {
    const auto own = reader.attributes(instance, "CURVE_BOUNDED_SURFACE", 1, 3);
    const bool whole = !own.empty() && reader.references(own[1]).empty() && reader.enumeration(own[2]) == "T";
    return own.empty() || whole ? std::nullopt : reader.reference(own[0]);
  }
  if (!reader.is(instance, "RECTANGULAR_TRIMMED_SURFACE")) return std::nullopt;
  const auto own = reader.attributes(instance, "RECTANGULAR_TRIMMED_SURFACE", 1, 5);
  const auto basis = own.empty() ? std::nullopt : reader.reference(own[0]);
  const auto found = basis ? index.find(*basis) : index.end();
  if (found == index.end()) return std::nullopt;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto domain = surfaces[found->second].surface.knots(static_cast<int>(k / 2)).domain();
    const auto bound = reader.real(own[k + 1]);
    const double end = k % 2 == 0 ? domain.lower : domain.upper;
    if (!bound || std::abs(*bound - end) > 1e-9 * domain.length()) return basis;
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::uint8_t> cut_surfaces(const Reader& reader, const std::vector<std::uint32_t>& instances,
                                       const std::vector<brep::SplineSurface>& surfaces) {
  std::vector<std::uint8_t> result(surfaces.size(), 0);
  std::unordered_map<std::uint32_t, std::size_t> index;
  for (std::size_t k = 0; k < instances.size(); ++k) index.emplace(instances[k], k);
  for (const auto k : reader.file().named({"CURVE_BOUNDED_SURFACE", "RECTANGULAR_TRIMMED_SURFACE"})) {
    const auto cut = cut_surface(reader, k, index, surfaces);
    const auto found = cut ? index.find(*cut) : index.end();
    if (found != index.end()) result[found->second] = 1;
  }
  return result;
}

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

std::vector<FaceRecord> read_faces(const Reader& reader) {
  std::vector<FaceRecord> result;
  const auto turned = turned_faces(reader);
  for (const auto k : reader.file().named(face_kinds)) {
    const bool has_surface = reader.is(k, "ADVANCED_FACE") || reader.is(k, "FACE_SURFACE");
    const auto bounds = reader.attributes(k, "FACE", 1, 1);
    if (bounds.empty()) continue;
    FaceRecord face{.instance = k, .bounds = bounds[0], .turned = turned.contains(k)};
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

std::string name_of(const Reader& reader, std::uint32_t instance) {
  return "#" + std::to_string(reader.file().instance(instance).id);
}

}  // namespace knead::step
