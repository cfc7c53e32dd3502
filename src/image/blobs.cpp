#include "knead/image/image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ranges>

namespace knead {
namespace {

constexpr double growth = 1.15;  // from scale to scale

/// The contrast of the disc of radius √2 σ that would answer so, at each pixel.
///
/// −σ² ∇²(G_σ * I) is 2/e of the contrast at the centre of such a disc (Lindeberg 1998); times e/2
/// it is the contrast itself, comparable from scale to scale. The factor σ² is what makes it so:
/// without it derivatives of ever smoother images only shrink. The Laplacian is the five-point
/// difference, exact to a share of O(1/σ²).
Image answers(const Image& image, double sigma, double sign) {
  const Image smooth = gaussian(image, sigma);
  Image result = smooth;
  const double scale = -sign * sigma * sigma * std::numbers::e / 2;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int left = std::max(x - 1, 0), right = std::min(x + 1, image.width - 1);
      const int up = std::max(y - 1, 0), down = std::min(y + 1, image.height - 1);
      result.at(x, y) = scale * (smooth.at(left, y) + smooth.at(right, y) + smooth.at(x, up) +
                                 smooth.at(x, down) - 4 * smooth.at(x, y));
    }
  }
  return result;
}

/// Whether no neighbour at this and the next scales answers more.
///
/// Of 26 neighbours in space and scale. Equal ones do not forbid: what lies double is removed
/// afterwards, when blobs nearer than the larger radius are left out.
bool is_largest(const std::vector<Image>& scales, std::size_t k, int x, int y) {
  const double here = scales[k].at(x, y);
  for (std::size_t scale = k > 0 ? k - 1 : 0; scale < std::min(k + 2, scales.size()); ++scale) {
    const Image& image = scales[scale];
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, image.height - 1); ++j) {
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, image.width - 1); ++i) {
        if (image.at(i, j) > here) return false;
      }
    }
  }
  return true;
}

}  // namespace

// Greedy by contrast: the strongest answer stands for its place, whatever weaker ones the same
// thing has at other scales.
Expected<std::vector<Blob>> find_blobs(const Image& image, const BlobSettings& settings) {
  if (auto checked = check_image(image); !checked) return std::unexpected(checked.error());
  const auto [least, largest] = settings.radii;
  if (!(least > 0 && largest >= least && largest <= 100)) {
    return input_error(fmt::format("{} to {} are no sizes", least, largest), "radii",
                       "use 0 < least <= largest <= 100");
  }
  if (!(settings.contrast >= 0)) return input_error("it is negative", "contrast", "use 0 or more");
  std::vector<Image> scales;
  std::vector<double> radii;
  for (double radius = least; radius <= largest * (1 + 1e-12); radius *= growth) {
    radii.push_back(radius);
    scales.push_back(answers(image, radius / std::numbers::sqrt2, settings.dark ? -1 : 1));
  }
  std::vector<Blob> found;
  for (std::size_t k = 0; k < scales.size(); ++k) {
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const double contrast = scales[k].at(x, y);
        if (contrast <= settings.contrast || !is_largest(scales, k, x, y)) continue;
        found.push_back({double(x), double(y), radii[k], contrast});
      }
    }
  }
  std::ranges::stable_sort(found, std::greater(), &Blob::contrast);
  std::vector<Blob> kept;
  for (const Blob& blob : found) {
    const auto apart = [&blob](const Blob& other) {
      return std::hypot(blob.x - other.x, blob.y - other.y) > std::max(blob.radius, other.radius);
    };
    if (std::ranges::all_of(kept, apart)) kept.push_back(blob);
  }
  return kept;
}

}  // namespace knead
