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

/// The search for the deepest penetration of a tool: samples, then a compass search from the deepest ones.
template <int D>
class ToolLoad<D>::EntrySearch {
 public:
  EntrySearch(const ToolLoad& load, const Points& x, int first, const ModelTool& tool)
      : load_(load), x_(x), first_(first), tool_(tool) {
    for (std::size_t d = 0; d < D; ++d) spans_[d] = load.knots_[d].spans();
    masked_ = load.pass_of(tool) == ToolPass::visible;
  }

  [[nodiscard]] double deepest() {
    load_.for_each_element([&](const Element& element) { sample(element); });
    double deepest = 0;
    for (Candidate& c : candidates_) deepest = std::max(deepest, refine(c));
    return deepest;
  }

 private:
  struct Candidate {
    double depth;
    Element element;
    std::array<double, D> u, spacing;
  };

  [[nodiscard]] int span(const Element& element, std::size_t d) const {
    return spans_[d][static_cast<std::size_t>(element.span[d])];
  }

  [[nodiscard]] double depth_at(const Element& element, const std::array<double, D>& u) const {
    std::array<std::array<double, max_degree + 1>, D> n;
    for (std::size_t d = 0; d < D; ++d) basis_values(load_.knots_[d], span(element, d), u[d], n[d].data());
    double sum[3] = {0, 0, 0}, denominator = 0;
    std::size_t at = 0;
    load_.for_each_control_point(element, [&](int row) {
      double product = load_.weights_.empty() ? 1 : load_.weights_[static_cast<std::size_t>(row)];
      std::size_t rest = at++;
      for (std::size_t d = D; d-- > 0;) {
        const auto width = static_cast<std::size_t>(load_.knots_[d].degree() + 1);
        product *= n[d][rest % width];
        rest /= width;
      }
      const double* p = x_.data() + 3 * static_cast<std::ptrdiff_t>(first_ + row);
      for (int c = 0; c < 3; ++c) sum[c] += product * p[c];
      denominator += product;
    });
    return -tool_.distance(Point(sum[0], sum[1], sum[2]) / denominator);
  }

  /// Whether the tool touches a place of an element.
  [[nodiscard]] bool touches(const std::array<double, D>& u) const {
    if (!in_cut_) return true;
    Eigen::Vector2d at = Eigen::Vector2d::Zero();
    for (std::size_t d = 0; d < std::min<std::size_t>(D, 2); ++d) {
      const Interval domain = load_.knots_[d].domain();
      at[static_cast<Eigen::Index>(d)] = (u[d] - domain.lower) / domain.length();
    }
    return load_.region_->contains(at);
  }

  /// Keeps the deepest samples of all elements.
  void sample(const Element& element) {
    const int visible = masked_ ? load_.visibility(element) : VisibleMask::full;
    if (visible == VisibleMask::hidden) return;
    in_cut_ = visible == VisibleMask::cut;
    Point lower, upper;
    load_.box_of(element, x_, first_, lower, upper);
    if (load_.in_hull_ && !tool_.may_reach(lower, upper)) return;
    Candidate c{0, element, {}, {}};
    // Between samples the shape may penetrate further, but by no more than the extent of its control points.
    const double reach = (upper - lower).norm();
    std::array<int, D> counts, k{};
    std::array<double, D> begin, end;
    for (std::size_t d = 0; d < D; ++d) {
      counts[d] = samples_per_gauss_point[D - 1] * (element.end[d] - element.begin[d]);
      begin[d] = load_.knots_[d][span(element, d)];
      end[d] = load_.knots_[d][span(element, d) + 1];
      c.spacing[d] = (end[d] - begin[d]) / counts[d];
    }
    do {
      for (std::size_t d = 0; d < D; ++d) c.u[d] = k[d] == counts[d] ? end[d] : begin[d] + k[d] * c.spacing[d];
      c.depth = depth_at(element, c.u);
      if (c.depth > -reach && is_deep(c) && touches(c.u)) keep(c);
    } while (advance(k, counts));
  }

  /// Advances through 0 … counts[d] in all directions, the last one fastest; false after the last.
  [[nodiscard]] static bool advance(std::array<int, D>& k, const std::array<int, D>& counts) {
    for (std::size_t d = D; d-- > 0;) {
      if (++k[d] <= counts[d]) return true;
      k[d] = 0;
    }
    return false;
  }

  /// Whether it is among the deepest so far.
  [[nodiscard]] bool is_deep(const Candidate& c) const {
    return candidates_.size() < refined || c.depth > candidates_.back().depth;
  }
  void keep(const Candidate& c) {
    if (candidates_.size() == refined) candidates_.pop_back();
    candidates_.insert(std::ranges::upper_bound(candidates_, c.depth, std::greater{}, &Candidate::depth), c);
  }

  /// The depth found by a compass search within the candidate's element.
  [[nodiscard]] double refine(Candidate& c) {
    in_cut_ = masked_ && load_.visibility(c.element) == VisibleMask::cut;
    for (double h = 1; h > 1e-6; h /= 2) {
      for (std::size_t d = 0; d < D; ++d) {
        const double begin = load_.knots_[d][span(c.element, d)], end = load_.knots_[d][span(c.element, d) + 1];
        for (const double sign : {-1.0, 1.0}) {
          std::array<double, D> u = c.u;
          u[d] = std::clamp(u[d] + sign * h * c.spacing[d], begin, end);
          const double depth = depth_at(c.element, u);
          if (depth <= c.depth || !touches(u)) continue;
          c.depth = depth;
          c.u = u;
        }
      }
    }
    return c.depth;
  }

  const ToolLoad& load_;
  const Points& x_;
  int first_;
  const ModelTool& tool_;
  std::array<std::vector<int>, D> spans_;
  bool masked_ = false;                // the tool touches what is visible only
  bool in_cut_ = false;                // in the present element that is a part
  std::vector<Candidate> candidates_;  // deepest first
};

template <int D>
double ToolLoad<D>::deepest_entry(const Points& x, int first, const ModelTool& tool) const {
  if (!tool.tool().collides()) return 0;
  return EntrySearch(*this, x, first, tool).deepest();
}

template double ToolLoad<1>::deepest_entry(const Points&, int, const ModelTool&) const;
template double ToolLoad<2>::deepest_entry(const Points&, int, const ModelTool&) const;
template double ToolLoad<3>::deepest_entry(const Points&, int, const ModelTool&) const;

}  // namespace knead
