#include "faces.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

namespace knead::step {
namespace {

constexpr std::array<std::string_view, 3> face_kinds = {"ADVANCED_FACE", "FACE_SURFACE", "FACE"};
constexpr std::array<std::string_view, 2> turned_shell_kinds = {"ORIENTED_CLOSED_SHELL",
                                                                "ORIENTED_OPEN_SHELL"};
constexpr std::array<std::string_view, 3> solid_kinds = {"MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS",
                                                         "FACETED_BREP"};

/// The faces of shells that are used turned, such as those round the hollows of a solid, and by no
/// solid as they are.
std::unordered_set<std::uint32_t> turned_faces(const Reader& reader) {
  std::unordered_map<std::uint32_t, bool> turned;  // shells
  for (const auto k : reader.file().named(turned_shell_kinds)) {
    for (const auto kind : turned_shell_kinds) {
      const auto attributes = reader.attributes(k, kind, 2, 2);
      const auto shell = attributes.empty() ? std::nullopt : reader.reference(attributes[0]);
      if (shell)
        turned.try_emplace(*shell, true).first->second &= reader.enumeration(attributes[1]) == "F";
    }
  }
  std::unordered_set<std::uint32_t> result;
  if (turned.empty()) return result;
  for (const auto k : reader.file().named(solid_kinds)) {
    const auto attributes = reader.attributes(k, "MANIFOLD_SOLID_BREP", 1, 1);
    const auto shell = attributes.empty() ? std::nullopt : reader.reference(attributes[0]);
    if (shell) turned.erase(*shell);
  }
  for (const auto& [shell, is_turned] : turned) {
    const auto list = is_turned ? reader.attributes(shell, "CONNECTED_FACE_SET", 1, 1)
                                : std::vector<std::uint32_t>();
    if (list.empty()) continue;
    for (const auto face : reader.references(list[0])) result.insert(face);
  }
  return result;
}

constexpr std::array<std::string_view, 2> bounded_kinds = {"CURVE_BOUNDED_SURFACE",
                                                           "RECTANGULAR_TRIMMED_SURFACE"};

std::optional<std::uint32_t> basis_of(const Reader& reader, std::uint32_t surface) {
  const auto value = basis_value(reader, surface);
  return value ? reader.reference(*value) : std::nullopt;
}

/// Bounded surfaces on which no face lies, which no other one bounds further, and which something
/// else than curves in their parameters refers to, or nothing.
void add_bounded_surfaces(const Reader& reader, std::vector<FaceRecord>& faces) {
  const auto bounded = reader.file().named(bounded_kinds);
  if (bounded.empty()) return;
  std::unordered_map<std::uint32_t, std::uint32_t> curves;  // on each surface
  for (const auto k : reader.file().named({"PCURVE", "BOUNDED_PCURVE", "DEGENERATE_PCURVE"})) {
    const auto attributes = reader.attributes(
        k, reader.is(k, "DEGENERATE_PCURVE") ? "DEGENERATE_PCURVE" : "PCURVE", 1, 1);
    if (const auto on = attributes.empty() ? std::nullopt : reader.reference(attributes[0]))
      ++curves[*on];
  }
  std::unordered_set<std::uint32_t> below;
  for (const auto k : bounded) {
    if (const auto basis = basis_of(reader, k)) below.insert(*basis);
  }
  for (const auto k : reader.file().named({"ADVANCED_FACE", "FACE_SURFACE"})) {
    const auto attributes = reader.attributes(k, "FACE_SURFACE", 2, 1);
    if (const auto on = attributes.empty() ? std::nullopt : reader.reference(attributes[0]))
      below.insert(*on);
  }
  for (const auto k : bounded) {
    const auto uses = reader.file().instance(k).uses;
    if (below.contains(k) || (uses > 0 && uses == curves[k])) continue;
    if (const auto basis = untrimmed(reader, k); basis && !is_bounded_surface(reader, *basis))
      faces.push_back({.instance = k, .surface = *basis, .is_surface = true});
  }
}

}  // namespace

bool is_bounded_surface(const Reader& reader, std::uint32_t surface) {
  return std::ranges::any_of(bounded_kinds,
                             [&](std::string_view kind) { return reader.is(surface, kind); });
}

std::optional<std::uint32_t> basis_value(const Reader& reader, std::uint32_t surface) {
  const auto kind = std::ranges::find_if(bounded_kinds,
                                         [&](std::string_view k) { return reader.is(surface, k); });
  const auto basis = kind == bounded_kinds.end() ? std::vector<std::uint32_t>()
                                                 : reader.attributes(surface, *kind, 1, 1);
  return basis.empty() ? std::nullopt : std::optional(basis[0]);
}

std::optional<std::uint32_t> untrimmed(const Reader& reader, std::optional<std::uint32_t> surface) {
  constexpr int max_nesting = 4;
  for (int depth = 0; depth < max_nesting && surface && is_bounded_surface(reader, *surface);
       ++depth)
    surface = basis_of(reader, *surface);
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
      const auto attributes = reader.attributes(k, "FACE_SURFACE", 2, 2);
      const auto target =
          untrimmed(reader, attributes.empty() ? std::nullopt : reader.reference(attributes[0]));
      if (!target) continue;
      face.surface = *target;
      face.same_sense = reader.enumeration(attributes[1]) != "F";
    }
    result.push_back(face);
  }
  add_bounded_surfaces(reader, result);
  return result;
}

// A bound is a record that any number of faces may list, and a loop may list any edge: a small file
// could ask for a model of any size. The uses are counted before they are made.
Expected<void> check_loop_uses(const Reader& reader) {
  const std::size_t records = reader.file().instances().size(),
                    most = free_edge_uses + edge_uses_per_record * records;
  std::unordered_map<std::uint32_t, std::size_t> edges_of;  // of each bound
  std::size_t uses = 0;
  for (const auto k : reader.file().named(face_kinds)) {
    const auto bounds = reader.attributes(k, "FACE", 1, 1);
    if (bounds.empty()) continue;
    for (const auto bound : reader.references(bounds[0])) {
      const auto [known, fresh] = edges_of.try_emplace(bound, 1);
      if (fresh) {
        const auto attributes = reader.attributes(bound, "FACE_BOUND", 1, 2);
        const auto loop = attributes.empty() ? std::nullopt : reader.reference(attributes[0]);
        const bool of_points = loop && reader.is(*loop, "POLY_LOOP");
        const auto path =
            !loop ? attributes : reader.attributes(*loop, of_points ? "POLY_LOOP" : "PATH", 1, 1);
        if (loop && !path.empty()) known->second += reader.references(path[0]).size();
      }
      uses += known->second;
    }
    if (uses <= most) continue;
    return reader.error(k,
                        "faces up to this one repeat loops until they have " +
                            std::to_string(uses) + " edges, in a file of " +
                            std::to_string(records) + " records",
                        "give every face loops of its own");
  }
  return {};
}

std::string name_of(const Reader& reader, std::uint32_t instance) {
  return "#" + std::to_string(reader.file().instance(instance).id);
}

}  // namespace knead::step
