#pragma once

#include <string>

#include "knead/brep/model.hpp"

namespace knead::studio {

/// {"unit", "parts": [{"name", "unit", "surfaces", "faces", "places": [{"path", "matrix"}]}], "warnings"}; `matrix` has
/// three rows of four, one after the other, from the part's coordinates to the model's. Among the surfaces are those
/// that a conversion makes splines of. null for a file without assemblies; one that cannot be followed has no parts,
/// and the reason is its warning.
[[nodiscard]] std::string assembly_json(const brep::Model& model);

}  // namespace knead::studio
