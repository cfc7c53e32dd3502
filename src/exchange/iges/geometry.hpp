#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>

#include "file.hpp"
#include "knead/spline/spline.hpp"

namespace knead::iges {

/// Where the numbers of a B-spline curve or surface stand among the parameters of its entity (126,
/// 128).
struct SplineLayout {
  std::array<int, 2> degree = {1, 1}, count = {1, 1};  ///< a curve has the first
  std::array<std::size_t, 2> knots = {};               ///< first knot of each direction
  std::size_t weights = 0, points = 0,
              domain = 0;  ///< first weight, coordinate, and limit of the parameters
  std::size_t end = 0;     ///< one after the last number that describes it
};

/// Errors (input): counts or degrees out of range, or more numbers than there are.
[[nodiscard]] Expected<SplineLayout> surface_layout(const File& file, int number,
                                                    const Parameters& parameters);

[[nodiscard]] Expected<SplineLayout> curve_layout(const File& file, int number,
                                                  const Parameters& parameters);

/// Of the entity's transformation matrix (124) and those of that; the identity if it has none.
/// Errors (input): numbers that cannot be read, or that are not those of an invertible matrix; it
/// refers to itself.
[[nodiscard]] Expected<Eigen::Affine3d> transform_of(const File& file, int number);

/// A B-spline surface (128), or a parametric spline surface (114) or ruled surface (118) as one, in
/// the coordinates of the model, moved by `outer` and its own matrix. It has no weights if all of
/// them are equal. u is slow and v fast, as in `Surface`; the file has u fast. Errors (input):
/// those above; a degree above `max_degree`; knots or weights that make no surface.
[[nodiscard]] Expected<Surface> read_surface(const File& file, int number,
                                             const Eigen::Affine3d& outer);

/// A parametric spline surface (114), whose patches of cubic polynomials are made B-splines exactly
/// but for rounding, with triple knots. Errors (input): numbers that cannot be read; patches that
/// do not meet.
[[nodiscard]] Expected<Surface> read_power_surface(const File& file, int number,
                                                   const Eigen::Affine3d& move);

/// A ruled surface (118) between two lines (110) or B-spline curves (126) over 0 … 1 in both
/// directions, exact but for rounding: both curves get the larger degree and all knots. Errors
/// (input): numbers that cannot be read; what is no B-spline surface or is not made one: points
/// joined by equal lengths along curves (form 0) that are not both lines, other curves, curves with
/// different weights.
[[nodiscard]] Expected<Surface> read_ruled_surface(const File& file, int number,
                                                   const Eigen::Affine3d& move);

/// A B-spline curve (126), likewise.
[[nodiscard]] Expected<Curve> read_curve(const File& file, int number,
                                         const Eigen::Affine3d& outer);

/// All of the parameters from `first` on as numbers. Error (input): one that is none, or too few.
[[nodiscard]] Expected<std::vector<double>> numbers(const File& file, int number,
                                                    const Parameters& parameters, std::size_t first,
                                                    std::size_t count);

}  // namespace knead::iges
