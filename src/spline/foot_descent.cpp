#include <Eigen/Dense>
#include <cmath>

#include "foot_search.hpp"

namespace knead::detail {
namespace {

/// The present iterate: parameters w and the jet j there.
/// Newton's iteration for the stationary points of |x − S|², projected onto the rectangle (a
/// parameter at a side counts as fixed while the slope pushes against it). Where the Hessian is not
/// positive definite, Gauss and Newton's matrix stands for it, with 1e-10 of its trace to bear
/// singular tangents. A step that does not lead nearer is shortened by quarters, except for a short
/// Newton step close to the foot: there distances differ by less than rounding, and only the
/// gradient can tell.
class Descent {
 public:
  Descent(const Point& x, const Patch& patch, const ParameterRectangle& within,
          const std::array<double, 2>& start, double size)
      : x_(x),
        patch_(patch),
        within_(within),
        size_(size),
        w_(start[0], start[1]),
        j_(patch.jet(w_[0], w_[1])) {}

  void iterate() {
    double before = std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < 80; ++iteration) {
      const Eigen::Vector2d g = gradient();
      const std::array<bool, 2> free = free_sides(g);
      if (!free[0] && !free[1]) break;
      const double reach = advance(step(g, free), free);
      // Steps of quadratic convergence shrink by far more than half; those that do not are
      // rounding.
      if (reach <= 1e-16 * size_ || (reach < 1e-13 * size_ && reach >= 0.5 * before)) break;
      before = reach;
    }
  }

  /// Towards a cusp the steps shrink indefinitely: the cusp itself is tried too.
  void try_cusps() {
    for (Eigen::Index k = 0; k < 2; ++k) {
      const Range& side = within_.side[index(k)];
      for (double end : {side.lower, side.upper}) {
        if (w_[k] == end || std::abs(w_[k] - end) > 0.05 * side.length()) continue;
        Eigen::Vector2d there = w_;
        there[k] = end;
        const PatchJet trial = patch_.jet(there[0], there[1]);
        if (trial[1 + index(k)].norm() > 1e-9 * size_) continue;
        if ((trial[0] - x_).squaredNorm() > (j_[0] - x_).squaredNorm()) continue;
        w_ = there;
        j_ = trial;
      }
    }
  }

  [[nodiscard]] Foot foot() const {
    Foot f;
    f.patch = 0;
    f.at = {w_[0], w_[1]};
    f.jet = j_;
    f.squared = (j_[0] - x_).squaredNorm();
    const Eigen::Vector2d g = gradient();
    for (std::size_t d = 0; d < 2; ++d) {
      const auto k = static_cast<Eigen::Index>(d);
      const Range &side = within_.side[d], &whole = patch_.domain.side[d];
      if (whole.length() == 0) continue;
      const bool low = w_[k] <= side.lower && g[k] > 0, high = w_[k] >= side.upper && g[k] < 0;
      const double push =
          std::abs(g[k]) / (j_[1 + d].norm() * (std::sqrt(f.squared) + 1e-3 * size_) + 1e-300);
      f.pressure = std::max(f.pressure, push);
      if (!low && !high) continue;
      const bool border = low ? w_[k] <= whole.lower : w_[k] >= whole.upper;
      if (border) {
        f.pressed[d] = push > 1e-9;
      } else if (push > 1e-9) {
        f.patch = -1;
      }
    }
    return f;
  }

 private:
  struct Step {
    Eigen::Vector2d by = Eigen::Vector2d::Zero();
    bool newton = true;  // else Gauss–Newton, where |x − S|² is not convex
  };

  /// Half the gradient of |x − S|².
  [[nodiscard]] Eigen::Vector2d gradient() const {
    const Point r = j_[0] - x_;
    return {r.dot(j_[1]), r.dot(j_[2])};
  }

  /// The parameters not blocked by a side of the rectangle.
  [[nodiscard]] std::array<bool, 2> free_sides(const Eigen::Vector2d& g) const {
    std::array<bool, 2> free{};
    for (std::size_t d = 0; d < 2; ++d) {
      const Range& side = within_.side[d];
      const auto k = static_cast<Eigen::Index>(d);
      free[d] = side.length() > 0 && !(w_[k] <= side.lower && g[k] >= 0) &&
                !(w_[k] >= side.upper && g[k] <= 0);
    }
    return free;
  }

  [[nodiscard]] Step step(const Eigen::Vector2d& g, const std::array<bool, 2>& free) const {
    const Point r = j_[0] - x_;
    const Eigen::Matrix2d metric{{j_[1].dot(j_[1]), j_[1].dot(j_[2])},
                                 {j_[1].dot(j_[2]), j_[2].dot(j_[2])}};
    Eigen::Matrix2d a =
        metric + Eigen::Matrix2d{{r.dot(j_[3]), r.dot(j_[4])}, {r.dot(j_[4]), r.dot(j_[5])}};
    Step step;
    for (int round = 0; round < 2; ++round) {
      const double determinant = a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0);
      if (free[0] && free[1] && a(0, 0) > 0 && determinant > 1e-14 * a(0, 0) * a(1, 1)) {
        step.by[0] = -(a(1, 1) * g[0] - a(0, 1) * g[1]) / determinant;
        step.by[1] = -(a(0, 0) * g[1] - a(1, 0) * g[0]) / determinant;
        break;
      }
      if (free[0] != free[1]) {
        const Eigen::Index k = free[0] ? 0 : 1;
        if (a(k, k) > 0) {
          step.by[k] = -g[k] / a(k, k);
          break;
        }
      }
      step.newton = false;
      a = metric;
      a.diagonal().array() += 1e-10 * metric.trace() + 1e-300;
    }
    return step;
  }

  /// Takes a step, shortened until it leads closer to x; returns its length in space, to second
  /// order.
  double advance(const Step& step, const std::array<bool, 2>& free) {
    const PatchJet before = j_;
    const double squared = (before[0] - x_).squaredNorm();
    Eigen::Vector2d next = w_;
    double reach = 0;
    for (double t = 1;; t *= 0.25) {
      for (Eigen::Index k = 0; k < 2; ++k) {
        const Range& side = within_.side[index(k)];
        next[k] =
            free[index(k)] ? std::clamp(w_[k] + t * step.by[k], side.lower, side.upper) : w_[k];
      }
      const Eigen::Vector2d moved = next - w_;
      reach = (moved[0] * j_[1] + moved[1] * j_[2]).norm() +
              0.5 * (moved[0] * moved[0] * j_[3].norm() + moved[1] * moved[1] * j_[5].norm());
      const bool sure = step.newton && t == 1 && reach < 1e-4 * size_;
      j_ = patch_.jet(next[0], next[1]);
      if (sure || (j_[0] - x_).squaredNorm() < squared || t < 1e-12) break;
      j_ = before;
    }
    w_ = next;
    return reach;
  }

  Point x_;
  const Patch& patch_;
  const ParameterRectangle& within_;
  double size_;
  Eigen::Vector2d w_;
  PatchJet j_;
};

}  // namespace

Foot descended(const Point& x, const Patch& patch, const ParameterRectangle& within,
               const std::array<double, 2>& start, double size) {
  Descent descent(x, patch, within, start, size);
  descent.iterate();
  descent.try_cusps();
  return descent.foot();
}

}  // namespace knead::detail
