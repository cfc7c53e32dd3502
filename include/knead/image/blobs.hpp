#pragma once

#include <array>
#include <vector>

#include "knead/image/image.hpp"

namespace knead {

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

/// Blobs of an image, by decreasing contrast: the local maxima, over places and scales, of −σ² ∇²(G_σ * I), which at
/// the centre of a disc of radius r is largest, 2/e of its contrast, at σ = r / √2 (T. Lindeberg, *Feature detection
/// with automatic scale selection*, 1998). Scales grow by 15 %. Of two whose centres are nearer than the larger radius
/// the one with more contrast is kept. Cost: O(scales · pixels · radius). Errors (input): those of `check_image`; radii
/// that are not positive, descending or above 100; a contrast that is negative.
[[nodiscard]] Expected<std::vector<Blob>> find_blobs(const Image& image, const BlobSettings& settings = {});

}  // namespace knead
