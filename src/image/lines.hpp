#pragma once

#include <cstddef>
#include <vector>

/// Operations on one line of samples, of images and of volumes.
namespace knead::detail {

/// Of a Gaussian of that standard deviation above 0, cut at 4 σ: an odd number, with the sum 1.
[[nodiscard]] std::vector<double> gaussian_weights(double sigma);

/// min_j (f_j + step² (i − j)²) for all i: the lower envelope of parabolas.
void lower_envelope(const std::vector<double>& f, std::vector<double>& result, double step = 1);

/// Cubic spline coefficients of one line of n samples with stride, mirrored at its ends: in place,
/// by the recursive filter with the pole √3 − 2.
void interpolate_line(double* line, std::size_t stride, int n);

/// The same of `count` lines side by side, element k of line i at [k * stride + i].
void interpolate_lines(double* lines, std::size_t count, std::size_t stride, int n);

/// The four uniform cubic B-splines, or their derivatives, at t in [0, 1] of the span that they
/// share.
void cubic_basis(double t, double* values, bool derivative);

}  // namespace knead::detail
