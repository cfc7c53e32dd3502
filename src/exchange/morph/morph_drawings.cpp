// Histograms and scales of colours on the page of a morph, as SVG.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knead/base/printable.hpp"
#include "morph_page.hpp"

namespace knead::detail {
namespace {

std::string unit_after(const std::string& unit) {
  return unit == "unknown" ? "" : " " + xml_text(unit);
}

std::string hex(const std::array<double, 3>& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", std::lround(colour[0]), std::lround(colour[1]),
                     std::lround(colour[2]));
}

std::string opening(int width, int height) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
      "viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      width, height);
}

std::string label(double x, double y, std::string_view anchor, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     text);
}

/// Numbers below an axis from −limit to limit.
std::string numbers_below(double left, double width, double y, double limit,
                          const std::string& unit) {
  std::string svg;
  for (int k = 0; k <= 4; ++k) {
    const double share = k / 4.0, x = left + share * width;
    svg += fmt::format(
        "<line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\" stroke=\"#555\"/>\n", x,
        y, y + 4);
    svg += label(x, y + 17, "middle",
                 fmt::format("{:.3g}{}", (2 * share - 1) * limit, k == 4 ? unit_after(unit) : ""));
  }
  return svg;
}

/// One histogram in a frame, with the tolerance as lines where it is within the range.
std::string panel(const MorphHistogram& histogram, const std::string& title, double left,
                  const MorphReport& report) {
  constexpr double width = 380, top = 46, height = 190;
  const int most = std::max(1, std::ranges::max(histogram.counts));
  const double limit = histogram.limit, step = width / static_cast<double>(histogram.counts.size());
  std::string svg = label(left, 22, "start", title);
  svg += label(left, top - 6, "start", fmt::format("highest bar: {} points", most));
  for (std::size_t k = 0; k < histogram.counts.size(); ++k) {
    const double bar = height * histogram.counts[k] / most;
    if (bar == 0) continue;
    svg += fmt::format(
        "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"#4f7cac\"/>\n",
        left + static_cast<double>(k) * step, top + height - bar, step - 0.8, bar);
  }
  svg += fmt::format(
      "<line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{2:.1f}\" y2=\"{1:.1f}\" stroke=\"#555\"/>\n", left,
      top + height, left + width);
  for (const double sign : {-1.0, 1.0}) {
    if (!(report.tolerance < limit)) break;
    const double x = left + width * (1 + sign * report.tolerance / limit) / 2;
    svg += fmt::format(
        "<line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\" stroke=\"#b2182b\" "
        "stroke-dasharray=\"4 3\"/>\n",
        x, top, top + height);
  }
  if (!(limit > 0))  // all in the middle: there is no range
    return svg + label(left + width / 2, top + height + 17, "middle", "0");
  return svg + numbers_below(left, width, top + height, limit, report.unit);
}

}  // namespace

std::array<double, 3> colour_of(double value) {
  // Diverging, of C. Brewer's "RdBu": distinguishable by colour-blind readers too.
  static constexpr std::array<std::array<double, 3>, 5> stops = {
      {{33, 102, 172}, {146, 197, 222}, {247, 247, 247}, {244, 165, 130}, {178, 24, 43}}};
  const double x = (std::clamp(value, -1.0, 1.0) + 1) / 2 * (stops.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(x), stops.size() - 2);
  std::array<double, 3> result{};
  for (std::size_t c = 0; c < 3; ++c)
    result[c] = std::lerp(stops[k][c], stops[k + 1][c], x - static_cast<double>(k));
  return result;
}

std::string histogram_drawing(const MorphReport& report) {
  std::string svg = opening(960, 270);
  svg += panel(report.histogram_before, "Signed deviation before", 50, report);
  svg += panel(report.histogram_after, "Signed deviation after", 520, report);
  if (report.tolerance < std::max(report.histogram_before.limit, report.histogram_after.limit))
    svg +=
        label(900, 22, "end",
              fmt::format("dashed: tolerance {:.3g}{}", report.tolerance, unit_after(report.unit)));
  return svg + "</svg>\n";
}

std::string scale_drawing(double limit, const std::string& unit) {
  constexpr double left = 60, width = 480;
  constexpr int steps = 64;
  std::string svg = opening(600, 62);
  for (int k = 0; k < steps; ++k) {
    svg += fmt::format("<rect x=\"{:.2f}\" y=\"22\" width=\"{:.2f}\" height=\"14\" fill=\"{}\"/>\n",
                       left + width * k / steps, width / steps + 0.3,
                       hex(colour_of(2 * (k + 0.5) / steps - 1)));
  }
  svg += label(left, 15, "start", "data inside of the model");
  svg += label(left + width, 15, "end", "data outside");
  return svg + numbers_below(left, width, 36, limit, unit) + "</svg>\n";
}

}  // namespace knead::detail
