#include "knead/gramian/rational_gramian.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "methods.hpp"
#include "rational_piece.hpp"
#include "unit_gauss.hpp"

namespace knead {
namespace {

using detail::RationalAxis;
using detail::RationalPiece;
using Orders = std::array<int, 2>;

constexpr int most_points = 24;  ///< a piece that needs more is halved
constexpr int deepest = 60;      ///< halvings of one span before giving up

/// Integrates ∂^a R_I ∂^b R_J over one span (or product of spans) to a given error.
class SpanIntegrator {
 public:
  SpanIntegrator(Orders a, Orders b, int functions)
      : a_(a),
        b_(b),
        functions_(functions),
        local_(static_cast<std::size_t>(functions) * functions),
        values_(static_cast<std::size_t>(6 * functions)) {}

  /// The integrals of all pairs, row by row, into local(). False if no halving gave the denominator a positive
  /// bound.
  [[nodiscard]] bool integrate(const RationalPiece& piece, double allowed) {
    std::fill(local_.begin(), local_.end(), 0.0);
    error_ = 0;
    return halve_until_bounded(piece, allowed, 0);
  }
  [[nodiscard]] const std::vector<double>& local() const { return local_; }
  [[nodiscard]] double error() const { return error_; }
  [[nodiscard]] int pieces() const { return pieces_; }
  [[nodiscard]] int largest_points() const { return largest_points_; }

  /// local() += the rule with these points, without a bound.
  void add_rule(const RationalPiece& piece, Orders points) {
    const auto ru = detail::unit_gauss<double>(points[0]), rv = detail::unit_gauss<double>(points[1]);
    detail::SpanValues<double> u[3], v[3];
    for (std::size_t g = 0; g < ru.t.size(); ++g) {
      piece.axis(0).values(ru.t[g], ru.complement[g], u);
      for (std::size_t h = 0; h < rv.t.size(); ++h) {
        piece.axis(1).values(rv.t[h], rv.complement[h], v);
        piece.evaluate(u, v, values_.data());
        const double weight = piece.axis(0).length() * ru.weights[g] * piece.axis(1).length() * rv.weights[h];
        const double* f = values_.data() + detail::order_index(a_[0], a_[1]) * functions_;
        const double* s = values_.data() + detail::order_index(b_[0], b_[1]) * functions_;
        for (int i = 0; i < functions_; ++i) {
          const double factor = weight * f[i];
          double* row = local_.data() + static_cast<std::ptrdiff_t>(i) * functions_;
          for (int j = 0; j < functions_; ++j) row[j] += factor * s[j];
        }
      }
    }
  }

 private:
  struct Choice {
    int points = most_points + 1;
    double error = 0;
  };

  /// The fewest points along one direction for which the bound, integrated over the other, stays within `allowed`.
  [[nodiscard]] Choice choose(const RationalPiece& piece, int direction, double allowed) const {
    Choice best;
    if (piece.axis(direction).knots == nullptr) return {1, 0};
    const double area = piece.axis(0).length() * piece.axis(1).length();
    for (double rho = 1.1; rho < 200; rho *= 1.2) {
      const double m = piece.bound(direction == 0 ? rho : 1, direction == 0 ? 1 : rho, a_, b_);
      if (!std::isfinite(m)) break;  // and on all larger ellipses
      const double at_zero = 0.5 * area * (64.0 / 15) * m / (1 - 1 / (rho * rho));
      const double asked = std::ceil(0.5 * std::log(at_zero / allowed) / std::log(rho));  // of nothing −∞
      const int points = static_cast<int>(std::clamp(asked, 1.0, 1e6));
      if (points < best.points) best = {points, at_zero * std::pow(rho, -2.0 * points)};
    }
    return best;
  }

  bool halve_until_bounded(const RationalPiece& piece, double allowed, int depth) {
    const Choice u = choose(piece, 0, allowed / 2), v = choose(piece, 1, allowed / 2);
    if (u.points <= most_points && v.points <= most_points) {
      add_rule(piece, {u.points, v.points});
      error_ += u.error + v.error;
      ++pieces_;
      largest_points_ = std::max({largest_points_, u.points, v.points});
      return true;
    }
    if (depth == deepest) return false;
    const bool both = u.points > most_points && v.points > most_points;
    const int direction = both ? (piece.variation(1) > piece.variation(0) ? 1 : 0) : u.points > most_points ? 0 : 1;
    for (int which = 0; which < 2; ++which) {
      std::array<RationalAxis, 2> axes{piece.axis(0), piece.axis(1)};
      axes[static_cast<std::size_t>(direction)] = piece.axis(direction).half(which);
      if (!halve_until_bounded(RationalPiece(axes, piece.weights()), allowed / 2, depth + 1)) return false;
    }
    return true;
  }

  Orders a_, b_;
  int functions_;
  std::vector<double> local_, values_;
  double error_ = 0;
  int pieces_ = 0, largest_points_ = 0;
};

Expected<void> check(std::span<const double> weights, int count, Orders a, Orders b, double tolerance) {
  for (const Orders order : {a, b}) {
    if (order[0] < 0 || order[1] < 0 || order[0] + order[1] > detail::rational_order) {
      return usage_error(fmt::format("there is no rational Gramian of order {} {}", order[0], order[1]), {},
                         "use total orders 0 to 2");
    }
  }
  if (!(tolerance > 0)) return usage_error("the tolerance is not positive", {}, "use a fraction such as 1e-10");
  if (static_cast<int>(weights.size()) != count) {
    return input_error(fmt::format("there are {} weights for {} functions", weights.size(), count), "weights",
                       "give one weight for each function");
  }
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (!(weights[k] > 0) || !std::isfinite(weights[k])) {
      return input_error("the weight is not a positive number", fmt::format("weight {}", k), "use positive weights");
    }
  }
  return {};
}

/// The elements of a rational curve (no second direction) or surface.
class RationalNet {
 public:
  RationalNet(const KnotVector& u, const KnotVector* v, std::span<const double> weights)
      : u_(u), v_(v), weights_(weights), columns_(v != nullptr ? v->count() : 1) {}

  [[nodiscard]] int functions() const { return (u_.degree() + 1) * (v_ != nullptr ? v_->degree() + 1 : 1); }

  /// visit(piece, indices) for every element, in order; stops when it returns false.
  template <class Visit>
  bool for_elements(Visit visit) const {
    std::vector<RationalAxis> along_v;
    if (v_ == nullptr) {
      along_v.emplace_back();
    } else {
      for (const int span : v_->spans()) along_v.push_back({v_, span, (*v_)[span], (*v_)[span + 1]});
    }
    for (RationalAxis& axis : along_v) axis.tabulate();
    std::vector<double> weights(static_cast<std::size_t>(functions()));
    std::vector<int> indices(weights.size());
    for (const int span : u_.spans()) {
      RationalAxis axis{&u_, span, u_[span], u_[span + 1]};
      axis.tabulate();
      for (const RationalAxis& other : along_v) {
        std::size_t k = 0;
        for (int i = 0; i <= axis.degree(); ++i) {
          for (int j = 0; j <= other.degree(); ++j, ++k) {
            indices[k] = (axis.first() + i) * columns_ + other.first() + j;
            weights[k] = weights_[static_cast<std::size_t>(indices[k])];
          }
        }
        if (!visit(RationalPiece({axis, other}, weights.data()), indices)) return false;
      }
    }
    return true;
  }

  /// max_I sqrt(G^aa_II G^bb_II), roughly: the size to which a tolerance is relative.
  [[nodiscard]] double size(Orders a, Orders b) const {
    std::vector<double> diagonal[2];
    const Orders order[2] = {a, b};
    for (int side = 0; side < 2; ++side) {
      diagonal[side].assign(weights_.size(), 0.0);
      for_elements([&](const RationalPiece& piece, const std::vector<int>& indices) {
        SpanIntegrator local(order[side], order[side], functions());
        const int points = std::max(8, piece.axis(0).degree() + 2);
        local.add_rule(piece, {points, piece.axis(1).knots == nullptr ? 1 : points});
        for (std::size_t k = 0; k < indices.size(); ++k) {
          diagonal[side][static_cast<std::size_t>(indices[k])] += local.local()[k * indices.size() + k];
        }
        return true;
      });
    }
    double largest = 0;
    for (std::size_t k = 0; k < weights_.size(); ++k) {
      largest = std::max(largest, std::sqrt(diagonal[0][k] * diagonal[1][k]));
    }
    return largest;
  }

 private:
  const KnotVector& u_;
  const KnotVector* v_;
  std::span<const double> weights_;
  int columns_;
};

/// add(row, column, value) for every pair of every element; the rest of the result into `summary`.
template <class Matrix, class Add>
Expected<void> integrate(const RationalNet& net, Orders a, Orders b, double tolerance, RationalGramian<Matrix>& summary,
                         Add add) {
  const double size = net.size(a, b);
  // An entry sums as many elements as there are functions on one.
  const double allowed = size > 0 ? tolerance * size / net.functions() : 1;
  SpanIntegrator integrator(a, b, net.functions());
  double worst = 0;
  const bool done = net.for_elements([&](const RationalPiece& piece, const std::vector<int>& indices) {
    if (!integrator.integrate(piece, allowed)) return false;
    worst = std::max(worst, integrator.error());
    for (std::size_t i = 0; i < indices.size(); ++i) {
      for (std::size_t j = 0; j < indices.size(); ++j) {
        add(indices[i], indices[j], integrator.local()[i * indices.size() + j]);
      }
    }
    return true;
  });
  if (!done) {
    return numerical_error("the rational denominator has no positive lower bound", "rational Gramian",
                           "use weights that differ less");
  }
  summary.error_bound = worst * net.functions();
  summary.pieces = integrator.pieces();
  summary.largest_points = integrator.largest_points();
  return {};
}

}  // namespace

Expected<RationalGramian<BandMatrix>> rational_gramian(const KnotVector& knots, std::span<const double> weights, int a,
                                                       int b, double tolerance) {
  const Orders first{a, 0}, second{b, 0};
  if (const auto good = check(weights, knots.count(), first, second, tolerance); !good) {
    return std::unexpected(good.error());
  }
  RationalGramian<BandMatrix> result{BandMatrix(knots.count(), knots.degree(), detail::symmetry_of(a, b))};
  const auto done = integrate(RationalNet(knots, nullptr, weights), first, second, tolerance, result,
                              [&](int i, int j, double value) {
                                if (a != b || i <= j) result.matrix.at(i, j) += value;
                              });
  if (!done) return std::unexpected(done.error());
  return result;
}

Expected<RationalGramian<Eigen::SparseMatrix<double>>> rational_gramian(const std::array<KnotVector, 2>& knots,
                                                                        std::span<const double> weights, Orders a,
                                                                        Orders b, double tolerance) {
  const int count = knots[0].count() * knots[1].count();
  if (const auto good = check(weights, count, a, b, tolerance); !good) return std::unexpected(good.error());
  RationalGramian<Eigen::SparseMatrix<double>> result;
  std::vector<Eigen::Triplet<double>> triplets;
  const auto done = integrate(RationalNet(knots[0], &knots[1], weights), a, b, tolerance, result,
                              [&](int i, int j, double value) { triplets.emplace_back(i, j, value); });
  if (!done) return std::unexpected(done.error());
  result.matrix.resize(count, count);
  result.matrix.setFromTriplets(triplets.begin(), triplets.end());
  return result;
}

Expected<BandMatrix> constant_denominator_gramian(const KnotVector& knots, std::span<const double> weights, int a,
                                                  int b) {
  if (const auto good = check(weights, knots.count(), {a, 0}, {b, 0}, 1); !good) return std::unexpected(good.error());
  const int p = knots.degree(), orders[2] = {a, b}, none[1] = {0};
  BandMatrix result(knots.count(), p, detail::symmetry_of(a, b));
  const detail::UnitGaussRule<double> rule = detail::unit_gauss<double>(p + 1);
  detail::SpanValues<double> f[2], middle[1];
  for (const int span : knots.spans()) {
    detail::span_basis(knots, span, 0.5, 0.5, none, 1, middle);
    double w = 0;
    for (int r = 0; r <= p; ++r) w += weights[static_cast<std::size_t>(span - p + r)] * middle[0][r];
    for (std::size_t g = 0; g < rule.t.size(); ++g) {
      detail::span_basis(knots, span, rule.t[g], rule.complement[g], orders, 2, f);
      const double factor = (knots[span + 1] - knots[span]) * rule.weights[g] / (w * w);
      for (int i = 0; i <= p; ++i) {
        for (int j = a == b ? i : 0; j <= p; ++j) {
          result.at(span - p + i, span - p + j) += factor * weights[static_cast<std::size_t>(span - p + i)] *
                                                   weights[static_cast<std::size_t>(span - p + j)] * f[0][i] * f[1][j];
        }
      }
    }
  }
  return result;
}

}  // namespace knead
