#pragma once

#include <string>

#include "knead/exchange/step_file.hpp"
#include "knead/exchange/trim_loops.hpp"

namespace knead::studio {

/// The faces round the surfaces as bytes: the numbers of points n and of triangles t (uint32 each); 3 n positions
/// relative to `origin` and 3 n normals (float); 3 t indices (uint32); then, as JSON, what was left out:
/// [{"id": "#12", "reason": "…"}, …].
[[nodiscard]] std::string context_bytes(const step::File& file, const Point& origin);

/// {"faces": [[[s, t, s, t, …], …], …]}: of each face its loops, in fractions of the domain; null for a whole surface.
[[nodiscard]] std::string trim_json(const SurfaceTrim& trim);

}  // namespace knead::studio
