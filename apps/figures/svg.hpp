#pragma once

#include <string>
#include <utility>
#include <vector>

namespace knead::figures {

using Points = std::vector<std::pair<double, double>>;

/// A chart as SVG text: lines and impulses over linear or logarithmic axes, with a legend. Ranges are those of the
/// data.
class Chart {
 public:
  Chart(std::string title, std::string x_label, std::string y_label)
      : title_(std::move(title)), x_label_(std::move(x_label)), y_label_(std::move(y_label)) {}

  Chart& logarithmic(bool x, bool y) {
    log_x_ = x, log_y_ = y;
    return *this;
  }
  /// A line through the points; values that a logarithmic axis cannot show are left out.
  void line(std::string name, Points points) { series_.push_back({std::move(name), std::move(points), false}); }
  /// A vertical stroke from zero to every point.
  void impulses(std::string name, Points points) { series_.push_back({std::move(name), std::move(points), true}); }
  [[nodiscard]] std::string svg() const;

 private:
  struct Series {
    std::string name;
    Points points;
    bool impulses;
  };
  std::string title_, x_label_, y_label_;
  bool log_x_ = false, log_y_ = false;
  std::vector<Series> series_;
};

/// A matrix as a picture: one cell per entry, blue below zero, red above, the darker the larger; the value as its
/// tooltip.
[[nodiscard]] std::string matrix_svg(const std::string& title, const std::vector<std::vector<double>>& rows);

}  // namespace knead::figures
