#include "orientation.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace knead {
namespace {

/// A sum of doubles without rounding: terms that do not overlap, by increasing magnitude. Room for
/// `Terms` of them.
template <std::size_t Terms>
class ExactSum {
 public:
  void add_product(double x, double y) {
    const double product = x * y;
    add(std::fma(x, y, -product));
    add(product);
  }

  [[nodiscard]] int sign() const {
    for (std::size_t k = count_; k-- > 0;) {
      if (terms_[k] != 0) return terms_[k] > 0 ? 1 : -1;
    }
    return 0;
  }

 private:
  void add(double value) {
    double carried = value;
    for (std::size_t k = 0; k < count_; ++k) {
      const double sum = carried + terms_[k], part = sum - carried;  // Knuth's two-sum
      terms_[k] = (carried - (sum - part)) + (terms_[k] - part);
      carried = sum;
    }
    terms_[count_++] = carried;
  }

  std::array<double, Terms> terms_ = {};
  std::size_t count_ = 0;
};

}  // namespace

int orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  constexpr double u = std::numeric_limits<double>::epsilon() / 2, error = (3 + 16 * u) * u;
  const double left = (b.x() - a.x()) * (c.y() - a.y()), right = (b.y() - a.y()) * (c.x() - a.x());
  const double area = left - right, bound = error * (std::abs(left) + std::abs(right));
  if (area > bound) return 1;
  if (-area > bound) return -1;
  ExactSum<12> sum;
  sum.add_product(a.x(), b.y());
  sum.add_product(-a.y(), b.x());
  sum.add_product(b.x(), c.y());
  sum.add_product(-b.y(), c.x());
  sum.add_product(c.x(), a.y());
  sum.add_product(-c.y(), a.x());
  return sum.sign();
}

}  // namespace knead
