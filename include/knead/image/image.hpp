#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/energy/spline_field.hpp"

namespace knead {

/// A grey image: `values[y * width + x]` is the pixel whose centre is at (x, y), x to the right and y down, both from
/// 0. Full white is 1 and black is 0 by convention; any finite numbers will do.
struct Image {
  int width = 0, height = 0;
  std::vector<double> values = {};

  [[nodiscard]] double at(int x, int y) const { return values[index(x, y)]; }
  [[nodiscard]] double& at(int x, int y) { return values[index(x, y)]; }
  friend bool operator==(const Image&, const Image&) = default;

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// What of a colour image its grey values are: the luma of Rec. 709, or one of its colours.
enum class ImageChannel { grey, red, green, blue };

/// Errors (input): no pixels, a wrong number of values, a value that is not finite.
[[nodiscard]] Expected<void> check_image(const Image& image);

/// The image convolved with a Gaussian of that standard deviation in pixels, cut at 4 σ, with the pixels of the border
/// repeated beyond it. σ = 0 returns the image. Cost: O(pixels · σ).
[[nodiscard]] Image gaussian(const Image& image, double sigma);

/// |∇I| by Sobel's masks: √((h² + v²) / 2), h and v the differences over two pixels, halved, averaged 1 : 2 : 1 across.
/// The slope of a ramp is found exactly but for the factor √½ that Sobel's magnitude has by convention. Pixels beyond
/// the border are those of the border.
[[nodiscard]] Image sobel(const Image& image);

/// Distance of every pixel's centre to the nearest pixel whose value is 0.5 or more, in pixels; exact (P. Felzenszwalb
/// and D. Huttenlocher, *Distance transforms of sampled functions*, 2012). Infinite if there is none. Cost: O(pixels).
[[nodiscard]] Image distance_to(const Image& mask);

/// The curvature of the lines of equal grey, (I_yy I_x² − 2 I_xy I_x I_y + I_xx I_y²) / |∇I|³, where the gradient is
/// above 1e-3 of its largest, else 0: large at corners and ends of lines (M. Kass, A. Witkin, D. Terzopoulos, *Snakes:
/// active contour models*, 1988). By differences over two pixels.
[[nodiscard]] Image termination(const Image& image);

/// The gradient vector flow of an edge map f: the (u, v) that minimise ∫ μ (|∇u|² + |∇v|²) + |∇f|² |(u, v) − ∇f|² (C.
/// Xu and J. Prince, *Snakes, shapes, and gradient vector flow*, 1998), by their explicit iteration with f scaled to
/// [0, 1]. Far from edges it still points to them. Cost: O(pixels · iterations).
[[nodiscard]] std::array<Image, 2> gradient_vector_flow(const Image& edges, double mu, int iterations);

/// The bicubic spline through the centres of the pixels, mirrored at those of the border (M. Unser, A. Aldroubi and M.
/// Eden, *B-spline signal processing*, 1993): twice continuously differentiable, exact at the pixels to rounding.
/// Beyond the border it has the value and no slope there.
class ImageSpline {
 public:
  explicit ImageSpline(const Image& image);

  [[nodiscard]] double value(double x, double y) const;
  /// ∂/∂x and ∂/∂y; zero in a direction in which the place is beyond the border.
  [[nodiscard]] std::array<double, 2> gradient(double x, double y) const;

  /// The same spline as a field over [0, width − 1] × [0, height − 1], on unclamped uniform knots. Needs an image of at
  /// least two by two pixels.
  [[nodiscard]] Expected<SplineField<2>> field() const;

 private:
  int width_, height_;
  std::vector<double> coefficients_;  ///< (width + 2) × (height + 2), one beyond each border
};

}  // namespace knead
