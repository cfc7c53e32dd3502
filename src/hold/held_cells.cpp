#include "held_cells.hpp"

namespace knead {

std::vector<std::array<int, 2>> held_cells(const Surface& s, const std::vector<bool>& held) {
  const int n = s.net()[1];
  const auto holds = [&](int a, int b) {
    for (int i = a - s.knots(0).degree(); i <= a; ++i) {
      for (int j = b - s.knots(1).degree(); j <= b; ++j) {
        if (!held[static_cast<std::size_t>(i * n + j)]) return false;
      }
    }
    return true;
  };
  std::vector<std::array<int, 2>> result;
  for (const int a : s.knots(0).spans()) {
    for (const int b : s.knots(1).spans()) {
      if (holds(a, b)) result.push_back({a, b});
    }
  }
  return result;
}

}  // namespace knead
