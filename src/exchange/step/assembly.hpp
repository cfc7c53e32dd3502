#pragma once

#include "instances.hpp"
#include "knead/brep/model.hpp"
#include "model.hpp"

namespace knead::step {

/// Representations are joined to parts by relationships without transformation, and parts to
/// assemblies by NEXT_ASSEMBLY_USAGE_OCCURRENCE with its CONTEXT_DEPENDENT_SHAPE_REPRESENTATION, by
/// other REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION (rep_1 within rep_2) and by MAPPED_ITEM
/// (ISO 10303-43 and -44). A point x of the component is at P s F⁻¹ x in the parent, with the
/// component's frame F, its place P and the ratio s of the two length units;
/// CARTESIAN_TRANSFORMATION_OPERATOR_3D may scale and mirror. Products that no other uses are the
/// roots, at their own origins, in the unit of the first. Geometry that belongs to no product
/// stands where its coordinates say, as does a component whose transformation is missing, with a
/// warning; an assembly within itself ends there. Errors (input): more than `max_places`. Cost:
/// linear in the file, and in the places.
[[nodiscard]] Expected<brep::Assembly> read_assembly(const Reader& reader,
                                                     const Structure& structure,
                                                     const brep::Model& model,
                                                     const ModelRecords& records);

}  // namespace knead::step
