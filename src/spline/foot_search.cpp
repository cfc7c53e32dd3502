#include "foot_search.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace knead::detail {
namespace {

constexpr int most_cells = 8000;
constexpr double smallest_cell = 1e-6;  ///< of the size
constexpr double margin = 1e-12;        ///< of squared lengths: differences hidden by rounding

/// Whether tangents turn so little over a leaf that the tests of `examine` usually decide at once.
/// Leaves are made once, for all queries: finer ones cost memory, coarser ones a descent in every
/// query. Tangents that vary by a fifth of their mean let the sign of the slope be decided at most
/// places; below 2 % of the size nothing is gained by halving.
bool fine_enough(const PatchBounds& b, const ParameterRectangle& at, double size) {
  for (std::size_t d = 0; d < 2; ++d) {
    if (at.side[d].length() == 0) continue;
    const Range3& t = b[1 + d];
    const double spread = 0.5 * t.diagonal();
    const double mid =
        0.5 * std::hypot(t.axis[0].lower + t.axis[0].upper, t.axis[1].lower + t.axis[1].upper,
                         t.axis[2].lower + t.axis[2].upper);
    if (spread > 0.2 * mid && t.magnitude() * at.side[d].length() > 0.02 * size) return false;
  }
  return true;
}

/// The side along which to halve the cell: the longer one in space. If a cell touches a pole and
/// the tangents leaving it still vary a lot, it is the side around the pole.
/// Halving towards a pole would not help, as the tangents around it point everywhere however short
/// the cell is.
std::size_t side_to_halve(const PatchBounds& b, const ParameterRectangle& at) {
  const std::array<double, 2> extent = {b[1].magnitude() * at.side[0].length(),
                                        b[2].magnitude() * at.side[1].length()};
  if (at.side[0].length() == 0) return 1;
  if (at.side[1].length() == 0) return 0;
  const std::size_t longer = extent[0] >= extent[1] ? 0 : 1, round = 1 - longer;
  const Range3& t = b[1 + round];
  const bool touches = t.axis[0].holds_zero() && t.axis[1].holds_zero() && t.axis[2].holds_zero();
  return touches && b[4].magnitude() * at.side[round].length() > 0.5 * b[1 + longer].magnitude()
             ? round
             : longer;
}

std::array<ParameterRectangle, 2> halves(const ParameterRectangle& at, std::size_t side) {
  std::array<ParameterRectangle, 2> h = {at, at};
  h[0].side[side].upper = h[1].side[side].lower = at.centre()[side];
  return h;
}

/// Of two feet that differ only by rounding: the one with the smaller gradient, then the one
/// further from a pole.
bool firmer(const Foot& a, const Foot& b) {
  if (std::abs(a.pressure - b.pressure) > 1e-11) return a.pressure < b.pressure;
  return a.jet[1].cross(a.jet[2]).squaredNorm() > b.jet[1].cross(b.jet[2]).squaredNorm();
}

}  // namespace

struct FootSearch::Query {
  Point x;
  double bound = std::numeric_limits<double>::infinity();
  std::vector<Foot> feet;
  double limit = bound;  ///< distances within rounding of `bound`
  double rounding = 0;   ///< a negligible length

  int patch = -1;              ///< where `bound` was found
  std::array<double, 2> at{};  ///< and at which parameters

  void lower(double squared, int on, const std::array<double, 2>& where) {
    if (squared >= bound) return;
    patch = on;
    at = where;
    bound = squared;
    limit = loosened(squared);
  }
  [[nodiscard]] double loosened(double squared) const {
    return squared * (1 + margin) + rounding * (2 * std::sqrt(squared) + rounding);
  }
  [[nodiscard]] bool close(double squared) const { return squared <= limit; }
  bool certified = true;
  int cells = 0;
};

FootSearch::FootSearch(std::vector<std::unique_ptr<Patch>> patches, double size)
    : patches_(std::move(patches)), size_(size) {
  std::vector<int> roots;
  for (std::size_t k = 0; k < patches_.size(); ++k) {
    roots.push_back(build_patch(static_cast<int>(k), patches_[k]->domain, 0));
  }
  root_ = join(std::move(roots));
}

int FootSearch::build_patch(int patch, const ParameterRectangle& at, int depth) {
  const PatchBounds bounds = patches_[index(patch)]->bounds(at);
  const int node = static_cast<int>(nodes_.size());
  nodes_.push_back({bounds[0], {-1, -1}, -1});
  if (depth >= 10 || fine_enough(bounds, at, size_)) {
    nodes_.back().leaf = static_cast<int>(leaves_.size());
    leaves_.push_back({patch, at, bounds});
    return node;
  }
  const auto parts = halves(at, side_to_halve(bounds, at));
  const std::array<int, 2> child = {build_patch(patch, parts[0], depth + 1),
                                    build_patch(patch, parts[1], depth + 1)};
  nodes_[index(node)].child = child;
  Range3 box = nodes_[index(child[0])].box;
  box.include(nodes_[index(child[1])].box);
  nodes_[index(node)].box = box;
  return node;
}

int FootSearch::join(std::vector<int> nodes) {
  if (nodes.size() == 1) return nodes.front();
  Range3 box = nodes_[index(nodes.front())].box;
  for (int k : nodes) box.include(nodes_[index(k)].box);
  std::size_t axis = 0;
  for (std::size_t a = 1; a < 3; ++a) {
    if (box.axis[a].length() > box.axis[axis].length()) axis = a;
  }
  const auto middle = [&](int k) {
    const Range& r = nodes_[index(k)].box.axis[axis];
    return r.lower + r.upper;
  };
  const auto half = nodes.begin() + static_cast<std::ptrdiff_t>(nodes.size() / 2);
  std::nth_element(nodes.begin(), half, nodes.end(),
                   [&](int a, int b) { return middle(a) < middle(b); });
  const int left = join({nodes.begin(), half}), right = join({half, nodes.end()});
  nodes_.push_back({box, {left, right}, -1});
  return static_cast<int>(nodes_.size()) - 1;
}

FootResult FootSearch::nearest(const Point& x) const {
  Query q;
  q.x = x;
  q.rounding = 1e-14 * (size_ + x.norm());
  struct Open {
    double lower;
    int node;
  };
  std::array<Open, 256> stack;
  std::size_t open = 0;
  stack[open++] = {box().squared_distance(x), root_};
  while (open > 0) {
    const Open next = stack[--open];
    if (!q.close(next.lower)) continue;
    const Node& node = nodes_[index(next.node)];
    if (node.leaf >= 0) {
      const Leaf& leaf = leaves_[index(node.leaf)];
      if (q.feet.empty() && !std::isfinite(q.bound)) {
        const Foot f =
            descend(q, leaf.patch, patches_[index(leaf.patch)]->domain, leaf.at.centre());
        q.lower(f.squared, leaf.patch, f.at);
      }
      examine(q, leaf.patch, leaf.at, leaf.bounds, 0);
      continue;
    }
    Open a = {nodes_[index(node.child[0])].box.squared_distance(x), node.child[0]};
    Open b = {nodes_[index(node.child[1])].box.squared_distance(x), node.child[1]};
    if (a.lower < b.lower) std::swap(a, b);  // the nearer one is examined first
    stack[open++] = a;
    stack[open++] = b;
  }

  FootResult result;
  result.cells = q.cells;
  result.certified = q.certified && !q.feet.empty();
  if (q.feet.empty()) {
    const int patch = std::max(q.patch, 0);  // squares that overflow found none
    q.feet.push_back(descend(q, patch, patches_[index(patch)]->domain, q.at));
  }
  double least = std::numeric_limits<double>::infinity();
  for (const Foot& f : q.feet) least = std::min(least, f.squared);
  const double tie = q.loosened(least);
  const Foot* best = nullptr;
  for (const Foot& f : q.feet) {
    if (f.squared <= tie && (best == nullptr || firmer(f, *best))) best = &f;
  }
  if (best == nullptr) {  // squares that overflow compare with nothing
    result.best = q.feet.front();
    result.best.patch = std::max(result.best.patch, 0);
    result.certified = false;
    return result;
  }
  result.best = *best;
  for (int round = 0; round < 2; ++round) {  // the second if the first went to a cusp
    const Foot polished =
        descend(q, result.best.patch, patches_[index(result.best.patch)]->domain, result.best.at);
    if (polished.squared > tie || polished.at == result.best.at) break;
    result.best = polished;
  }
  if (result.best.pressed[0] || result.best.pressed[1]) {
    for (const Foot& f : q.feet) {
      const auto apart = [&](int d) { return std::abs(f.at[d] - result.best.at[d]) > 1e-3; };
      const bool elsewhere = f.patch != result.best.patch || apart(0) || apart(1);
      if (elsewhere && (f.jet[0] - result.best.jet[0]).norm() < 1e-9 * size_) {
        result.neighbours.push_back(f);
      }
    }
  }
  return result;
}

// In the order of their cost: the distance of the box; the signs of (S − x)·S_u and (S − x)·S_v by
// intervals, where a slope of one sign moves the search to the border or ends it; the Hessian by
// intervals, S_u·S_u + (S − x)·S_uu and so on, positive definite by its diagonal and determinant; a
// lower bound by the mean value form. What none of them decides is halved. Interval results err
// outwards, and `margin` covers the rounding of the comparisons: nothing is discarded that could be
// nearer.
void FootSearch::examine(Query& q, int patch, ParameterRectangle at, PatchBounds bounds,
                         int depth) const {
  const Patch& p = *patches_[index(patch)];
  for (bool changed = true; changed;) {
    changed = false;
    if (++q.cells > most_cells) {
      q.certified = false;
      return;
    }
    if (!q.close(bounds[0].squared_distance(q.x))) return;
    const Range3 way = bounds[0] - q.x;
    for (std::size_t d = 0; d < 2 && !changed; ++d) {
      if (at.side[d].length() == 0) continue;
      const Range slope = way.dot(bounds[6 + d]);
      const double rounding = 1e-14 * way.magnitude() * bounds[6 + d].magnitude();
      const bool first = at.side[d].lower == p.domain.side[d].lower,
                 last = at.side[d].upper == p.domain.side[d].upper;
      if (slope.lower > rounding || (first && slope.lower >= 0)) {
        if (!first) return;
        at.side[d].upper = at.side[d].lower;
        changed = true;
      } else if (slope.upper < -rounding || (last && slope.upper <= 0)) {
        if (!last) return;
        at.side[d].lower = at.side[d].upper;
        changed = true;
      }
    }
    if (changed) bounds = p.bounds(at);
  }
  const Range3 way = bounds[0] - q.x;
  const bool free_u = at.side[0].length() > 0, free_v = at.side[1].length() > 0;
  const Range uu = bounds[1].squared_norm() + way.dot(bounds[3]),
              vv = bounds[2].squared_norm() + way.dot(bounds[5]);
  bool convex = (!free_u || uu.lower > 0) && (!free_v || vv.lower > 0);
  if (convex && free_u && free_v) {
    const double uv = (bounds[1].dot(bounds[2]) + way.dot(bounds[4])).magnitude();
    convex = uu.lower * vv.lower > uv * uv;
  }
  const auto c = at.centre();
  const PatchJet jet = p.jet(c[0], c[1]);
  const Point middle_way = jet[0] - q.x;
  const double middle = middle_way.squaredNorm();
  if (convex) {
    // A convex function lies above its tangent plane.
    const double fall = std::abs(middle_way.dot(jet[1])) * at.side[0].length() +
                        std::abs(middle_way.dot(jet[2])) * at.side[1].length();
    if (q.close(middle - fall))
      record(q, descend(q, patch, at, q.patch == patch && at.holds(q.at) ? q.at : c));
    return;
  }
  // |x − S|² >= |x − S(centre)|² − 2 Σ max|∂| half side (mean value form).
  const bool nearer = middle < q.bound;
  q.lower(middle, patch, c);
  const double fall = way.dot(bounds[1]).magnitude() * at.side[0].length() +
                      way.dot(bounds[2]).magnitude() * at.side[1].length();
  if (!q.close(middle - fall)) return;
  if (depth == 0 && nearer) {
    const Foot f = descend(q, patch, p.domain, c);
    q.lower(f.squared, patch, f.at);
  }
  const double extent = std::max(bounds[1].magnitude() * at.side[0].length(),
                                 bounds[2].magnitude() * at.side[1].length());
  if (extent < smallest_cell * size_ || depth > 60) {
    const double hidden = q.bound - (middle - fall);
    if (hidden > 1e-11 * size_ * (size_ + std::sqrt(q.bound))) q.certified = false;
    record(q, descend(q, patch, p.domain, c));
    return;
  }
  halve(q, patch, at, bounds, depth);
}

void FootSearch::halve(Query& q, int patch, const ParameterRectangle& at, const PatchBounds& bounds,
                       int depth) const {
  auto parts = halves(at, side_to_halve(bounds, at));
  std::array<PatchBounds, 2> b = {patches_[index(patch)]->bounds(parts[0]),
                                  patches_[index(patch)]->bounds(parts[1])};
  const bool swap = b[1][0].squared_distance(q.x) < b[0][0].squared_distance(q.x);
  examine(q, patch, parts[swap ? 1 : 0], b[swap ? 1 : 0], depth + 1);
  examine(q, patch, parts[swap ? 0 : 1], b[swap ? 0 : 1], depth + 1);
}

Foot FootSearch::descend(const Query& q, int patch, const ParameterRectangle& within,
                         const std::array<double, 2>& start) const {
  Foot foot = descended(q.x, *patches_[index(patch)], within, start, size_);
  if (foot.patch >= 0) foot.patch = patch;
  return foot;
}

void FootSearch::record(Query& q, const Foot& foot) const {
  if (foot.patch >= 0) q.lower(foot.squared, foot.patch, foot.at);
  if (foot.patch >= 0 && q.close(foot.squared)) q.feet.push_back(foot);
}

}  // namespace knead::detail
