#include "knead/image/snake_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "describe/record_json.hpp"

namespace knead {

struct SnakeInfo {
  bool closed = true;
  int degree = 0, iterations = 0;
  bool converged = false;
  int crossings = 0;
  double area = 0;
  std::vector<double> knots;
  std::vector<std::array<double, 2>> control_points;
};
static void describe(SnakeInfo& s, Fields& fields) {
  fields.add_all("closed", s.closed, "degree", s.degree, "iterations", s.iterations, "converged",
                 s.converged, "crossings", s.crossings, "area", s.area, "knots", s.knots,
                 "control_points", s.control_points);
}

struct SurfaceSnakeInfo {
  SurfaceForm form = SurfaceForm::sphere;
  std::array<int, 2> degree = {0, 0};
  int iterations = 0;
  bool converged = false;
  int crossings = 0;
  double area = 0, volume = 0;
  std::array<std::vector<double>, 2> knots;
  std::array<int, 2> net = {0, 0};
  std::vector<std::array<double, 3>> control_points;
};
static void describe(SurfaceSnakeInfo& s, Fields& fields) {
  fields.add_all("form", s.form, "degree", s.degree, "iterations", s.iterations, "converged",
                 s.converged, "crossings", s.crossings, "area", s.area, "volume", s.volume, "knots",
                 s.knots, "net", s.net, "control_points", s.control_points);
}

namespace {

// The polygon's area by Gauss's formula, without a sign.
double area_inside(const std::vector<std::array<double, 2>>& line) {
  double twice = 0;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const auto &a = line[k], &b = line[(k + 1) % line.size()];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return std::abs(twice) / 2;
}

std::vector<double> values_of(const KnotVector& knots) {
  return {knots.knots().begin(), knots.knots().end()};
}

template <std::size_t N, class Result>
std::vector<std::array<double, N>> control_points(const Result& shape) {
  std::vector<std::array<double, N>> list(static_cast<std::size_t>(shape.size()));
  for (std::size_t i = 0; i < list.size(); ++i) {
    for (std::size_t d = 0; d < N; ++d) {
      list[i][d] =
          shape.control_points()(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(d));
    }
  }
  return list;
}

/// Each in a line.
template <class Info>
std::string list_json(const std::vector<Info>& infos) {
  std::string text;
  for (const Info& info : infos)
    text += (text.empty() ? "\n" : ",\n") + to_json(type_of<Info>(), &info);
  return "[" + text + "]}\n";
}

}  // namespace

std::string snakes_json(std::span<const SnakeResult> snakes, std::string_view name, int width,
                        int height) {
  std::vector<SnakeInfo> infos;
  for (const SnakeResult& s : snakes) {
    const KnotVector& knots = s.curve.knots()[0];
    infos.push_back({s.closed, knots.degree(), s.iterations, s.converged, crossings(s),
                     s.closed ? area_inside(polyline(s)) : 0, values_of(knots),
                     control_points<2>(s.curve)});
  }
  return fmt::format("{{\"image\":{},\"width\":{},\"height\":{},\"snakes\":", json_text(name),
                     width, height) +
         list_json(infos);
}

std::string volume_snakes_json(std::span<const SurfaceSnakeResult> snakes, std::string_view name) {
  std::vector<SurfaceSnakeInfo> infos;
  for (const SurfaceSnakeResult& s : snakes) {
    const Surface& surface = s.snake.surface;
    const KnotVector &u = surface.knots(0), &v = surface.knots(1);
    const SurfaceMeasure measured = measure(s.snake);
    infos.push_back({s.snake.form,
                     {u.degree(), v.degree()},
                     s.iterations,
                     s.converged,
                     crossings(closed_mesh(s.snake)),
                     measured.area,
                     measured.volume,
                     {values_of(u), values_of(v)},
                     surface.net(),
                     control_points<3>(surface)});
  }
  return fmt::format("{{\"volume\":{},\"snakes\":", json_text(name)) + list_json(infos);
}

VolumeImage volume_snakes_mask(std::span<const SurfaceSnakeResult> snakes,
                               const VolumeImage& volume) {
  VolumeImage all{volume.size, std::vector<double>(volume.values.size(), 0), volume.frame};
  for (const SurfaceSnakeResult& s : snakes) {
    const VolumeImage one = mask_of(closed_mesh(s.snake), all.size, all.frame);
    std::ranges::transform(all.values, one.values, all.values.begin(),
                           [](double a, double b) { return std::max(a, b); });
  }
  return all;
}

std::string snakes_csv(std::span<const SnakeResult> snakes) {
  std::string text = "snake,x,y\n";
  for (std::size_t k = 0; k < snakes.size(); ++k) {
    for (const auto& [x, y] : polyline(snakes[k]))
      text += fmt::format("{},{:.17g},{:.17g}\n", k, x, y);
  }
  return text;
}

std::string snakes_svg(std::span<const SnakeResult> snakes, int width, int height) {
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-0.5 -0.5 {} {}\" width=\"{}\" "
      "height=\"{}\">\n",
      width, height, width, height);
  for (const SnakeResult& s : snakes) {
    std::string points;
    for (const auto& [x, y] : polyline(s))
      points += fmt::format("{}{:.17g},{:.17g}", points.empty() ? "" : " ", x, y);
    text += fmt::format("<{} points=\"{}\" fill=\"none\" stroke=\"#c0392b\" stroke-width=\"1\"/>\n",
                        s.closed ? "polygon" : "polyline", points);
  }
  return text + "</svg>\n";
}

Image snakes_mask(std::span<const SnakeResult> snakes, int width, int height) {
  Image all{
      width, height,
      std::vector<double>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0)};
  for (const SnakeResult& s : snakes) {
    if (!s.closed) continue;
    const Image one = mask_of(s, width, height);
    for (std::size_t k = 0; k < all.values.size(); ++k)
      all.values[k] = std::max(all.values[k], one.values[k]);
  }
  return all;
}

}  // namespace knead
