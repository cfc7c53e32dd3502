#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead::morph {

/// What was measured of a part: points, and how the part faces there.
struct Scan {
  std::vector<Point> points;
  /// One for each point, of length 1 and of either sense; (0, 0, 0) where it is not known.
  std::vector<Point> normals;
};

/// A scan with normals: those given, one per point and of any length; else, of meshes, the sum of
/// the vectors of the triangles round each point, a × b, so that large ones count more; else those
/// of the planes that fit the 12 nearest points best. Of a point whose triangles face apart by more
/// than 45° from their mean, as at sharp edges, nothing is known. Points are numbered from 0 in
/// `triangles`. Requires: these numbers are less than the count of points (asserted). Results do
/// not depend on the number of threads. Cost: O(n log n).
[[nodiscard]] Scan scan_of(std::vector<Point> points, std::vector<Point> normals,
                           std::span<const std::array<std::uint32_t, 3>> triangles);

/// The standard deviation of each coordinate of the points of a surface, estimated from the points
/// alone: σ² = (16 s₂₀² − s₄₀²) / 15 with s_k the median over up to 4,000 of them of
///
///   √(Σ r² / (k − 10)),
///
/// r the distances of the k nearest points from the cubic z(x, y), 10 coefficients, that fits them
/// best over their plane; divided by the median that this has where noise is normal and of
/// deviation 1, (1 − 2 / (9 (k − 10)))^(3/2) (E. Wilson and M. Hilferty, 1931, for χ²). What a
/// cubic cannot follow is of fourth order and 4 times as large for twice the points: the difference
/// takes it away. Points beside edges and outliers hardly change it as long as they are few. Noise
/// that neighbours have in common counts as shape. 0 of fewer than 40 points. Accuracy: 5 % of
/// independent noise. Cost: 80 µs for each of those points, and O(n log n).
[[nodiscard]] double estimated_noise(std::span<const Point> points);

/// Up to 4,000 points, evenly chosen, with the nearest other one of each. Cost: O(n log n).
[[nodiscard]] std::vector<std::array<std::uint32_t, 2>> neighbour_pairs(
    std::span<const Point> points);

/// One point in each cube of a grid of this side in which there are some, the first: their
/// positions, ascending. Requires: side > 0.
[[nodiscard]] std::vector<std::size_t> thinned(std::span<const Point> points, double side);

}  // namespace knead::morph
