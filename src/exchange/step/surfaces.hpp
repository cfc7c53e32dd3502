#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "entity.hpp"
#include "knead/spline/spline.hpp"
#include "knots.hpp"

namespace knead::step {

/// A surface and where it stands.
struct ReadSurface {
  std::uint32_t instance = no_instance;
  Surface surface;
};

/// Whether it is a B_SPLINE_SURFACE in any form, simple or as part of a complex instance.
[[nodiscard]] bool is_b_spline_surface(const Reader& reader, std::uint32_t instance);

/// All of them, in the order of the file.
[[nodiscard]] std::vector<std::uint32_t> b_spline_surfaces(const Reader& reader);

/// Reads one (ISO 10303-42, b_spline_surface and its subtypes). Errors (input) with entity and
/// line.
[[nodiscard]] Expected<ReadSurface> read_b_spline_surface(const Reader& reader,
                                                          std::uint32_t instance);

/// Reads several, by several threads where the file is large.
[[nodiscard]] std::vector<Expected<ReadSurface>> read_b_spline_surfaces(
    const Reader& reader, std::span<const std::uint32_t> instances);

/// The values that refer to its control points, in their order; it must be one that can be read.
[[nodiscard]] std::vector<std::uint32_t> control_point_values(const Reader& reader,
                                                              std::uint32_t instance);

/// The number of attributes of B_SPLINE_SURFACE with the name it inherits.
inline constexpr std::size_t attributes_of_b_spline_surface = 8;

/// The values of its u multiplicities, v multiplicities, u knots, v knots, and whatever follows;
/// empty if it lists none.
[[nodiscard]] std::vector<std::uint32_t> knot_parameters(const Reader& reader,
                                                         std::uint32_t instance);

/// The value of the list of its weights; it must be rational.
[[nodiscard]] std::uint32_t weights_parameter(const Reader& reader, std::uint32_t instance);

/// The form that implies its knots, if it has one.
[[nodiscard]] std::optional<ImpliedKnots> implied_form(const Reader& reader,
                                                       std::uint32_t instance);
[[nodiscard]] const char* implied_keyword(ImpliedKnots form);

}  // namespace knead::step
