#include "snake_net.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "knead/gramian/gramian.hpp"
#include "knead/spline/evaluate.hpp"
#include "periodic_knots.hpp"

namespace knead {
namespace {

Expected<KnotVector> knots_between(std::span<const double> breaks, const SnakeSettings& settings) {
  const int p = settings.degree, spans = static_cast<int>(breaks.size()) - 1;
  if (settings.closed) return periodic_knots(p, breaks);
  std::vector<double> knots;
  for (int k = -p; k <= spans + p; ++k)
    knots.push_back(breaks[static_cast<std::size_t>(std::clamp(k, 0, spans))]);
  return KnotVector::create(p, std::move(knots));
}

}  // namespace

// A = γ M + α G11 + β G22 + Σ k N Nᵀ of one coordinate, N × N with bandwidth p, exact Gramians of
// the given knots. Periodic functions fold by i mod N, which adds entries in the corners. M in
// place of Kass's identity makes the evolution that of the contour and not of its control points:
// the same motion on any net. A projection has M alone.
Expected<SnakeNet> SnakeNet::create(std::span<const double> breaks, const SnakeSettings& settings,
                                    bool projection) {
  auto knots = knots_between(breaks, settings);
  if (!knots) return std::unexpected(knots.error());
  const auto set = gramians(*knots);
  if (!set) return std::unexpected(set.error());
  const int n = knots->count(), p = knots->degree();
  const int unknowns = settings.closed ? n - p : n;
  std::vector<Eigen::Triplet<double>> entries, mass;
  for (int i = 0; i < n; ++i) {
    for (int j = std::max(0, i - p); j <= std::min(n - 1, i + p); ++j) {
      mass.emplace_back(i % unknowns, j % unknowns, set->g00(i, j));
      if (projection) continue;
      entries.emplace_back(i % unknowns, j % unknowns,
                           settings.alpha * set->g11(i, j) + settings.beta * set->g22(i, j));
    }
  }
  Points springs = Points::Zero(unknowns, 3);
  for (const SnakeSpring& spring : settings.springs) {
    if (projection) break;
    const double s = std::lerp(breaks.front(), breaks.back(), spring.at);
    const auto basis = tabulate_basis(*knots, std::span(&s, 1), 0);
    if (!basis) return std::unexpected(basis.error());
    for (int r = 0; r <= p; ++r) {
      const int i = (basis->first[0] + r) % unknowns;
      const double value = spring.strength * basis->row(0, 0)[r];
      springs.row(i) += value * Eigen::RowVector3d(spring.to[0], spring.to[1], 0);
      for (int q = 0; q <= p; ++q)
        entries.emplace_back(i, (basis->first[0] + q) % unknowns, value * basis->row(0, 0)[q]);
    }
  }
  BasisQuadrature quadrature = gauss_basis(*knots, p + 2, 1);
  SnakeNet net(std::move(*knots), {breaks.begin(), breaks.end()});
  net.unknowns_ = unknowns;
  net.held_ = !settings.closed && (settings.hold_ends || projection);
  net.quadrature_ = std::move(quadrature);
  net.mass_.resize(unknowns, unknowns);
  net.mass_.setFromTriplets(mass.begin(), mass.end());
  net.stiffness_.resize(unknowns, unknowns);
  net.stiffness_.setFromTriplets(entries.begin(), entries.end());
  net.springs_ = std::move(springs);
  if (auto factored = net.set_viscosity(projection ? 1 : settings.gamma); !factored) {
    return std::unexpected(factored.error());
  }
  return net;
}

// Held ends stay in the matrix as rows of the identity: symmetric, and the numbering of unknowns is
// the same for all snakes.
Expected<void> SnakeNet::set_viscosity(double gamma) {
  matrix_ = gamma * mass_ + stiffness_;
  SparseMatrix reduced = matrix_;
  if (held_) {
    const auto fixed = [this](Eigen::Index i) { return i == 0 || i == unknowns_ - 1; };
    reduced.prune(
        [&](Eigen::Index i, Eigen::Index j, double) { return i == j || (!fixed(i) && !fixed(j)); });
    for (const int i : {0, unknowns_ - 1}) reduced.coeffRef(i, i) = 1;
  }
  auto factor = SparseCholesky::factor(reduced);
  if (!factor) return std::unexpected(factor.error().within("snake"));
  factor_ = std::move(*factor);
  return {};
}

Points SnakeNet::at_gauss(const Points& c, int derivative) const {
  const BasisTable& basis = quadrature_.basis;
  Points result = Points::Zero(basis.size(), 3);
  for (int q = 0; q < basis.size(); ++q) {
    const double* values = basis.row(q, derivative);
    for (int r = 0; r <= basis.degree; ++r) {
      result.row(q) += values[r] * c.row(unknown(basis.first[static_cast<std::size_t>(q)] + r));
    }
  }
  return result;
}

// ∫ N f ds by p + 2 Gauss points a span, as the image is no polynomial; one substitution, O(N p).
// Columns of held ends go to the right side.
Points SnakeNet::solve(const Points& f, const Points& c,
                       const std::array<Eigen::RowVector3d, 2>& ends) const {
  const BasisTable& basis = quadrature_.basis;
  Points right = springs_;
  right.row(0) += ends[0];
  right.row(unknowns_ - 1) += ends[1];
  for (int q = 0; q < basis.size(); ++q) {
    const double* values = basis.row(q, 0);
    const double weight = quadrature_.weights[static_cast<std::size_t>(q)];
    for (int r = 0; r <= basis.degree; ++r) {
      right.row(unknown(basis.first[static_cast<std::size_t>(q)] + r)) +=
          weight * values[r] * f.row(q);
    }
  }
  if (held_) {
    for (const int fixed : {0, unknowns_ - 1}) {
      for (SparseMatrix::InnerIterator it(matrix_, fixed); it; ++it)
        right.row(it.row()) -= it.value() * c.row(fixed);
    }
    for (const int fixed : {0, unknowns_ - 1}) right.row(fixed) = c.row(fixed);
  }
  return factor_->solve(right);
}

Expected<Curve> SnakeNet::curve(const Points& c) const {
  Points all(knots_.count(), 3);
  for (int i = 0; i < knots_.count(); ++i) all.row(i) = c.row(unknown(i));
  return Curve::create({knots_}, std::move(all));
}

std::vector<double> breaks_of(const Curve& curve) {
  const KnotVector& knots = curve.knots()[0];
  std::vector<double> breaks;
  for (const int span : knots.spans()) breaks.push_back(knots[span]);
  breaks.push_back(knots.domain().upper);
  return breaks;
}

Expected<Points> projected(const Curve& curve, std::span<const double> breaks,
                           const SnakeSettings& settings) {
  const auto net = SnakeNet::create(breaks, settings, true);
  if (!net) return std::unexpected(net.error());
  const auto& at = net->quadrature().parameters;
  const auto places =
      evaluate(curve, Parameters<1>(Eigen::Map<const Eigen::VectorXd>(at.data(), std::ssize(at))));
  if (!places) return std::unexpected(places.error());
  Points ends = Points::Zero(net->unknowns(), 3);
  ends.row(0) = curve.control_points().row(0);
  ends.row(net->unknowns() - 1) = curve.control_points().row(curve.size() - 1);
  return net->solve(places->points(), ends);
}

// The c that minimises ∫ |v(s) − q(s)|² ds, q the polygon at the same share of its length. Least
// squares in L², not at the given places: places that crowd do not outweigh others, and fewer
// places than unknowns leave nothing undetermined.
Expected<Points> fitted(std::vector<std::array<double, 2>> places, std::span<const double> breaks,
                        const SnakeSettings& settings) {
  if (settings.closed && places.front() != places.back()) places.push_back(places.front());
  std::vector<double> chord = {0};
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (!std::isfinite(places[k][0]) || !std::isfinite(places[k][1])) {
      return input_error("the place is not finite", fmt::format("points[{}]", k));
    }
    if (k > 0) {
      chord.push_back(chord.back() +
                      std::hypot(places[k][0] - places[k - 1][0], places[k][1] - places[k - 1][1]));
    }
  }
  const double length = chord.back(), units = breaks.back() - breaks.front();
  if (!(length > 0) || !std::isfinite(length))
    return input_error("all points are one", "points", "spread them");
  const auto net = SnakeNet::create(breaks, settings, true);
  if (!net) return std::unexpected(net.error());
  const auto& at = net->quadrature().parameters;
  Points targets = Points::Zero(std::ssize(at), 3);
  std::size_t piece = 0;
  for (std::size_t q = 0; q < at.size(); ++q) {
    const double s = (at[q] - breaks.front()) / units * length;
    while (piece + 2 < chord.size() && chord[piece + 1] < s) ++piece;
    const double part = chord[piece + 1] - chord[piece],
                 r = part > 0 ? (s - chord[piece]) / part : 0;
    for (std::size_t d = 0; d < 2; ++d) {
      targets(static_cast<Eigen::Index>(q), static_cast<Eigen::Index>(d)) =
          std::lerp(places[piece][d], places[piece + 1][d], r);
    }
  }
  Points ends = Points::Zero(net->unknowns(), 3);
  ends.row(0) << places.front()[0], places.front()[1], 0;
  ends.row(net->unknowns() - 1) << places.back()[0], places.back()[1], 0;
  return net->solve(targets, ends);
}

double chord_length(std::span<const std::array<double, 2>> places, bool closed) {
  double length = 0;
  for (std::size_t k = closed ? 0 : 1; k < places.size(); ++k) {
    const auto &a = places[(k + places.size() - 1) % places.size()], &b = places[k];
    length += std::hypot(b[0] - a[0], b[1] - a[1]);
  }
  return length;
}

}  // namespace knead
