#include "item_kinds.hpp"

#include <algorithm>

namespace knead::step {
namespace {

constexpr auto primitives = std::to_array<std::string_view>(
    {"BLOCK", "RIGHT_ANGULAR_WEDGE", "SPHERE", "TORUS", "RIGHT_CIRCULAR_CONE",
     "RIGHT_CIRCULAR_CYLINDER", "ECCENTRIC_CONE", "ELLIPSOID", "FACETED_PRIMITIVE",
     "CONVEX_HEXAHEDRON", "TETRAHEDRON", "RECTANGULAR_PYRAMID", "CYCLIDE_SEGMENT_SOLID",
     "CSG_SOLID", "BOOLEAN_RESULT", "HALF_SPACE_SOLID", "BOXED_HALF_SPACE", "SOLID_REPLICA"});
constexpr auto swept = std::to_array<std::string_view>(
    {"SWEPT_AREA_SOLID", "EXTRUDED_AREA_SOLID", "REVOLVED_AREA_SOLID",
     "SURFACE_CURVE_SWEPT_AREA_SOLID", "SWEPT_FACE_SOLID", "EXTRUDED_FACE_SOLID",
     "REVOLVED_FACE_SOLID", "SURFACE_CURVE_SWEPT_FACE_SOLID", "SWEPT_DISK_SOLID",
     "SWEPT_CURVE_SOLID"});
constexpr auto volumes = std::to_array<std::string_view>(
    {"B_SPLINE_VOLUME", "B_SPLINE_VOLUME_WITH_KNOTS", "BEZIER_VOLUME", "UNIFORM_VOLUME",
     "QUASI_UNIFORM_VOLUME", "BLOCK_VOLUME", "WEDGE_VOLUME", "PYRAMID_VOLUME", "TETRAHEDRON_VOLUME",
     "HEXAHEDRON_VOLUME", "SPHERICAL_VOLUME", "CYLINDRICAL_VOLUME", "ECCENTRIC_CONICAL_VOLUME",
     "TOROIDAL_VOLUME", "ELLIPSOID_VOLUME"});
constexpr auto tolerances = std::to_array<std::string_view>({"DIMENSIONAL_SIZE",
                                                             "DIMENSIONAL_SIZE_WITH_PATH",
                                                             "ANGULAR_SIZE",
                                                             "DIMENSIONAL_LOCATION",
                                                             "ANGULAR_LOCATION",
                                                             "DIRECTED_DIMENSIONAL_LOCATION",
                                                             "DIMENSIONAL_LOCATION_WITH_PATH",
                                                             "GEOMETRIC_TOLERANCE",
                                                             "ANGULARITY_TOLERANCE",
                                                             "CIRCULAR_RUNOUT_TOLERANCE",
                                                             "COAXIALITY_TOLERANCE",
                                                             "CONCENTRICITY_TOLERANCE",
                                                             "CYLINDRICITY_TOLERANCE",
                                                             "FLATNESS_TOLERANCE",
                                                             "LINE_PROFILE_TOLERANCE",
                                                             "PARALLELISM_TOLERANCE",
                                                             "PERPENDICULARITY_TOLERANCE",
                                                             "POSITION_TOLERANCE",
                                                             "ROUNDNESS_TOLERANCE",
                                                             "STRAIGHTNESS_TOLERANCE",
                                                             "SURFACE_PROFILE_TOLERANCE",
                                                             "SYMMETRY_TOLERANCE",
                                                             "TOTAL_RUNOUT_TOLERANCE",
                                                             "DATUM",
                                                             "DATUM_TARGET",
                                                             "PLACED_DATUM_TARGET_FEATURE"});
constexpr auto elements = std::to_array<std::string_view>(
    {"NODE", "NODE_REPRESENTATION", "VOLUME_3D_ELEMENT_REPRESENTATION",
     "SURFACE_3D_ELEMENT_REPRESENTATION", "CURVE_3D_ELEMENT_REPRESENTATION",
     "POINT_ELEMENT_REPRESENTATION"});

template <const auto& Kinds>
bool in(std::string_view keyword) {
  return std::ranges::any_of(Kinds,
                             [&](std::string_view kind) { return same_kind(keyword, kind); });
}

/// Other tessellated items than those made of triangles.
constexpr auto polylines = std::to_array<std::string_view>(
    {"TESSELLATED_CURVE_SET", "TESSELLATED_POINT_SET", "TESSELLATED_EDGE",
     "TESSELLATED_CONNECTING_EDGE", "TESSELLATED_VERTEX", "CUBIC_BEZIER_TESSELLATED_EDGE",
     "CUBIC_BEZIER_TRIANGULATED_FACE"});

bool view(std::string_view keyword) { return upper_case(keyword).starts_with("CAMERA_MODEL_D3"); }
bool layer(std::string_view keyword) { return same_kind(keyword, "PRESENTATION_LAYER_ASSIGNMENT"); }
bool cloud(std::string_view keyword) { return upper_case(keyword).starts_with("POINT_CLOUD_"); }

constexpr std::string_view without_faces = "its faces are not in the file",
                           as_faces =
                               "write a boundary representation in the program that made the file";

constexpr KindGroup groups[] = {
    {{"record of solids made of primitives", "records of solids made of primitives", without_faces,
      as_faces},
     in<primitives>},
    {{"swept solid", "swept solids", without_faces, as_faces}, in<swept>},
    {{"volume", "volumes", "volumes of a STEP file are not read"}, in<volumes>},
    {{"tessellated curve or point", "tessellated curves and points",
      "of tessellated items only triangles are shown"},
     in<polylines>},
    {{"point cloud", "point clouds", "a point has no surface"}, cloud},
    {{"record of finite elements", "records of finite elements",
      "meshes of an analysis are not read"},
     in<elements>},
    {{"drawn annotation", "drawn annotations", "annotations (PMI) are not shown"}, is_annotation},
    {{"dimension, tolerance or datum", "dimensions, tolerances and datums",
      "annotations (PMI) are not shown"},
     in<tolerances>},
    {{"saved view", "saved views", "views are not shown"}, view},
    {{"layer", "layers", "layers are not shown"}, layer},
};

}  // namespace

std::string upper_case(std::string_view keyword) {
  std::string result(keyword);
  for (char& c : result) c = 'a' <= c && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return result;
}

bool same_kind(std::string_view keyword, std::string_view kind) {
  return keyword.size() == kind.size() && upper_case(keyword) == kind;
}

bool holds_shape(std::string_view keyword) {
  const std::string kind = upper_case(keyword);
  return kind.ends_with("SHAPE_REPRESENTATION") || kind == "CONSTRUCTIVE_GEOMETRY_REPRESENTATION";
}

bool is_annotation(std::string_view keyword) {
  const std::string kind = upper_case(keyword);
  return kind == "DRAUGHTING_CALLOUT" || kind == "TESSELLATED_ANNOTATION_OCCURRENCE" ||
         (kind.starts_with("ANNOTATION_") && kind.ends_with("_OCCURRENCE")) ||
         kind == "ANNOTATION_OCCURRENCE";
}

const std::span<const KindGroup> kind_groups = groups;

}  // namespace knead::step
