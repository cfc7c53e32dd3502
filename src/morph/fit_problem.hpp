#pragma once

#include <limits>
#include <numbers>

#include "affine_part.hpp"
#include "fit_system.hpp"

namespace knead::morph {

/// What all parts of a fit need to know: what is given, in the units of the fit, and the nets as
/// they are.
struct FitProblem {
  std::span<const FitSurface> given;
  std::span<const FitEdge> edges;
  FitSettings settings;
  double size = 0, tolerance = 0, parting = 0;
  std::vector<FitUnits> units = {};
  std::vector<FitPoint> points = {};  ///< on free surfaces; wanted: what the affine part leaves
  std::vector<FitExcess> contradicted = {};  ///< the worst data that contradict what stays
  AffinePart affine = {};
  FitNets nets = {};
  double lambda = std::numeric_limits<double>::infinity();  ///< of the nets before
  std::vector<std::array<double, 2>> shares = {};           ///< of the weights of each joint
  /// By what factor each joint's positions and angles were too large when they last asked for finer
  /// nets; 0: finer nets did not help.
  std::vector<std::array<double, 2>> asked = {};
  /// By what factor a measure of a joint was too large when more weight last helped, and the share
  /// that it had then.
  struct Pressed {
    double excess = std::numeric_limits<double>::infinity(), share = 1;
  };
  std::vector<std::array<Pressed, 2>> pressed = {};
  std::vector<double> excess = {};  ///< of data with noise, of each surface, likewise

  [[nodiscard]] bool satisfied(const FitState& state) const {
    return state.largest_residual <= tolerance && state.largest_parting <= parting &&
           state.largest_slope <= settings.angle * std::numbers::pi / 180;
  }
};

/// Checks what is given, places the data on the surfaces and takes the affine part from them. The
/// nets are those given. Errors: as of `fit_surfaces`.
[[nodiscard]] Expected<FitProblem> pose_problem(std::span<const FitSurface> surfaces,
                                                std::span<const FitEdge> edges,
                                                std::span<const Datum> data,
                                                const FitSettings& settings);

/// Gives the nets that are not fixed clamped ends and degree 3 at least. Errors: those of
/// `elevate_degree`.
[[nodiscard]] Expected<void> raise_degrees(FitProblem& problem);

/// Gives the nets the knots of `FitSettings::begin_with` too. Errors: those of `insert_knots`.
[[nodiscard]] Expected<void> take_knots(FitProblem& problem);

/// The surfaces moved by X and the affine part; fixed ones, and those that nothing moves, are the
/// ones given.
[[nodiscard]] Expected<std::vector<Surface>> moved(const FitProblem& problem, const Points& x);

/// The result where the affine part leaves nothing of the data but rounding; none where it leaves
/// more. The nets stay as they were given.
[[nodiscard]] Expected<std::optional<FitResult>> affine_result(FitProblem& problem);

}  // namespace knead::morph
