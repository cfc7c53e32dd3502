#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "knead/spline/basis.hpp"

namespace knead::detail {

/// Sample parameters strictly inside the spans of one direction, `per_span` on each, evenly spread.
struct SpanSamples {
  int per_span = 0;
  std::vector<int> spans;
  std::vector<double> parameters;

  SpanSamples(const KnotVector& knots, int least_per_span, int least) : spans(knots.spans()) {
    const int count = static_cast<int>(spans.size());
    per_span = std::max(least_per_span, (least + count - 1) / count);
    for (const int s : spans) {
      for (int k = 0; k < per_span; ++k) {
        parameters.push_back(std::clamp(knots[s] + (knots[s + 1] - knots[s]) * (k + 0.5) / per_span,
                                        knots[s], knots[s + 1]));
      }
    }
  }
};

/// Halves the marked spans (flags in the order of `knots.spans()`), and neighbours until no span is
/// more than twice as long as the next one unless it was before. Spans too short to halve stay.
/// Returns whether anything changed.
inline bool halve(KnotVector& knots, std::vector<bool> marked) {
  const std::vector<int> spans = knots.spans();
  const auto length = [&](std::size_t k) {
    return (knots[spans[k] + 1] - knots[spans[k]]) / (marked[k] ? 2 : 1);
  };
  for (bool grew = true; grew;) {
    grew = false;
    for (std::size_t k = 0; k + 1 < spans.size(); ++k) {
      for (const auto& [a, b] : {std::pair{k, k + 1}, std::pair{k + 1, k}}) {
        // Halving a would make it too short relative to b.
        if (marked[a] && !marked[b] && length(b) > 2.001 * length(a)) marked[b] = grew = true;
      }
    }
  }
  std::vector<double> result(knots.knots().begin(), knots.knots().end());
  const std::size_t before = result.size();
  for (std::size_t k = 0; k < spans.size(); ++k) {
    const double a = knots[spans[k]], b = knots[spans[k] + 1], middle = a + (b - a) / 2;
    if (marked[k] && a < middle && middle < b) result.push_back(middle);
  }
  if (result.size() == before) return false;
  std::ranges::sort(result);
  knots = *KnotVector::create(knots.degree(), std::move(result));
  return true;
}

}  // namespace knead::detail
