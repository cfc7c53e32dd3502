#include "knead/spline/spline_refinement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

namespace knead {
namespace {

using Index = Eigen::Index;

/// One row per control point of the direction: for each line of the net, the fields' homogeneous
/// coordinates.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Several fields (3 columns each) and a weight at (row, line): columns line · width … of `Rows`.
struct Layout {
  Index lines = 0, fields = 0;
  bool rational = false;
  [[nodiscard]] Index width() const { return 3 * fields + (rational ? 1 : 0); }
  [[nodiscard]] double weight(const Rows& rows, Index i, Index line) const {
    return rational ? rows(i, line * width() + 3 * fields) : 1;
  }
  [[nodiscard]] Point cartesian(const Rows& rows, Index i, Index line, Index field) const {
    return rows.row(i).segment<3>(line * width() + 3 * field).transpose() / weight(rows, i, line);
  }
};

/// The effect of removing one knot u of multiplicity m on the rows first … last: their coefficients
/// must satisfy Σ (−1)^(k − first) size_k c_k = 0.
/// Removing u undoes a knot insertion, fine row k = left_k · new row k + right_k · new row k − 1:
/// one equation more than unknowns. Eliminating the new rows leaves one condition on the fine ones
/// with alternating signs and size_k = size_{k−1} left_{k−1} / right_k; what violates it is the
/// jump that the knot carries (Tiller, Knot-removal algorithms for NURBS curves and surfaces, 1992;
/// The NURBS Book, § 5.4).
struct Relation {
  int first = 0, last = 0, knot = 0;
  std::vector<double> size;         ///< of rows first … last, the largest 1
  std::vector<double> left, right;  ///< fine row k = left_k · new row k + right_k · new row k − 1

  [[nodiscard]] bool fixed(int row, int count) const { return row == 0 || row == count - 1; }
};

/// \param knot index of the last copy of the knot
std::optional<Relation> relation(const KnotVector& y, int knot) {
  const int p = y.degree(), multiplicity = y.multiplicity(y[knot]);
  const double u = y[knot];
  // Knots without this one: those above `knot` move down by one.
  const auto x = [&](int i) { return i < knot ? y[i] : y[i + 1]; };
  Relation r;
  r.knot = knot;
  r.first = knot - 1 - p;
  r.last = knot - multiplicity + 1;
  const auto rows = static_cast<std::size_t>(r.last - r.first + 1);
  r.left.assign(rows, 1);
  r.right.assign(rows, 1);
  for (std::size_t k = 1; k + 1 < rows; ++k) {
    const int i = r.first + static_cast<int>(k);
    const double length = x(i + p) - x(i);
    r.left[k] = (u - x(i)) / length;
    r.right[k] = (x(i + p) - u) / length;
  }
  r.size.assign(rows, 1);
  double largest = 1;
  for (std::size_t k = 1; k < rows; ++k) {
    r.size[k] = r.size[k - 1] * r.left[k - 1] / r.right[k];
    largest = std::max(largest, r.size[k]);
  }
  if (!std::isfinite(largest)) return std::nullopt;
  for (double& value : r.size) value /= largest;
  return r;
}

/// Σ_k (−1)^k size_k c_k for all columns, and Σ_k size_k w_k over the rows that may change, per
/// line.
void violation(const Rows& c, const Layout& layout, const Relation& r, Eigen::RowVectorXd& jump,
               Eigen::VectorXd& total) {
  jump.setZero(c.cols());
  total.setZero(layout.lines);
  for (int i = r.first; i <= r.last; ++i) {
    const double size = r.size[static_cast<std::size_t>(i - r.first)];
    jump += ((i - r.first) % 2 == 0 ? size : -size) * c.row(i);
    if (r.fixed(i, static_cast<int>(c.rows()))) continue;
    for (Index line = 0; line < layout.lines; ++line)
      total[line] += size * layout.weight(c, i, line);
  }
}

/// A lower bound on the movement of points, from the control points near this knot.
/// To meet Σ ± size_k c_k = 0 by changing rows of which the sizes sum up to `total`, some row moves
/// by |jump| / total at least.
double smallest_change(const Rows& c, const Layout& layout, const Relation& r) {
  Eigen::RowVectorXd jump;
  Eigen::VectorXd total;
  violation(c, layout, r, jump, total);
  double worst = 0;
  for (Index line = 0; line < layout.lines; ++line) {
    for (Index f = 0; f < layout.fields; ++f) {
      const Point value = jump.segment<3>(line * layout.width() + 3 * f).transpose();
      if (!layout.rational) {
        worst = std::max(worst, value.norm() / total[line]);
        continue;
      }
      const double weight = jump[line * layout.width() + 3 * layout.fields];
      for (int i = r.first; i <= r.last; ++i) {
        if (r.fixed(i, static_cast<int>(c.rows()))) continue;
        worst = std::max(worst,
                         (value - weight * layout.cartesian(c, i, line, f)).norm() / total[line]);
      }
    }
  }
  return worst;
}

/// The coefficients without the knot, changed as little as possible.
/// First all rows that may change take an equal share of the jump, in proportion to their weights:
/// the smallest change in the maximum norm. Then the equations have a solution, found from both
/// ends, each as long as it divides by a number of at least one half, so that rounding does not
/// grow.
Rows without_knot(Rows c, const Layout& layout, const Relation& r) {
  Eigen::RowVectorXd jump;
  Eigen::VectorXd total;
  violation(c, layout, r, jump, total);
  const int count = static_cast<int>(c.rows());
  for (int i = r.first; i <= r.last; ++i) {
    if (r.fixed(i, count)) continue;
    for (Index line = 0; line < layout.lines; ++line) {
      const double share = layout.weight(c, i, line) / total[line];
      c.row(i).segment(line * layout.width(), layout.width()) -=
          ((i - r.first) % 2 == 0 ? share : -share) *
          jump.segment(line * layout.width(), layout.width());
    }
  }
  // New rows from both ends, dividing by the larger coefficient each; the remaining equation in the
  // middle holds.
  Rows result(count - 1, c.cols());
  result.topRows(r.first + 1) = c.topRows(r.first + 1);
  result.bottomRows(count - r.last) = c.bottomRows(count - r.last);
  int from_left = r.first;
  for (; from_left + 1 < r.last - 1; ++from_left) {
    const int i = from_left + 1;
    const auto k = static_cast<std::size_t>(i - r.first);
    if (r.left[k] < 0.5) break;
    result.row(i) = (c.row(i) - r.right[k] * result.row(i - 1)) / r.left[k];
  }
  for (int i = r.last - 1; i - 1 > from_left; --i) {
    const auto k = static_cast<std::size_t>(i - r.first);
    result.row(i - 1) = (c.row(i) - r.left[k] * result.row(i)) / r.right[k];
  }
  return result;
}

/// A bound for the distance of the spline `coarse` from the spline `fine`, both with positive
/// weights; infinite if there is none.
/// The coarse spline is refined back onto the knots of the original one; distances of control
/// points there bound those of points (convex hull), so that the tolerance holds everywhere and not
/// at samples. With weights w and w' the difference of A/W and A'/W' is [w' (P − P') + (w − w')(P −
/// S')] / W summed with the basis, S' the coarse spline's point, which its box bounds. The last
/// term is for the rounding of the insertion.
double certified_distance(const Rows& coarse, const Rows& fine, const Layout& layout,
                          const Refinement& refinement) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Eigen::Array3Xd lower(3, layout.fields), upper(3, layout.fields);
  lower.setConstant(infinite);
  upper.setConstant(-infinite);
  for (Index i = 0; i < coarse.rows(); ++i) {
    for (Index line = 0; line < layout.lines; ++line) {
      if (!(layout.weight(coarse, i, line) > 0)) return infinite;
      for (Index f = 0; f < layout.fields; ++f) {
        const Eigen::Array3d at = layout.cartesian(coarse, i, line, f).array();
        if (!at.allFinite()) return infinite;
        lower.col(f) = lower.col(f).min(at);
        upper.col(f) = upper.col(f).max(at);
      }
    }
  }
  Rows back(fine.rows(), fine.cols());
  refinement.apply(coarse.data(), back.data(), 1, static_cast<int>(coarse.cols()));
  double bound = 0, largest = 0;
  for (Index i = 0; i < fine.rows(); ++i) {
    for (Index line = 0; line < layout.lines; ++line) {
      const double w = layout.weight(fine, i, line), back_w = layout.weight(back, i, line);
      for (Index f = 0; f < layout.fields; ++f) {
        const Point point = layout.cartesian(fine, i, line, f);
        double distance = (point - layout.cartesian(back, i, line, f)).norm();
        if (layout.rational) {
          const auto range =
              (point.array() - lower.col(f)).abs().max((point.array() - upper.col(f)).abs());
          distance = (back_w * distance + std::abs(w - back_w) * range.matrix().norm()) / w;
        }
        // Written so that a NaN does not pass.
        if (!(distance <= bound)) bound = distance;
        largest = std::max(largest, point.cwiseAbs().maxCoeff());
      }
    }
  }
  largest = std::max({largest, lower.abs().maxCoeff(), upper.abs().maxCoeff()});
  const int p = refinement.from().degree();
  return std::isnan(bound)
             ? infinite
             : bound + 16 * (p + 2) * std::numeric_limits<double>::epsilon() * largest;
}

KnotVector without(const KnotVector& knots, int index) {
  std::vector<double> rest(knots.knots().begin(), knots.knots().end());
  rest.erase(rest.begin() + index);
  return *KnotVector::create(knots.degree(), std::move(rest));
}

/// Indices of the last copy of each knot strictly inside the domain.
std::vector<int> inner_knots(const KnotVector& knots) {
  std::vector<int> result;
  for (int i = knots.degree() + 1; i < knots.count(); ++i) {
    if (knots.domain().lower < knots[i] && knots[i] < knots[i + 1]) result.push_back(i);
  }
  return result;
}

/// The state of the greedy loop.
struct Reduction {
  KnotVector knots;
  Rows rows;
  std::vector<int> origin;  ///< row of the original net that a row still equals; −1 if changed
  std::vector<double> removed, refused;
  std::map<double, double> change;  ///< `smallest_change` by knot, where still valid
  double bound = 0;

  /// Drops what depends on changed rows or knots when the knot of this index is removed.
  void forget_around(int knot) {
    const int reach = 2 * knots.degree() + 3, last = static_cast<int>(knots.knots().size()) - 1;
    change.erase(change.lower_bound(knots[std::max(0, knot - reach)]),
                 change.upper_bound(knots[std::min(last, knot + reach)]));
  }
};

/// Removes one more knot; false if none can be removed.
/// Greedy: the knot of the least change first, tested against the original spline and not the last
/// one, so that errors do not add up unseen. A knot that was refused is not tried again, as
/// removals only take freedom. Changes are cached by knot, and forgotten 2 p + 3 knots around a
/// removal, which is as far as it moves rows.
bool remove_one(Reduction& state, const Rows& original, const KnotVector& original_knots,
                const Layout& layout, double tolerance) {
  std::vector<std::pair<double, Relation>> candidates;
  for (const int knot : inner_knots(state.knots)) {
    if (std::ranges::find(state.refused, state.knots[knot]) != state.refused.end()) continue;
    auto found = relation(state.knots, knot);
    if (!found) continue;
    const auto known = state.change.find(state.knots[knot]);
    const double change =
        known != state.change.end() ? known->second : smallest_change(state.rows, layout, *found);
    state.change[state.knots[knot]] = change;
    if (change <= tolerance) candidates.emplace_back(change, *std::move(found));
  }
  std::ranges::stable_sort(candidates, {}, [](const auto& candidate) { return candidate.first; });
  for (const auto& [change, r] : candidates) {
    Rows rows = without_knot(state.rows, layout, r);
    KnotVector knots = without(state.knots, r.knot);
    const auto back = Refinement::create(knots, original_knots);
    const double bound = back ? certified_distance(rows, original, layout, *back)
                              : std::numeric_limits<double>::infinity();
    if (bound > tolerance) {
      state.refused.push_back(state.knots[r.knot]);
      continue;
    }
    const int count = static_cast<int>(state.rows.rows());
    std::vector<int> origin(state.origin.begin(), state.origin.begin() + r.first + 1);
    origin.resize(static_cast<std::size_t>(r.last), -1);
    if (!r.fixed(r.first, count)) origin.back() = origin[static_cast<std::size_t>(r.first)] = -1;
    if (r.fixed(r.last, count)) origin.back() = state.origin.back();
    origin.insert(origin.end(), state.origin.begin() + r.last + 1, state.origin.end());
    state.removed.push_back(state.knots[r.knot]);
    state.forget_around(r.knot);
    state.knots = std::move(knots);
    state.rows = std::move(rows);
    state.origin = std::move(origin);
    state.bound = bound;
    return true;
  }
  return false;
}

template <int D>
Expected<void> validate(const Spline<D>& spline, double tolerance,
                        std::span<const Points> companions) {
  if (!std::isfinite(tolerance) || tolerance < 0) {
    return input_error(fmt::format("the tolerance {} is not a length", tolerance), {},
                       "give a number of at least 0");
  }
  for (std::size_t k = 0; k < spline.weights().size(); ++k) {
    if (!(spline.weights()[k] > 0)) {
      return input_error(fmt::format("the weight {} is not positive", spline.weights()[k]),
                         fmt::format("control point {}", k),
                         "knots are removed where all weights are positive");
    }
  }
  for (std::size_t f = 0; f < companions.size(); ++f) {
    if (auto fits = spline.with_control_points(companions[f]); !fits) {
      return std::unexpected(fits.error().within(fmt::format("companion {}", f)));
    }
  }
  return {};
}

}  // namespace

template <int D>
Expected<KnotRemoval<D>> remove_knots(const Spline<D>& spline, int direction, double tolerance,
                                      std::span<const Points> companions) {
  assert(0 <= direction && direction < D);
  if (auto valid = validate<D>(spline, tolerance, companions); !valid)
    return std::unexpected(valid.error());
  const auto net = spline.net();
  const auto d = static_cast<std::size_t>(direction);
  const Index inner =
      std::accumulate(net.begin() + direction + 1, net.end(), 1, std::multiplies<>());
  const Index lines = spline.size() / net[d];
  const Layout layout{lines, static_cast<Index>(companions.size()) + 1, spline.rational()};
  const auto field = [&](Index f) -> const Points& {
    return f == 0 ? spline.control_points() : companions[static_cast<std::size_t>(f - 1)];
  };
  // Control point (outer o, i, inner c) with `count` points along the direction.
  const auto number = [&](Index line, Index i, Index count) {
    return (line / inner * count + i) * inner + line % inner;
  };

  Rows original(net[d], lines * layout.width());
  for (Index i = 0; i < net[d]; ++i) {
    for (Index line = 0; line < lines; ++line) {
      const Index at = number(line, i, net[d]);
      const double weight = spline.rational() ? spline.weights()[static_cast<std::size_t>(at)] : 1;
      for (Index f = 0; f < layout.fields; ++f) {
        original.row(i).segment<3>(line * layout.width() + 3 * f) = weight * field(f).row(at);
      }
      if (spline.rational()) original(i, line * layout.width() + 3 * layout.fields) = weight;
    }
  }
  Reduction state{spline.knots(direction),
                  original,
                  std::vector<int>(static_cast<std::size_t>(net[d])),
                  {},
                  {},
                  {},
                  0};
  std::iota(state.origin.begin(), state.origin.end(), 0);
  while (remove_one(state, original, spline.knots(direction), layout, tolerance)) {
  }

  const Index count = state.rows.rows();
  std::vector<Points> fields(static_cast<std::size_t>(layout.fields), Points(count * lines, 3));
  std::vector<double> weights(spline.rational() ? static_cast<std::size_t>(count * lines) : 0);
  for (Index i = 0; i < count; ++i) {
    const Index origin = state.origin[static_cast<std::size_t>(i)];
    for (Index line = 0; line < lines; ++line) {
      const Index to = number(line, i, count), from = number(line, origin, net[d]);
      for (Index f = 0; f < layout.fields; ++f) {
        fields[static_cast<std::size_t>(f)].row(to) =
            origin >= 0 ? field(f).row(from).eval()
                        : layout.cartesian(state.rows, i, line, f).transpose().eval();
      }
      if (spline.rational())
        weights[static_cast<std::size_t>(to)] = layout.weight(state.rows, i, line);
    }
  }
  auto knots = spline.knots();
  knots[d] = state.knots;
  auto result = Spline<D>::create(std::move(knots), std::move(fields.front()), std::move(weights));
  if (!result) return std::unexpected(std::move(result.error()));
  fields.erase(fields.begin());
  std::ranges::sort(state.removed);
  return KnotRemoval<D>{*std::move(result), std::move(fields), std::move(state.removed),
                        state.bound};
}

#define KNEAD_INSTANTIATE(D)                                                       \
  template Expected<KnotRemoval<D>> remove_knots<D>(const Spline<D>&, int, double, \
                                                    std::span<const Points>);
KNEAD_INSTANTIATE(1)
KNEAD_INSTANTIATE(2)
KNEAD_INSTANTIATE(3)
#undef KNEAD_INSTANTIATE

}  // namespace knead
