#include "knead/sculpt/surface_load.hpp"

#include <algorithm>
#include <cmath>

#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

constexpr double points_per_detail = 6;
constexpr int max_points_per_direction = 3000;

/// Pieces per span of direction d, so that Gauss points lie closer than detail / points_per_detail on the surface.
Expected<std::vector<int>> pieces(const Surface& surface, int direction, double detail) {
  std::array<BasisQuadrature, 2> q;
  for (int d = 0; d < 2; ++d) {
    q[static_cast<std::size_t>(d)] = gauss_basis(surface.knots(d), surface.knots(d).degree() + 1, 1);
  }
  auto grid = evaluate_grid<2>(surface, std::array<const BasisTable*, 2>{&q[0].basis, &q[1].basis}, 1);
  if (!grid) return std::unexpected(grid.error());
  const Points& tangent = direction == 0 ? grid->at({1, 0}) : grid->at({0, 1});
  const int nu = q[0].basis.size(), nv = q[1].basis.size();
  const std::vector<int> spans = surface.knots(direction).spans();
  const int per_span = surface.knots(direction).degree() + 1;
  const int others = direction == 0 ? nv : nu;
  std::vector<int> result(spans.size(), 1);
  int total = static_cast<int>(spans.size()) * per_span;
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
    result[s] = static_cast<int>(std::clamp(wanted, 1.0, 64.0));
    total += (result[s] - 1) * per_span;
  }
  if (total > max_points_per_direction) {
    const double shrink = static_cast<double>(max_points_per_direction) / total;
    for (int& count : result) count = std::max(1, static_cast<int>(count * shrink));
  }
  return result;
}

}  // namespace

Expected<SurfaceLoad> SurfaceLoad::create(const Surface& surface, const DomainScaling& scaling, double detail) {
  SurfaceLoad load;
  load.net_ = surface.net();
  for (int d = 0; d < 2; ++d) {
    const auto k = static_cast<std::size_t>(d);
    auto counts = pieces(surface, d, detail);
    if (!counts) return std::unexpected(counts.error());
    load.quadrature_[k] = gauss_basis(surface.knots(d), surface.knots(d).degree() + 1, 0, *counts);
    for (double& w : load.quadrature_[k].weights) w *= scaling.factors[k];
  }
  if (!surface.rational()) return load;

  load.weights_.assign(surface.weights().begin(), surface.weights().end());
  // The denominator is the first coordinate of the polynomial surface whose control points are the weights.
  Points weights = Points::Zero(surface.size(), 3);
  weights.col(0) = Eigen::Map<const Eigen::VectorXd>(load.weights_.data(), surface.size());
  auto denominator = Surface::create(surface.knots(), weights);
  if (!denominator) return std::unexpected(denominator.error());
  auto grid = evaluate_grid<2>(
      *denominator, std::array<const BasisTable*, 2>{&load.quadrature_[0].basis, &load.quadrature_[1].basis});
  if (!grid) return std::unexpected(grid.error());
  load.inverse_denominator_.resize(static_cast<std::size_t>(grid->points().rows()));
  for (Eigen::Index k = 0; k < grid->points().rows(); ++k) {
    const double w = grid->points()(k, 0);
    if (!(w > 0)) return numerical_error("the rational denominator is not positive", "load", "use positive weights");
    load.inverse_denominator_[static_cast<std::size_t>(k)] = 1 / w;
  }
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

SurfaceLoad::State SurfaceLoad::evaluate(const Points& x, std::span<const Tool> tools) const {
  State state;
  state.force_ = Points::Zero(x.rows(), 3);
  if (tools.empty()) return state;
  const BasisTable &tu = quadrature_[0].basis, &tv = quadrature_[1].basis;
  const int nu = tu.size(), nv = tv.size(), n = net_[1];
  // Homogeneous net contracted along u once per row of Gauss points.
  Points net = x;
  for (std::size_t k = 0; k < weights_.size(); ++k) net.row(static_cast<Eigen::Index>(k)) *= weights_[k];
  Points row(n, 3);
  for (int ku = 0; ku < nu; ++ku) {
    const double* basis_u = tu.row(ku, 0);
    const Eigen::Index first = static_cast<Eigen::Index>(tu.first[static_cast<std::size_t>(ku)]) * n;
    row = basis_u[0] * net.middleRows(first, n);
    for (int r = 1; r <= tu.degree; ++r)
      row += basis_u[r] * net.middleRows(first + static_cast<Eigen::Index>(r) * n, n);
    for (int kv = 0; kv < nv; ++kv) {
      const double* basis_v = tv.row(kv, 0);
      const double* from = row.data() + 3 * static_cast<std::ptrdiff_t>(tv.first[static_cast<std::size_t>(kv)]);
      double sum[3] = {0, 0, 0};
      for (int c = 0; c <= tv.degree; ++c) {
        for (int k = 0; k < 3; ++k) sum[k] += basis_v[c] * from[3 * c + k];
      }
      const double inverse = inverse_denominator_.empty()
                                 ? 1
                                 : inverse_denominator_[static_cast<std::size_t>(ku) * static_cast<std::size_t>(nv) +
                                                        static_cast<std::size_t>(kv)];
      const Point point = inverse * Point(sum[0], sum[1], sum[2]);
      const double weight =
          quadrature_[0].weights[static_cast<std::size_t>(ku)] * quadrature_[1].weights[static_cast<std::size_t>(kv)];
      for (const Tool& tool : tools) {
        const ToolAction action = tool_action(tool, point);
        state.potential_ += weight * action.potential;
        if (!action.active()) continue;
        scatter(ku, kv, (weight * inverse) * action.force, state.force_);
        state.contacts_.push_back(
            {ku, kv, weight * inverse * inverse, action.normal, action.tangential, action.direction});
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
