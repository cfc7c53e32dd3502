#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/gauss_legendre.hpp"
#include "knead/energy/loads.hpp"
#include "knead/spline/evaluate.hpp"
#include "rational_basis.hpp"

namespace knead {
namespace {

constexpr double area_tolerance = 1e-10;  // of the largest |f| times the area of a piece
constexpr int more_points = 4;            // of the rule that judges the other one
constexpr int most_area_halvings = 20;

/// A rectangle of parameters within one span of the shape and one of the load.
struct Piece {
  std::array<double, 2> lower, upper;
};

/// What one rule gives on a piece.
struct PieceForces {
  std::vector<int> nodes;     // local function -> control point
  Eigen::MatrixX3d forces;    // ∫ R_i f dA
  double area = 0, size = 0;  // ∫ dA, max |f| ∫ dA
};

std::vector<double> common_breaks(const KnotVector& a, const KnotVector& b) {
  const auto [lower, upper] = a.domain();
  std::vector<double> breaks;
  for (const KnotVector* k : {&a, &b}) {
    std::ranges::copy_if(k->knots(), std::back_inserter(breaks),
                         [&](double x) { return lower <= x && x <= upper; });
  }
  std::ranges::sort(breaks);
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  return breaks;
}

class AreaLoad {
 public:
  AreaLoad(const Surface& shape, const Surface& weighted, const Surface& load)
      : shape_(shape), load_(load), functions_(weighted, 1) {
    for (std::size_t d = 0; d < 2; ++d) {  // exact where the area element is a polynomial
      const int p = shape.knots()[d].degree();
      points_[d] = (3 * p + load.knots()[d].degree()) / 2 + 1;
      local_ *= p + 1;
    }
    largest_ = load.control_points().rowwise().norm().maxCoeff();
  }

  /// Adds the forces of a piece, halved in both directions until two rules agree to `allowed` of
  /// its size.
  /// |S_u × S_v| is a root: no rule is exact, and near folds it has a kink. Two Gauss rules, n and
  /// n
  /// + 4 points, judge each other; where they differ a piece is quartered, each quarter with half
  /// of the tolerance (errors of quarters do not add up with one sign). Flat pieces, whose area
  /// element is a polynomial, end at once. Twenty halvings end a fold, with an error.
  [[nodiscard]] Expected<void> add(const Piece& piece, double allowed, int halvings,
                                   Points& to) const {
    const auto coarse = by_rule(piece, 0), fine = by_rule(piece, more_points);
    if (!coarse) return std::unexpected(coarse.error());
    if (!fine) return std::unexpected(fine.error());
    const double off = (fine->forces - coarse->forces).cwiseAbs().maxCoeff();
    if (allowed < 0) allowed = area_tolerance * fine->size;
    if (!(off <= allowed)) {
      std::array<double, 2> middle;
      bool halved = halvings > 0 && std::isfinite(off);
      for (std::size_t d = 0; d < 2; ++d) {
        middle[d] = piece.lower[d] + (piece.upper[d] - piece.lower[d]) / 2;
        halved = halved && piece.lower[d] < middle[d] && middle[d] < piece.upper[d];
      }
      if (!halved) {
        return numerical_error(
            fmt::format("the forces are known to {:.1e} only, not {:.1e}", off, allowed),
            fmt::format("load: parameters ({}, {})", middle[0], middle[1]),
            R"(give the load "per":"parameters", or remove what folds the surface there)");
      }
      for (int quarter = 0; quarter < 4; ++quarter) {
        Piece part = piece;
        for (std::size_t d = 0; d < 2; ++d)
          ((quarter >> d & 1) != 0 ? part.lower : part.upper)[d] = middle[d];
        if (auto ok = add(part, allowed / 2, halvings - 1, to); !ok) return ok;
      }
      return {};
    }
    for (std::size_t r = 0; r < fine->nodes.size(); ++r) {
      to.row(fine->nodes[r]) += fine->forces.row(static_cast<Eigen::Index>(r));
    }
    return {};
  }

 private:
  [[nodiscard]] Expected<PieceForces> by_rule(const Piece& piece, int more) const {
    std::array<BasisTable, 2> table, other;
    std::array<std::vector<double>, 2> weights;
    for (std::size_t d = 0; d < 2; ++d) {
      const GaussRule rule = gauss_legendre(points_[d] + more);
      const double half = (piece.upper[d] - piece.lower[d]) / 2;
      std::vector<double> at;
      for (std::size_t g = 0; g < rule.abscissae.size(); ++g) {
        at.push_back(std::clamp(piece.lower[d] + half + half * rule.abscissae[g], piece.lower[d],
                                std::nextafter(piece.upper[d], piece.lower[d])));
        weights[d].push_back(half * rule.weights[g]);
      }
      auto made = tabulate_basis(shape_.knots()[d], at, 1),
           loaded = tabulate_basis(load_.knots()[d], at, 0);
      if (!made) return std::unexpected(made.error());
      if (!loaded) return std::unexpected(loaded.error());
      table[d] = std::move(*made);
      other[d] = std::move(*loaded);
    }
    const auto f = evaluate_grid<2>(load_, {&other[0], &other[1]}, 0);
    if (!f) return std::unexpected(f.error());
    const std::array<int, 2> first{table[0].first.front(), table[1].first.front()};
    PieceForces result;
    for (int r = 0; r < local_; ++r) {
      const auto i = functions_.global(first, r);
      result.nodes.push_back(i[0] * shape_.net()[1] + i[1]);
    }
    result.forces = Eigen::MatrixX3d::Zero(local_, 3);
    std::vector<Eigen::MatrixXd> basis(3, Eigen::MatrixXd(local_, 1));
    for (std::size_t a = 0, k = 0; a < weights[0].size(); ++a) {
      for (std::size_t b = 0; b < weights[1].size(); ++b, ++k) {
        const std::array<const double*, 2> rows{table[0].row(static_cast<int>(a), 0),
                                                table[1].row(static_cast<int>(b), 0)};
        if (auto ok = functions_.evaluate(first, rows, 0, basis); !ok)
          return std::unexpected(ok.error());
        const double area = weights[0][a] * weights[1][b] * area_element(result.nodes, basis);
        result.area += area;
        result.forces += area * basis[0] * f->points().row(static_cast<Eigen::Index>(k));
      }
    }
    result.size = largest_ * result.area;
    return result;
  }

  [[nodiscard]] double area_element(const std::vector<int>& nodes,
                                    const std::vector<Eigen::MatrixXd>& basis) const {
    Eigen::Vector3d u = Eigen::Vector3d::Zero(), v = u;
    for (std::size_t r = 0; r < nodes.size(); ++r) {
      const auto x = shape_.control_points().row(nodes[r]).transpose();
      const auto row = static_cast<Eigen::Index>(r);
      u += basis[static_cast<std::size_t>(multi_index_position<2>({1, 0}))](row, 0) * x;
      v += basis[static_cast<std::size_t>(multi_index_position<2>({0, 1}))](row, 0) * x;
    }
    return u.cross(v).norm();
  }

  const Surface &shape_, &load_;
  RationalBasis<2> functions_;
  std::array<int, 2> points_{};
  int local_ = 1;
  double largest_ = 0;
};

}  // namespace

Expected<Points> area_load_forces(const Surface& shape, const Surface& load) {
  std::array<std::vector<double>, 2> breaks;
  for (std::size_t d = 0; d < 2; ++d) {
    const Interval a = shape.knots()[d].domain(), b = load.knots()[d].domain();
    if (a.lower != b.lower || a.upper != b.upper) {
      return input_error(
          fmt::format("the domains [{}, {}] of the shape and [{}, {}] of the load differ", a.lower,
                      a.upper, b.lower, b.upper),
          fmt::format("load: direction {}", d == 0 ? "u" : "v"),
          "give a load over the domain of the shape");
    }
    breaks[d] = common_breaks(shape.knots()[d], load.knots()[d]);
  }
  const auto weighted =
      shape.rational()
          ? Expected<Surface>(shape)
          : Surface::create(shape.knots(), shape.control_points(),
                            std::vector<double>(static_cast<std::size_t>(shape.size()), 1.0));
  if (!weighted) return std::unexpected(weighted.error());
  const AreaLoad forces(shape, *weighted, load);
  Points result = Points::Zero(shape.size(), 3);
  for (std::size_t i = 0; i + 1 < breaks[0].size(); ++i) {
    for (std::size_t j = 0; j + 1 < breaks[1].size(); ++j) {
      const Piece piece{{breaks[0][i], breaks[1][j]}, {breaks[0][i + 1], breaks[1][j + 1]}};
      if (auto ok = forces.add(piece, -1, most_area_halvings, result); !ok)
        return std::unexpected(ok.error());
    }
  }
  return result;
}

}  // namespace knead
