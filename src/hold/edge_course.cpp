#include "edge_course.hpp"

#include <algorithm>
#include <cmath>

namespace knead {
namespace {

using Sample = SharedEdge::Sample;

constexpr double most_parts_of_interval = 256;

/// The number of the span at a fraction of the domain, and how far into it: continuous.
double phase(const KnotVector& knots, const std::vector<int>& spans, double fraction) {
  const Interval domain = knots.domain();
  const double u =
      std::clamp(domain.lower + fraction * domain.length(), domain.lower, domain.upper);
  const int span = knots.find_span(u);
  const auto at = std::ranges::lower_bound(spans, span) - spans.begin();
  return static_cast<double>(at) + (u - knots[span]) / (knots[span + 1] - knots[span]);
}

}  // namespace

bool is_smooth(const SharedEdge& edge) {
  return edge.surfaces().size() > 1 && edge.angle() <= smooth_angle;
}

std::vector<Sample> finer_samples(std::span<const Sample> given,
                                  std::span<const Surface* const> surfaces,
                                  const CourseSampling& sampling) {
  std::vector<double> parts(given.size(), 1);
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    for (int d = 0; d < 2; ++d) {
      const KnotVector& knots = surfaces[s]->knots(d);
      const std::vector<int> spans = knots.spans();
      const int per_span = sampling.per_span(knots);
      double before = phase(knots, spans, given[0].feet[s][d]);
      for (std::size_t k = 1; k < given.size(); ++k) {
        const double now = phase(knots, spans, given[k].feet[s][d]);
        parts[k] = std::max(parts[k], std::ceil(std::abs(now - before) * per_span));
        before = now;
      }
    }
  }
  std::vector<Sample> result = {given.front()};
  for (std::size_t k = 1; k < given.size(); ++k) {
    const int count = static_cast<int>(std::min(parts[k], most_parts_of_interval));
    for (int j = 1; j < count; ++j) {
      result.push_back(sampling.between(given[k - 1], given[k],
                                        static_cast<double>(j) / static_cast<double>(count)));
    }
    result.push_back(given[k]);
  }
  return result;
}

}  // namespace knead
