#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead::brep {

/// AXIS2_PLACEMENT_3D as the file gives it: directions are not normalised; an omitted axis is (0,
/// 0, 1) and an omitted reference direction (1, 0, 0), or (0, 1, 0) where the axis is along x (ISO
/// 10303-42, first_proj_axis).
struct AxisPlacement {
  Point origin = Point::Zero();
  Point axis = Point::UnitZ();
  Point ref_direction = Point::UnitX();
};

/// One placement of a component in an assembly: a NEXT_ASSEMBLY_USAGE_OCCURRENCE with its
/// CONTEXT_DEPENDENT_SHAPE_REPRESENTATION, a MAPPED_ITEM, or another
/// REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION. The component is moved so that `frame` (in the
/// child's coordinates) lands on `placement` (in the parent's). Nothing is applied to the surfaces;
/// `assembly_of` (assembly.hpp) says where they stand in the model.
struct Instance {
  std::string id;      ///< "#123", of that record
  std::string name;    ///< its label
  std::string parent;  ///< product name of the assembly; empty if the file gives none
  std::string child;   ///< product name of the component; empty likewise
  std::optional<AxisPlacement>
      placement;  ///< where the component's frame lies in the parent; none if not given
  std::optional<AxisPlacement> frame;  ///< the component's own frame
};

/// The length unit of one representation context.
struct LengthUnit {
  std::string context;  ///< "#123" of the GLOBAL_UNIT_ASSIGNED_CONTEXT
  std::string name;  ///< SI: "m", "mm", "um", …; conversion based: its name in lower case, "inch",
                     ///< "foot", …
  double metres = 0;  ///< length of one unit in metres; 0 if the file does not say
};

/// Most places of parts in one model.
inline constexpr std::size_t max_places = 100'000;

struct Model;

/// One place where an assembly puts a part.
struct PartPlace {
  std::string path;  ///< products from the model down: "engine/valve/spring"
  /// From the part's coordinates to the model's, units too.
  Eigen::Affine3d to_model = Eigen::Affine3d::Identity();
};

/// Geometry with coordinates of its own: what one product's representations hold.
struct Part {
  std::string name;  ///< of the product; empty if there is none
  std::string unit;  ///< of its coordinates, as in `LengthUnit::name`; "unknown" if not given
  std::vector<std::string> surfaces;  ///< ids of its B-spline surfaces
  std::vector<std::string> faces;     ///< ids of its faces and tessellated items (tessellated.hpp)
  std::vector<std::string>
      curves;                     ///< ids of its curves that stand for themselves (`File::curves`)
  std::vector<PartPlace> places;  ///< at least one

  /// Adds a face of the model, and the B-spline surface on which it lies.
  void add(const Model& model, std::uint32_t face);
};

/// The model of a STEP file: its parts, and where each of them stands.
struct Assembly {
  std::string unit;  ///< of the model's coordinates: of its first root that has one; else "unknown"
  std::vector<Part>
      parts;  ///< those with faces, B-spline surfaces or curves, in the order of their first record
  std::vector<std::string> warnings;  ///< what could not be followed, one sentence each

  /// Some part is used several times, or does not stand at its own origin.
  [[nodiscard]] bool placed() const;
  /// The part that holds a B-spline surface, the first if there are several; null if none.
  [[nodiscard]] const Part* part_of(const std::string& surface) const;
};

}  // namespace knead::brep
