#pragma once

#include <string>

#include "exchange/faces/face_plan.hpp"
#include "text.hpp"

namespace knead::step {

/// A STEP file (ISO 10303-21, AP214 or AP242) of the faces of a model, its surfaces without faces
/// and its curves.
///
/// Every part is a product. Its solids are MANIFOLD_SOLID_BREPs or BREP_WITH_VOIDS of an
/// ADVANCED_BREP_SHAPE_REPRESENTATION, its other shells and its surfaces without faces
/// SHELL_BASED_SURFACE_MODELs of a MANIFOLD_SURFACE_SHAPE_REPRESENTATION, its curves a
/// GEOMETRIC_CURVE_SET. Faces share their edges, vertices and surfaces as in the model. Several
/// parts, and one that does not stand once at its own origin, are the components of one assembly,
/// each place a NEXT_ASSEMBLY_USAGE_OCCURRENCE. Numbers are those of the model with 17 significant
/// digits; curves in parameters (PCURVE) are not written. Errors (input): an unknown unit. Cost:
/// linear.
[[nodiscard]] Expected<std::string> model_text(const detail::FacePlan& plan,
                                               const TextOptions& options);

}  // namespace knead::step
