#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "entity.hpp"
#include "knead/brep/model.hpp"

namespace knead::step {

/// An ADVANCED_FACE, FACE_SURFACE or FACE as given by its record; or a CURVE_BOUNDED_SURFACE or
/// RECTANGULAR_TRIMMED_SURFACE that stands for itself, without a face on it.
struct FaceRecord {
  std::uint32_t instance = no_instance;
  std::uint32_t bounds = 0;             ///< the value of its list of FACE_BOUNDs; of a surface 0
  std::uint32_t surface = no_instance;  ///< none: a FACE has only the geometry of its loops
  bool same_sense = true;
  /// Inside out: an ORIENTED_CLOSED_SHELL or ORIENTED_OPEN_SHELL turns its shell.
  bool turned = false;
  bool is_surface = false;  ///< `instance` is a bounded surface
};

/// Whether it is a CURVE_BOUNDED_SURFACE or RECTANGULAR_TRIMMED_SURFACE.
[[nodiscard]] bool is_bounded_surface(const Reader& reader, std::uint32_t surface);
/// The value of a bounded surface that refers to the surface that it trims; none: its record is
/// incomplete.
[[nodiscard]] std::optional<std::uint32_t> basis_value(const Reader& reader, std::uint32_t surface);

/// The surface that a RECTANGULAR_TRIMMED_SURFACE or CURVE_BOUNDED_SURFACE trims; another surface
/// is itself. None where a reference is missing.
[[nodiscard]] std::optional<std::uint32_t> untrimmed(const Reader& reader,
                                                     std::optional<std::uint32_t> surface);

/// All faces, in the order of the file, and after them the bounded surfaces that stand for
/// themselves. The surface of a face that is a RECTANGULAR_TRIMMED_SURFACE or CURVE_BOUNDED_SURFACE
/// is the one that it trims: the bounds of the face are more precise.
[[nodiscard]] std::vector<FaceRecord> read_faces(const Reader& reader);

// What loops may hold, each counted once for every face that it bounds: no more than a file of
// loops that bound one face each has, but for small files. Without it a hundred kilobytes ask for
// millions of edges.
inline constexpr std::size_t edge_uses_per_record = 2, free_edge_uses = 50000;

/// An error (input) at the first face with which the faces exceed that.
[[nodiscard]] Expected<void> check_loop_uses(const Reader& reader);

/// "#12", as the file calls an instance.
[[nodiscard]] std::string name_of(const Reader& reader, std::uint32_t instance);

}  // namespace knead::step
