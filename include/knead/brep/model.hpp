#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/brep/face_mesh.hpp"
#include "knead/spline/spline.hpp"

/// The boundary representation of a file: what readers of every format fill, and what everything
/// about faces and their edges is told by. The entities are those of ISO 10303-42 (topology and
/// geometry), under the file's own ids.
namespace knead::brep {

/// Position in a list of the model.
using Index = std::uint32_t;
inline constexpr Index none = 0xFFFFFFFF;

/// Why an entity cannot be used; null where it can. Others of the file are still usable.
using Fault = std::shared_ptr<const Error>;
[[nodiscard]] inline Fault fault(Error error) {
  return std::make_shared<const Error>(std::move(error));
}

/// Axes of a placement, orthonormal: x is the reference direction orthogonalised to the axis z, and
/// y = z × x.
struct Frame {
  Point origin = Point::Zero();
  Point x = Point::UnitX(), y = Point::UnitY(), z = Point::UnitZ();
};

/// A place and a direction, with the other axes turned by any angle about it.
[[nodiscard]] Frame frame_about(const Point& origin, const Point& axis);

struct Line {
  Point origin = Point::Zero(), direction = Point::UnitX();  ///< the direction is a unit vector
  double magnitude = 1;  ///< length of one unit of the file's parameter
};

/// C + a cos t + b sin t, C + a cosh t + b sinh t, or C + a t² + 2 b t.
struct Conic {
  enum class Form { ellipse, hyperbola, parabola };
  Form form = Form::ellipse;
  Point centre = Point::Zero(), a = Point::Zero(),
        b = Point::Zero();  ///< semi-axes; of a parabola focal length × axis
};

/// A curve in space, unbounded where its form is.
struct CurveGeometry {
  /// A polyline is a spline of degree 1 with its corners at 0, 1, 2, ….
  std::variant<Line, Conic, std::shared_ptr<const Curve>> form;
  bool polyline = false;
  bool turned = false;  ///< it runs against its form, as a TRIMMED_CURVE may
};

struct Vertex {
  std::string id;
  Point place = Point::Zero();
  Fault wrong = {};         ///< its place cannot be read
  bool of_one_use = false;  ///< the file refers to it once
};

struct Edge {
  std::string id;
  Index start = none, end = none;  ///< vertices
  bool same_sense = true;          ///< along its curve
  std::shared_ptr<const CurveGeometry> curve = {};
  Fault wrong = {};  ///< without a curve or a vertex
};

/// An edge as a loop runs along it.
struct EdgeUse {
  Index edge = none;
  bool forward = true;
};

/// A bound of a face, with the face on its left as seen from the tip of the face's normal, unless
/// `forward` is false.
struct Bound {
  enum class Kind {
    edges,    ///< one after the other
    polygon,  ///< of points
    vertex,   ///< a pole, or a point that bounds nothing
    unknown,
  };
  Kind kind = Kind::unknown;
  bool forward = true;
  Index vertex = none;
  std::vector<EdgeUse> edges = {};
  std::vector<Point> polygon = {};
  Fault wrong = {};  ///< it, or one of its parts, cannot be read; `edges` are those that can
};

/// What errors call an entity: "#12 ADVANCED_FACE", and its line; 0 in files without lines.
struct Record {
  std::string id, kind;
  int line = 0;
  [[nodiscard]] std::string label() const { return kind.empty() ? id : id + " " + kind; }
};

struct Face : Record {
  /// The surface on which it lies; none: it has only the geometry of its loops.
  Index support = none;
  bool same_sense = true;
  bool turned = false;  ///< inside out: a solid uses its shell turned, as round a hollow
  std::vector<Bound> bounds = {};

  /// 1 where its normal, turned where it is, is that of its surface; else -1. Its bounds run about
  /// the normal of `same_sense`.
  [[nodiscard]] int sense() const { return same_sense != turned ? 1 : -1; }
};

struct Shell {
  std::string id;
  std::vector<Index> faces;
};

/// Planes, and surfaces of revolution of a line or circle, parametrised as in ISO 10303-42.
struct ElementarySurface {
  enum class Kind { plane, cylinder, cone, sphere, torus };
  Kind kind = Kind::plane;
  Frame frame;
  double radius = 0;
  double second = 0;  ///< of a cone its half angle, in one of the model's `angle_units`; of a torus
                      ///< its minor radius
  bool inner = false;  ///< the part of a torus that crosses its axis, within itself
};

struct SweptSurface {
  bool revolution = false;  ///< about the z axis of the frame; else along it
  Frame frame;
  std::shared_ptr<const CurveGeometry> curve = {};
  Fault wrong = {};  ///< without a curve
};

/// A surface on which faces lie.
struct Support : Record {
  Index spline = none;  ///< a B-spline surface of the model, which has no form here
  std::variant<std::monostate, ElementarySurface, SweptSurface> form;
  Fault wrong = {};        ///< without a form
  double uncertainty = 0;  ///< as stated by the file, in its own unit; 0 if none
};

/// A B-spline surface.
struct SplineSurface {
  std::string id;    ///< "#123"
  std::string name;  ///< its label; empty if it has none
  std::string unit;  ///< length unit of its coordinates as in `LengthUnit::name`; "unknown" if it
                     ///< cannot be determined

  /// u is the outer direction of the control points (slow), v the inner one (fast). Numbers are the
  /// correctly rounded doubles of the file's decimals, in the file's units and in the frame of the
  /// surface's own representation.
  Surface surface;

  /// `closed_directions`; the file's own flags are often wrong and are ignored.
  std::array<bool, 2> closed = {false, false};

  /// Some face on this surface covers only part of it: an edge of its bounds leaves the four
  /// boundary isocurves of the surface, or its edges together miss part of a boundary isocurve that
  /// is neither a seam nor a single point. Decided by points sampled on the edges, to twice the
  /// uncertainty the file states (edge and surface may each be off by it), but no less than 1e-5
  /// and no more than 1e-4 of the net's bounding-box diagonal. Where the type of an edge's curve is
  /// unknown (docs/step.md) the face counts as trimmed. A surface that no face uses is untrimmed,
  /// unless something else cuts it.
  bool trimmed = false;

  int faces = 0;           ///< faces of the file that lie on it
  double uncertainty = 0;  ///< as stated by the file, in its own unit; 0 if none
};

/// A B-spline curve in space that stands for itself: no edge, surface or trimmed curve uses it.
struct FreeCurve {
  std::string id, name, unit;  ///< as those of a `SplineSurface`
  Curve curve;
};

/// A surface of a file that could not be made a `Surface`; the others are still usable.
struct UnreadableSurface {
  std::string id;
  Error reason;
};

struct Model;

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
/// `Model::assembly` says where they stand in the model.
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

/// A model, as plain values. Lists are in the order of the file.
struct Model {
  std::string name;  ///< of the file
  std::vector<Vertex> vertices;
  std::vector<Edge> edges;
  std::vector<Face> faces;
  std::vector<Shell> shells;
  std::vector<Support> supports;
  std::vector<SplineSurface> surfaces;
  std::vector<UnreadableSurface> unreadable;
  std::vector<FreeCurve> curves;
  TessellatedItems tessellated;
  std::vector<double> angle_units = {1};     ///< in radians: those that angles of cones may be in
  std::vector<LengthUnit> units;             ///< one per context that assigns one
  std::vector<Instance> instances;           ///< components of assemblies
  Expected<Assembly> assembly = Assembly{};  ///< its parts, and where each of them stands

  /// The B-spline surface with this id, or null.
  [[nodiscard]] const SplineSurface* find_surface(const std::string& id) const;
  /// Its position; `none` if there is no such surface.
  [[nodiscard]] Index surface_index(const std::string& id) const;
  /// The B-spline surface on which a face lies, or null.
  [[nodiscard]] const SplineSurface* spline_under(const Face& face) const;
  /// "#12 PLANE", on which a face lies, or "no surface".
  [[nodiscard]] std::string label_under(const Face& face) const;
  /// The distinct names of `units`, joined by ", " (nearly always one name); "unknown" where there
  /// is none.
  [[nodiscard]] std::string length_unit() const;
  /// An input error at an entity.
  [[nodiscard]] std::unexpected<Error> error(const Record& at, std::string what,
                                             std::string remedy = {}) const;

  /// To be called when `surfaces` is complete.
  void index_surfaces();

 private:
  std::unordered_map<std::string, Index> surface_index_;
};

/// The edges around a face, once for every time a loop runs along them.
[[nodiscard]] std::vector<Index> edges_around(const Face& face);

/// Geometrically closed in u, in v: S(a, ·) and S(b, ·) are the same curve. The two boundary
/// isocurves are split at their ends into control points (and weights) by the basis at the first
/// and last parameter; they are the same curve where these agree to 1e-9 of the net's bounding-box
/// diagonal. A direction along which the whole net is collapsed is not closed.
[[nodiscard]] std::array<bool, 2> closed_directions(const Surface& surface);

/// Adds a part with what is in none of the others, where its coordinates say, unless there is
/// nothing.
void add_rest(const Model& model, Assembly& assembly);

/// A model without an assembly: one part with everything in it, where its coordinates say.
[[nodiscard]] Assembly single_part(const Model& model);

}  // namespace knead::brep
