#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "knead/exchange/step_file.hpp"

namespace knead::step {

/// Most places of parts in one model.
inline constexpr std::size_t max_places = 100'000;

/// One place where an assembly puts a part.
struct PartPlace {
  std::string path;                                        ///< products from the model down: "engine/valve/spring"
  Eigen::Affine3d to_model = Eigen::Affine3d::Identity();  ///< from the part's coordinates to the model's, units too
};

/// Geometry with coordinates of its own: what one product's representations hold.
struct Part {
  std::string name;                   ///< of the product; empty if there is none
  std::string unit;                   ///< of its coordinates, as in `LengthUnit::name`; "unknown" if not given
  std::vector<std::string> surfaces;  ///< ids of its B-spline surfaces
  std::vector<std::string> faces;     ///< ids of its faces
  std::vector<std::string> curves;    ///< ids of its curves that stand for themselves (`File::curves`)
  std::vector<PartPlace> places;      ///< at least one
};

/// The model of a STEP file: its parts, and where each of them stands.
struct Assembly {
  std::string unit;         ///< of the model's coordinates: of its first root that has one; else "unknown"
  std::vector<Part> parts;  ///< those with faces, B-spline surfaces or curves, in the order of their first record
  std::vector<std::string> warnings;  ///< what could not be followed, one sentence each

  /// Some part is used several times, or does not stand at its own origin.
  [[nodiscard]] bool placed() const;
  /// The part that holds a B-spline surface, the first if there are several; null if none.
  [[nodiscard]] const Part* part_of(const std::string& surface) const;
};

/// Representations are joined to parts by relationships without transformation, and parts to assemblies by
/// NEXT_ASSEMBLY_USAGE_OCCURRENCE with its CONTEXT_DEPENDENT_SHAPE_REPRESENTATION, by other
/// REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION (rep_1 within rep_2) and by MAPPED_ITEM (ISO 10303-43 and -44). A
/// point x of the component is at P s F⁻¹ x in the parent, with the component's frame F, its place P and the ratio s of
/// the two length units; CARTESIAN_TRANSFORMATION_OPERATOR_3D may scale and mirror. Products that no other uses are the
/// roots, at their own origins, in the unit of the first. Geometry that belongs to no product stands where its
/// coordinates say, as does a component whose transformation is missing, with a warning; an assembly within itself ends
/// there. Errors (input): more than `max_places`. Cost: linear in the file, and in the places.
[[nodiscard]] Expected<Assembly> assembly_of(const File& file);

}  // namespace knead::step
