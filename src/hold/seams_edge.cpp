#include "seams_edge.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace knead {

std::string to_string(const PatchEdge& edge) {
  return fmt::format("patch {}, edge {}", edge.patch, edge_name(edge.edge));
}

namespace seams {

double edge_end(const Surface& surface, SurfaceEdge edge) {
  const Interval domain = surface.knots(edge_across(edge)).domain();
  return edge_at_end(edge) ? domain.upper : domain.lower;
}

Expected<Evaluation<2>> evaluate_edge(const Surface& surface, SurfaceEdge edge,
                                      std::span<const double> t, int order) {
  const Interval domain = surface.knots(edge_along(edge)).domain();
  std::vector<double> along;
  along.reserve(t.size());
  for (double s : t)
    along.push_back(std::clamp(domain.lower + s * domain.length(), domain.lower, domain.upper));
  const double end = edge_end(surface, edge);
  const std::span<const double> fixed(&end, 1);
  return edge_across(edge) == 0 ? evaluate_grid<2>(surface, {fixed, along}, order)
                                : evaluate_grid<2>(surface, {along, fixed}, order);
}

Points inward(const Evaluation<2>& evaluation, SurfaceEdge edge) {
  const double sign = edge_at_end(edge) ? -1 : 1;
  return sign * (edge_across(edge) == 0 ? evaluation.at({1, 0}) : evaluation.at({0, 1}));
}

// p + 3 a span tell a curve of degree p from any other; 24 in all give polylines of short edges a
// shape.
std::vector<double> edge_samples(const KnotVector& along) {
  const std::vector<int> spans = along.spans();
  const Interval domain = along.domain();
  const int pieces = std::max(along.degree() + 3, 24 / static_cast<int>(spans.size()) + 1);
  std::vector<double> t;
  t.reserve(spans.size() * static_cast<std::size_t>(pieces) + 1);
  for (int s : spans) {
    const double a = (along[s] - domain.lower) / domain.length(),
                 b = (along[s + 1] - domain.lower) / domain.length();
    for (int k = 0; k < pieces; ++k) t.push_back(a + (b - a) * k / pieces);
  }
  t.push_back(1);
  return t;
}

}  // namespace seams
}  // namespace knead
