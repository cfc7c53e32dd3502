#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include "base/interruption.hpp"
#include "tool_load_sums.hpp"

namespace knead {
namespace {

constexpr int samples_per_gauss_point[] = {3, 2, 1};  // in one, two and three directions
constexpr std::size_t refined = 12;

}  // namespace

/// The search for the deepest penetration of a tool: samples, then a compass search from the
/// deepest ones.
template <int D>
class ToolLoad<D>::EntrySearch {
 public:
  EntrySearch(const ToolLoad& load, const Points& x, int first, const ModelTool& tool)
      : load_(load), x_(x), first_(first), tool_(tool), levels_(load, 4) {
    for (std::size_t d = 0; d < D; ++d) spans_[d] = load.knots_[d].spans();
    masked_ = load.pass_of(tool) == ToolPass::visible;
    leaps_ = !tool.jumps();
  }

  [[nodiscard]] Penetration deepest() {
    load_.for_each_element([&](const Element& element) { sample(element); });
    Penetration deepest{0, visited_};
    for (Candidate& c : candidates_) deepest.depth = std::max(deepest.depth, refine(c));
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
    for (std::size_t d = 0; d < D; ++d)
      basis_values(load_.knots_[d], span(element, d), u[d], n[d].data());
    double sum[3] = {0, 0, 0}, denominator = 0;
    std::size_t at = 0;
    load_.for_each_control_point(element, [&](int row) {
      double product = load_.weight(row);
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

  /// The samples of an element in one direction, and what every basis function is there.
  struct Line {
    int degree = 0;
    std::vector<double> u, values;  // values: of the p + 1 functions, sample after sample
    std::vector<double> progress;   // see `progress_along`
  };

  /// The Gauss points of a span, or as many as this tool would have if it were alone: a smaller one
  /// may need more.
  [[nodiscard]] int points_for_tool(const Element& element, std::size_t d) const {
    const int all = element.end[d] - element.begin[d], per_piece = load_.knots_[d].degree() + 1;
    const double length = load_.lengths_[d][static_cast<std::size_t>(element.span[d])];
    return static_cast<int>(
        std::min<double>(all, per_piece * pieces_of_span(length, per_piece, tool_.size())));
  }

  void tabulate(const Element& element, std::size_t d) {
    const KnotVector& knots = load_.knots_[d];
    const int at = span(element, d),
              count = samples_per_gauss_point[D - 1] * points_for_tool(element, d);
    const double begin = knots[at], end = knots[at + 1];
    Line& line = lines_[d];
    line.degree = knots.degree();
    const auto width = static_cast<std::size_t>(line.degree + 1),
               size = static_cast<std::size_t>(count + 1);
    line.u.resize(size);
    line.values.resize(size * width);
    line.progress.assign(size, 0.0);
    spacing_[d] = (end - begin) / count;
    for (std::size_t k = 0; k < size; ++k) {
      line.u[k] = k + 1 == size ? end : begin + static_cast<double>(k) * spacing_[d];
      double* n = line.values.data() + k * width;
      basis_values(knots, at, line.u[k], n);
      for (std::size_t r = 1; r < width; ++r) line.progress[k] += static_cast<double>(r) * n[r];
    }
  }

  /// Samples are kept whose depth is more.
  [[nodiscard]] double least_depth() const {
    return candidates_.size() < refined ? -reach_ : std::max(-reach_, candidates_.back().depth);
  }

  /// Whether no sample between these control points can be kept.
  [[nodiscard]] bool all_shallow(std::size_t d) const {
    Point lower, upper;
    levels_.bounds(d, lower, upper);
    return 0.5 * (upper - lower).norm() - tool_.distance(0.5 * (lower + upper)) < least_depth();
  }

  /// Visits the samples of directions d … D − 1, for which level d holds the control points. The
  /// last direction leaps over samples that are too near to a shallow one to be deep.
  void visit(std::size_t d, Candidate& c) {
    if (leaps_ && load_.in_hull_ && d > 0 && all_shallow(d)) return;
    const Line& line = lines_[d];
    const auto width = static_cast<std::size_t>(line.degree + 1);
    const double step = leaps_ && d + 1 == D && load_.weights_.empty() ? levels_.longest_step() : 0;
    if (Interruption::asked_for()) return;
    for (std::size_t k = 0; k < line.u.size(); ++k) {
      c.u[d] = line.u[k];
      const double* n = line.values.data() + k * width;
      if (d + 1 < D) {
        kernels_.combine(n, line.degree + 1, levels_[d], levels_.sizes[d + 1], levels_[d + 1]);
        visit(d + 1, c);
        continue;
      }
      look(n, c);
      if (step == 0) continue;
      constexpr double safe = 1 - 1e-6;
      const double enough = line.progress[k] + safe * (least_depth() - c.depth) / step;
      while (k + 1 < line.u.size() && line.progress[k + 1] < enough) ++k;
    }
  }

  /// A sample on the line of control points, where the functions of the last direction have values
  /// n.
  void look(const double* n, Candidate& c) {
    ++visited_;
    const std::ptrdiff_t functions = levels_.functions;
    std::array<double, 4> sum{};
    for (std::ptrdiff_t j = 0; j < functions; ++j) {
      for (std::ptrdiff_t e = 0; e < 4; ++e)
        sum[static_cast<std::size_t>(e)] += n[j] * levels_[D - 1][e * functions + j];
    }
    c.depth = -tool_.distance(Point(sum[0], sum[1], sum[2]) / sum[3]);
    if (c.depth > least_depth() && touches(c.u)) keep(c);
  }

  /// Keeps the deepest samples of all elements.
  void sample(const Element& element) {
    if (Interruption::asked_for()) return;
    const int visible = masked_ ? load_.visibility(element) : VisibleMask::full;
    if (visible == VisibleMask::hidden) return;
    in_cut_ = visible == VisibleMask::cut;
    Point lower, upper;
    levels_.gather(element.first, x_.data() + 3 * static_cast<std::ptrdiff_t>(first_));
    levels_.box(lower, upper);
    if (load_.in_hull_ && !tool_.may_reach(lower, upper)) return;
    // Between samples the shape may penetrate further, but by no more than the extent of its
    // control points.
    reach_ = (upper - lower).norm();
    levels_.multiply_by_weights(element.first);
    for (std::size_t d = 0; d < D; ++d) tabulate(element, d);
    Candidate c{0, element, {}, spacing_};
    visit(0, c);
  }

  void keep(const Candidate& c) {
    if (candidates_.size() == refined) candidates_.pop_back();
    candidates_.insert(
        std::ranges::upper_bound(candidates_, c.depth, std::greater{}, &Candidate::depth), c);
  }

  /// The depth found by a compass search within the candidate's element.
  [[nodiscard]] double refine(Candidate& c) {
    in_cut_ = masked_ && load_.visibility(c.element) == VisibleMask::cut;
    for (double h = 1; h > 1e-6; h /= 2) {
      for (std::size_t d = 0; d < D; ++d) {
        const double begin = load_.knots_[d][span(c.element, d)],
                     end = load_.knots_[d][span(c.element, d) + 1];
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
  bool masked_ = false;        // the tool touches what is visible only
  bool in_cut_ = false;        // in the present element that is a part
  bool leaps_ = true;          // distances bound those of points nearby
  std::array<Line, D> lines_;  // of the present element, as are
  std::array<double, D> spacing_{};
  double reach_ = 0;
  ElementLevels levels_;  // in homogeneous coordinates
  const detail::ElementKernels& kernels_ = detail::element_kernels();
  long long visited_ = 0;
  std::vector<Candidate> candidates_;  // deepest first
};

template <int D>
Penetration ToolLoad<D>::deepest_entry(const Points& x, int first, const ModelTool& tool) const {
  if (!tool.tool().collides()) return {};
  return EntrySearch(*this, x, first, tool).deepest();
}

template Penetration ToolLoad<1>::deepest_entry(const Points&, int, const ModelTool&) const;
template Penetration ToolLoad<2>::deepest_entry(const Points&, int, const ModelTool&) const;
template Penetration ToolLoad<3>::deepest_entry(const Points&, int, const ModelTool&) const;

}  // namespace knead
