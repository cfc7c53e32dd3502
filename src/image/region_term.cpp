#include "region_term.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "contour_rows.hpp"

namespace knead {
namespace {

/// Which closed snake each pixel is inside of.
///
/// Rasterised polygons of Gauss points, to half a pixel: exact insides would cost point-in-curve
/// tests for every sample of every band.
class Cover {
 public:
  static constexpr int none = -1, several = -2;

  Cover(const std::vector<MovingSnake>& snakes, int width, int height)
      : width_(width), height_(height) {
    owner_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), none);
    for (std::size_t k = 0; k < snakes.size(); ++k) {
      if (snakes[k].settings.closed) add(snakes[k], static_cast<int>(k));
    }
  }

  /// Whether a place is inside of other snakes than this one, or beyond the image.
  [[nodiscard]] bool forbidden(double x, double y, int snake_index) const {
    const auto at = pixel(x, y);
    return !at || (owner_[*at] != none && owner_[*at] != snake_index);
  }
  [[nodiscard]] bool free(double x, double y) const {
    const auto at = pixel(x, y);
    return at && owner_[*at] == none;
  }

 private:
  void add(const MovingSnake& snake, int snake_index) {
    const Points v = snake.net.at_gauss(snake.c, 0);
    std::vector<std::array<double, 2>> line;
    for (Eigen::Index q = 0; q < v.rows(); ++q) line.push_back({v(q, 0), v(q, 1)});
    for_rows_inside(line, width_, height_, [&](int y, int from, int to) {
      for (int x = from; x <= to; ++x) {
        int& owner = owner_[*pixel(x, y)];
        owner = owner == none ? snake_index : several;
      }
    });
  }
  [[nodiscard]] std::optional<std::size_t> pixel(double x, double y) const {
    if (!(x > -0.5 && y > -0.5 && x < width_ - 0.5 && y < height_ - 0.5)) return {};
    return static_cast<std::size_t>(std::lround(y) * width_ + std::lround(x));
  }

  int width_, height_;
  std::vector<int> owner_;
};

/// Grey values with weights.
using GreySamples = std::vector<std::pair<double, double>>;

// A median and not a mean: a bright neighbour that reaches into less than half of the band hardly
// changes it.
std::optional<double> median(GreySamples samples) {
  std::ranges::sort(samples);
  double all = 0, below = 0;
  for (const auto& [grey, weight] : samples) all += weight;
  for (const auto& [grey, weight] : samples) {
    below += weight;
    if (below >= all / 2) return grey;
  }
  return {};
}

/// Fills in what is outside within the snake's band.
///
/// From every Gauss point outwards, a sample a pixel, until the band ends or another snake begins;
/// weighted by the length of contour that the point stands for, or crowded points would count more.
void look_around(const ImagePotential& image, const MovingSnake& snake, double side,
                 const Cover& cover, int snake_index, Sides& sides) {
  const Points v = snake.net.at_gauss(snake.c, 0), t = snake.net.at_gauss(snake.c, 1);
  GreySamples band;
  std::vector<std::array<double, 2>> least_and_most;  // on the way outwards from each point
  for (Eigen::Index q = 0; q < v.rows(); ++q) {
    const double length =
        snake.net.quadrature().weights[static_cast<std::size_t>(q)] * t.row(q).norm();
    const Eigen::Vector2d normal = side * Eigen::Vector2d(t(q, 1), -t(q, 0)).normalized();
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (double d = 0; d < snake.settings.band; ++d) {
      const double x = v(q, 0) + d * normal[0], y = v(q, 1) + d * normal[1];
      if (cover.forbidden(x, y, snake_index)) break;
      const double grey = image.intensity(x, y);
      least = std::min(least, grey);
      most = std::max(most, grey);
      if (cover.free(x, y)) band.emplace_back(grey, length);
    }
    least_and_most.push_back({least, most});
    sides.beyond.push_back(cover.forbidden(v(q, 0), v(q, 1), snake_index));
  }
  const double around = median(std::move(band)).value_or(sides.outside.front());
  for (std::size_t q = 0; q < least_and_most.size(); ++q) {
    const auto [least, most] = least_and_most[q];
    const double there = least > most ? around : sides.inside > around ? least : most;
    sides.outside[q] = std::lerp(around, there, snake.settings.local);
  }
}

}  // namespace

// The outside of all is the image less the insides of all; snakes that overlap are subtracted twice
// where they do, which the mean of a large image hardly shows. Where less than a pixel is left
// there is no outside, and 0 stands for it.
std::vector<std::optional<Sides>> sides_of(const ImagePotential& image,
                                           const std::vector<MovingSnake>& snakes,
                                           const std::vector<Inside>& insides) {
  std::vector<std::optional<Sides>> result(snakes.size());
  if (image.settings().region == 0) return result;
  double area = 0, intensity = 0;
  for (const Inside& inside : insides) {
    area += std::abs(inside.area);
    intensity += std::copysign(1, inside.area) * inside.intensity;
  }
  const double left = double(image.width()) * double(image.height()) - area;
  const double outside = left >= 1 ? (image.total_intensity() - intensity) / left : 0;
  std::optional<Cover> cover;
  if (std::ranges::any_of(snakes, [](const MovingSnake& s) { return s.settings.band > 0; })) {
    cover.emplace(snakes, image.width(), image.height());
  }
  for (std::size_t k = 0; k < snakes.size(); ++k) {
    if (snakes[k].ended() || std::abs(insides[k].area) < 1) continue;
    const auto points = snakes[k].net.quadrature().parameters.size();
    result[k] = Sides{insides[k].intensity / insides[k].area, std::vector<double>(points, outside)};
    if (!(snakes[k].settings.band > 0)) continue;
    look_around(image, snakes[k], std::copysign(1, insides[k].area), *cover, static_cast<int>(k),
                *result[k]);
  }
  return result;
}

// Chan and Vese (2001): the derivative of ∫ (I − μ_in)² inside plus ∫ (I − μ_out)² outside as the
// contour moves outwards, negated. Points in other snakes or beyond the image are pushed back with
// the largest force that the term has between the two means.
double region_pressure(const Sides& sides, std::size_t point, double grey, bool relative) {
  const double outside = sides.outside[point], contrast = sides.inside - outside,
               square = contrast * contrast;
  if (!sides.beyond.empty() && sides.beyond[point] != 0) return relative ? -1 : -square;
  return region_pressure(sides.inside, outside, grey, relative);
}

double region_pressure(double inside, double outside, double grey, bool relative) {
  const double in = grey - inside, out = grey - outside, pressure = out * out - in * in;
  if (!relative) return pressure;
  const double contrast = inside - outside, square = contrast * contrast;
  return square > 0 ? std::clamp(pressure / square, -1.0, 1.0) : 0;
}

}  // namespace knead
