#include <algorithm>
#include <cmath>
#include <optional>

#include "knead/spline/evaluate.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "trim_hold.hpp"

namespace knead {
namespace {

constexpr int smooth_degree = 3;  // the degree to which degree 1 is raised
constexpr int least_cap = 2500;
constexpr double grown = 4;
constexpr double coarse_enough = 1.5;  // spans that are too long by less than this factor stay
constexpr int samples_per_span = 4;

/// An isocurve through a place: the distance of its points from the place along it, in space.
class Isocurve {
 public:
  Isocurve(const Surface& surface, std::size_t direction, const std::array<double, 2>& at)
      : surface_(surface), direction_(direction), at_(at) {}

  [[nodiscard]] Expected<Point> point(double u) const {
    std::array<double, 2> parameters = at_;
    parameters[direction_] = u;
    return evaluate_point<2>(surface_, parameters);
  }
  /// Length of the curve between two parameters, by chords.
  [[nodiscard]] Expected<double> length(double from, double to) const {
    double sum = 0;
    auto before = point(from);
    for (int k = 1; k <= samples_per_span && before; ++k) {
      auto next = point(k == samples_per_span ? to : from + (to - from) * k / samples_per_span);
      if (!next) return std::unexpected(next.error());
      sum += (*next - *before).norm();
      before = std::move(next);
    }
    if (!before) return std::unexpected(before.error());
    return sum;
  }
  /// The parameter at this length from the place towards `end`, or `end`; in steps of a 64th of the
  /// length.
  ///
  /// An adaptive march: steps between a 128th and a 32nd of the length, so that the sum of chords
  /// is near the arc, whatever the speed of the parameter.
  [[nodiscard]] Expected<double> reach(double length_to, double end) const {
    constexpr int steps = 64;
    const double from = at_[direction_];
    double u = from, gone = 0;
    auto before = point(u);
    if (!before) return std::unexpected(before.error());
    double step = (end - from) / 1024;
    for (int k = 0; k < 64 * steps && u != end; ++k) {
      const double next_u = std::abs(end - u) <= std::abs(step) ? end : u + step;
      auto next = point(next_u);
      if (!next) return std::unexpected(next.error());
      const double way = (*next - *before).norm();
      if (way > 2 * length_to / steps) {  // too large a step
        step /= 2;
        if (std::abs(step) < 1e-12 * std::abs(end - from)) return u;
        continue;
      }
      if (gone + way >= length_to) return u + (next_u - u) * (length_to - gone) / way;
      if (way < 0.5 * length_to / steps) step *= 2;
      gone += way;
      u = next_u;
      before = std::move(next);
    }
    return u;
  }

 private:
  const Surface& surface_;
  std::size_t direction_;
  std::array<double, 2> at_;
};

/// Knots that divide the spans of one direction between `lower` and `upper` to at most `length`.
///
/// Spans are divided evenly in parameters, measured in space: a surface whose speed changes little
/// within a span is refined evenly.
Expected<void> divide(const Isocurve& curve, const KnotVector& knots, double lower, double upper,
                      double length, std::vector<double>& insert) {
  std::vector<double> lines = {lower, upper};
  for (const double x : knots.knots()) {
    if (x > lower && x < upper) lines.push_back(x);
  }
  for (const double x : insert) {
    if (x > lower && x < upper) lines.push_back(x);
  }
  std::ranges::sort(lines);
  std::vector<double> more;
  const double least = 1e-7 * knots.domain().length();
  for (std::size_t k = 0; k + 1 < lines.size(); ++k) {
    if (lines[k + 1] - lines[k] < least) continue;
    const auto size = curve.length(lines[k], lines[k + 1]);
    if (!size) return std::unexpected(size.error());
    if (*size <= coarse_enough * length) continue;
    const int pieces = static_cast<int>(std::ceil(*size / length));
    for (int j = 1; j < pieces; ++j)
      more.push_back(lines[k] + (lines[k + 1] - lines[k]) * j / pieces);
  }
  insert.insert(insert.end(), more.begin(), more.end());
  return {};
}

}  // namespace

int trim_refinement_cap(const Surface& opened) {
  return std::max(least_cap, static_cast<int>(grown * opened.size()));
}

Expected<Surface> TrimRefinement::apply(const Surface& surface) const {
  Expected<Surface> result = surface;
  for (int d = 0; d < 2; ++d) {
    const int times = elevate[static_cast<std::size_t>(d)];
    if (result && times > 0) result = elevate_degree<2>(*result, d, times);
  }
  if (!result) return result;
  return insert_knots<2>(*result, insert);
}

// Lengths grow by 2 until the net fits under the cap, or nothing is refined.
Expected<TrimRefinement> trim_refinement(const Surface& surface, const std::array<double, 2>& at,
                                         double distance, double detail, int cap) {
  TrimRefinement result;
  if (!(distance > 0 && std::isfinite(distance))) return result;
  for (double coarser = 1; coarser <= 8; coarser *= 2) {
    result.insert = {};
    double size = 1;
    for (std::size_t d = 0; d < 2; ++d) {
      const KnotVector& knots = surface.knots()[d];
      result.elevate[d] = knots.degree() == 1 ? smooth_degree - 1 : 0;
      const int degree = knots.degree() + result.elevate[d];
      const Isocurve curve(surface, d, at);
      const auto lower = curve.reach(distance, knots.domain().lower),
                 upper = curve.reach(distance, knots.domain().upper);
      if (!lower) return std::unexpected(lower.error());
      if (!upper) return std::unexpected(upper.error());
      const double length = coarser * distance / std::max(8, 2 * degree + 2);
      auto status = divide(curve, knots, *lower, *upper, length, result.insert[d]);
      if (status && detail > 0 && coarser * detail / 3 < length) {
        const auto a = curve.reach(1.5 * detail, knots.domain().lower),
                   b = curve.reach(1.5 * detail, knots.domain().upper);
        if (!a) return std::unexpected(a.error());
        if (!b) return std::unexpected(b.error());
        status = divide(curve, knots, std::max(*a, *lower), std::min(*b, *upper),
                        coarser * detail / 3, result.insert[d]);
      }
      if (!status) return std::unexpected(status.error());
      std::ranges::sort(result.insert[d]);
      size *= knots.count() +
              static_cast<double>(result.elevate[d]) * static_cast<double>(knots.spans().size()) +
              static_cast<double>(result.insert[d].size());
    }
    if (size <= cap) return result;
    result.capped = true;
  }
  result.insert = {};
  result.elevate = {0, 0};
  return result;
}

}  // namespace knead
