#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "knead/brep/model.hpp"

namespace knead::brep {

/// What an edge is, by its faces and how they meet. A smooth edge is one at which they meet at less
/// than `meant_smooth` everywhere.
enum class EdgeKind {
  unknown,       ///< its curve, or one of its faces, cannot be followed
  open,          ///< of one face
  seam,          ///< of one face that is on both of its sides
  non_manifold,  ///< of more than two faces
  gap,           ///< its faces, or it and a face, are farther apart than the tolerance
  sharp,         ///< smooth nowhere
  partly,        ///< smooth on a part of it only
  g0,            ///< smooth, but the angle is above the tolerance somewhere
  g1,            ///< tangent planes agree, curvatures across the edge do not
  g2,            ///< curvatures agree too
};

/// A point of an edge, and its nearest points on the surfaces of its faces.
struct EdgePlace {
  std::array<double, 3> point = {};  ///< of the edge's curve
  /// One pair for each of `EdgeMeasures::faces`, of a seam two. Of B-spline surfaces fractions of
  /// the domain; of others the parameters of ISO 10303-42, angles in radians, the v of a cone being
  /// the height.
  std::vector<std::array<double, 2>> parameters;
};

/// The largest value of a measure along an edge, and where it is taken.
struct EdgeFigure {
  double value = 0;
  EdgePlace at;
};

/// How the faces at an edge meet. Lengths are in units of the coordinates.
///
/// With p a point of the curve of the edge and q_a, q_b the nearest points to p of the surfaces
/// under its faces (not cut by their bounds), n_a, n_b their unit normals there, turned such that
/// the face is to the left of the way its bound runs, and κ_a, κ_b the normal curvatures of the
/// surfaces in the direction perpendicular to the edge within the mean of both tangent planes:
/// - gap: max |q_a − q_b|, of several faces the largest of any two; of one face max |p − q_a|;
/// - off_curve: max |p − q| over all its faces;
/// - angle: max ∠(n_a, n_b) = max atan2(|n_a × n_b|, n_a · n_b), degrees: 0 is smooth, 180
///   a knife's edge;
/// - curvature: max |κ_a − κ_b|, 1/length, where the angle is at most `compared_angle` or the
///   tolerance of angles; 0 where |κ_a| and |κ_b| are both below 1e-3 / size;
/// - relative_curvature: max 100 |κ_a − κ_b| / (|κ_a| + |κ_b|) there, percent from 0 to 100.
///
/// At knots that the edge crosses the limits of both sides count; along a knot line the limit is
/// that of the side of the face. Points without a tangent plane, as at poles, have no angle.
struct EdgeMeasures {
  std::string id;                  ///< of the edge, "#12"
  std::vector<std::string> faces;  ///< their ids, in the order of the file, each once
  EdgeKind kind = EdgeKind::unknown;
  std::string reason = {};  ///< why nothing is known; empty: it is
  double length = 0;
  std::array<double, 3> start = {}, middle = {}, end = {};  ///< of the curve, at half its parameter
  std::optional<EdgeFigure> gap = {}, off_curve = {};       ///< none: unknown
  std::optional<EdgeFigure> angle = {};                     ///< none: of one face only
  std::optional<double> least_angle = {};                   ///< along the edge, degrees
  double smooth_share = 0;  ///< of its length, where the angle is at most the tolerance
  std::optional<EdgeFigure> curvature = {},
                            relative_curvature = {};  ///< none: its faces are nowhere tangent
  int samples = 0;                                    ///< points of the edge that were looked at
  /// Points along it for drawing, from its start to its end: chords are within 1e-3 of the radius,
  /// or of half the extent of a curve that is no conic.
  std::vector<std::array<double, 3>> course = {};
};

/// Edges at which faces meet at less than this all along, degrees, are meant to be smooth: joints
/// that should be tangent are off by some tenths of a degree up to a few, and designed creases,
/// chamfers and the edges of fillets that were left out turn by far more.
inline constexpr double meant_smooth = 5;
/// Faces that meet at no larger angle, degrees, are compared in curvature.
inline constexpr double compared_angle = 0.5;

/// By how much faces may miss each other and still count as joined.
struct EdgeTolerances {
  /// In units of the coordinates; none: the largest uncertainty that the file states for its
  /// surfaces, but at least 1e-6 of the model's size.
  std::optional<double> gap = {};
  double angle = 0.1;    ///< degrees
  double curvature = 5;  ///< percent of relative curvature difference
};

/// The edges of a model.
struct ModelMeasures {
  double size = 0;           ///< diagonal of the box of all edges
  double gap_tolerance = 0;  ///< that was used
  std::vector<EdgeMeasures> edges = {};
};

/// Measures edges of a model that faces use, each once, in the order of the file; of those with
/// `ids` only, unless it is empty. Where two edges of one face each run beside each other, the part
/// along which they do is measured as an edge of both faces, "#12+#15", and so are the sides of
/// B-spline surfaces without faces, "#55.u0" (docs/check.md). Faces on every surface that can be
/// drawn are followed: B-splines, planes, cylinders, cones, spheres, tori, surfaces of revolution
/// and of linear extrusion.
///
/// Edges are sampled at both ends, the knots of their curve and those of the surfaces that they
/// cross, and evenly at 17 points or more; the steps are halved until no largest value changes by
/// more than half a percent, up to 600 points, and around the largest values a golden-section
/// search follows. Accuracy: each figure to 1 % of itself, unless it is below 1e-9 of the size, an
/// angle of 1e-6 degrees; curves that oscillate between the samples of a span may hide more. Errors
/// (input): no edge with one of `ids`. What cannot be followed is `unknown` with a reason. Cost: 40
/// searches for the nearest point on each face or more per edge, shared among threads by edges; the
/// result is the same with any number of them.
[[nodiscard]] Expected<ModelMeasures> measure_edges(const Model& model,
                                                    const EdgeTolerances& tolerances = {},
                                                    std::span<const std::string> ids = {});

/// Largest values that are accepted; none: not judged.
struct EdgeThresholds {
  std::optional<double> gap = {};        ///< in units of the coordinates
  std::optional<double> angle = {};      ///< degrees
  std::optional<double> curvature = {};  ///< percent
};

/// What of an edge is above a threshold.
struct EdgeFault {
  std::string edge, measure;  ///< "gap", "angle", "curvature"; "faces" of one that has come open
  double value = 0, limit = 0;
  std::optional<double> before = {};  ///< as it was in the model it is compared with
};

/// The measures of edges above their thresholds, in the order of edges: the larger of gap and
/// off_curve; the angle and the relative curvature difference of edges that are meant to be smooth
/// (g0, g1, g2; with gaps too, where the angle is less than `meant_smooth`).
[[nodiscard]] std::vector<EdgeFault> faults_of(const ModelMeasures& measures,
                                               const EdgeThresholds& thresholds);

/// The measures of edges that exceed those of the same edge in `before` by more than the
/// thresholds; the angle and curvature of edges that were meant to be smooth there. Edges that are
/// not there are judged by themselves. An edge of one face that had more there has come open.
///
/// An edge is the one with the same id, if most of the edges with common ids begin and end in the
/// same places; else, and where the id is new, the one whose ends and middle are nearest, within
/// 1e-3 of the size, in either direction.
[[nodiscard]] std::vector<EdgeFault> faults_against(const ModelMeasures& measures,
                                                    const ModelMeasures& before,
                                                    const EdgeThresholds& thresholds);

/// How many edges there are of a kind.
struct EdgeCount {
  EdgeKind kind = EdgeKind::unknown;
  int count = 0;
};
/// Of every kind that there is, in the order of `EdgeKind`.
[[nodiscard]] std::vector<EdgeCount> counts_of(std::span<const EdgeMeasures> edges);

/// What `knead check` says of a file.
struct EdgeCheckReport {
  std::string file = {}, format = {}, unit = {};
  std::string against = {};  ///< the file it is compared with; empty: none
  EdgeThresholds thresholds = {};
  double size = 0, gap_tolerance = 0, angle_tolerance = 0, curvature_tolerance = 0;
  std::vector<EdgeCount> counts = {};
  std::vector<EdgeMeasures> edges = {};
  std::vector<EdgeFault> faults = {};
  bool passed = true;  ///< there are no faults
};

/// It as JSON, over several lines (docs/check.md), and the schema of that.
[[nodiscard]] std::string check_json(const EdgeCheckReport& report);
[[nodiscard]] std::string check_schema();

/// It as a JUnit report: one test suite with a test case for each edge, failed if it has faults,
/// skipped if it is unknown.
[[nodiscard]] std::string check_junit(const EdgeCheckReport& report);

/// "non-manifold", as text and JSON call it.
[[nodiscard]] std::string_view name_of(EdgeKind kind);

}  // namespace knead::brep
