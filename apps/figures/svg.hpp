#pragma once

#include <string>
#include <utility>
#include <vector>

namespace knead::figures {

using Points = std::vector<std::pair<double, double>>;

/// How a series of a chart is drawn.
struct Style {
  int colour = -1;  ///< of the palette; -1: the next one
  bool dashed = false;
  bool markers = false;   ///< a dot at every point
  bool in_legend = true;  ///< false if another series stands for this one too
};

/// A chart as SVG text: lines and impulses over linear or logarithmic axes, with a legend. Ranges
/// are those of the data.
class Chart {
 public:
  Chart(std::string title, std::string x_label, std::string y_label)
      : title_(std::move(title)), x_label_(std::move(x_label)), y_label_(std::move(y_label)) {}

  Chart& logarithmic(bool x, bool y) {
    log_x_ = x, log_y_ = y;
    return *this;
  }
  /// A line through the points; values that a logarithmic axis cannot show are omitted.
  void line(std::string name, Points points, Style style = {}) {
    series_.push_back({std::move(name), std::move(points), style, false});
  }
  /// A vertical stroke from zero to every point. The strokes of several series over one point are
  /// drawn side by side.
  void impulses(std::string name, Points points, Style style = {}) {
    series_.push_back({std::move(name), std::move(points), style, true});
  }
  [[nodiscard]] std::string svg() const;

 private:
  struct Series {
    std::string name;
    Points points;
    Style style;
    bool impulses;
  };
  std::string title_, x_label_, y_label_;
  bool log_x_ = false, log_y_ = false;
  std::vector<Series> series_;
};

/// Surfaces over one grid as wire frames, seen from the front left: heights[row][column], all from
/// zero. Rows go back, columns to the right.
struct Surface {
  std::string name;
  std::vector<std::vector<double>> heights;
};
[[nodiscard]] std::string surface_svg(const std::string& title, const std::string& row_label,
                                      const std::string& column_label,
                                      const std::vector<std::string>& rows,
                                      const std::vector<std::string>& columns,
                                      const std::vector<Surface>& surfaces);

/// The band of a matrix as a picture: one cell per entry with its value, blue below zero, red
/// above, the darker the larger; entries below `zero` are white. Rows may have any lengths.
[[nodiscard]] std::string matrix_svg(const std::string& title,
                                     const std::vector<std::vector<double>>& rows, double zero);

}  // namespace knead::figures
