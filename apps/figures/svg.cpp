#include "figures/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knead::figures {
namespace {

constexpr double width = 760, height = 460, left = 80, right = 170, top = 40, bottom = 55;
constexpr const char* colours[] = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e",
                                   "#17becf", "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22"};

struct Axis {
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;
  bool logarithmic = false;

  [[nodiscard]] bool shows(double x) const { return std::isfinite(x) && (!logarithmic || x > 0); }
  [[nodiscard]] double scaled(double x) const { return logarithmic ? std::log10(x) : x; }
  void include(double x) {
    if (!shows(x)) return;
    lower = std::min(lower, scaled(x));
    upper = std::max(upper, scaled(x));
  }
  void widen() {
    if (!(lower <= upper)) lower = 0, upper = 1;
    if (logarithmic) lower = std::floor(lower), upper = std::ceil(upper);
    if (lower == upper) upper = lower + 1;
  }
  [[nodiscard]] double fraction(double x) const { return (scaled(x) - lower) / (upper - lower); }
  /// Ticks at round numbers, scaled.
  [[nodiscard]] std::vector<double> ticks() const {
    const double raw = (upper - lower) / 6, power = std::pow(10, std::floor(std::log10(raw)));
    double step = power * (raw / power > 5 ? 10 : raw / power > 2 ? 5 : raw / power > 1 ? 2 : 1);
    if (logarithmic) step = std::max(1.0, std::round(step));
    std::vector<double> result;
    for (double t = std::ceil(lower / step) * step; t <= upper + 1e-9 * step; t += step) {
      result.push_back(std::abs(t) < 1e-9 * step ? 0 : t);
    }
    return result;
  }
  [[nodiscard]] std::string label(double tick) const {
    return logarithmic ? fmt::format("1e{:g}", tick) : fmt::format("{:g}", tick);
  }
};

std::string text(double x, double y, const std::string& words, const char* anchor, const char* extra = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" {}>{}</text>\n", x, y, anchor, extra, words);
}

std::string header(double w, double h) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" height=\"{1:g}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      w, h);
}

}  // namespace

std::string Chart::svg() const {
  Axis x, y;
  x.logarithmic = log_x_;
  y.logarithmic = log_y_;
  for (const Series& series : series_) {
    for (const auto& [u, v] : series.points) {
      if (!x.shows(u) || !y.shows(v)) continue;
      x.include(u);
      y.include(v);
      if (series.impulses) y.include(0);
    }
  }
  x.widen();
  y.widen();
  const auto px = [&](double fraction) { return left + fraction * (width - left - right); };
  const auto py = [&](double fraction) { return height - bottom - fraction * (height - top - bottom); };

  std::string out = header(width, height) + text(left, 22, title_, "start", "font-size=\"15\"");
  for (const double tick : x.ticks()) {
    const double at = px((tick - x.lower) / (x.upper - x.lower));
    out += fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}\" stroke=\"#ddd\"/>\n", at, py(0), py(1));
    out += text(at, py(0) + 18, x.label(tick), "middle");
  }
  for (const double tick : y.ticks()) {
    const double at = py((tick - y.lower) / (y.upper - y.lower));
    out += fmt::format("<path d=\"M{0:.1f} {1:.1f}H{2:.1f}\" stroke=\"#ddd\"/>\n", px(0), at, px(1));
    out += text(px(0) - 6, at + 4, y.label(tick), "end");
  }
  out += fmt::format("<path d=\"M{:.1f} {:.1f}V{:.1f}H{:.1f}\" fill=\"none\" stroke=\"#333\"/>\n", px(0), py(1), py(0),
                     px(1));
  out += text(px(0.5), height - 14, x_label_, "middle");
  out += text(0, 0, y_label_, "middle", fmt::format("transform=\"translate(18 {:.1f}) rotate(-90)\"", py(0.5)).c_str());

  for (std::size_t k = 0; k < series_.size(); ++k) {
    const char* colour = colours[k % std::size(colours)];
    std::string path;
    bool pen = false;
    for (const auto& [u, v] : series_[k].points) {
      if (!x.shows(u) || !y.shows(v)) {
        pen = false;
        continue;
      }
      const double at = px(x.fraction(u)), to = py(y.fraction(v));
      if (series_[k].impulses) {
        path += fmt::format("M{:.1f} {:.1f}V{:.1f}", at, py(y.logarithmic ? 0 : y.fraction(0)), to);
        out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", at, to, colour);
      } else {
        path += fmt::format("{}{:.1f} {:.1f}", pen ? "L" : "M", at, to);
        pen = true;
      }
    }
    const char* dashes = k < std::size(colours) ? "none" : "5 3";  // colours come round again
    out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" stroke-dasharray=\"{}\"/>\n",
                       path, colour, dashes);
    const double row = top + 16 * static_cast<double>(k);
    out += fmt::format("<path d=\"M{:.1f} {:.1f}h18\" stroke=\"{}\" stroke-width=\"3\"/>\n", width - right + 10, row,
                       colour);
    out += text(width - right + 34, row + 4, series_[k].name, "start");
  }
  return out + "</svg>\n";
}

std::string matrix_svg(const std::string& title, const std::vector<std::vector<double>>& rows) {
  constexpr double cell = 26;
  double largest = 0;
  for (const auto& row : rows) {
    for (const double value : row) largest = std::max(largest, std::abs(value));
  }
  const double side = cell * static_cast<double>(rows.size());
  std::string out = header(side + 40, side + 60) + text(20, 24, title, "start", "font-size=\"15\"");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows[i].size(); ++j) {
      // The cube root makes small entries visible.
      const double shade = largest > 0 ? std::cbrt(std::abs(rows[i][j]) / largest) : 0;
      const int pale = 255 - static_cast<int>(215 * shade);
      const std::string colour =
          rows[i][j] >= 0 ? fmt::format("rgb(255,{0},{0})", pale) : fmt::format("rgb({0},{0},255)", pale);
      out += fmt::format(
          "<rect x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\" fill=\"{}\" stroke=\"#eee\"><title>{}, {}: "
          "{:.15g}</title></rect>\n",
          20 + cell * static_cast<double>(j), 40 + cell * static_cast<double>(i), cell, cell, colour, i, j, rows[i][j]);
    }
  }
  return out + "</svg>\n";
}

}  // namespace knead::figures
