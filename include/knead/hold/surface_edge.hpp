#pragma once

namespace knead {

/// A boundary isocurve of a surface: u at the start or end of its domain, or v.
enum class SurfaceEdge { u0, u1, v0, v1 };

[[nodiscard]] constexpr const char* edge_name(SurfaceEdge edge) {
  constexpr const char* names[] = {"u0", "u1", "v0", "v1"};
  return names[static_cast<int>(edge)];
}
/// The direction across the edge: 0 for u0 and u1, along which v runs.
[[nodiscard]] constexpr int edge_across(SurfaceEdge edge) { return static_cast<int>(edge) / 2; }
/// The direction that runs along the edge.
[[nodiscard]] constexpr int edge_along(SurfaceEdge edge) { return 1 - edge_across(edge); }
[[nodiscard]] constexpr bool edge_at_end(SurfaceEdge edge) { return static_cast<int>(edge) % 2 == 1; }

}  // namespace knead
