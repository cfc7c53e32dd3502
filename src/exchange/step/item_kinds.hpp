#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "exchange/left_out_list.hpp"

namespace knead::step {

/// Entities of ISO 10303-42 and its neighbours, by what becomes of them as items of
/// representations. In upper case.

/// Items that are read, by themselves or with what refers to them, and those that only hold others,
/// place, style or measure them.
inline constexpr auto read_items = std::to_array<std::string_view>({
    "B_SPLINE_SURFACE_WITH_KNOTS",
    "BEZIER_SURFACE",
    "QUASI_UNIFORM_SURFACE",
    "UNIFORM_SURFACE",
    "B_SPLINE_SURFACE",
    "MANIFOLD_SOLID_BREP",
    "BREP_WITH_VOIDS",
    "FACETED_BREP",
    "SHELL_BASED_SURFACE_MODEL",
    "FACE_BASED_SURFACE_MODEL",
    "CONNECTED_FACE_SET",
    "CONNECTED_FACE_SUB_SET",
    "OPEN_SHELL",
    "CLOSED_SHELL",
    "ORIENTED_OPEN_SHELL",
    "ORIENTED_CLOSED_SHELL",
    "SURFACED_OPEN_SHELL",
    "ADVANCED_FACE",
    "FACE_SURFACE",
    "FACE",
    "ORIENTED_FACE",
    "TRIANGULATED_FACE",
    "COMPLEX_TRIANGULATED_FACE",
    "TRIANGULATED_SURFACE_SET",
    "COMPLEX_TRIANGULATED_SURFACE_SET",
    "TESSELLATED_SOLID",
    "TESSELLATED_SHELL",
    "TESSELLATED_WIRE",
    "TESSELLATED_GEOMETRIC_SET",
    "GEOMETRIC_SET",
    "GEOMETRIC_CURVE_SET",
    "SHELL_BASED_WIREFRAME_MODEL",
    "EDGE_BASED_WIREFRAME_MODEL",
    "CONNECTED_EDGE_SET",
    "WIRE_SHELL",
    "EDGE_CURVE",
    "ORIENTED_EDGE",
    "EDGE_LOOP",
    "PATH",
    "OPEN_PATH",
    "EDGE",
    "AXIS2_PLACEMENT_3D",
    "AXIS2_PLACEMENT_2D",
    "AXIS1_PLACEMENT",
    "PLACEMENT",
    "DIRECTION",
    "VECTOR",
    "CARTESIAN_TRANSFORMATION_OPERATOR",
    "CARTESIAN_TRANSFORMATION_OPERATOR_3D",
    "MAPPED_ITEM",
    "STYLED_ITEM",
    "OVER_RIDING_STYLED_ITEM",
    "DESCRIPTIVE_REPRESENTATION_ITEM",
    "VALUE_REPRESENTATION_ITEM",
    "MEASURE_REPRESENTATION_ITEM",
    "QUALIFIED_REPRESENTATION_ITEM",
    "COMPOUND_REPRESENTATION_ITEM",
    "INTEGER_REPRESENTATION_ITEM",
    "REAL_REPRESENTATION_ITEM",
    "PLANAR_BOX",
    "PLANAR_EXTENT",
});

inline constexpr auto point_kinds = std::to_array<std::string_view>(
    {"CARTESIAN_POINT", "CYLINDRICAL_POINT", "SPHERICAL_POINT", "POLAR_POINT", "POINT_ON_CURVE",
     "POINT_ON_SURFACE", "POINT_REPLICA", "POINT_IN_VOLUME", "DEGENERATE_PCURVE",
     "EVALUATED_DEGENERATE_PCURVE", "VERTEX_POINT", "VERTEX_SHELL"});

inline constexpr auto curve_kinds = std::to_array<std::string_view>({"LINE",
                                                                     "CIRCLE",
                                                                     "ELLIPSE",
                                                                     "HYPERBOLA",
                                                                     "PARABOLA",
                                                                     "CLOTHOID",
                                                                     "CIRCULAR_INVOLUTE",
                                                                     "POLYLINE",
                                                                     "TRIMMED_CURVE",
                                                                     "COMPOSITE_CURVE",
                                                                     "COMPOSITE_CURVE_ON_SURFACE",
                                                                     "BOUNDARY_CURVE",
                                                                     "OUTER_BOUNDARY_CURVE",
                                                                     "OFFSET_CURVE_2D",
                                                                     "OFFSET_CURVE_3D",
                                                                     "CURVE_REPLICA",
                                                                     "PCURVE",
                                                                     "BOUNDED_PCURVE",
                                                                     "SURFACE_CURVE",
                                                                     "BOUNDED_SURFACE_CURVE",
                                                                     "INTERSECTION_CURVE",
                                                                     "SEAM_CURVE",
                                                                     "SURFACED_EDGE_CURVE"});

inline constexpr auto surface_kinds = std::to_array<std::string_view>(
    {"PLANE", "CYLINDRICAL_SURFACE", "CONICAL_SURFACE", "SPHERICAL_SURFACE", "TOROIDAL_SURFACE",
     "DEGENERATE_TOROIDAL_SURFACE", "DUPIN_CYCLIDE_SURFACE", "SURFACE_OF_REVOLUTION",
     "SURFACE_OF_LINEAR_EXTRUSION", "SURFACE_CURVE_SWEPT_SURFACE", "FIXED_REFERENCE_SWEPT_SURFACE",
     "OFFSET_SURFACE", "ORIENTED_SURFACE", "SURFACE_REPLICA", "RECTANGULAR_TRIMMED_SURFACE",
     "CURVE_BOUNDED_SURFACE", "RECTANGULAR_COMPOSITE_SURFACE"});

/// Kinds that are not read wherever they stand.
struct KindGroup {
  detail::LeftOutKind kind;
  bool (*has)(std::string_view keyword);
};

[[nodiscard]] std::string upper_case(std::string_view keyword);
/// Equal but for case; `kind` is in upper case.
[[nodiscard]] bool same_kind(std::string_view keyword, std::string_view kind);
/// Whether its items are those of a shape: SHAPE_REPRESENTATION and its subtypes, and of
/// supplemental geometry.
[[nodiscard]] bool holds_shape(std::string_view keyword);
/// Drawn annotations: ANNOTATION_CURVE_OCCURRENCE and the like, DRAUGHTING_CALLOUT.
[[nodiscard]] bool is_annotation(std::string_view keyword);

extern const std::span<const KindGroup> kind_groups;

}  // namespace knead::step
