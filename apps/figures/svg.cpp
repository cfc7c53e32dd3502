#include "figures/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "knead/base/printable.hpp"

namespace knead::figures {
namespace {

constexpr double height = 480, plot_width = 560, left = 84, top = 48, bottom = 58, letter = 6.6;
// Okabe and Ito's colours, distinguishable by colour-blind readers too, without their yellow, which
// is pale on white.
constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00",
                                   "#56b4e9", "#555555", "#7a3e9d", "#8c564b", "#000000"};

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
  /// A little room around the data, but none below zero where all is positive.
  void widen(double room, bool below_zero = false) {
    if (!(lower <= upper)) lower = 0, upper = 1;
    if (lower == upper) upper = lower + 1;
    const double extra = room * (upper - lower);
    lower = !below_zero && !logarithmic && lower >= 0 && lower < upper / 2 ? 0 : lower - extra;
    upper += extra;
  }
  [[nodiscard]] double fraction(double x) const { return (scaled(x) - lower) / (upper - lower); }
  /// Ticks at round numbers, scaled.
  [[nodiscard]] std::vector<double> ticks() const {
    const double raw = (upper - lower) / 8, power = std::pow(10, std::floor(std::log10(raw)));
    double step = power * (raw / power > 5 ? 10 : raw / power > 2 ? 5 : raw / power > 1 ? 2 : 1);
    if (logarithmic) step = std::max(1.0, std::ceil(raw));
    std::vector<double> result;
    for (double t = std::ceil(lower / step) * step; t <= upper + 1e-9 * step; t += step) {
      result.push_back(std::abs(t) < 1e-9 * step ? 0 : t);
    }
    return result;
  }
  /// 2, 3, … 9 times the powers of ten of a logarithmic axis of few decades.
  [[nodiscard]] std::vector<double> minor_ticks() const {
    std::vector<double> result;
    if (!logarithmic || upper - lower > 5) return result;
    for (double decade = std::floor(lower); decade < upper; ++decade) {
      for (int k = 2; k <= 9; ++k) {
        const double t = decade + std::log10(k);
        if (t >= lower && t <= upper) result.push_back(t);
      }
    }
    return result;
  }
  [[nodiscard]] std::string label(double tick) const {
    if (!logarithmic) return fmt::format("{:g}", tick);
    return fmt::format("10<tspan dy=\"-5\" font-size=\"9\">{:g}</tspan>", tick);
  }
};

std::string text(double x, double y, const std::string& words, const char* anchor,
                 const std::string& extra = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" {}>{}</text>\n", x, y,
                     anchor, extra, words);
}

/// The number of letters of UTF-8 text.
double letters(const std::string& words) {
  return static_cast<double>(
      std::ranges::count_if(words, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string header(double w, double h) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" "
      "height=\"{1:g}\" font-family=\"DejaVu Sans, sans-serif\" font-size=\"12\">\n<rect "
      "width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      w, h);
}

}  // namespace

std::string Chart::svg() const {
  Axis x, y;
  x.logarithmic = log_x_;
  y.logarithmic = log_y_;
  double legend = 0;
  int strokes = 0;
  for (const Series& series : series_) {
    if (series.style.in_legend) legend = std::max(legend, 60 + letter * letters(series.name));
    if (series.impulses) ++strokes;
    for (const auto& [u, v] : series.points) {
      if (!x.shows(u) || !y.shows(v)) continue;
      x.include(u);
      y.include(v);
      if (series.impulses) y.include(0);
    }
  }
  x.widen(strokes > 0 || log_x_ ? 0.04 : 0, strokes > 1);
  y.widen(0.05);
  const double width =
      left + std::max(plot_width, letter * 1.25 * letters(title_) - legend) + legend;
  const auto px = [&](double fraction) { return left + fraction * (width - left - legend); };
  const auto py = [&](double fraction) {
    return height - bottom - fraction * (height - top - bottom);
  };

  std::string out =
      header(width, height) + text(left, 26, xml_text(title_), "start", "font-size=\"15\"");
  for (const double tick : x.minor_ticks()) {
    const double at = px((tick - x.lower) / (x.upper - x.lower));
    out += fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}\" stroke=\"#f2f2f2\"/>\n", at, py(0),
                       py(1));
  }
  for (const double tick : y.minor_ticks()) {
    const double at = py((tick - y.lower) / (y.upper - y.lower));
    out += fmt::format("<path d=\"M{0:.1f} {1:.1f}H{2:.1f}\" stroke=\"#f2f2f2\"/>\n", px(0), at,
                       px(1));
  }
  for (const double tick : x.ticks()) {
    const double at = px((tick - x.lower) / (x.upper - x.lower));
    out += fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}\" stroke=\"#e3e3e3\"/>\n", at, py(0),
                       py(1));
    out += text(at, py(0) + 19, x.label(tick), "middle");
  }
  for (const double tick : y.ticks()) {
    const double at = py((tick - y.lower) / (y.upper - y.lower));
    const bool zero = tick == 0 && !y.logarithmic;
    out += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" stroke=\"{}\"/>\n", px(0), at, px(1),
                       zero ? "#999" : "#e3e3e3");
    out += text(px(0) - 7, at + 4, y.label(tick), "end");
  }
  out += fmt::format("<path d=\"M{:.1f} {:.1f}V{:.1f}H{:.1f}\" fill=\"none\" stroke=\"#333\"/>\n",
                     px(0), py(1), py(0), px(1));
  out += text(px(0.5), height - 16, xml_text(x_label_), "middle");
  out += text(0, 0, xml_text(y_label_), "middle",
              fmt::format("transform=\"translate(20 {:.1f}) rotate(-90)\"", py(0.5)));

  int next_colour = 0, stroke = 0;
  double row = top + 6;
  for (const Series& series : series_) {
    const int index = series.style.colour >= 0 ? series.style.colour : next_colour++;
    const char* colour = colours[static_cast<std::size_t>(index) % std::size(colours)];
    const double shift = series.impulses ? 2.5 * (stroke++ - (strokes - 1) / 2.0) : 0;
    std::string path, dots;
    bool pen = false;
    for (const auto& [u, v] : series.points) {
      if (!x.shows(u) || !y.shows(v)) {
        pen = false;
        continue;
      }
      const double at = px(x.fraction(u)) + shift, to = py(y.fraction(v));
      if (series.impulses) {
        path += fmt::format("M{:.1f} {:.1f}V{:.1f}", at, py(y.logarithmic ? 0 : y.fraction(0)), to);
      } else {
        path += fmt::format("{}{:.1f} {:.1f}", pen ? "L" : "M", at, to);
        pen = true;
      }
      if (series.impulses || series.style.markers) {
        dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.8\" fill=\"{}\"/>\n", at, to,
                            colour);
      }
    }
    const char* dashes = series.style.dashed ? "6 4" : "none";
    out += fmt::format(
        "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\" "
        "stroke-dasharray=\"{}\"/>\n",
        path, colour, dashes);
    out += dots;
    if (!series.style.in_legend) continue;
    out += fmt::format(
        "<path d=\"M{:.1f} {:.1f}h26\" stroke=\"{}\" stroke-width=\"2.4\" "
        "stroke-dasharray=\"{}\"/>\n",
        px(1) + 14, row, colour, dashes);
    out += text(px(1) + 46, row + 4, xml_text(series.name), "start");
    row += 19;
  }
  return out + "</svg>\n";
}

std::string surface_svg(const std::string& title, const std::string& row_label,
                        const std::string& column_label, const std::vector<std::string>& rows,
                        const std::vector<std::string>& columns,
                        const std::vector<Surface>& surfaces) {
  constexpr double floor_left = 100, floor_front = 430, right = 400, back_x = 150, back_y = -110,
                   tall = 250;
  double largest = 0;
  for (const Surface& surface : surfaces) {
    for (const auto& row : surface.heights) largest = std::max(largest, std::ranges::max(row));
  }
  const auto along = [](std::size_t k, std::size_t count) {
    return count > 1 ? static_cast<double>(k) / static_cast<double>(count - 1) : 0;
  };
  const auto x_of = [&](double row, double column) {
    return floor_left + right * column + back_x * row;
  };
  const auto y_of = [&](double row, double height) {
    return floor_front + back_y * row - tall * height;
  };
  std::string out = header(floor_left + right + back_x + 190, 510) +
                    text(24, 26, xml_text(title), "start", "font-size=\"15\"");
  // The floor with its marks, and a post at the back left with heights.
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double r = along(i, rows.size());
    out += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" stroke=\"#ddd\"/>\n", x_of(r, 0),
                       y_of(r, 0), x_of(r, 1));
    out += text(x_of(r, 1) + 10, y_of(r, 0) + 4, rows[i], "start");
  }
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const double c = along(j, columns.size());
    out += fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"#ddd\"/>\n", x_of(0, c),
                       y_of(0, 0), x_of(1, c), y_of(1, 0));
    out += text(x_of(0, c), y_of(0, 0) + 18, columns[j], "middle");
  }
  out += text(x_of(0, 0.5), y_of(0, 0) + 42, xml_text(column_label), "middle");
  out += text(x_of(0.5, 1) + 44, y_of(0.5, 0) + 4, xml_text(row_label), "start");
  Axis z;
  z.include(0);
  z.include(largest);
  out += fmt::format("<path d=\"M{:.1f} {:.1f}V{:.1f}\" stroke=\"#333\"/>\n", x_of(0, 0),
                     y_of(0, 0), y_of(0, 1));
  for (const double tick : z.ticks()) {
    out += text(x_of(0, 0) - 8, y_of(0, tick / largest) + 4, z.label(tick), "end");
    out += fmt::format("<path d=\"M{:.1f} {:.1f}h-4\" stroke=\"#333\"/>\n", x_of(0, 0),
                       y_of(0, tick / largest));
  }
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const auto& heights = surfaces[s].heights;
    std::string path;
    const auto corner = [&](std::size_t i, std::size_t j, bool pen) {
      const double r = along(i, rows.size());
      path += fmt::format("{}{:.1f} {:.1f}", pen ? "L" : "M", x_of(r, along(j, columns.size())),
                          y_of(r, heights[i][j] / largest));
    };
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = 0; j < columns.size(); ++j) corner(i, j, j > 0);
    }
    for (std::size_t j = 0; j < columns.size(); ++j) {
      for (std::size_t i = 0; i < rows.size(); ++i) corner(i, j, i > 0);
    }
    out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.4\"/>\n", path,
                       colours[s]);
    const double row = 60 + 19 * static_cast<double>(s);
    out += fmt::format("<path d=\"M{:.1f} {:.1f}h26\" stroke=\"{}\" stroke-width=\"2.4\"/>\n",
                       floor_left + 30, row, colours[s]);
    out += text(floor_left + 64, row + 4, xml_text(surfaces[s].name), "start");
  }
  return out + "</svg>\n";
}

std::string matrix_svg(const std::string& title, const std::vector<std::vector<double>>& rows,
                       double zero) {
  constexpr double wide = 62, high = 22, margin = 34, above = 66;
  double largest = 0;
  std::size_t columns = 0;
  for (const auto& row : rows) {
    for (const double value : row) largest = std::max(largest, std::abs(value));
    columns = std::max(columns, row.size());
  }
  std::string out = header(wide * static_cast<double>(columns) + margin + 12,
                           high * static_cast<double>(rows.size()) + above + 12) +
                    text(12, 26, xml_text(title), "start", "font-size=\"15\"");
  for (std::size_t j = 0; j < columns; ++j) {
    out += text(margin + wide * (static_cast<double>(j) + 0.5), above - 8, fmt::format("{}", j),
                "middle", "fill=\"#555\" font-size=\"11\"");
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double y = above + high * static_cast<double>(i);
    out += text(margin - 8, y + 15, fmt::format("{}", i), "end", "fill=\"#555\" font-size=\"11\"");
    for (std::size_t j = 0; j < rows[i].size(); ++j) {
      const double value = rows[i][j], x = margin + wide * static_cast<double>(j);
      const bool empty = std::abs(value) <= zero;
      // The cube root makes small entries visible.
      const double shade = empty || largest == 0 ? 0 : std::cbrt(std::abs(value) / largest);
      const int pale = 255 - static_cast<int>(170 * shade),
                half = 255 - static_cast<int>(110 * shade);
      const std::string colour = value >= 0 ? fmt::format("rgb(255,{},{})", half, pale)
                                            : fmt::format("rgb({},{},255)", pale, half);
      out += fmt::format(
          "<rect x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\" fill=\"{}\" "
          "stroke=\"#ddd\"><title>{}, {}: {:.15g}</title></rect>\n",
          x, y, wide, high, colour, i, j, value);
      if (!empty)
        out +=
            text(x + wide / 2, y + 15, fmt::format("{:.4g}", value), "middle", "font-size=\"10\"");
    }
  }
  return out + "</svg>\n";
}

}  // namespace knead::figures
