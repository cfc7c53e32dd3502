#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "knead/base/error.hpp"
#include "scene/scene.hpp"

namespace knead {

// What scripts may ask for. Each is far beyond use, and keeps what a few bytes can ask for within
// memory and time.

inline constexpr std::int64_t max_net_size = 4000000;  ///< control points of one surface
inline constexpr std::int64_t max_document_size =
    20000000;                              ///< control points of all that a document holds
inline constexpr int max_steps = 1000000;  ///< of one command
inline constexpr int most_modes = 100;     ///< or factors of buckling, of one command

/// An error about `net` if a net of these counts (0 or more) is larger than `max_net_size`.
[[nodiscard]] Expected<void> check_net_size(const std::array<int, 2>& counts);

/// An error about `net` if the surfaces, curves and volumes of a scene have more than
/// `max_document_size` control points, with so many more.
[[nodiscard]] Expected<void> check_document_size(const Scene& scene, std::int64_t more);

/// An error about `steps` if those at each of `places` are more than `max_steps` in all.
[[nodiscard]] Expected<void> check_steps(int steps, std::size_t places);

/// An error about `radius` if it is no length from 1e-50 to 1e50: the square of a smaller one
/// vanishes.
[[nodiscard]] Expected<void> check_radius(double radius);

}  // namespace knead
