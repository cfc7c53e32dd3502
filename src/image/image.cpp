#include "knead/image/image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "lines.hpp"

namespace knead {
namespace {

/// The image filtered along x and then along y by an odd number of weights, the border repeated.
/// Whole rows at a time: each sum is in the order of its weights.
///
/// Two passes of m weights cost 2 m a pixel, a mask of m × m would cost m²: every filter here is a
/// product of two.
Image convolved(const Image& image, const std::vector<double>& along_x,
                const std::vector<double>& along_y) {
  const auto width = static_cast<std::size_t>(image.width);
  const int reach_x = static_cast<int>(along_x.size() / 2),
            reach_y = static_cast<int>(along_y.size() / 2);
  Image half = image, whole = image;
  std::ranges::fill(half.values, 0);
  std::ranges::fill(whole.values, 0);
  std::vector<double> padded(width + 2 * static_cast<std::size_t>(reach_x));
  for (int y = 0; y < image.height; ++y) {
    for (std::size_t x = 0; x < padded.size(); ++x) {
      padded[x] = image.at(std::clamp(static_cast<int>(x) - reach_x, 0, image.width - 1), y);
    }
    double* row = &half.at(0, y);
    for (std::size_t k = 0; k < along_x.size(); ++k) {
      for (std::size_t x = 0; x < width; ++x) row[x] += along_x[k] * padded[x + k];
    }
  }
  for (int y = 0; y < image.height; ++y) {
    double* row = &whole.at(0, y);
    for (int k = -reach_y; k <= reach_y; ++k) {
      const double weight = along_y[static_cast<std::size_t>(k + reach_y)];
      const double* from = &half.at(0, std::clamp(y + k, 0, image.height - 1));
      for (std::size_t x = 0; x < width; ++x) row[x] += weight * from[x];
    }
  }
  return whole;
}

/// Differences over two pixels, the border repeated.
std::array<Image, 2> differences(const Image& image) {
  return {convolved(image, {-0.5, 0, 0.5}, {1}), convolved(image, {1}, {-0.5, 0, 0.5})};
}

}  // namespace

Expected<void> check_image(const Image& image) {
  if (image.width < 1 || image.height < 1) {
    return input_error(fmt::format("{} x {} pixels are no image", image.width, image.height),
                       "image");
  }
  const std::size_t asked =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.values.size() != asked) {
    return input_error(fmt::format("{} x {} pixels have {} values", image.width, image.height,
                                   image.values.size()),
                       "image", "give one per pixel");
  }
  for (std::size_t k = 0; k < asked; ++k) {
    if (!std::isfinite(image.values[k]))
      return input_error("the value is not finite", fmt::format("pixel {}", k));
  }
  return {};
}

Image gaussian(const Image& image, double sigma) {
  if (!(sigma > 0)) return image;
  const std::vector<double> weights = detail::gaussian_weights(sigma);
  return convolved(image, weights, weights);
}

Image sobel(const Image& image) {
  const Image h = convolved(image, {0.25, 0.5, 0.25}, {-0.5, 0, 0.5}),
              v = convolved(image, {-0.5, 0, 0.5}, {0.25, 0.5, 0.25});
  Image result = image;
  for (std::size_t k = 0; k < result.values.size(); ++k) {
    result.values[k] = std::sqrt((h.values[k] * h.values[k] + v.values[k] * v.values[k]) / 2);
  }
  return result;
}

// The squared distance separates, min over x' of (x − x')² + min over y' of (y − y')² + 0 or ∞: a
// lower envelope of parabolas for every column, then for every row. Exact, unlike chamfer or
// sweeping methods, at the same O(pixels).
Image distance_to(const Image& mask) {
  Image result = mask;
  for (double& x : result.values) x = x >= 0.5 ? 0 : std::numeric_limits<double>::infinity();
  std::vector<double> line, squared;
  for (int x = 0; x < mask.width; ++x) {
    line.clear();
    for (int y = 0; y < mask.height; ++y) line.push_back(result.at(x, y));
    detail::lower_envelope(line, squared);
    for (int y = 0; y < mask.height; ++y) result.at(x, y) = squared[static_cast<std::size_t>(y)];
  }
  for (int y = 0; y < mask.height; ++y) {
    line.clear();
    for (int x = 0; x < mask.width; ++x) line.push_back(result.at(x, y));
    detail::lower_envelope(line, squared);
    for (int x = 0; x < mask.width; ++x)
      result.at(x, y) = std::sqrt(squared[static_cast<std::size_t>(x)]);
  }
  return result;
}

// Below 1e-3 of the largest slope the quotient is of rounding and noise; it would be large where
// nothing is to be seen.
Image termination(const Image& image) {
  const auto [ix, iy] = differences(image);
  const auto [ixx, ixy] = differences(ix);
  const Image iyy = differences(iy)[1];
  Image result = image;
  double largest = 0;
  for (std::size_t k = 0; k < image.values.size(); ++k) {
    largest = std::max(largest, std::hypot(ix.values[k], iy.values[k]));
  }
  for (std::size_t k = 0; k < image.values.size(); ++k) {
    const double x = ix.values[k], y = iy.values[k], slope = std::hypot(x, y);
    result.values[k] =
        slope > 1e-3 * largest
            ? (iyy.values[k] * x * x - 2 * ixy.values[k] * x * y + ixx.values[k] * y * y) /
                  (slope * slope * slope)
            : 0;
  }
  return result;
}

// Euler's explicit steps of u_t = μ Δu − |∇f|² (u − f_x), and of v likewise, from ∇f on. With the
// step below no weight of the sum is negative, so that values stay between those of ∇f, whatever μ:
// the maximum principle. Far from edges the flow spreads by one pixel an iteration, which is what
// `iterations` is for.
std::array<Image, 2> gradient_vector_flow(const Image& edges, double mu, int iterations) {
  Image scaled = edges;
  const auto [low, high] = std::ranges::minmax_element(edges.values);
  const double base = *low, range = *high - *low;
  for (double& x : scaled.values) x = range > 0 ? (x - base) / range : 0;
  const std::array<Image, 2> slope = differences(scaled);
  std::array<Image, 2> flow = slope;
  // Stable: step (4 μ + |∇f|²) <= 1 with |∇f|² <= 1/2.
  const double step = std::min(1.0, 1 / (4 * mu + 2));
  for (std::size_t d = 0; d < 2; ++d) {
    Image next = flow[d];
    for (int i = 0; i < iterations; ++i) {
      for (int y = 0; y < edges.height; ++y) {
        for (int x = 0; x < edges.width; ++x) {
          const double here = flow[d].at(x, y), gx = slope[0].at(x, y), gy = slope[1].at(x, y);
          const double around =
              flow[d].at(std::max(x - 1, 0), y) + flow[d].at(std::min(x + 1, edges.width - 1), y) +
              flow[d].at(x, std::max(y - 1, 0)) + flow[d].at(x, std::min(y + 1, edges.height - 1));
          next.at(x, y) = here + step * (mu * (around - 4 * here) -
                                         (gx * gx + gy * gy) * (here - slope[d].at(x, y)));
        }
      }
      std::swap(flow[d], next);
    }
  }
  return flow;
}

// Coefficients of the tensor product, one direction after the other. One more beyond each border,
// mirrored, saves every evaluation a case.
ImageSpline::ImageSpline(const Image& image) : width_(image.width), height_(image.height) {
  Image c = image;
  for (int y = 0; y < height_; ++y) detail::interpolate_lines(&c.at(0, y), 1, 1, width_);
  const auto columns = static_cast<std::size_t>(width_);
  detail::interpolate_lines(c.values.data(), columns, columns, height_);
  const auto mirrored = [](int k, int n) {
    return n == 1 ? 0 : k < 0 ? -k : k >= n ? 2 * n - 2 - k : k;
  };
  coefficients_.reserve(static_cast<std::size_t>(width_ + 2) *
                        static_cast<std::size_t>(height_ + 2));
  for (int y = -1; y <= height_; ++y) {
    for (int x = -1; x <= width_; ++x)
      coefficients_.push_back(c.at(mirrored(x, width_), mirrored(y, height_)));
  }
}

namespace {

/// Σ of 4 × 4 coefficients from there, fewer of an image of one pixel, with weights along and
/// across the rows.
template <std::size_t Sums>
std::array<double, Sums> weighted(const std::vector<double>& coefficients, std::array<int, 2> size,
                                  std::array<int, 2> from,
                                  const std::array<const double*, Sums>& along,
                                  const std::array<const double*, Sums>& across) {
  const int rows = std::min(4, size[1] - from[1]), columns = std::min(4, size[0] - from[0]);
  std::array<double, Sums> totals{};
  for (int b = 0; b < rows; ++b) {
    const double* row = coefficients.data() +
                        static_cast<std::size_t>(from[1] + b) * static_cast<std::size_t>(size[0]) +
                        from[0];
    for (std::size_t s = 0; s < Sums; ++s) {
      double line = 0;
      for (int a = 0; a < columns; ++a) line += along[s][a] * row[a];
      totals[s] += across[s][b] * line;
    }
  }
  return totals;
}

int span_at(double u, int n) { return std::clamp(static_cast<int>(u), 0, std::max(n - 2, 0)); }

}  // namespace

double ImageSpline::value(double x, double y) const {
  const double u = std::clamp(x, 0.0, width_ - 1.0), v = std::clamp(y, 0.0, height_ - 1.0);
  const int i = span_at(u, width_), j = span_at(v, height_);
  double bx[4], by[4];
  detail::cubic_basis(u - i, bx, false);
  detail::cubic_basis(v - j, by, false);
  return weighted<1>(coefficients_, {width_ + 2, height_ + 2}, {i, j}, {bx}, {by})[0];
}

std::array<double, 2> ImageSpline::gradient(double x, double y) const {
  const double u = std::clamp(x, 0.0, width_ - 1.0), v = std::clamp(y, 0.0, height_ - 1.0);
  const int i = span_at(u, width_), j = span_at(v, height_);
  double bx[4], by[4], dx[4], dy[4];
  detail::cubic_basis(u - i, bx, false);
  detail::cubic_basis(v - j, by, false);
  detail::cubic_basis(u - i, dx, true);
  detail::cubic_basis(v - j, dy, true);
  auto slope = weighted<2>(coefficients_, {width_ + 2, height_ + 2}, {i, j}, {dx, bx}, {by, dy});
  if (x < 0 || x > width_ - 1.0) slope[0] = 0;
  if (y < 0 || y > height_ - 1.0) slope[1] = 0;
  return slope;
}

// The knots are the integers from −3 to n + 2: three beyond each end of [0, n − 1].
Expected<SplineField<2>> ImageSpline::field() const {
  std::vector<KnotVector> knots;
  for (const int n : {width_, height_}) {
    std::vector<double> values;
    for (int k = -3; k < n + 3; ++k) values.push_back(k);
    auto made = KnotVector::create(3, std::move(values));
    if (!made) return std::unexpected(made.error());
    knots.push_back(std::move(*made));
  }
  std::vector<double> by_x(coefficients_.size());  // the last direction, y, fastest
  const auto w = static_cast<std::size_t>(width_ + 2), h = static_cast<std::size_t>(height_ + 2);
  for (std::size_t y = 0; y < h; ++y) {
    for (std::size_t x = 0; x < w; ++x) by_x[x * h + y] = coefficients_[y * w + x];
  }
  return SplineField<2>::create({knots[0], knots[1]}, std::move(by_x));
}

std::array<double, 3> shares_of(ImageChannel channel) {
  switch (channel) {
    case ImageChannel::red:
      return {1, 0, 0};
    case ImageChannel::green:
      return {0, 1, 0};
    case ImageChannel::blue:
      return {0, 0, 1};
    case ImageChannel::grey:
      break;
  }
  return {0.2125, 0.7154, 0.0721};
}

}  // namespace knead
