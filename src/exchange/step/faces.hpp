#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "entity.hpp"
#include "knead/brep/model.hpp"

namespace knead::step {

/// An ADVANCED_FACE, FACE_SURFACE or FACE as given by its record.
struct FaceRecord {
  std::uint32_t instance = no_instance;
  std::uint32_t bounds = 0;             ///< the value of its list of FACE_BOUNDs
  std::uint32_t surface = no_instance;  ///< none: a FACE has only the geometry of its loops
  bool same_sense = true;
  bool turned = false;  ///< inside out: an ORIENTED_CLOSED_SHELL or ORIENTED_OPEN_SHELL turns its shell
};

/// The surface that a RECTANGULAR_TRIMMED_SURFACE or CURVE_BOUNDED_SURFACE trims; another surface is itself. None where
/// a reference is missing.
[[nodiscard]] std::optional<std::uint32_t> untrimmed(const Reader& reader, std::optional<std::uint32_t> surface);

/// Which of these B-spline surfaces, with their records, a RECTANGULAR_TRIMMED_SURFACE or CURVE_BOUNDED_SURFACE
/// cuts: 1.
[[nodiscard]] std::vector<std::uint8_t> cut_surfaces(const Reader& reader, const std::vector<std::uint32_t>& instances,
                                                     const std::vector<brep::SplineSurface>& surfaces);

/// All faces, in the order of the file. RECTANGULAR_TRIMMED_SURFACE and CURVE_BOUNDED_SURFACE stand for the surface
/// that they trim: the bounds of the face are more precise.
[[nodiscard]] std::vector<FaceRecord> read_faces(const Reader& reader);

// What loops may hold, each counted once for every face that it bounds: no more than a file of loops that bound one
// face each has, but for small files. Without it a hundred kilobytes ask for millions of edges.
inline constexpr std::size_t edge_uses_per_record = 2, free_edge_uses = 50000;

/// An error (input) at the first face with which the faces exceed that.
[[nodiscard]] Expected<void> check_loop_uses(const Reader& reader);

/// "#12", as the file calls an instance.
[[nodiscard]] std::string name_of(const Reader& reader, std::uint32_t instance);

}  // namespace knead::step
