#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/exchange/source.hpp"
#include "knead/spline/spline.hpp"

namespace knead::step {

/// One B-spline surface entity of a STEP file.
struct SurfaceEntity {
  std::string id;    ///< "#123"
  std::string name;  ///< decoded label of the representation item; empty if it has none
  std::string unit;  ///< length unit of its coordinates as in `LengthUnit::name`; "unknown" if it cannot be determined

  /// u is the outer list of control points (slow), v the inner one (fast). Numbers are the correctly rounded doubles of
  /// the file's decimals, in the file's units and in the frame of the surface's own representation.
  Surface surface;

  /// `closed_directions`; the file's own u_closed and v_closed flags are often wrong and are ignored.
  std::array<bool, 2> closed = {false, false};

  /// Some face on this surface covers only part of it: an edge of its bounds leaves the four boundary isocurves of the
  /// surface, or its edges together miss part of a boundary isocurve that is neither a seam nor a single point. Decided
  /// by points sampled on the edges, to twice the uncertainty the file states (edge and surface may each be off
  /// by it), but no less than 1e-5 and no more than 1e-4 of the net's bounding-box diagonal. Where the type of an
  /// edge's curve is unknown (docs/step.md) the face counts as trimmed. A surface that no face uses is untrimmed,
  /// unless a RECTANGULAR_TRIMMED_SURFACE or CURVE_BOUNDED_SURFACE cuts it.
  bool trimmed = false;

  int faces = 0;  ///< faces of the file that lie on it
};

/// One B-spline curve in space that stands for itself: no edge, surface or trimmed curve uses it.
struct CurveEntity {
  std::string id, name, unit;  ///< as those of a `SurfaceEntity`
  Curve curve;
};

/// AXIS2_PLACEMENT_3D as the file gives it: directions are not normalised; an omitted axis is (0, 0, 1) and an omitted
/// reference direction (1, 0, 0), or (0, 1, 0) where the axis is along x (ISO 10303-42, first_proj_axis).
struct AxisPlacement {
  Point origin = Point::Zero();
  Point axis = Point::UnitZ();
  Point ref_direction = Point::UnitX();
};

/// One placement of a component in an assembly: a NEXT_ASSEMBLY_USAGE_OCCURRENCE with its
/// CONTEXT_DEPENDENT_SHAPE_REPRESENTATION, a MAPPED_ITEM, or another REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION.
/// The component is moved so that `frame` (in the child's coordinates) lands on `placement` (in the parent's). Nothing
/// is applied to the surfaces; `assembly_of` (assembly.hpp) says where they stand in the model.
struct Instance {
  std::string id;                          ///< "#123", of that record
  std::string name;                        ///< its label
  std::string parent;                      ///< product name of the assembly; empty if the file gives none
  std::string child;                       ///< product name of the component; empty likewise
  std::optional<AxisPlacement> placement;  ///< where the component's frame lies in the parent; none if not given
  std::optional<AxisPlacement> frame;      ///< the component's own frame
};

/// The length unit of one representation context.
struct LengthUnit {
  std::string context;  ///< "#123" of the GLOBAL_UNIT_ASSIGNED_CONTEXT
  std::string name;     ///< SI: "m", "mm", "um", …; conversion based: its name in lower case, "inch", "foot", …
  double metres = 0;    ///< length of one unit in metres; 0 if the file does not say
};

/// New control points of one surface, in the order of `Surface::control_points`.
struct Edit {
  std::string id;  ///< "#123"
  Points control_points;
};

/// Another surface in place of one in the file: refined or coarser, over the same parameter domain.
struct Replacement {
  std::string id;  ///< "#123"
  Surface surface;
};

/// Another curve in place of a free one.
struct CurveReplacement {
  std::string id;  ///< "#123"
  Curve curve;
};

/// Another curve in space for an EDGE_CURVE, through the same parameters as the one it replaces, in its direction.
struct MovedEdge {
  std::string id;  ///< "#456"
  Curve curve;
};

/// Another place for a VERTEX_POINT.
struct MovedVertex {
  std::string id;  ///< "#78"
  Point place = Point::Zero();
};

/// Edges that have moved with their faces.
struct MovedEdges {
  std::vector<MovedEdge> edges;
  std::vector<MovedVertex> vertices;
};

/// A STEP file (ISO 10303-21 exchange structure) whose records remember their bytes, and its B-spline surfaces.
///
/// Reading keeps all bytes. Writing is surgical: only what must differ does (docs/step.md).
/// Immutable; copies share the data; const access is thread-safe. Cost of reading: linear in the size of the file.
class File {
 public:
  /// Reads and parses a file. Errors (input): it cannot be read; it is not an exchange structure (with line and
  /// entity).
  [[nodiscard]] static Expected<File> read(const std::filesystem::path& path);
  /// Parses bytes; `name` stands for the file in errors.
  [[nodiscard]] static Expected<File> parse(std::string bytes, std::string name);

  [[nodiscard]] const std::string& name() const;
  /// The input, byte for byte.
  [[nodiscard]] const std::string& bytes() const;
  /// The first FILE_SCHEMA name, as in "AUTOMOTIVE_DESIGN"; empty if the header has none.
  [[nodiscard]] const std::string& schema() const;

  /// In the order of the file.
  [[nodiscard]] const std::vector<SurfaceEntity>& surfaces() const;
  [[nodiscard]] const std::vector<UnreadableSurface>& unreadable_surfaces() const;
  /// The free ones, in the order of the file; those that cannot be read are left out.
  [[nodiscard]] const std::vector<CurveEntity>& curves() const;
  /// Whether this is a B-spline curve that is not free.
  [[nodiscard]] bool is_bound_curve(const std::string& id) const;
  [[nodiscard]] const std::vector<Instance>& instances() const;
  /// One per context that assigns a length unit, in the order of the file.
  [[nodiscard]] const std::vector<LengthUnit>& length_units() const;
  /// The distinct names of `length_units`, joined by ", " (nearly always one name); "unknown" where there is none.
  [[nodiscard]] std::string length_unit() const;
  /// What is wrong with the file outside of its surfaces: references to names that it does not define, the first ten of
  /// them and the number of the others. What such a record describes is left out, and kept as it is when written.
  [[nodiscard]] std::vector<Error> warnings() const;
  /// The surface with this id, or null.
  [[nodiscard]] const SurfaceEntity* find_surface(const std::string& id) const;

  /// The bytes of this file with the control points of some surfaces replaced and every other byte as it was.
  ///
  /// A coordinate is rewritten, to 17 significant digits, only if its bits change. A point also referenced outside this
  /// surface keeps its record and the surface refers to a new one; references shared within the surface are split only
  /// if their positions come to differ. The result is parsed again and compared bit for bit before it is returned.
  /// No edits, or edits that change nothing, give the input bytes.
  /// Errors: unknown or repeated id, wrong number of control points, a coordinate that is not finite (input); the
  /// self-check fails (numerical).
  [[nodiscard]] Expected<std::string> with_control_points(std::span<const Edit> edits) const;

  /// The bytes of this file with whole surfaces replaced, including nets, degrees, knots and weights, and every other
  /// byte as it was.
  ///
  /// Where only control points differ this is `with_control_points`. Otherwise what differs in the surface's record is
  /// rewritten: degrees, the list of control points, weights, and the knots of a direction; forms with implied knots
  /// become B_SPLINE_SURFACE_WITH_KNOTS unless the new knots are implied as well; a surface that gains weights becomes
  /// a complex instance with RATIONAL_B_SPLINE_SURFACE. Name, surface form and the flags for closed
  /// and self-intersecting stay. Control points equal to one of the old net keep its record; others take over records
  /// that only this surface used and no longer needs, or get new ones (docs/step.md). The parameter domain should stay
  /// the same, since trimming curves are defined on it; this is not checked.
  /// Errors: unknown or repeated id; no weights where the file has some; a knot inside the domain
  /// repeated more often than the degree (input); the self-check fails (numerical).
  ///
  /// `moved`: the curve of an edge becomes a new B_SPLINE_CURVE_WITH_KNOTS, RATIONAL_B_SPLINE_CURVE if it has weights.
  /// A SURFACE_CURVE (or subtype) stays, with its PCURVEs, and refers to the new curve: in place if only this edge uses
  /// it, else as a copy under a new name. The old curve's records stay. The point of a vertex is treated as a control
  /// point is. Further errors (input): an edge or vertex that is not in the file.
  ///
  /// `curves`: of a free curve on the same net only moved coordinates differ; with another net its record is written
  /// anew under its name and label. Further errors (input): a curve that is not free, or torn along a knot.
  [[nodiscard]] Expected<std::string> with_surfaces(std::span<const Replacement> replacements,
                                                    const MovedEdges& moved = {},
                                                    std::span<const CurveReplacement> curves = {}) const;

  struct Data;  ///< private to the exchange room
  [[nodiscard]] const Data& data() const { return *data_; }

 private:
  explicit File(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

}  // namespace knead::step
