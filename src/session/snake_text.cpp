#include "knead/session/snake_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "json.hpp"

namespace knead {
namespace {

double area_inside(const std::vector<std::array<double, 2>>& line) {
  double twice = 0;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const auto &a = line[k], &b = line[(k + 1) % line.size()];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return std::abs(twice) / 2;
}

}  // namespace

std::string snakes_json(std::span<const SnakeResult> snakes, std::string_view name, int width, int height) {
  const std::string named = nlohmann::json(name).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string text = fmt::format("{{\"image\":{},\"width\":{},\"height\":{},\"snakes\":[", named, width, height);
  for (std::size_t k = 0; k < snakes.size(); ++k) {
    const SnakeResult& s = snakes[k];
    const KnotVector& knots = s.curve.knots()[0];
    text += fmt::format(
        "{}\n{{\"closed\":{},\"degree\":{},\"iterations\":{},\"converged\":{},\"crossings\":{},\"area\":{},",
        k > 0 ? "," : "", s.closed, knots.degree(), s.iterations, s.converged, crossings(s),
        json_number(s.closed ? area_inside(polyline(s)) : 0));
    std::string list;
    for (const double x : knots.knots()) list += (list.empty() ? "" : ",") + json_number(x);
    text += "\"knots\":[" + list + "],\"control_points\":[";
    list.clear();
    for (Eigen::Index i = 0; i < s.curve.size(); ++i) {
      list += fmt::format("{}[{},{}]", list.empty() ? "" : ",", json_number(s.curve.control_points()(i, 0)),
                          json_number(s.curve.control_points()(i, 1)));
    }
    text += list + "]}";
  }
  return text + "]}\n";
}

std::string snakes_csv(std::span<const SnakeResult> snakes) {
  std::string text = "snake,x,y\n";
  for (std::size_t k = 0; k < snakes.size(); ++k) {
    for (const auto& [x, y] : polyline(snakes[k])) text += fmt::format("{},{:.17g},{:.17g}\n", k, x, y);
  }
  return text;
}

std::string snakes_svg(std::span<const SnakeResult> snakes, int width, int height) {
  std::string text =
      fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-0.5 -0.5 {} {}\" width=\"{}\" height=\"{}\">\n",
                  width, height, width, height);
  for (const SnakeResult& s : snakes) {
    std::string points;
    for (const auto& [x, y] : polyline(s)) points += fmt::format("{}{:.17g},{:.17g}", points.empty() ? "" : " ", x, y);
    text += fmt::format("<{} points=\"{}\" fill=\"none\" stroke=\"#c0392b\" stroke-width=\"1\"/>\n",
                        s.closed ? "polygon" : "polyline", points);
  }
  return text + "</svg>\n";
}

Image snakes_mask(std::span<const SnakeResult> snakes, int width, int height) {
  Image all{width, height, std::vector<double>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0)};
  for (const SnakeResult& s : snakes) {
    if (!s.closed) continue;
    const Image one = mask_of(s, width, height);
    for (std::size_t k = 0; k < all.values.size(); ++k) all.values[k] = std::max(all.values[k], one.values[k]);
  }
  return all;
}

}  // namespace knead
