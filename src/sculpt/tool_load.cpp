#include "tool_load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "knead/spline/evaluate.hpp"
#include "tool_load_elements.hpp"

namespace knead {
namespace {

constexpr double points_per_detail = 6;
constexpr double max_points_per_direction = 1e5;

/// The longest isocurve of direction d on every span of d, in file units.
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
    (d < direction ? outer : d > direction ? inner : outer) *= d == direction ? 1 : q[d].weights.size();
  const std::size_t size = q[direction].weights.size();
  const auto per_span = static_cast<std::size_t>(spline.knots()[direction].degree() + 1);
  std::vector<double> result(size / per_span, 0.0);
  for (std::size_t s = 0; s < result.size(); ++s) {
    for (std::size_t o = 0; o < outer; ++o) {
      for (std::size_t i = 0; i < inner; ++i) {
        double length = 0;
        for (std::size_t at = s * per_span; at < (s + 1) * per_span; ++at) {
          length +=
              q[direction].weights[at] * tangent.row(static_cast<Eigen::Index>((o * size + at) * inner + i)).norm();
        }
        result[s] = std::max(result[s], length);
      }
    }
  }
  return result;
}

/// Pieces per span, so that Gauss points lie closer than detail / points_per_detail.
Expected<std::vector<int>> pieces(const std::vector<double>& lengths, int per_span, double detail) {
  std::vector<int> result;
  double total = 0;
  for (double length : lengths) {
    // Rounded up with a grain of slack, so that a length that is a whole multiple but for rounding is taken as whole.
    const double wanted = std::max(1.0, std::ceil(length * points_per_detail / (detail * per_span) * (1 - 1e-6)));
    total += wanted * per_span;
    if (total > max_points_per_direction) {
      return input_error(fmt::format("a tool of size {:.3g} is too small for this surface", detail), "tool",
                         "use a larger tool, or sculpt a surface that is smaller or has a finer net");
    }
    result.push_back(static_cast<int>(wanted));
  }
  return result;
}

/// Potential, slope / way and curvature of friction that grips with force `grip` after `slip`: quadratic up to there,
/// linear beyond.
struct Grip {
  double potential, slope, curvature;
};

Grip grip_at(double way, double grip, double slip) {
  if (way < slip) return {0.5 * grip / slip * way * way, grip / slip, grip / slip};
  return {grip * (way - 0.5 * slip), grip / way, 0};
}

}  // namespace

template <int D>
struct ToolLoad<D>::Sample {
  std::array<int, 3> at{};
  double weight, inverse;  // Gauss weight, 1 / denominator
  Point place;
};

template <int D>
Expected<ToolLoad<D>> ToolLoad<D>::create(const Spline<D>& spline, const DomainScaling<D>& scaling, double detail) {
  ToolLoad load;
  load.net_ = spline.net();
  for (std::size_t d = 0; d < D; ++d) {
    auto lengths = span_lengths<D>(spline, d);
    if (!lengths) return std::unexpected(lengths.error());
    const int per_piece = spline.knots()[d].degree() + 1;
    const auto counts = pieces(*lengths, per_piece, detail);
    if (!counts) return std::unexpected(counts.error());
    load.quadrature_[d] = gauss_basis(spline.knots()[d], per_piece, 0, *counts);
    for (double& w : load.quadrature_[d].weights) w *= scaling.factors[d];
    load.spans_[d].push_back(0);
    for (int count : *counts) load.spans_[d].push_back(load.spans_[d].back() + count * per_piece);
    for (double& length : *lengths) length /= scaling.length;
    load.lengths_[d] = std::move(*lengths);
    load.knots_.push_back(spline.knots()[d]);
  }
  load.weights_.assign(spline.weights().begin(), spline.weights().end());
  load.in_hull_ = std::ranges::all_of(load.weights_, [](double w) { return w > 0; });
  return load;
}

template <int D>
long long ToolLoad<D>::points() const {
  long long count = 1;
  for (const BasisQuadrature& q : quadrature_) count *= q.basis.size();
  return count;
}

template <int D>
long long ToolLoad<D>::index(const std::array<int, 3>& at) const {
  long long result = 0;
  for (std::size_t d = 0; d < D; ++d) result = result * quadrature_[d].basis.size() + at[d];
  return result;
}

/// f(row of the control point, value of its basis function times its weight) at one Gauss point.
template <int D>
template <class F>
void ToolLoad<D>::for_each_function(const std::array<int, 3>& at, const F& f) const {
  const auto direction = [&](auto self, std::size_t d, int row, double product) -> void {
    const BasisTable& table = quadrature_[d].basis;
    const double* n = table.row(at[d], 0);
    const int base = row * net_[d] + table.first[static_cast<std::size_t>(at[d])];
    for (int r = 0; r <= table.degree; ++r) {
      if (d + 1 == D) {
        f(base + r, weights_.empty() ? product * n[r] : product * n[r] * weights_[static_cast<std::size_t>(base + r)]);
      } else {
        self(self, d + 1, base + r, product * n[r]);
      }
    }
  };
  direction(direction, 0, 0, 1.0);
}

/// f(sample) for every Gauss point of the element. The control points, homogeneous, are contracted one direction at a
/// time.
template <int D>
template <class F>
void ToolLoad<D>::for_each_point(const Element& element, const Points& x, int first, Workspace& workspace,
                                 const F& f) const {
  std::array<std::size_t, D + 1> sizes;
  sizes[D] = 1;
  for (std::size_t d = D; d-- > 0;) sizes[d] = sizes[d + 1] * static_cast<std::size_t>(quadrature_[d].basis.degree + 1);
  auto& level = workspace;  // level[d]: directions d … D−1 are still control points
  for (std::size_t d = 0; d <= D; ++d) level[d].resize(sizes[d]);
  std::size_t to = 0;
  for_each_control_point(element, [&](int row) {
    const double w = weights_.empty() ? 1 : weights_[static_cast<std::size_t>(row)];
    const double* p = x.data() + 3 * static_cast<std::ptrdiff_t>(first + row);
    level[0][to++] = {w * p[0], w * p[1], w * p[2], w};
  });
  Sample sample;
  const auto contract = [&](auto self, std::size_t d, double weight) -> void {
    if (d == D) {
      const Homogeneous& h = level[D][0];
      sample.weight = weight;
      sample.inverse = weights_.empty() ? 1 : 1 / h[3];
      sample.place = sample.inverse * Point(h[0], h[1], h[2]);
      f(sample);
      return;
    }
    const BasisQuadrature& q = quadrature_[d];
    for (int k = element.begin[d]; k < element.end[d]; ++k) {
      const double* n = q.basis.row(k, 0);
      sample.at[d] = k;
      for (std::size_t i = 0; i < sizes[d + 1]; ++i) {
        Homogeneous sum = {0, 0, 0, 0};
        for (int r = 0; r <= q.basis.degree; ++r) {
          const Homogeneous& from = level[d][static_cast<std::size_t>(r) * sizes[d + 1] + i];
          for (std::size_t c = 0; c < 4; ++c) sum[c] += n[r] * from[c];
        }
        level[d + 1][i] = sum;
      }
      self(self, d + 1, weight * q.weights[static_cast<std::size_t>(k)]);
    }
  };
  contract(contract, 0, 1.0);
}

template <int D>
void ToolLoad<D>::evaluate(const Points& x, int first, int patch, const Actors& actors, PotentialState& state) const {
  if (actors.tools.empty() && actors.limit == nullptr) return;
  Eigen::VectorXd ways;  // of the control points: their hull bounds the way of every point
  if (actors.limit != nullptr) {
    ways = (x.middleRows(first, actors.limit->original.rows()) - actors.limit->original).rowwise().norm();
  }
  const auto may_exceed = [&](const Element& element) {
    if (!in_hull_) return true;
    bool result = false;
    for_each_control_point(element, [&](int row) { result = result || ways[row] > actors.limit->distance; });
    return result;
  };
  const auto count = static_cast<std::size_t>(std::accumulate(net_.begin(), net_.end(), 1, std::multiplies{}));
  std::vector<unsigned char> sides(count * actors.tools.size());  // tool after tool
  for (std::size_t t = 0; t < actors.tools.size(); ++t) {
    const double* at = x.data() + 3 * static_cast<std::ptrdiff_t>(first);
    for (std::size_t i = 0; i < count; ++i, at += 3) sides[t * count + i] = actors.tools[t].sides(at);
  }
  Workspace workspace;
  std::vector<std::size_t> near;
  for_each_element([&](const Element& element) {
    near.clear();
    for (std::size_t t = 0; t < actors.tools.size(); ++t) {
      unsigned char beyond = 0xff;
      for_each_control_point(element, [&](int row) { beyond &= sides[t * count + static_cast<std::size_t>(row)]; });
      if (!in_hull_ || beyond == 0) near.push_back(t);
    }
    if (in_hull_ && !near.empty()) {
      Point lower, upper;
      box_of(element, x, first, lower, upper);
      std::erase_if(near, [&](std::size_t t) { return !actors.tools[t].may_reach(lower, upper); });
    }
    const bool limited = actors.limit != nullptr && may_exceed(element);
    if (near.empty() && !limited) return;
    double longest = 0;
    for (std::size_t d = 0; d < D; ++d)
      longest = std::max(longest, lengths_[d][static_cast<std::size_t>(element.span[d])]);
    for_each_point(element, x, first, workspace, [&](const Sample& s) {
      const auto push = [&](double potential, const Point& force, const Eigen::Matrix3d& hessian) {
        state.potential += s.weight * potential;
        for_each_function(s.at, [&](int row, double n) {
          double* to = state.force.data() + 3 * static_cast<std::ptrdiff_t>(first + row);
          for (int c = 0; c < 3; ++c) to[c] += s.weight * s.inverse * n * force[c];
        });
        state.contacts.push_back({patch, s.at, s.weight * s.inverse * s.inverse, hessian});
      };
      for (std::size_t t : near) {
        const ModelTool& tool = actors.tools[t];
        const ToolAction action = tool.action(s.place);
        if (!action.active) continue;
        push(action.potential, action.force, action.hessian);
        const double size = tool.size();
        state.coarseness = std::max(state.coarseness, longest / size);
        if (action.entry > state.entry * size) {
          state.entry = action.entry / size;
          state.entered = static_cast<int>(t);
        }
      }
      if (actors.friction != nullptr) {
        const int anchor = actors.friction->index[static_cast<std::size_t>(index(s.at))];
        if (anchor >= 0) {
          const auto& a = actors.friction->anchors[static_cast<std::size_t>(anchor)];
          const Eigen::Matrix3d tangential = Eigen::Matrix3d::Identity() - a.normal * a.normal.transpose();
          const Point way = tangential * (s.place - a.place);
          const double length = way.norm();
          const Grip grip = grip_at(length, a.grip, actors.friction->slip);
          Eigen::Matrix3d hessian = grip.slope * tangential;
          if (length > 0) hessian += (grip.curvature - grip.slope) / (length * length) * way * way.transpose();
          push(grip.potential, -grip.slope * way, hessian);
        }
      }
      if (limited) {
        Point original = Point::Zero();
        for_each_function(
            s.at, [&](int row, double n) { original += s.inverse * n * actors.limit->original.row(row).transpose(); });
        const Point way = s.place - original;
        const double length = way.norm(), beyond = length - actors.limit->distance, k = actors.limit->stiffness;
        if (beyond > 0) {
          state.limited = true;
          const Point n = way / length;
          Eigen::Matrix3d hessian = k * (1 - beyond / length) * n * n.transpose();
          hessian.diagonal().array() += k * beyond / length;
          push(0.5 * k * beyond * beyond, -k * beyond * n, hessian);
        }
      }
    });
  });
}

template <int D>
void ToolLoad<D>::apply_hessian(const ContactPoint& contact, int first, const Points& v, Points& out) const {
  double sum[3] = {0, 0, 0};
  for_each_function(contact.at, [&](int row, double n) {
    const double* from = v.data() + 3 * static_cast<std::ptrdiff_t>(first + row);
    for (int c = 0; c < 3; ++c) sum[c] += n * from[c];
  });
  const Point h = contact.factor * (contact.hessian * Point(sum[0], sum[1], sum[2]));
  for_each_function(contact.at, [&](int row, double n) {
    double* to = out.data() + 3 * static_cast<std::ptrdiff_t>(first + row);
    for (int c = 0; c < 3; ++c) to[c] += n * h[c];
  });
}

template <int D>
void ToolLoad<D>::mark(const ContactPoint& contact, int first, std::vector<char>& marks) const {
  for_each_function(contact.at, [&](int row, double) { marks[static_cast<std::size_t>(first + row)] = 1; });
}

template <int D>
FrictionAnchors ToolLoad<D>::anchors(const Points& x, int first, std::span<const ModelTool> tools, double slip) const {
  FrictionAnchors result;
  Workspace workspace;
  result.slip = slip;
  result.index.assign(static_cast<std::size_t>(points()), -1);
  for_each_element([&](const Element& element) {
    Point lower, upper;
    box_of(element, x, first, lower, upper);
    for (const ModelTool& tool : tools) {
      if (!tool.tool().collides() || tool.tool().friction == 0) continue;
      if (in_hull_ && !tool.may_reach(lower, upper)) continue;
      for_each_point(element, x, first, workspace, [&](const Sample& s) {
        const ToolAction action = tool.action(s.place);
        if (!action.active) return;
        int& at = result.index[static_cast<std::size_t>(index(s.at))];
        const FrictionAnchors::Anchor anchor{tool.tool().friction * action.force.norm(), action.normal, s.place};
        if (at < 0) {
          at = static_cast<int>(result.anchors.size());
          result.anchors.push_back(anchor);
        } else if (anchor.grip > result.anchors[static_cast<std::size_t>(at)].grip) {
          result.anchors[static_cast<std::size_t>(at)] = anchor;  // between two tools the stronger grips
        }
      });
    }
  });
  return result;
}

template class ToolLoad<1>;
template class ToolLoad<2>;
template class ToolLoad<3>;

}  // namespace knead
