#pragma once

#include <array>
#include <memory>
#include <optional>

#include "knead/image/image.hpp"

namespace knead {

/// What of an image attracts a contour. A positive weight draws it to what is bright, has edges, is curved, is near.
struct ImagePotentialSettings {
  double smoothing = 1;          ///< σ of the Gaussian that everything but the mask is taken at, pixels; 0: none
  double line = 0;               ///< weight of the intensity (thesis Eq. 2.29, whose P is minus this)
  double edge = 1;               ///< weight of the gradient's magnitude (`sobel`)
  double termination = 0;        ///< weight of the curvature of lines of equal grey (`termination`)
  double flow = 0;               ///< weight of the gradient vector flow of the gradient's magnitude, directions only
  double flow_smoothness = 0.2;  ///< its μ
  int flow_iterations = 200;
  double region = 0;  ///< weight of the region term: grey values inside and outside like their means
  /// Divides the region term by (μ_in − μ_out)² and limits it to ±1: the same force for what is pale and what is
  /// bright.
  bool relative_region = false;
  double distance = 0;  ///< weight of the nearness to the mask

  friend bool operator==(const ImagePotentialSettings&, const ImagePotentialSettings&) = default;
};

/// Errors (input): weights that are no numbers; negative smoothing, μ or iterations; too much of them.
[[nodiscard]] Expected<void> check_potential_settings(const ImagePotentialSettings& settings);

/// The external energy of snakes in one image: −P of thesis Eqs. 2.28 to 2.30 as a C2 function, and forces that are no
/// gradient.
///
/// Q = line · I + edge · |∇I| + termination · κ − distance · d at pixels, between them the bicubic spline through
/// these; the force is ∇Q. With `flow` the unit vectors of the gradient vector flow are added, interpolated as splines.
/// The region term (T. Chan and L. Vese, *Active contours without edges*, 2001) acts along the normal of a closed
/// contour with (I − μ_out)² − (I − μ_in)², the means over its inside and outside. Copies share the images.
class ImagePotential {
 public:
  /// `mask` is needed for `distance`. Cost: O(pixels · (smoothing + flow iterations)). Errors (input): those of
  /// `check_image`; no mask, one of another size or without a pixel of 0.5 or more; settings that are no numbers,
  /// negative smoothing, μ or iterations.
  [[nodiscard]] static Expected<ImagePotential> create(const Image& image, const ImagePotentialSettings& settings = {},
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
  /// ∫ I dx from the left border to x at height y: by Green's theorem its integral along a closed contour, dy, is the
  /// sum of the intensity inside. Where the region term has no weight, 0.
  [[nodiscard]] double intensity_to_the_left(double x, double y) const;
  /// Of the smoothed image over its pixels.
  [[nodiscard]] double total_intensity() const;

 private:
  struct Fields;
  explicit ImagePotential(std::shared_ptr<const Fields> fields) : fields_(std::move(fields)) {}
  std::shared_ptr<const Fields> fields_;
};

}  // namespace knead
