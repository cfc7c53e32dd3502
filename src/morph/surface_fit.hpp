#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "brep/shared_edge.hpp"
#include "knead/hold/constraints.hpp"

namespace knead::morph {

/// A displacement wanted at a point of a surface, in file units.
struct Datum {
  int surface = 0;                        ///< position in the list of surfaces
  std::array<double, 2> parameters = {};  ///< within the domain of that surface
  Point displacement = Point::Zero();
  double weight = 1;  ///< relative to the other data of this surface; >= 0
  /// Of length 1: only the part of the displacement along it is known; zero: all of it is.
  Point along = Point::Zero();
};

/// What a surface keeps, exactly.
struct SurfaceHolds {
  /// Conditions on the displacements of the control points of a net, whose surface is the one that
  /// was given; their right sides do not count: displacements are zero, or perpendicular to a
  /// normal. Control points that are held keep their bits.
  std::function<Expected<ConstraintList>(const Surface& net)> conditions = {};
  /// Lines and points of it that keep their place, as parameters, beside those whose control points
  /// are all held. Between its corners a line is one of parameters, or short.
  std::vector<std::vector<std::array<double, 2>>> places = {};
  /// By direction: its knots stay symmetric, as they are.
  std::array<bool, 2> mirrored = {false, false};
};

/// A surface of the model and what its faces show of it.
struct FitSurface {
  std::shared_ptr<const Surface> surface;
  VisibleRegion region = {};
  bool fixed = false;     ///< keeps its control points, and holds its neighbours' edges
  std::string name = {};  ///< what errors call it; empty: its position in the list
  std::shared_ptr<const SurfaceHolds> holds = {};  ///< null: nothing else is kept
};

/// An edge at which surfaces stay together.
struct FitEdge {
  std::shared_ptr<const SharedEdge> course;
  std::vector<int> surfaces;  ///< position of each of `course->surfaces()` in the list of surfaces
  /// In place of a course, which is null then: points of the edge with a foot on each surface.
  /// Between them feet are those of the chord in fractions: exact for edges along lines of
  /// parameters.
  std::vector<SharedEdge::Sample> samples = {};
  std::string name = {};  ///< with `samples`: what the edge is called
  /// Its surfaces keep their place along it, as beside a face that is none of the surfaces.
  bool held = false;
};

struct FitSettings {
  /// The largest residual wanted at data, file units; none: 1e-5 of the size.
  std::optional<double> tolerance = {};
  /// Standard deviation of each coordinate of the data, file units; none: the data are exact, and
  /// `tolerance` is what is sought. Else rounds and λ end where the residuals are of that size.
  std::optional<double> noise = {};
  std::optional<double> energy = {};   ///< λ > 0; none: chosen
  std::optional<double> parting = {};  ///< largest at edges, file units; none: 7e-7 of the size
  /// Largest at edges that can be borne, file units, if more than `parting`: edges above it are
  /// closed at the cost of residuals; none: `parting`.
  std::optional<double> allowed_parting = {};
  /// The displacement at every point of space, if it is known there: sides of an edge that are
  /// parted by more than `parting` move apart as it says. Empty: they move alike.
  std::function<Expected<Point>(const Point&)> displacement = {};
  /// Whether the affine map that fits the data best is taken from them before. It goes on beyond
  /// the data, where displacements run out flat without it.
  bool affine = true;
  double angle = 0.02;  ///< largest by which tangent planes at smooth edges turn apart, degrees
  /// At most so many times the control points that all surfaces have after raising to degree 3.
  double refinement = 8;
  /// Repeated solves on each factor, exactly; none: as needed. If given, weights are never changed,
  /// and on nets that are not refined displacements are linear in data that contradict no hold.
  std::optional<int> rounds = {};
  /// The surfaces of a fit of similar data to the same surfaces, and the λ of that fit: nets have
  /// their knots and λ is sought from there. Empty: the surfaces as they are.
  std::span<const Surface> begin_with = {};
  std::optional<double> begin_with_energy = {};
};

/// What is larger than wanted after the fit.
struct FitExcess {
  enum class Measure {
    residual,       ///< of a datum, file units
    parting,        ///< of the surfaces at an edge, file units
    angle,          ///< at a smooth edge or knot line, degrees
    contradiction,  ///< of a datum, what it wants where surfaces stay or are held, file units
  };
  Measure measure = Measure::residual;
  int surface = 0;
  std::array<double, 2> parameters = {};  ///< on that surface
  Point place = Point::Zero();            ///< before the displacement
  std::string edge = {};                  ///< its name; empty where the measure is not of an edge
  double found = 0, wanted = 0;
  int count = 1;  ///< data of that surface that contradict; this is the worst
};

struct FitResult {
  std::vector<Surface> surfaces = {};  ///< in the order given
  double lambda = 0;       ///< that was used at last; 0: the affine map alone was enough
  int rounds = 0;          ///< solves on the last factor
  int refinements = 0;     ///< times that knots were inserted
  int control_points = 0;  ///< of all surfaces
  double size = 0;         ///< diagonal of the box of the visible edges and data
  double largest_residual = 0, rms_residual = 0;  ///< of data on surfaces that are not fixed
  double largest_parting = 0;                     ///< |Δ displacement| at edges, file units
  double largest_angle = 0;  ///< between tangent planes at smooth edges and knot lines, degrees
  std::vector<FitExcess> above = {};  ///< by measure, the worst of every surface or edge
};

/// Moves surfaces so that their points follow data, and keeps them together at edges: the
/// displacement D_s = Σ R_ij X_ij of every surface s, R its rational basis with unchanged weights,
/// that minimises over all surfaces at once
///
///   Σ_data w |D − d|² + ρ_0 Σ_edges |D_a − D_b|² + ρ_1 Σ_smooth |∂D_a − ∂D_b|² + λ Σ_s E_s(D_s),
///
/// with ∂ the derivative by length across the edge, and E_s stretch and bend on the whole domain in
/// the units of each surface (`normalised_scaling`). The affine map that fits the data best is
/// taken from them before and applied to all control points, exactly. Iterated Tikhonov
/// regularisation (H. Engl, M. Hanke, A. Neubauer, *Regularization of Inverse Problems*, 1996,
/// 5.1): X ← X + (M + λK)⁻¹ (b − M X) on one factor, until tolerance or, of data with noise, the
/// discrepancy principle; then knots are inserted where residual, parting or angle ask for it.
/// Poles stay points and closed surfaces closed, exactly. docs/design/morph.md.
///
/// What surfaces keep (`SurfaceHolds`) is eliminated from the unknowns, and so exact to rounding.
/// Data that contradict what is fixed, held or kept are faded out towards it (`fade_at_holds`), and
/// listed.
///
/// Data that are zero give the surfaces as they are, bit for bit; an affine map gives its image on
/// the nets as they are. Results do not depend on the number of threads.
///
/// Errors (input): a number that is not finite, parameters outside the domain, an index out of
/// range, no datum on a surface that is free; (numerical) a denominator that is not positive; those
/// of `SurfaceHolds::conditions`; those of an `Interruption`. Cost: a few sparse factorisations and
/// about twenty solves on each; 300 bytes of memory per datum.
[[nodiscard]] Expected<FitResult> fit_surfaces(std::span<const FitSurface> surfaces,
                                               std::span<const FitEdge> edges,
                                               std::span<const Datum> data,
                                               const FitSettings& settings = {});

}  // namespace knead::morph
