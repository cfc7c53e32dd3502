#include "tool_load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/interruption.hpp"
#include "element_hessian.hpp"
#include "knead/base/error_code.hpp"
#include "knead/spline/evaluate.hpp"
#include "tool_load_grip.hpp"
#include "tool_load_sums.hpp"
#include "tool_load_sweep.hpp"

namespace knead {

const detail::ElementKernels& detail::element_kernels(InstructionSet set) {
  return avx2_element_kernels != nullptr && set >= InstructionSet::avx2
             ? *avx2_element_kernels
             : *vector128_element_kernels;
}

namespace {

constexpr double max_points_per_direction = 1e5;
constexpr double max_points = 4e7;  // in all directions together

/// The longest isocurve of direction d on every span of d, in file units.
/// Of the rest shape: a net keeps its grid while it is deformed, or forces would jump.
template <int D>
Expected<std::vector<double>> span_lengths(const Spline<D>& spline, std::size_t direction) {
  std::array<BasisQuadrature, D> q;
  std::array<const BasisTable*, D> tables;
  for (std::size_t d = 0; d < D; ++d) {
    q[d] = gauss_basis(spline.knots()[d], spline.knots()[d].degree() + 1, 1);
    tables[d] = &q[d].basis;
  }
  const auto grid = evaluate_grid<D>(spline, tables, 1);
  if (!grid) return std::unexpected(grid.error());
  MultiIndex<D> first{};
  first[direction] = 1;
  const Points& tangent = grid->at(first);
  std::size_t inner = 1, outer = 1;
  for (std::size_t d = 0; d < D; ++d)
    (d < direction   ? outer
     : d > direction ? inner
                     : outer) *= d == direction ? 1 : q[d].weights.size();
  const std::size_t size = q[direction].weights.size();
  const auto per_span = static_cast<std::size_t>(spline.knots()[direction].degree() + 1);
  std::vector<double> result(size / per_span, 0.0);
  for (std::size_t s = 0; s < result.size(); ++s) {
    for (std::size_t o = 0; o < outer; ++o) {
      for (std::size_t i = 0; i < inner; ++i) {
        double length = 0;
        for (std::size_t at = s * per_span; at < (s + 1) * per_span; ++at) {
          length += q[direction].weights[at] *
                    tangent.row(static_cast<Eigen::Index>((o * size + at) * inner + i)).norm();
        }
        result[s] = std::max(result[s], length);
      }
    }
  }
  return result;
}

std::unexpected<Error> too_small(double detail) {
  return input_error(fmt::format("a tool of size {:.3g} is too small for this surface", detail),
                     "tool", "use a larger tool, or sculpt a smaller surface",
                     {ErrorCode::tool_too_small, {{"size", detail}}});
}

/// Pieces per span, so that Gauss points lie closer than detail / points_per_detail.
Expected<std::vector<int>> pieces(const std::vector<double>& lengths, int per_span, double detail) {
  std::vector<int> result;
  double total = 0;
  for (double length : lengths) {
    const double wanted = pieces_of_span(length, per_span, detail);
    total += wanted * per_span;
    if (total > max_points_per_direction) return too_small(detail);
    result.push_back(static_cast<int>(wanted));
  }
  return result;
}

}  // namespace

// A tool of size r makes a dent whose force has features of r: six points per r resolve them.
// Pieces of p + 1 points keep the degree of exactness of every span where no tool is.
double pieces_of_span(double length, int per_piece, double detail) {
  constexpr double points_per_detail = 6;
  // Rounded up with a little slack, so that a length that is a whole multiple up to rounding counts
  // as whole.
  return std::max(1.0, std::ceil(length * points_per_detail / (detail * per_piece) * (1 - 1e-6)));
}

std::vector<double> progress_along(const BasisTable& basis) {
  std::vector<double> result(static_cast<std::size_t>(basis.size()), 0.0);
  for (int k = 0; k < basis.size(); ++k) {
    for (int r = 1; r <= basis.degree; ++r)
      result[static_cast<std::size_t>(k)] += r * basis.row(k, 0)[r];
  }
  return result;
}

template <int D>
Expected<ToolLoad<D>> ToolLoad<D>::create(const Spline<D>& spline, const DomainScaling<D>& scaling,
                                          double detail) {
  ToolLoad load;
  load.net_ = spline.net();
  load.detail_ = detail / scaling.length;
  load.scale_ = scaling.factors;
  std::array<std::vector<int>, D> counts;
  double points = 1;
  for (std::size_t d = 0; d < D; ++d) {
    auto longest = span_lengths<D>(spline, d);
    if (!longest) return std::unexpected(longest.error());
    const int per_piece = spline.knots()[d].degree() + 1;
    auto chosen = pieces(*longest, per_piece, detail);
    if (!chosen) return std::unexpected(chosen.error());
    counts[d] = std::move(*chosen);
    points *= std::accumulate(counts[d].begin(), counts[d].end(), 0.0) * per_piece;
    for (double& length : *longest) length /= scaling.length;
    load.lengths_[d] = std::move(*longest);
    load.knots_.push_back(spline.knots()[d]);
  }
  if (points > max_points && !std::isfinite(detail)) {
    return input_error(
        fmt::format("forces on this net would be integrated over {:.0f} points, more than {:.0f}",
                    points, static_cast<double>(max_points)),
        "net", "use a coarser net, or a lower degree");
  }
  if (points > max_points) return too_small(detail);
  load.divide(counts);
  load.weights_.assign(spline.weights().begin(), spline.weights().end());
  load.in_hull_ = std::ranges::all_of(load.weights_, [](double w) { return w > 0; });
  return load;
}

/// Lays out the grid, with every span cut into as many pieces of p + 1 points.
template <int D>
void ToolLoad<D>::divide(const std::array<std::vector<int>, D>& counts) {
  for (std::size_t d = 0; d < D; ++d) {
    const int per_piece = knots_[d].degree() + 1;
    quadrature_[d] = gauss_basis(knots_[d], per_piece, 0, counts[d]);
    for (double& w : quadrature_[d].weights) w *= scale_[d];
    spans_[d] = {0};
    starts_[d].clear();
    for (int count : counts[d]) {
      starts_[d].push_back(quadrature_[d].basis.first[static_cast<std::size_t>(spans_[d].back())]);
      spans_[d].push_back(spans_[d].back() + count * per_piece);
    }
  }
  progress_ = progress_along(quadrature_[D - 1].basis);
  transpose();
}

template <int D>
std::optional<ToolLoad<D>> ToolLoad<D>::split() {
  std::array<std::vector<int>, D> counts;
  bool coarsest = true;
  for (std::size_t d = 0; d < D; ++d) {
    const int per_piece = knots_[d].degree() + 1;
    coarsest =
        coarsest && quadrature_[d].basis.size() == per_piece * static_cast<int>(lengths_[d].size());
    for (double length : lengths_[d])
      counts[d].push_back(static_cast<int>(pieces_of_span(length, per_piece, 2 * detail_)));
  }
  if (coarsest) return std::nullopt;
  ToolLoad coarser = *this;
  coarser.detail_ = 2 * detail_;
  coarser.least_ = coarser.detail_;
  coarser.grid_ = grid_ + 1;
  coarser.divide(counts);
  most_ = coarser.least_;
  return coarser;
}

template <int D>
void ToolLoad<D>::transpose() {
  const BasisTable& basis = quadrature_[D - 1].basis;
  const std::vector<int>& starts = spans_[D - 1];
  transposed_.clear();
  for (std::size_t s = 0; s + 1 < starts.size(); ++s) {
    const std::ptrdiff_t count = starts[s + 1] - starts[s];
    // Any point may be the first of a few that are read together.
    TransposedBasis t{detail::ElementKernels::rounded_up(count) + detail::ElementKernels::step, {}};
    t.values.resize(static_cast<std::size_t>((basis.degree + 1) * t.stride));
    for (int k = 0; k < count; ++k) {
      const double* n = basis.row(starts[s] + k, 0);
      for (int j = 0; j <= basis.degree; ++j)
        t.values[static_cast<std::size_t>(j * t.stride + k)] = n[j];
    }
    transposed_.push_back(std::move(t));
  }
}

template <int D>
void ToolLoad<D>::show(std::shared_ptr<const VisibleRegion> region) {
  if constexpr (D == 2) {
    std::array<std::vector<double>, 2> lines;
    for (std::size_t d = 0; d < 2; ++d) {
      const Interval domain = knots_[d].domain();
      const std::vector<int> spans = knots_[d].spans();
      double whole = 0;
      for (const double w : quadrature_[d].weights) whole += w;
      for (std::size_t s = 0; s < spans.size(); ++s) {
        double at = (knots_[d][spans[s]] - domain.lower) / domain.length();
        for (int k = spans_[d][s]; k < spans_[d][s + 1]; ++k) {
          lines[d].push_back(at);
          at += quadrature_[d].weights[static_cast<std::size_t>(k)] / whole;
        }
      }
      lines[d].push_back(1);
    }
    auto mask = std::make_shared<const VisibleMask>(*region, lines);
    if (mask->whole()) return;
    part_values_.clear();
    std::array<double, max_degree + 1> n;
    for (const VisibleMask::CutCell& part : mask->cut_cells()) {
      for (std::size_t d = 0; d < 2; ++d) {
        const KnotVector& knots = knots_[d];
        const int p = knots.degree(),
                  span = quadrature_[d].basis.first[static_cast<std::size_t>(part.cell[d])] + p;
        basis_values(knots, span, knots.domain().lower + part.middle[d] * knots.domain().length(),
                     n.data());
        part_values_.insert(part_values_.end(), n.begin(), n.begin() + p + 1);
      }
    }
    mask_ = std::move(mask);
    region_ = std::move(region);
  }
}

template <int D>
long long ToolLoad<D>::points() const {
  long long count = 1;
  for (const BasisQuadrature& q : quadrature_) count *= q.basis.size();
  return count;
}

// H v = Σ_k w_k R(u_k)ᵀ h_k R(u_k) v over contact points, h_k 3 × 3: without a matrix, as contacts
// change in every iteration. Points in the order of `evaluate` share their rows of the basis.
template <int D>
void ToolLoad<D>::apply_hessian(std::span<const ContactPoint> contacts, int first, const Points& v,
                                Points& out) const {
  FieldAtPoints field(*this, v, first);
  ForcesOfPoints forces(*this, first, out);
  for (const ContactPoint& contact : contacts) {
    if (contact.part < 0) {
      forces.add(contact.at, contact.factor, contact.hessian * field.at(contact.at));
      continue;
    }
    double sum[3] = {0, 0, 0};
    for_each_function(contact.at, contact.part, [&](int row, double n) {
      const double* from = v.data() + 3 * static_cast<std::ptrdiff_t>(first + row);
      for (int c = 0; c < 3; ++c) sum[c] += n * from[c];
    });
    const Point h = contact.factor * (contact.hessian * Point(sum[0], sum[1], sum[2]));
    for_each_function(contact.at, contact.part, [&](int row, double n) {
      double* to = out.data() + 3 * static_cast<std::ptrdiff_t>(first + row);
      for (int c = 0; c < 3; ++c) to[c] += n * h[c];
    });
  }
}

template <int D>
void ToolLoad<D>::each_hessian_block(std::span<const ContactPoint> contacts, int first,
                                     const AddBlock& add) const {
  std::vector<int> rows;
  std::vector<double> basis;
  ElementHessian sum;
  for (const ContactPoint& contact : contacts) {
    rows.clear();
    basis.clear();
    for_each_function(contact.at, contact.part, [&](int row, double n) {
      rows.push_back(first + row);
      basis.push_back(n);
    });
    if (rows != sum.rows()) {
      sum.give(add);
      sum.begin(rows);
    }
    sum.add(basis, contact.factor, contact.hessian);
  }
  sum.give(add);
}

template <int D>
void ToolLoad<D>::mark(std::span<const ContactPoint> contacts, int first,
                       std::vector<char>& marks) const {
  Element element, last;
  last.first.fill(-1);
  for (const ContactPoint& contact : contacts) {
    for (std::size_t d = 0; d < D; ++d) {
      element.first[d] = quadrature_[d].basis.first[static_cast<std::size_t>(contact.at[d])];
    }
    if (element.first == last.first) continue;
    for_each_control_point(element,
                           [&](int row) { marks[static_cast<std::size_t>(first + row)] = 1; });
    last.first = element.first;
  }
}

template <int D>
void ToolLoad<D>::widen(int first, std::vector<char>& marks) const {
  char* const begin = marks.data() + first;
  const auto size = static_cast<std::size_t>(control_points());
  std::size_t inner = 1;
  for (std::size_t d = D; d-- > 0;) {
    const auto n = static_cast<std::size_t>(net_[d]);
    const std::vector<char> before(begin, begin + size);
    for (std::size_t i = 0; i < size; ++i) {
      if (!before[i]) continue;
      const std::size_t at = i / inner % n;
      if (at > 0) begin[i - inner] = 1;
      if (at + 1 < n) begin[i + inner] = 1;
    }
    inner *= n;
  }
}

template <int D>
std::vector<int> ToolLoad<D>::elements_of(int first, const std::vector<char>& marks) const {
  // Only elements between the first and the last marked control point of every direction can be
  // meant.
  std::array<int, D> lower = net_, upper{};
  for (int i = 0; i < control_points(); ++i) {
    if (!marks[static_cast<std::size_t>(first + i)]) continue;
    for (int d = D, rest = i; d-- > 0;) {
      const auto k = static_cast<std::size_t>(d);
      lower[k] = std::min(lower[k], rest % net_[k]);
      upper[k] = std::max(upper[k], rest % net_[k]);
      rest /= net_[k];
    }
  }
  std::array<std::size_t, D> begin, end;
  for (std::size_t d = 0; d < D; ++d) {
    const int p = quadrature_[d].basis.degree;
    const auto inside = [&](std::size_t span) {
      return starts_[d][span] >= lower[d] && starts_[d][span] + p <= upper[d];
    };
    const std::size_t count = spans_[d].size() - 1;
    for (begin[d] = 0; begin[d] < count && !inside(begin[d]);) ++begin[d];
    for (end[d] = begin[d]; end[d] < count && inside(end[d]);) ++end[d];
  }
  std::vector<int> result;
  for_each_element(begin, end, [&](const Element& element) {
    bool all = true;
    for_each_control_point(
        element, [&](int row) { all = all && marks[static_cast<std::size_t>(first + row)] != 0; });
    if (!all) return;
    result.push_back(number(element));
  });
  return result;
}

template <int D>
FrictionAnchors ToolLoad<D>::anchors(const Points& x, int first, std::span<const ModelTool> tools,
                                     double slip, ToolPass pass) const {
  FrictionAnchors result;
  result.slip = slip;
  std::vector<const ModelTool*> rubbing;
  for (const ModelTool& tool : tools) {
    if (tool.tool().collides() && tool.tool().friction > 0 && takes_in_pass(tool, pass))
      rubbing.push_back(&tool);
  }
  if (rubbing.empty()) return result;
  std::size_t elements = 1;
  for (std::size_t d = 0; d < D; ++d) elements *= starts_[d].size();
  result.elements.assign(elements, -1);
  Sweep sweep(*this, x, first);
  for_each_element([&](const Element& element) {
    if (Interruption::asked_for()) return;
    const int visible = pass == ToolPass::all ? VisibleMask::full : visibility(element);
    if (visible == VisibleMask::hidden) return;
    Point lower, upper;
    sweep.enter(element, lower, upper);
    for (const ModelTool* tool : rubbing) {
      if (in_hull_ && !tool->may_reach(lower, upper)) continue;
      Gripping gripping{*this, x, first, *tool, visible != VisibleMask::full, element, result};
      sweep.run(gripping);
    }
  });
  return result;
}

template class ToolLoad<1>;
template class ToolLoad<2>;
template class ToolLoad<3>;

}  // namespace knead
