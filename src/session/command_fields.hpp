#pragma once

#include <array>
#include <optional>
#include <span>

#include "describe/describe.hpp"
#include "session_state.hpp"

namespace knead {

struct Act;

[[nodiscard]] inline Vector3 array_of(const Point& p) { return {p[0], p[1], p[2]}; }
[[nodiscard]] inline Point point_of(const Vector3& v) { return {v[0], v[1], v[2]}; }

// Fields shared by several commands. Each command's header declares, next to its struct C,
//   Expected<void> execute(const C&, Act&)   what it does
//   void describe(C&, Fields&)               its fields
// and its .cpp file defines both.

/// What a command acts on. Each declares it as `acts_on`, unless it is for surfaces alone.
enum class ActsOn {
  surfaces,  ///< the selected surfaces
  shapes,    ///< the selected surfaces, or the selected curve or volume
  scene,     ///< what it names, whatever is selected
};

template <class C>
[[nodiscard]] constexpr ActsOn target_of() {
  if constexpr (requires { C::acts_on; }) return C::acts_on;
  return ActsOn::surfaces;
}

/// What a command that moves surfaces may do where they come to another face of their model
/// (`meet_faces`).
enum class ThroughAllowance { through, nothing };

std::span<const Choice> choices(ThroughAllowance);
/// The field `allow` of such a command.
void describe_allowance(std::optional<ThroughAllowance>& allow, Fields& fields);

std::span<const Choice> choices(StepWeight);
std::span<const Choice> choices(EdgeChoice);

/// The directions of a surface.
inline constexpr Choice surface_directions[] = {{"u", "the first"}, {"v", "the second"}};

/// A surface point: fractions of the domain, or the visible middle.
struct SurfacePlace {
  Fractions at = {0.5, 0.5};
  bool middle = false;
};

}  // namespace knead
