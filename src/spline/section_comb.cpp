#include "section_comb.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <unordered_map>

#include "grid_lines.hpp"
#include "knead/spline/curvature.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

constexpr double on_plane = 1e-12;   // of the extent
constexpr int most_iterations = 60;  // bisection alone would reach the last bit

/// A side of a cell of the grid that the plane crosses.
struct CrossedSide {
  int direction = 0;  ///< the parameter that runs
  double at = 0;      ///< the other one
  /// Of the one that runs; the plane's value is negative at the first.
  std::array<double, 2> bracket = {};
  std::array<int, 2> next = {-1, -1};  ///< the crossed sides to which curves go on
};

/// Where a plane crosses the sides of a grid, and which of them its curves join.
class Crossings {
 public:
  Crossings(const std::array<std::vector<double>, 2>& grid, const Eigen::VectorXd& values)
      : grid_(grid), values_(values), columns_(static_cast<int>(grid[1].size())) {
    const int rows = static_cast<int>(grid[0].size());
    for (int i = 0; i + 1 < rows; ++i) {
      for (int j = 0; j + 1 < columns_; ++j) cell(i, j);
    }
  }
  std::vector<CrossedSide> sides;

 private:
  [[nodiscard]] double value(int i, int j) const { return values_[i * columns_ + j]; }
  /// The number of a crossed side that begins at (i, j); −1 if it is not crossed.
  int side(int i, int j, int direction) {
    const double from = value(i, j), to = direction == 0 ? value(i + 1, j) : value(i, j + 1);
    if ((from >= 0) == (to >= 0)) return -1;
    const auto [found, fresh] =
        numbers_.try_emplace(2 * (static_cast<std::int64_t>(i) * columns_ + j) + direction,
                             static_cast<int>(sides.size()));
    if (!fresh) return found->second;
    const auto& along = grid_[static_cast<std::size_t>(direction)];
    const auto k = static_cast<std::size_t>(direction == 0 ? i : j);
    CrossedSide& made = sides.emplace_back();
    made.direction = direction;
    made.at = direction == 0 ? grid_[1][static_cast<std::size_t>(j)]
                             : grid_[0][static_cast<std::size_t>(i)];
    made.bracket =
        from < 0 ? std::array{along[k], along[k + 1]} : std::array{along[k + 1], along[k]};
    return found->second;
  }
  void join(int a, int b) {
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
      auto& next = sides[static_cast<std::size_t>(from)].next;
      next[next[0] < 0 ? 0 : 1] = to;
    }
  }
  void cell(int i, int j) {
    // Round the cell: below, right, above, left.
    const std::array<int, 4> round = {side(i, j, 0), side(i + 1, j, 1), side(i, j + 1, 0),
                                      side(i, j, 1)};
    std::vector<int> crossed;
    for (const int s : round) {
      if (s >= 0) crossed.push_back(s);
    }
    if (crossed.size() == 2) join(crossed[0], crossed[1]);
    if (crossed.size() != 4) return;
    // A saddle: the middle is on the side of two opposite corners, which the curves do not
    // separate.
    const double middle = value(i, j) + value(i + 1, j) + value(i, j + 1) + value(i + 1, j + 1);
    const bool first = (middle >= 0) == (value(i, j) >= 0);
    join(round[0], round[first ? 1 : 3]);
    join(round[2], round[first ? 3 : 1]);
  }

  const std::array<std::vector<double>, 2>& grid_;
  const Eigen::VectorXd& values_;
  int columns_;
  std::unordered_map<std::int64_t, int> numbers_;
};

/// The roots of all sides at once: Newton iteration, or bisection where that leaves the bracket.
Expected<Parameters<2>> roots(const Surface& surface, const SectionPlane& plane,
                              std::vector<CrossedSide>& sides, double accuracy) {
  Parameters<2> at(static_cast<Eigen::Index>(sides.size()), 2);
  for (Eigen::Index k = 0; k < at.rows(); ++k) {
    const CrossedSide& s = sides[static_cast<std::size_t>(k)];
    at(k, s.direction) = (s.bracket[0] + s.bracket[1]) / 2;
    at(k, 1 - s.direction) = s.at;
  }
  for (int round = 0; round < most_iterations; ++round) {
    const auto found = evaluate<2>(surface, at, 1);
    if (!found) return std::unexpected(found.error());
    bool all = true;
    for (Eigen::Index k = 0; k < at.rows(); ++k) {
      CrossedSide& s = sides[static_cast<std::size_t>(k)];
      double& u = at(k, s.direction);
      const double value = found->points().row(k).dot(plane.normal) - plane.offset;
      if (std::abs(value) <= accuracy) continue;
      all = false;
      s.bracket[value < 0 ? 0 : 1] = u;
      const Points& rates = found->at(s.direction == 0 ? std::array{1, 0} : std::array{0, 1});
      const double newton = u - value / rates.row(k).dot(plane.normal);
      const auto [least, most] = std::minmax(s.bracket[0], s.bracket[1]);
      u = newton > least && newton < most ? newton : (least + most) / 2;
    }
    if (all) break;
  }
  return at;
}

/// κN of the curve in which the plane cuts the surface.
Point section_curvature(const Evaluation<2>& s, Eigen::Index k, const Point& across) {
  const Point u = s.at({1, 0}).row(k), v = s.at({0, 1}).row(k);
  const Point n = u.cross(v).stableNormalized(), along = across.cross(n);
  const double sine = along.norm();
  const double area = n.dot(u.cross(v));
  if (!(area > 0) || !(sine > 0)) return Point::Zero();
  const Point t = along / sine, b = t.cross(across);
  // t = p S_u + q S_v
  const double p = t.cross(v).dot(n) / area, q = u.cross(t).dot(n) / area;
  const Point bend = p * p * s.at({2, 0}).row(k).transpose() +
                     2 * p * q * s.at({1, 1}).row(k).transpose() +
                     q * q * s.at({0, 2}).row(k).transpose();
  return bend.dot(n) / b.dot(n) * b;
}

/// The sides along each curve, in order: open ones from an end, closed ones back to their first.
std::vector<std::vector<int>> curves_of(const std::vector<CrossedSide>& sides) {
  std::vector<std::vector<int>> curves;
  std::vector<bool> followed(sides.size(), false);
  const auto follow = [&](int start) {
    std::vector<int>& curve = curves.emplace_back();
    int before = -1;
    for (int k = start; k >= 0;) {
      curve.push_back(k);
      if (followed[static_cast<std::size_t>(k)]) break;  // back at the start
      followed[static_cast<std::size_t>(k)] = true;
      const auto& [a, b] = sides[static_cast<std::size_t>(k)].next;
      const int next = a == before ? b : a;
      before = k;
      k = next;
    }
  };
  for (const bool ends : {true, false}) {
    for (std::size_t k = 0; k < sides.size(); ++k) {
      if (!followed[k] && (!ends || sides[k].next[1] < 0)) follow(static_cast<int>(k));
    }
  }
  return curves;
}

}  // namespace

Expected<std::vector<SectionComb>> section_combs(const Surface& surface, const SectionPlane& plane,
                                                 double tolerance) {
  if (!(std::abs(plane.normal.norm() - 1) <= 1e-9) || !std::isfinite(plane.offset)) {
    return std::unexpected(Error{ErrorKind::usage, "this is no plane", "normal",
                                 "give a normal of length 1 and a finite offset"});
  }
  if (!(tolerance > 0)) {
    return std::unexpected(Error{ErrorKind::usage, "the tolerance of chords is not positive",
                                 "tolerance", "give a length"});
  }
  ChordOptions options;
  options.tolerance = tolerance;
  options.detail = 24;
  const auto lines = grid_lines(surface, options);
  if (!lines) return std::unexpected(lines.error());
  const std::array grid = {(*lines)[0].parameters, (*lines)[1].parameters};
  const auto places = evaluate_grid<2>(surface, {grid[0], grid[1]});
  if (!places) return std::unexpected(places.error());
  const Eigen::VectorXd values = (places->points() * plane.normal).array() - plane.offset;
  Crossings crossings(grid, values);
  if (crossings.sides.empty()) return std::vector<SectionComb>();
  const Points& net = surface.control_points();
  const double extent = (net.colwise().maxCoeff() - net.colwise().minCoeff()).norm();
  const auto at = roots(surface, plane, crossings.sides, on_plane * extent);
  if (!at) return std::unexpected(at.error());
  const auto found = evaluate<2>(surface, *at, 2);
  if (!found) return std::unexpected(found.error());
  std::vector<SectionComb> combs;
  for (const std::vector<int>& curve : curves_of(crossings.sides)) {
    SectionComb& comb = combs.emplace_back();
    const auto size = static_cast<Eigen::Index>(curve.size());
    comb.parameters.resize(size, 2);
    comb.places.resize(size, 3);
    comb.vectors.resize(size, 3);
    for (Eigen::Index k = 0; k < size; ++k) {
      const Eigen::Index row = curve[static_cast<std::size_t>(k)];
      comb.parameters.row(k) = at->row(row);
      comb.places.row(k) = found->points().row(row);
      comb.vectors.row(k) = section_curvature(*found, row, plane.normal).transpose();
    }
  }
  return combs;
}

}  // namespace knead
