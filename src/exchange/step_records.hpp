#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead::step {

/// Writes records of an exchange structure.
class StepRecords {
 public:
  explicit StepRecords(int first) : next_(first) {}
  int add(const std::string& record) {
    put(next_, record);
    return next_++;
  }
  void put(int id, const std::string& record) { text_ += "#" + std::to_string(id) + "=" + record + ";\n"; }
  int point(const Point& p);
  int direction(const Point& d);
  int vertex(const Point& p);
  int frame(const Point& origin, const Point& z, const Point& x);
  int line(const Point& origin, const Point& direction);
  int curve(const Curve& curve);
  /// Under this name.
  void surface(int id, const Surface& surface, const std::string& label);
  [[nodiscard]] const std::string& text() const { return text_; }
  /// The records as the data of a whole exchange structure.
  [[nodiscard]] std::string exchange_structure() const;

 private:
  std::string text_;
  int next_;
};

/// "(#1,#2)".
[[nodiscard]] std::string list_of(const std::vector<int>& records);

}  // namespace knead::step
