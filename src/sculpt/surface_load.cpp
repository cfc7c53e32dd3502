#include "knead/sculpt/surface_load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

constexpr double points_per_detail = 6;
constexpr double max_points_per_direction = 1e5;

/// The tangents of a surface at p + 1 Gauss points per span.
struct TangentGrid {
  std::array<BasisQuadrature, 2> quadrature;
  Evaluation<2> surface;

  static Expected<TangentGrid> create(const Surface& surface) {
    TangentGrid grid;
    for (std::size_t d = 0; d < 2; ++d) {
      grid.quadrature[d] = gauss_basis(surface.knots()[d], surface.knots()[d].degree() + 1, 1);
    }
    auto evaluated = evaluate_grid<2>(
        surface, std::array<const BasisTable*, 2>{&grid.quadrature[0].basis, &grid.quadrature[1].basis}, 1);
    if (!evaluated) return std::unexpected(evaluated.error());
    grid.surface = std::move(*evaluated);
    return grid;
  }
};

/// Pieces per span of direction d, so that Gauss points lie closer than detail / points_per_detail on the surface.
Expected<std::vector<int>> pieces(const Surface& surface, const TangentGrid& grid, int direction, double detail) {
  const std::array<BasisQuadrature, 2>& q = grid.quadrature;
  const Points& tangent = direction == 0 ? grid.surface.at({1, 0}) : grid.surface.at({0, 1});
  const int nu = q[0].basis.size(), nv = q[1].basis.size();
  const std::vector<int> spans = surface.knots(direction).spans();
  const int per_span = surface.knots(direction).degree() + 1;
  const int others = direction == 0 ? nv : nu;
  std::vector<int> result(spans.size(), 1);
  double total = 0;
  for (std::size_t s = 0; s < spans.size(); ++s) {
    double longest = 0;
    for (int other = 0; other < others; ++other) {
      double length = 0;
      for (int g = 0; g < per_span; ++g) {
        const int at = static_cast<int>(s) * per_span + g;
        const Eigen::Index row =
            direction == 0 ? static_cast<Eigen::Index>(at) * nv + other : static_cast<Eigen::Index>(other) * nv + at;
        length +=
            q[static_cast<std::size_t>(direction)].weights[static_cast<std::size_t>(at)] * tangent.row(row).norm();
      }
      longest = std::max(longest, length);
    }
    // Rounded up with a grain of slack, so that a length that is a whole multiple but for rounding is taken as whole.
    const double wanted = std::ceil(longest * points_per_detail / (detail * per_span) * (1 - 1e-6));
    total += std::max(wanted, 1.0) * per_span;
    if (total > max_points_per_direction) {
      return input_error(fmt::format("a tool of size {:.3g} is too small for this surface", detail), "tool",
                         "use a larger tool, or sculpt a surface that is smaller or has a finer net");
    }
    result[s] = static_cast<int>(std::max(wanted, 1.0));
  }
  return result;
}

/// Distance of a point to an axis-parallel box; 0 inside.
double distance(const Point& x, const Point& lower, const Point& upper) {
  return (lower - x).cwiseMax(x - upper).cwiseMax(0.0).norm();
}

double reach(const Tool& tool) { return tool.shape.radius + (tool.mode == ToolMode::proximity ? tool.range : 0); }

}  // namespace

Expected<SurfaceLoad> SurfaceLoad::create(const Surface& surface, const DomainScaling& scaling, double detail) {
  SurfaceLoad load;
  load.net_ = surface.net();
  const auto grid = TangentGrid::create(surface);
  if (!grid) return std::unexpected(grid.error());
  for (int d = 0; d < 2; ++d) {
    const auto k = static_cast<std::size_t>(d);
    auto counts = pieces(surface, *grid, d, detail);
    if (!counts) return std::unexpected(counts.error());
    load.quadrature_[k] = gauss_basis(surface.knots(d), surface.knots(d).degree() + 1, 0, *counts);
    for (double& w : load.quadrature_[k].weights) w *= scaling.factors[k];
    const int per_piece = surface.knots(d).degree() + 1;
    load.spans_[k].push_back(0);
    for (int count : *counts) load.spans_[k].push_back(load.spans_[k].back() + count * per_piece);
  }
  load.weights_.assign(surface.weights().begin(), surface.weights().end());
  load.in_hull_ = std::ranges::all_of(load.weights_, [](double w) { return w > 0; });
  return load;
}

Point SurfaceLoad::gather(int ku, int kv, const Points& v) const {
  const BasisTable &tu = quadrature_[0].basis, &tv = quadrature_[1].basis;
  const double *nu = tu.row(ku, 0), *nv = tv.row(kv, 0);
  const int i0 = tu.first[static_cast<std::size_t>(ku)], j0 = tv.first[static_cast<std::size_t>(kv)];
  double sum[3] = {0, 0, 0};
  for (int r = 0; r <= tu.degree; ++r) {
    const int row = (i0 + r) * net_[1] + j0;
    const double* from = v.data() + 3 * static_cast<std::ptrdiff_t>(row);
    for (int c = 0; c <= tv.degree; ++c) {
      double n = nu[r] * nv[c];
      if (!weights_.empty()) n *= weights_[static_cast<std::size_t>(row + c)];
      for (int x = 0; x < 3; ++x) sum[x] += n * from[3 * c + x];
    }
  }
  return {sum[0], sum[1], sum[2]};
}

void SurfaceLoad::scatter(int ku, int kv, const Point& f, Points& out) const {
  const BasisTable &tu = quadrature_[0].basis, &tv = quadrature_[1].basis;
  const double *nu = tu.row(ku, 0), *nv = tv.row(kv, 0);
  const int i0 = tu.first[static_cast<std::size_t>(ku)], j0 = tv.first[static_cast<std::size_t>(kv)];
  for (int r = 0; r <= tu.degree; ++r) {
    const int row = (i0 + r) * net_[1] + j0;
    double* to = out.data() + 3 * static_cast<std::ptrdiff_t>(row);
    for (int c = 0; c <= tv.degree; ++c) {
      double n = nu[r] * nv[c];
      if (!weights_.empty()) n *= weights_[static_cast<std::size_t>(row + c)];
      for (int x = 0; x < 3; ++x) to[3 * c + x] += n * f[x];
    }
  }
}

/// The Gauss points of one span in u and one in v.
struct SurfaceLoad::Patch {
  int u_begin, u_end, v_begin, v_end;
};

void SurfaceLoad::evaluate_patch(const Patch& patch, const Points& x, std::span<const Tool> tools, State& state) const {
  const BasisTable &tu = quadrature_[0].basis, &tv = quadrature_[1].basis;
  const int i0 = tu.first[static_cast<std::size_t>(patch.u_begin)],
            j0 = tv.first[static_cast<std::size_t>(patch.v_begin)];
  // The patch's control points, homogeneous, contracted along u once per row of Gauss points.
  std::array<std::array<double, 4>, max_degree + 1> row;
  for (int ku = patch.u_begin; ku < patch.u_end; ++ku) {
    const double* nu = tu.row(ku, 0);
    for (int c = 0; c <= tv.degree; ++c) {
      std::array<double, 4> sum = {0, 0, 0, 0};
      for (int r = 0; r <= tu.degree; ++r) {
        const Eigen::Index at = static_cast<Eigen::Index>(i0 + r) * net_[1] + j0 + c;
        const double n = weights_.empty() ? nu[r] : nu[r] * weights_[static_cast<std::size_t>(at)];
        for (int k = 0; k < 3; ++k) sum[static_cast<std::size_t>(k)] += n * x(at, k);
        sum[3] += n;
      }
      row[static_cast<std::size_t>(c)] = sum;
    }
    for (int kv = patch.v_begin; kv < patch.v_end; ++kv) {
      const double* nv = tv.row(kv, 0);
      std::array<double, 4> sum = {0, 0, 0, 0};
      for (int c = 0; c <= tv.degree; ++c) {
        for (std::size_t k = 0; k < 4; ++k) sum[k] += nv[c] * row[static_cast<std::size_t>(c)][k];
      }
      const double inverse = weights_.empty() ? 1 : 1 / sum[3];
      const Point point = inverse * Point(sum[0], sum[1], sum[2]);
      const double weight =
          quadrature_[0].weights[static_cast<std::size_t>(ku)] * quadrature_[1].weights[static_cast<std::size_t>(kv)];
      for (const Tool& tool : tools) {
        const ToolAction action = tool_action(tool, point);
        if (!action.active()) continue;
        state.potential_ += weight * action.potential;
        scatter(ku, kv, (weight * inverse) * action.force, state.force_);
        state.contacts_.push_back(
            {ku, kv, weight * inverse * inverse, action.normal, action.tangential, action.direction});
      }
    }
  }
}

SurfaceLoad::State SurfaceLoad::evaluate(const Points& x, std::span<const Tool> tools) const {
  State state;
  state.force_ = Points::Zero(x.rows(), 3);
  if (tools.empty()) return state;
  const BasisTable &tu = quadrature_[0].basis, &tv = quadrature_[1].basis;
  std::vector<Point> lower(static_cast<std::size_t>(net_[1])), upper(lower);
  for (std::size_t a = 0; a + 1 < spans_[0].size(); ++a) {
    const int i0 = tu.first[static_cast<std::size_t>(spans_[0][a])];
    for (int j = 0; j < net_[1]; ++j) {  // boxes of the columns of control points that this span of u sees
      const auto k = static_cast<std::size_t>(j);
      lower[k] = upper[k] = x.row(static_cast<Eigen::Index>(i0) * net_[1] + j);
      for (int r = 1; r <= tu.degree; ++r) {
        const Point p = x.row(static_cast<Eigen::Index>(i0 + r) * net_[1] + j);
        lower[k] = lower[k].cwiseMin(p);
        upper[k] = upper[k].cwiseMax(p);
      }
    }
    for (std::size_t b = 0; b + 1 < spans_[1].size(); ++b) {
      const auto j0 = static_cast<std::size_t>(tv.first[static_cast<std::size_t>(spans_[1][b])]);
      Point low = lower[j0], high = upper[j0];
      for (std::size_t c = 1; c <= static_cast<std::size_t>(tv.degree); ++c) {
        low = low.cwiseMin(lower[j0 + c]);
        high = high.cwiseMax(upper[j0 + c]);
      }
      const bool near = std::ranges::any_of(
          tools, [&](const Tool& tool) { return distance(tool.shape.centre, low, high) <= reach(tool); });
      if (near || !in_hull_) {
        evaluate_patch({spans_[0][a], spans_[0][a + 1], spans_[1][b], spans_[1][b + 1]}, x, tools, state);
      }
    }
  }
  return state;
}

Points SurfaceLoad::apply_hessian(const State& state, const Points& v) const {
  Points result = Points::Zero(v.rows(), 3);
  for (const State::Contact& c : state.contacts_) {
    const Point s = gather(c.ku, c.kv, v);
    const double along = c.direction.dot(s);
    const Point h = c.factor * ((c.normal - c.tangential) * along * c.direction + c.tangential * s);
    scatter(c.ku, c.kv, h, result);
  }
  return result;
}

}  // namespace knead
