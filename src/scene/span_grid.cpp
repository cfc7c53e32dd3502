#include "span_grid.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "knead/spline/extremum.hpp"
#include "places.hpp"

namespace knead {
namespace {

using Box = Eigen::AlignedBox3d;

/// Whether the first and the last row of a net are the same points.
bool closes(const Surface& s, int direction) {
  const auto [m, n] = s.net();
  const Points& net = s.control_points();
  const double size = net_size(s);
  constexpr double same = 1e-9;  // of the size
  for (int k = 0; k < (direction == 0 ? n : m); ++k) {
    const auto first = direction == 0 ? net.row(k) : net.row(k * n);
    const auto last = direction == 0 ? net.row((m - 1) * n + k) : net.row(k * n + n - 1);
    if ((first - last).norm() > same * size) return false;
  }
  return true;
}

/// Σ N_i(u) N_j(v) P_ij over the control points of a span, rational where there are weights, at all
/// u and v given by their basis functions.
/// One direction after the other, in homogeneous coordinates: (n_u (p + 1) + n_u n_v) (q + 1)
/// products of four numbers instead of n_u n_v (p + 1) (q + 1).
std::vector<Point> contracted(const Surface& s, std::array<int, 2> first,
                              const std::array<Eigen::MatrixXd, 2>& basis) {
  const Eigen::Index a = basis[0].cols(), b = basis[1].cols();
  Eigen::MatrixXd net(a * b, 4);
  for (Eigen::Index i = 0; i < a; ++i) {
    for (Eigen::Index j = 0; j < b; ++j) {
      const Eigen::Index row = (first[0] + i) * s.net()[1] + first[1] + j;
      const double w = s.rational() ? s.weights()[static_cast<std::size_t>(row)] : 1;
      net.row(i * b + j) << w * s.control_points().row(row), w;
    }
  }
  std::vector<Point> result;
  Eigen::MatrixXd line(b, 4);
  for (Eigen::Index k = 0; k < basis[0].rows(); ++k) {
    line.setZero();
    for (Eigen::Index i = 0; i < a; ++i) line += basis[0](k, i) * net.middleRows(i * b, b);
    for (Eigen::Index l = 0; l < basis[1].rows(); ++l) {
      const Eigen::RowVector4d sum = basis[1].row(l) * line;
      result.emplace_back(sum.head<3>().transpose() / sum[3]);
    }
  }
  return result;
}

/// By which the triangles of a grid of points may miss the surface: h²/8 of the second derivative
/// in each direction, and the twist of a square between its two diagonals.
/// Second differences over 8 bound the chord error of a function that is quadratic over two cells;
/// the mixed difference over 4 bounds the distance between both diagonals of a bilinear cell.
/// Differences stand for derivatives, so this estimates the error and does not bound it; searches
/// that use it widen by it, and what they find is then solved on the surface itself.
double sag_of(const std::vector<Point>& p) {
  constexpr int n = SpanGrid::cells + 1;
  std::array<double, 3> most = {0, 0, 0};
  const auto at = [&](int i, int j) -> const Point& {
    return p[static_cast<std::size_t>(i * n + j)];
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      if (i > 0 && i + 1 < n)
        most[0] = std::max(most[0], (at(i - 1, j) - 2 * at(i, j) + at(i + 1, j)).norm());
      if (j > 0 && j + 1 < n)
        most[1] = std::max(most[1], (at(i, j - 1) - 2 * at(i, j) + at(i, j + 1)).norm());
      if (i + 1 < n && j + 1 < n) {
        most[2] =
            std::max(most[2], (at(i, j) - at(i + 1, j) - at(i, j + 1) + at(i + 1, j + 1)).norm());
      }
    }
  }
  return most[0] / 8 + most[1] / 8 + most[2] / 4;
}

}  // namespace

std::optional<SpanGrid> SpanGrid::create(Motion motion) {
  assert(same_basis(*motion.from, *motion.to));
  // The boxes of control points contain a rational span only with positive weights (convex hull).
  if (std::ranges::any_of(motion.from->weights(), [](double w) { return !(w > 0); }))
    return std::nullopt;
  SpanGrid result(std::move(motion));
  for (const int d : {0, 1}) {
    result.spans_[static_cast<std::size_t>(d)] = result.motion_.from->knots(d).spans();
    result.closed_[static_cast<std::size_t>(d)] = closes(*result.motion_.from, d);
  }
  result.make_boxes();
  return result;
}

/// One direction after the other.
/// For each row of the net first the boxes of q + 1 neighbours in it, then of p + 1 such boxes:
/// O(net (p + q)) instead of O(spans (p + 1)(q + 1)) points. Both ends of the motion are in a box;
/// between them each point goes straight, so that the box contains the way (S(u, t) is a convex
/// combination of both ends at every t). A span moves if one of its control points differs in any
/// bit: then it alone is looked at as something that may run into a wall.
void SpanGrid::make_boxes() {
  const Surface &from = *motion_.from, &to = *motion_.to;
  const int m = from.net()[0], n = from.net()[1], p = from.knots(0).degree(),
            q = from.knots(1).degree();
  const auto columns = static_cast<int>(spans_[1].size());
  const auto index = [columns](int i, int j) { return static_cast<std::size_t>(i * columns + j); };
  std::vector<Box> lines(index(m, 0));
  std::vector<char> moved(index(m, 0), 0);
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < columns; ++j) {
      const int last = spans_[1][static_cast<std::size_t>(j)];
      for (int k = last - q; k <= last; ++k) {
        const Point a = from.control_points().row(i * n + k),
                    b = to.control_points().row(i * n + k);
        lines[index(i, j)].extend(a).extend(b);
        moved[index(i, j)] |= static_cast<char>(a != b);
      }
    }
  }
  const auto rows = static_cast<int>(spans_[0].size());
  boxes_.resize(index(rows, 0));
  moves_.resize(boxes_.size(), 0);
  patches_.resize(boxes_.size());
  for (int i = 0; i < rows; ++i) {
    const int last = spans_[0][static_cast<std::size_t>(i)];
    for (int j = 0; j < columns; ++j) {
      for (int k = last - p; k <= last; ++k) {
        boxes_[index(i, j)].extend(lines[index(k, j)]);
        moves_[index(i, j)] |= moved[index(k, j)];
      }
    }
  }
  // Of a surface that moves only what moves is compared with others; of one that stays, all of it.
  const bool any = std::ranges::any_of(moves_, [](char c) { return c != 0; });
  for (std::size_t k = 0; k < boxes_.size(); ++k) {
    if (!any || moves(k)) box_.extend(boxes_[k]);
  }
}

const BoxTree& SpanGrid::tree() {
  if (!tree_) tree_ = BoxTree(boxes_);
  return *tree_;
}

const Patch& SpanGrid::patch(std::size_t span) {
  if (!patches_[span]) patches_[span] = std::make_unique<const Patch>(made_patch(span));
  return *patches_[span];
}

// (cells + 1)² points of a span before and after, with 2 cells² triangles between them, made when
// the span is first met: most spans never are.
Patch SpanGrid::made_patch(std::size_t span) const {
  const Surface& from = *motion_.from;
  const std::array<std::size_t, 2> of = {span / spans_[1].size(), span % spans_[1].size()};
  std::array<Eigen::MatrixXd, 2> basis;
  std::array<std::array<double, cells + 1>, 2> parameters{};
  std::array<int, 2> first{};
  for (const std::size_t d : {0U, 1U}) {
    const KnotVector& knots = from.knots()[d];
    const int s = spans_[d][of[d]], p = knots.degree();
    first[d] = s - p;
    basis[d].resize(cells + 1, p + 1);
    std::vector<double> row(static_cast<std::size_t>(p + 1));
    for (int k = 0; k <= cells; ++k) {
      // The last one is the knot itself, so that neighbouring spans have the same corner to the
      // bit.
      const double u = k == cells ? knots[s + 1] : knots[s] + (knots[s + 1] - knots[s]) * k / cells;
      parameters[d][static_cast<std::size_t>(k)] = u;
      basis_values(knots, s, u, row.data());
      basis[d].row(k) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), p + 1);
    }
  }
  Patch result;
  result.from = contracted(from, first, basis);
  result.to = motion_.moves() ? contracted(*motion_.to, first, basis) : result.from;
  result.sag = std::max(sag_of(result.from), sag_of(result.to));
  constexpr std::uint32_t n = cells + 1;
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      result.at.push_back({parameters[0][i], parameters[1][j]});
      if (i == cells || j == cells) continue;
      const std::uint32_t k = i * n + j;
      result.triangles.push_back({k, k + n, k + n + 1});
      result.triangles.push_back({k, k + n + 1, k + 1});
    }
  }
  return result;
}

// A continuous count of cells from the start of the domain, the same for spans of any length.
double SpanGrid::cell_of(int direction, double u) const {
  const KnotVector& knots = motion_.from->knots(direction);
  const std::vector<int>& spans = spans_[static_cast<std::size_t>(direction)];
  const int s = knots.find_span(std::clamp(u, knots.domain().lower, knots.domain().upper));
  const auto k = std::ranges::lower_bound(spans, s) - spans.begin();
  return cells * (static_cast<double>(k) + (u - knots[s]) / (knots[s + 1] - knots[s]));
}

// The larger of both directions; around a closed one the shorter way counts.
double SpanGrid::cells_between(const std::array<double, 2>& a,
                               const std::array<double, 2>& b) const {
  double most = 0;
  for (const std::size_t d : {0U, 1U}) {
    const auto direction = static_cast<int>(d);
    double way = std::abs(cell_of(direction, a[d]) - cell_of(direction, b[d]));
    if (closed_[d]) way = std::min(way, cells * static_cast<double>(spans_[d].size()) - way);
    most = std::max(most, way);
  }
  return most;
}

// A surface that is a graph over a plane cannot meet itself. Sufficient for that: all facets of the
// net, before and after, look to the same side of the sum of all, n_ij · Σ n >= 0, n_ij being the
// cross product of the diagonals of a facet. This is a cheap filter (O(net)) that spares nearly all
// surfaces a comparison of every span with every other. It judges by the facets alone, and so takes
// a surface between control points to be like its net.
bool SpanGrid::may_meet_itself() const {
  const auto [m, n] = motion_.from->net();
  std::vector<Point> normals;
  Point sum = Point::Zero();
  for (const auto* shape : {motion_.from.get(), motion_.to.get()}) {
    const Points& net = shape->control_points();
    for (int i = 0; i + 1 < m; ++i) {
      for (int j = 0; j + 1 < n; ++j) {
        const Point across = net.row((i + 1) * n + j + 1) - net.row(i * n + j),
                    other = net.row(i * n + j + 1) - net.row((i + 1) * n + j);
        normals.emplace_back(across.cross(other));
        sum += normals.back();
      }
    }
    if (!motion_.moves()) break;
  }
  return std::ranges::any_of(normals, [&](const Point& normal) { return normal.dot(sum) < 0; });
}

}  // namespace knead
