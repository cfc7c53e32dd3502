#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/energy/spline_field.hpp"

namespace knead {

/// A grey image: `values[y * width + x]` is the pixel whose centre is at (x, y), x to the right and
/// y down, both from 0. Full white is 1 and black is 0 by convention; any finite numbers will do.
struct Image {
  int width = 0, height = 0;
  std::vector<double> values = {};

  [[nodiscard]] double at(int x, int y) const { return values[index(x, y)]; }
  [[nodiscard]] double& at(int x, int y) { return values[index(x, y)]; }
  friend bool operator==(const Image&, const Image&) = default;

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// What of a colour image its grey values are: the luma of Rec. 709, or one of its colours.
enum class ImageChannel { grey, red, green, blue };
/// The shares of red, green and blue in a channel.
[[nodiscard]] std::array<double, 3> shares_of(ImageChannel channel);

/// Errors (input): no pixels, a wrong number of values, a value that is not finite.
[[nodiscard]] Expected<void> check_image(const Image& image);

/// The image convolved with a Gaussian of that standard deviation in pixels, cut at 4 σ, with the
/// pixels of the border repeated beyond it. σ = 0 returns the image. Cost: O(pixels · σ).
[[nodiscard]] Image gaussian(const Image& image, double sigma);

/// |∇I| by Sobel's masks: √((h² + v²) / 2), h and v the differences over two pixels, halved,
/// averaged 1 : 2 : 1 across. The slope of a ramp is found exactly but for the factor √½ that
/// Sobel's magnitude has by convention. Pixels beyond the border are those of the border.
[[nodiscard]] Image sobel(const Image& image);

/// Distance of every pixel's centre to the nearest pixel whose value is 0.5 or more, in pixels;
/// exact (P. Felzenszwalb and D. Huttenlocher, *Distance transforms of sampled functions*, 2012).
/// Infinite if there is none. Cost: O(pixels).
[[nodiscard]] Image distance_to(const Image& mask);

/// The curvature of the lines of equal grey, (I_yy I_x² − 2 I_xy I_x I_y + I_xx I_y²) / |∇I|³,
/// where the gradient is above 1e-3 of its largest, else 0: large at corners and ends of lines (M.
/// Kass, A. Witkin, D. Terzopoulos, *Snakes: active contour models*, 1988). By differences over two
/// pixels.
[[nodiscard]] Image termination(const Image& image);

/// The gradient vector flow of an edge map f: the (u, v) that minimise ∫ μ (|∇u|² + |∇v|²) + |∇f|²
/// |(u, v) − ∇f|² (C. Xu and J. Prince, *Snakes, shapes, and gradient vector flow*, 1998), by their
/// explicit iteration with f scaled to [0, 1]. Far from edges it still points to them. Cost:
/// O(pixels · iterations).
[[nodiscard]] std::array<Image, 2> gradient_vector_flow(const Image& edges, double mu,
                                                        int iterations);

/// The bicubic spline through the centres of the pixels, mirrored at those of the border (M. Unser,
/// A. Aldroubi and M. Eden, *B-spline signal processing*, 1993): twice continuously differentiable,
/// exact at the pixels to rounding. Beyond the border it has the value and no slope there.
class ImageSpline {
 public:
  explicit ImageSpline(const Image& image);

  [[nodiscard]] double value(double x, double y) const;
  /// ∂/∂x and ∂/∂y; zero in a direction in which the place is beyond the border.
  [[nodiscard]] std::array<double, 2> gradient(double x, double y) const;

  /// The same spline as a field over [0, width − 1] × [0, height − 1], on unclamped uniform knots.
  /// Needs an image of at least two by two pixels.
  [[nodiscard]] Expected<SplineField<2>> field() const;

 private:
  int width_, height_;
  std::vector<double> coefficients_;  ///< (width + 2) × (height + 2), one beyond each border
};

/// What of an image attracts a contour. A positive weight draws it to what is bright, has edges, is
/// curved, is near.
struct ImagePotentialSettings {
  /// Σ of the Gaussian that everything but the mask is taken at, pixels; 0: none.
  double smoothing = 1;
  double line = 0;         ///< weight of the intensity (thesis Eq. 2.29, whose P is minus this)
  double edge = 1;         ///< weight of the gradient's magnitude (`sobel`)
  double termination = 0;  ///< weight of the curvature of lines of equal grey (`termination`)
  /// Weight of the gradient vector flow of the gradient's magnitude, directions only.
  double flow = 0;
  double flow_smoothness = 0.2;  ///< its μ
  int flow_iterations = 200;
  /// Weight of the region term: grey values inside and outside like their means.
  double region = 0;
  /// Divides the region term by (μ_in − μ_out)² and limits it to ±1: the same force for what is
  /// pale and what is bright.
  bool relative_region = false;
  double distance = 0;  ///< weight of the nearness to the mask

  friend bool operator==(const ImagePotentialSettings&, const ImagePotentialSettings&) = default;
};

/// Errors (input): weights that are no numbers; negative smoothing, μ or iterations; too much of
/// them.
[[nodiscard]] Expected<void> check_potential_settings(const ImagePotentialSettings& settings);

/// The external energy of snakes in one image: −P of thesis Eqs. 2.28 to 2.30 as a C2 function, and
/// forces that are no gradient.
///
/// Q = line · I + edge · |∇I| + termination · κ − distance · d at pixels, between them the bicubic
/// spline through these; the force is ∇Q. With `flow` the unit vectors of the gradient vector flow
/// are added, interpolated as splines. The region term (T. Chan and L. Vese, *Active contours
/// without edges*, 2001) acts along the normal of a closed contour with (I − μ_out)² − (I − μ_in)²,
/// the means over its inside and outside. Copies share the images.
class ImagePotential {
 public:
  /// `mask` is needed for `distance`. Cost: O(pixels · (smoothing + flow iterations)). Errors
  /// (input): those of `check_image`; no mask, one of another size or without a pixel of 0.5 or
  /// more; settings that are no numbers, negative smoothing, μ or iterations.
  [[nodiscard]] static Expected<ImagePotential> create(const Image& image,
                                                       const ImagePotentialSettings& settings = {},
                                                       const std::optional<Image>& mask = {});

  [[nodiscard]] const ImagePotentialSettings& settings() const;
  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;

  /// Q at a place.
  [[nodiscard]] double value(double x, double y) const;
  /// ∇Q and the flow's force.
  [[nodiscard]] std::array<double, 2> force(double x, double y) const;

  /// The smoothed intensity.
  [[nodiscard]] double intensity(double x, double y) const;
  /// ∫ I dx from the left border to x at height y: by Green's theorem its integral along a closed
  /// contour, dy, is the sum of the intensity inside. Where the region term has no weight, 0.
  [[nodiscard]] double intensity_to_the_left(double x, double y) const;
  /// Of the smoothed image over its pixels.
  [[nodiscard]] double total_intensity() const;

 private:
  struct Fields;
  explicit ImagePotential(std::shared_ptr<const Fields> fields) : fields_(std::move(fields)) {}
  std::shared_ptr<const Fields> fields_;
};

/// A place that is brighter, or darker, than what is around it.
struct Blob {
  double x = 0, y = 0;  ///< its centre, a pixel's
  double radius = 0;    ///< of the disc that answers most alike, pixels
  double contrast = 0;  ///< of that disc with what is around
};

struct BlobSettings {
  std::array<double, 2> radii = {5, 20};  ///< least and largest, pixels
  double contrast = 0.05;                 ///< least
  bool dark = false;                      ///< darker than what is around them
};

/// Blobs of an image, by decreasing contrast: the local maxima, over places and scales, of −σ²
/// ∇²(G_σ * I), which at the centre of a disc of radius r is largest, 2/e of its contrast, at σ = r
/// / √2 (T. Lindeberg, *Feature detection with automatic scale selection*, 1998). Scales grow by 15
/// %. Of two whose centres are nearer than the larger radius the one with more contrast is kept.
/// Cost: O(scales · pixels · radius). Errors (input): those of `check_image`; radii that are not
/// positive, descending or above 100; a contrast that is negative.
[[nodiscard]] Expected<std::vector<Blob>> find_blobs(const Image& image,
                                                     const BlobSettings& settings = {});

}  // namespace knead
