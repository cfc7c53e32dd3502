#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include "tool_load_elements.hpp"

namespace knead {
namespace {

constexpr int samples_per_gauss_point[] = {3, 2, 1};  // in one, two and three directions
constexpr std::size_t refined = 12;

}  // namespace

template <int D>
double ToolLoad<D>::deepest_entry(const Points& x, int first, const ModelTool& tool) const {
  if (!tool.tool().collides()) return 0;
  std::array<std::vector<int>, D> spans;
  for (std::size_t d = 0; d < D; ++d) spans[d] = knots_[d].spans();
  const auto depth_at = [&](const Element& element, const std::array<double, D>& u) {
    std::array<std::array<double, max_degree + 1>, D> n;
    for (std::size_t d = 0; d < D; ++d) {
      basis_values(knots_[d], spans[d][static_cast<std::size_t>(element.span[d])], u[d], n[d].data());
    }
    double sum[3] = {0, 0, 0}, denominator = 0;
    std::size_t at = 0;
    for_each_control_point(element, [&](int row) {
      double product = weights_.empty() ? 1 : weights_[static_cast<std::size_t>(row)];
      std::size_t rest = at++;
      for (std::size_t d = D; d-- > 0;) {
        const auto width = static_cast<std::size_t>(knots_[d].degree() + 1);
        product *= n[d][rest % width];
        rest /= width;
      }
      const double* p = x.data() + 3 * static_cast<std::ptrdiff_t>(first + row);
      for (int c = 0; c < 3; ++c) sum[c] += product * p[c];
      denominator += product;
    });
    return -tool.distance(Point(sum[0], sum[1], sum[2]) / denominator);
  };

  struct Candidate {
    double depth;
    Element element;
    std::array<double, D> u, spacing;
  };
  std::vector<Candidate> candidates;  // the deepest samples, deepest first
  for_each_element([&](const Element& element) {
    Point lower, upper;
    box_of(element, x, first, lower, upper);
    if (in_hull_ && !tool.may_reach(lower, upper)) return;
    Candidate c{0, element, {}, {}};
    // Between samples the shape may reach further in, but not by more than its control points are apart.
    const double reach = (upper - lower).norm();
    std::array<int, D> counts, k{};
    std::array<double, D> begin;
    for (std::size_t d = 0; d < D; ++d) {
      const int span = spans[d][static_cast<std::size_t>(element.span[d])];
      counts[d] = samples_per_gauss_point[D - 1] * (element.end[d] - element.begin[d]);
      begin[d] = knots_[d][span];
      c.spacing[d] = (knots_[d][span + 1] - begin[d]) / counts[d];
    }
    while (true) {
      for (std::size_t d = 0; d < D; ++d) {
        const int span = spans[d][static_cast<std::size_t>(element.span[d])];
        c.u[d] = k[d] == counts[d] ? knots_[d][span + 1] : begin[d] + k[d] * c.spacing[d];
      }
      c.depth = depth_at(element, c.u);
      if (c.depth > -reach && (candidates.size() < refined || c.depth > candidates.back().depth)) {
        if (candidates.size() == refined) candidates.pop_back();
        candidates.insert(std::ranges::upper_bound(candidates, c.depth, std::greater{}, &Candidate::depth), c);
      }
      std::size_t d = D;
      while (d-- > 0) {
        if (++k[d] <= counts[d]) break;
        k[d] = 0;
        if (d == 0) return;
      }
    }
  });
  double deepest = 0;
  for (Candidate& c : candidates) {
    for (double h = 1; h > 1e-6; h /= 2) {
      for (std::size_t d = 0; d < D; ++d) {
        const int span = spans[d][static_cast<std::size_t>(c.element.span[d])];
        for (const double sign : {-1.0, 1.0}) {
          std::array<double, D> u = c.u;
          u[d] = std::clamp(u[d] + sign * h * c.spacing[d], knots_[d][span], knots_[d][span + 1]);
          const double depth = depth_at(c.element, u);
          if (depth <= c.depth) continue;
          c.depth = depth;
          c.u = u;
        }
      }
    }
    deepest = std::max(deepest, c.depth);
  }
  return deepest;
}

template double ToolLoad<1>::deepest_entry(const Points&, int, const ModelTool&) const;
template double ToolLoad<2>::deepest_entry(const Points&, int, const ModelTool&) const;
template double ToolLoad<3>::deepest_entry(const Points&, int, const ModelTool&) const;

}  // namespace knead
