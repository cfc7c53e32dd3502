#include "knead/image/image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace knead {

struct ImagePotential::Fields {
  ImagePotentialSettings settings;
  int width, height;
  ImageSpline intensity, potential;
  std::optional<ImageSpline> to_the_left = {};
  std::vector<ImageSpline> flow = {};
  double total = 0;
};

Expected<void> check_potential_settings(const ImagePotentialSettings& s) {
  const struct {
    const char* name;
    double value;
    bool signed_too;
  } numbers[] = {{"smoothing", s.smoothing, false},
                 {"line", s.line, true},
                 {"edge", s.edge, true},
                 {"termination", s.termination, true},
                 {"flow", s.flow, true},
                 {"flow_smoothness", s.flow_smoothness, false},
                 {"region", s.region, true},
                 {"distance", s.distance, true}};
  for (const auto& [name, value, signed_too] : numbers) {
    if (!std::isfinite(value)) return input_error("the weight is not a finite number", name);
    if (!signed_too && value < 0)
      return input_error(fmt::format("{} is negative", value), name, "use 0 or more");
  }
  if (s.smoothing > 100)
    return input_error(fmt::format("{} pixels are too many", s.smoothing), "smoothing",
                       "use up to 100");
  if (s.flow_iterations < 0 || s.flow_iterations > 100000) {
    return input_error(fmt::format("{} iterations", s.flow_iterations), "flow_iterations",
                       "use 0 to 100000");
  }
  return {};
}

namespace {

/// Sums along rows by the trapezoidal rule, from their left end.
///
/// ∂J/∂x = I, so that ∮ J dy = ∫∫ I dx dy: the sum of intensity inside a contour as a line
/// integral, whose cost is that of the contour and not of the pixels inside.
Image sums_to_the_left(const Image& image) {
  Image sums = image;
  for (int y = 0; y < image.height; ++y) {
    sums.at(0, y) = 0;
    for (int x = 1; x < image.width; ++x) {
      sums.at(x, y) = sums.at(x - 1, y) + (image.at(x - 1, y) + image.at(x, y)) / 2;
    }
  }
  return sums;
}

/// Vectors of length one; zero where there is none.
void normalise(std::array<Image, 2>& flow) {
  for (std::size_t k = 0; k < flow[0].values.size(); ++k) {
    double &u = flow[0].values[k], &v = flow[1].values[k];
    const double length = std::hypot(u, v);
    if (length > 0) u /= length, v /= length;
  }
}

Expected<Image> nearness(const Image& image, const std::optional<Image>& mask) {
  if (!mask)
    return input_error("there is no mask to be near", "mask", "give one, or leave out distance");
  if (auto checked = check_image(*mask); !checked)
    return std::unexpected(checked.error().within("mask"));
  if (mask->width != image.width || mask->height != image.height) {
    return input_error(fmt::format("it has {} x {} pixels, the image {} x {}", mask->width,
                                   mask->height, image.width, image.height),
                       "mask", "give one of the same size");
  }
  Image distance = distance_to(*mask);
  if (!std::isfinite(distance.values.front())) {
    return input_error("no pixel of it is set", "mask", "its pixels count from half of white");
  }
  return distance;
}

}  // namespace

// All terms of Q are added up as images and interpolated once. So the force is the exact gradient
// of one C2 function, which forces interpolated on their own are not, and costs 16 coefficients a
// point. Only the flow, which is no gradient, and the region term, which depends on the contour as
// a whole, are kept apart.
Expected<ImagePotential> ImagePotential::create(const Image& image,
                                                const ImagePotentialSettings& settings,
                                                const std::optional<Image>& mask) {
  if (auto checked = check_image(image); !checked) return std::unexpected(checked.error());
  if (auto checked = check_potential_settings(settings); !checked)
    return std::unexpected(checked.error());
  const Image smooth = gaussian(image, settings.smoothing);
  Image q = smooth;
  for (double& x : q.values) x *= settings.line;
  const auto add = [&q](const Image& term, double weight) {
    for (std::size_t k = 0; k < q.values.size(); ++k) q.values[k] += weight * term.values[k];
  };
  Image edges;
  if (settings.edge != 0 || settings.flow != 0) edges = sobel(smooth);
  if (settings.edge != 0) add(edges, settings.edge);
  if (settings.termination != 0) add(termination(smooth), settings.termination);
  if (settings.distance != 0) {
    const auto distance = nearness(image, mask);
    if (!distance) return std::unexpected(distance.error());
    add(*distance, -settings.distance);
  }
  Fields fields{settings, image.width, image.height, ImageSpline(smooth), ImageSpline(q)};
  if (settings.region != 0) fields.to_the_left.emplace(sums_to_the_left(smooth));
  for (const double x : smooth.values) fields.total += x;
  if (settings.flow != 0) {
    auto flow = gradient_vector_flow(edges, settings.flow_smoothness, settings.flow_iterations);
    normalise(flow);
    for (const Image& component : flow) fields.flow.emplace_back(component);
  }
  return ImagePotential(std::make_shared<const Fields>(std::move(fields)));
}

const ImagePotentialSettings& ImagePotential::settings() const { return fields_->settings; }
int ImagePotential::width() const { return fields_->width; }
int ImagePotential::height() const { return fields_->height; }
double ImagePotential::value(double x, double y) const { return fields_->potential.value(x, y); }

std::array<double, 2> ImagePotential::force(double x, double y) const {
  auto f = fields_->potential.gradient(x, y);
  for (std::size_t d = 0; d < fields_->flow.size(); ++d)
    f[d] += fields_->settings.flow * fields_->flow[d].value(x, y);
  return f;
}

double ImagePotential::intensity(double x, double y) const {
  return fields_->intensity.value(x, y);
}
double ImagePotential::intensity_to_the_left(double x, double y) const {
  return fields_->to_the_left ? fields_->to_the_left->value(x, y) : 0;
}
double ImagePotential::total_intensity() const { return fields_->total; }

}  // namespace knead
