#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "rational_piece.hpp"

namespace knead::detail {

/// How far `RationalRule` goes.
struct RationalLimits {
  int most_points = 24;     ///< per direction; a piece that needs more is halved
  int deepest = 60;         ///< halvings of one piece, per direction
  double all_points = 1e9;  ///< Gauss points of all pieces together
};

/// Gauss rules for an integrand of rational functions, with a bound of their error.
///
/// N points in direction d leave an error below (|Ω|/2) (64/15) M ρ^(−2N) / (1 − ρ^(−2)) on a piece
/// of measure |Ω|, with M a bound of the integrand for that direction on the Bernstein ellipse of
/// parameter ρ and the others on their intervals (L. N. Trefethen, Approximation Theory and
/// Approximation Practice, Thm 19.3). ρ is the one of a ladder that asks for the fewest points. A
/// piece that needs too many, or whose denominator has no positive bound on any ellipse of the
/// ladder, is halved.
///
/// size(bounds, direction, rho) is M from `RationalPiece::bounds`; visit(piece, points, error) gets
/// the rule of every piece and returns whether to go on.
template <int D>
class RationalRule {
 public:
  /// `orders`: how many derivatives `size` needs bounds of.
  explicit RationalRule(std::size_t orders, RationalLimits limits = {})
      : orders_(orders), limits_(limits) {}

  /// Rules for the whole piece whose errors sum to at most `allowed`. False: a limit was reached,
  /// or `visit` stopped.
  template <class Size, class Visit>
  [[nodiscard]] bool integrate(const RationalPiece<D>& piece, double allowed, const Size& size,
                               const Visit& visit, int depth = 0) {
    std::array<int, D> points;
    double error = 0, total = 1;
    std::size_t direction = D;
    for (std::size_t d = 0; d < D; ++d) {
      const Choice choice = choose(piece, d, allowed / D, size);
      points[d] = choice.points;
      error += choice.error;
      total *= choice.points;
      if (choice.points > limits_.most_points &&
          (direction == D || piece.variation(d) > piece.variation(direction))) {
        direction = d;
      }
    }
    if (direction == D) {
      all_points_ += total;
      if (all_points_ > limits_.all_points) return false;
      ++pieces_;
      largest_points_ = std::max(largest_points_, *std::ranges::max_element(points));
      return visit(piece, points, error);
    }
    if (depth == D * limits_.deepest) return false;
    for (int which = 0; which < 2; ++which) {
      const RationalAxis half = piece.axis(direction).half(which);
      std::array<const RationalAxis*, D> axes = piece.axes();
      axes[direction] = &half;
      if (!integrate(RationalPiece<D>(axes, piece.weights()), allowed / 2, size, visit, depth + 1))
        return false;
    }
    return true;
  }

  [[nodiscard]] int pieces() const { return pieces_; }
  [[nodiscard]] int largest_points() const { return largest_points_; }

 private:
  struct Choice {
    int points = 0;
    double error = 0, rho = 0;
  };

  /// The fewest points along one direction for which the bound stays within `allowed`: ρ by a
  /// coarse ladder, then nearer.
  template <class Size>
  [[nodiscard]] Choice choose(const RationalPiece<D>& piece, std::size_t direction, double allowed,
                              const Size& size) {
    Choice best{.points = limits_.most_points + 1};
    bounds_.resize(RationalPiece<D>::orders * piece.functions());
    const auto attempt = [&](double rho) {
      if (!piece.bounds(direction, rho, orders_, bounds_.data()))
        return false;  // nor on any larger ellipse
      const double at_zero = 0.5 * piece.measure() * (64.0 / 15) *
                             size(bounds_.data(), direction, rho) / (1 - 1 / (rho * rho));
      if (!std::isfinite(at_zero)) return false;
      // Of nothing −∞.
      const double asked = std::ceil(0.5 * std::log(at_zero / allowed) / std::log(rho));
      const int points = static_cast<int>(std::clamp(asked, 1.0, 1e6));
      if (points < best.points) best = {points, at_zero * std::pow(rho, -2.0 * points), rho};
      return best.rho == 0 || points < best.points + 4;
    };
    constexpr double smallest = 1.1, ladder = 1.7;
    for (double rho = smallest; rho < 200 && attempt(rho); rho *= ladder) {
    }
    for (double factor = std::sqrt(ladder); best.rho > 0 && factor > 1.1;
         factor = std::sqrt(factor)) {
      const double from = best.rho;
      attempt(from * factor);
      if (from / factor > smallest) attempt(from / factor);
    }
    return best;
  }

  std::size_t orders_;
  RationalLimits limits_;
  std::vector<double> bounds_;
  double all_points_ = 0;
  int pieces_ = 0, largest_points_ = 0;
};

}  // namespace knead::detail
