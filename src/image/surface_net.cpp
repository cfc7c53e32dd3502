#include "surface_net.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "knead/gramian/gramian.hpp"
#include "knead/spline/evaluate.hpp"
#include "periodic_knots.hpp"

namespace knead {
namespace {

using std::numbers::pi;

constexpr int extra_points = 6;  // for sin and 1/sin beside the polynomials: to rounding

Expected<KnotVector> uniform_knots(int degree, int count, double length, bool periodic) {
  if (!periodic) return KnotVector::clamped_uniform(degree, count, 0, length);
  std::vector<double> breaks;
  for (int k = 0; k <= count; ++k)
    breaks.push_back(length * (double(k) / count));  // the end exactly
  return periodic_knots(degree, breaks);
}

/// The Gramian of functions that come around again. On uniform periodic knots the result is a
/// symmetric circulant matrix.
Eigen::MatrixXd folded(const BandMatrix& band, int count) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(count, count);
  const int p = band.half_bandwidth();
  for (int i = 0; i < band.size(); ++i) {
    for (int j = std::max(0, i - p); j <= std::min(band.size() - 1, i + p); ++j)
      all(i % count, j % count) += band(i, j);
  }
  return all;
}

/// The eigenvalue of a symmetric circulant matrix for a wave number.
///
/// Its eigenvectors are cosines and sines of 2π k i/n whatever its entries: so all Gramians around
/// u are diagonal in one Fourier basis.
double symbol(const Eigen::MatrixXd& circulant, int wave) {
  double sum = 0;
  const auto n = static_cast<int>(circulant.rows());
  for (int k = 0; k < n; ++k) sum += circulant(0, k) * std::cos(2 * pi * ((wave * k) % n) / n);
  return sum;
}

/// ∫ N_i^(d) N_j^(d) weight(v) dv of the functions from pole to pole.
///
/// 1/sin is infinite at a pole. It weighs slopes along u only, of waves k ≥ 1, whose functions
/// vanish there (`allowed`): what is integrated stays finite, and entries of functions that do not
/// vanish are never used.
template <class Weight>
Eigen::MatrixXd weighted_gramian(const KnotVector& knots, int derivative, const Weight& weight) {
  const BasisQuadrature q = gauss_basis(knots, knots.degree() + 1 + extra_points, derivative);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(knots.count(), knots.count());
  for (int k = 0; k < q.basis.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    const double* values = q.basis.row(k, derivative);
    const double w = q.weights[at] * weight(q.parameters[at]);
    for (int r = 0; r <= knots.degree(); ++r) {
      for (int s = 0; s <= knots.degree(); ++s) {
        sum(q.basis.first[at] + r, q.basis.first[at] + s) += w * values[r] * values[s];
      }
    }
  }
  return sum;
}

}  // namespace

SurfaceSpace SurfaceSpace::halved() const {
  const bool around = form == SurfaceForm::torus;
  return {form, degree, {2 * counts[0], 2 * counts[1] - (around ? 0 : degree)}, lengths};
}

// Recognised by its knots, which must be those that `closed_surface` makes, to the bit: the modes
// need even spans, and a sphere's metric needs v to be half of u's length.
Expected<SurfaceSpace> space_of(const ClosedSurface& snake) {
  const auto& knots = snake.surface.knots();
  const int p = knots[0].degree();
  const bool torus = snake.form == SurfaceForm::torus;
  const SurfaceSpace space{snake.form,
                           p,
                           {knots[0].count() - p, knots[1].count() - (torus ? p : 0)},
                           {knots[0].domain().length(), knots[1].domain().length()}};
  for (std::size_t d = 0; d < 2; ++d) {
    const auto made =
        uniform_knots(p, std::max(space.counts[d], 0), space.lengths[d], d == 0 || torus);
    const bool half = torus || d == 0 ||
                      std::abs(2 * space.lengths[1] - space.lengths[0]) <= 1e-12 * space.lengths[0];
    if (made && *made == knots[d] && half && !snake.surface.rational()) continue;
    return input_error("its knots are not those of an active surface", d == 0 ? "u" : "v",
                       "use closed_surface");
  }
  return space;
}

// Dense tables of all functions at all Gauss points: mostly zeros, but products with them run at
// the speed of matrix products, and nets are small.
Expected<SurfaceNet::Axis> SurfaceNet::Axis::create(int degree, int count, double length,
                                                    bool periodic) {
  auto knots = uniform_knots(degree, count, length, periodic);
  if (!knots) return std::unexpected(knots.error());
  BasisQuadrature quadrature = gauss_basis(*knots, degree + 1, 1);
  const BasisTable& basis = quadrature.basis;
  std::array<Dense, 2> functions;
  for (int d = 0; d < 2; ++d) {
    Dense& f = functions[static_cast<std::size_t>(d)];
    f = Dense::Zero(basis.size(), count);
    for (int q = 0; q < basis.size(); ++q) {
      for (int r = 0; r <= degree; ++r) {
        f(q, (basis.first[static_cast<std::size_t>(q)] + r) % count) += basis.row(q, d)[r];
      }
    }
  }
  return Axis{std::move(*knots), periodic, count, std::move(quadrature), std::move(functions)};
}

// dΩ is du dv on a torus, which is flat, and sin(π v/l) du dv on the round sphere: what shapes at
// poles need, where du dv would give the pole the weight of a circle.
Expected<SurfaceNet> SurfaceNet::create(const SurfaceSpace& space, double alpha, double beta) {
  auto u = Axis::create(space.degree, space.counts[0], space.lengths[0], true);
  if (!u) return std::unexpected(u.error());
  const bool torus = space.form == SurfaceForm::torus;
  auto v = Axis::create(space.degree, space.counts[1], space.lengths[1], torus);
  if (!v) return std::unexpected(v.error());
  SurfaceNet net(space, {std::move(*u), std::move(*v)});
  const auto &wu = net.axes_[0].quadrature.weights, &wv = net.axes_[1].quadrature.weights;
  const auto& at = net.axes_[1].quadrature.parameters;
  net.weights_.resize(std::ssize(wu) * std::ssize(wv));
  net.weights_on_domain_.resize(net.weights_.size());
  Eigen::Index k = 0;
  for (const double a : wu) {
    for (std::size_t b = 0; b < wv.size(); ++b, ++k) {
      net.weights_[k] = a * wv[b];
      net.weights_on_domain_[k] =
          net.weights_[k] * (torus ? 1 : std::sin(pi * at[b] / space.lengths[1]));
    }
  }
  net.make_transform();
  if (auto status = net.make_modes(alpha, beta); !status) return std::unexpected(status.error());
  return net;
}

// Real and orthonormal: √(1/n) for k = 0 and n/2, √(2/n) cos and sin for those between. Dense
// products, O(n²) a line: with some tens of control points around, a fast transform gains nothing.
void SurfaceNet::make_transform() {
  const int n = space_.counts[0];
  waves_.resize(n, n);
  wave_.clear();
  for (int k = 0; 2 * k <= n; ++k) {
    const bool alone = k == 0 || 2 * k == n;
    for (int part = 0; part < (alone ? 1 : 2); ++part) {
      const auto column = static_cast<Eigen::Index>(wave_.size());
      for (int i = 0; i < n; ++i) {
        const double angle = 2 * pi * ((k * i) % n) / n;
        waves_(i, column) =
            std::sqrt((alone ? 1.0 : 2.0) / n) * (part == 0 ? std::cos(angle) : std::sin(angle));
      }
      wave_.push_back(k);
    }
  }
}

// A pole is one point with a tangent plane if the first column is constant (wave 0 alone) and the
// second is it plus an affine image of a regular polygon (waves 0, its mean the pole, and 1). In
// the Fourier basis these conditions leave out coefficients, and couple nothing.
Eigen::MatrixXd SurfaceNet::allowed(int wave) const {
  const int m = space_.counts[1];
  if (space_.form == SurfaceForm::torus) return Eigen::MatrixXd::Identity(m, m);
  // The mean of the column next to a pole is the pole, one wave turns around it, others begin one
  // column later.
  const int first = wave == 1 ? 1 : wave == 0 ? 1 : 2;
  Eigen::MatrixXd t = Eigen::MatrixXd::Zero(m, m - 2 * first);
  for (int k = 0; k < m - 2 * first; ++k) t(first + k, k) = 1;
  if (wave == 0) t(0, 0) = t(m - 1, m - 3) = 1;
  return t;
}

// K = Σ products of circulant and dense matrices becomes one dense m × m matrix for each wave
// number: n/2 + 1 factors of O(m³) in place of one of (n m)³, or of its band. Bend on a sphere is
// K₁ M⁻¹ K₁, the square of the discrete Laplacian: second derivatives in u and v would be infinite
// at poles although the surface is smooth there.
Expected<void> SurfaceNet::make_modes(double alpha, double beta) {
  for (const int wave : {0, 1, 2}) allowed_.push_back(allowed(wave));
  const auto around = gramians(axes_[0].knots);
  if (!around) return std::unexpected(around.error());
  const int n = space_.counts[0], m = space_.counts[1];
  const Eigen::MatrixXd u0 = folded(around->g00, n), u1 = folded(around->g11, n),
                        u2 = folded(around->g22, n);
  const bool torus = space_.form == SurfaceForm::torus;
  Eigen::MatrixXd v0, v1, v2, across;  // mass, slopes along v, second derivatives, slopes along u
  if (torus) {
    const auto along = gramians(axes_[1].knots);
    if (!along) return std::unexpected(along.error());
    v0 = across = folded(along->g00, m);
    v1 = folded(along->g11, m);
    v2 = folded(along->g22, m);
  } else {
    const double turn = pi / space_.lengths[1];
    v0 = weighted_gramian(axes_[1].knots, 0, [turn](double v) { return std::sin(turn * v); });
    v1 = weighted_gramian(axes_[1].knots, 1, [turn](double v) { return std::sin(turn * v); });
    across =
        weighted_gramian(axes_[1].knots, 0, [turn](double v) { return 1 / std::sin(turn * v); });
  }
  for (int k = 0; 2 * k <= n; ++k) {
    const Eigen::MatrixXd& t = allowed_of(k);
    const double g0 = symbol(u0, k), g1 = k == 0 ? 0 : symbol(u1, k),
                 g2 = k == 0 ? 0 : symbol(u2, k);
    Mode mode;
    mode.mass = t.transpose() * (g0 * v0) * t;
    const Eigen::MatrixXd stretch = t.transpose() * (g0 * v1 + g1 * across) * t;
    Eigen::MatrixXd bend;
    if (torus) {
      bend = g2 * v0 + 2 * g1 * v1 + g0 * v2;
    } else {
      const auto mass = detail::DenseCholesky::factor(mode.mass);
      if (!mass) return std::unexpected(mass.error());
      bend = stretch * mass->solve(stretch);
    }
    mode.internal = alpha * stretch + beta * (bend + bend.transpose()) / 2;
    modes_.push_back(std::move(mode));
  }
  return {};
}

Expected<void> SurfaceNet::factor(double gamma, bool mass_alone) {
  factors_.clear();
  for (const Mode& mode : modes_) {
    const Eigen::MatrixXd sum = gamma * mode.mass + (mass_alone ? 0 : 1) * mode.internal;
    auto factored = detail::DenseCholesky::factor(sum);
    if (!factored) {
      return numerical_error("the matrix of the active surface is not positive definite", "",
                             "use a larger gamma");
    }
    factors_.push_back(std::move(*factored));
  }
  return {};
}

// Rows of `waves` hold the m × 3 coefficients of one column of the Fourier basis.
template <class Work>
Points SurfaceNet::by_modes(const Points& right, const Work& work) const {
  const int n = space_.counts[0], m = space_.counts[1];
  Dense waves = waves_.transpose() * Eigen::Map<const Dense>(right.data(), n, 3 * m);
  for (int r = 0; r < n; ++r) {
    const int wave = wave_[static_cast<std::size_t>(r)];
    const Eigen::MatrixXd& t = allowed_of(wave);
    Eigen::Map<Points> values(waves.data() + static_cast<Eigen::Index>(r) * 3 * m, m, 3);
    values = work(static_cast<std::size_t>(wave), t, values);
  }
  Points result(n * m, 3);
  Eigen::Map<Dense>(result.data(), n, 3 * m) = waves_ * waves;
  return result;
}

Points SurfaceNet::solve(const Points& right) const {
  return by_modes(right, [this](std::size_t wave, const Eigen::MatrixXd& t, const auto& values) {
    return Points(t * factors_[wave].solve(Eigen::MatrixXd(t.transpose() * values)));
  });
}

Points SurfaceNet::internal(const Points& c) const {
  // The coefficients of allowed functions are those of the control points between the first and the
  // last of them; the forces are put there, too, where `solve` finds them.
  return by_modes(c, [this](std::size_t wave, const Eigen::MatrixXd& t, const auto& values) {
    const auto first = (t.rows() - t.cols()) / 2;
    Points forces = Points::Zero(t.rows(), 3);
    forces.middleRows(first, t.cols()) = modes_[wave].internal * values.middleRows(first, t.cols());
    return forces;
  });
}

// Sum factorisation: first along u for all columns, then along v for each Gauss point of u.
Points SurfaceNet::at_gauss(const Points& c, int du, int dv) const {
  const int n = space_.counts[0], m = space_.counts[1];
  const Dense &u = axes_[0].functions[static_cast<std::size_t>(du)],
              &v = axes_[1].functions[static_cast<std::size_t>(dv)];
  const Dense lines = u * Eigen::Map<const Dense>(c.data(), n, 3 * m);
  Points result(u.rows() * v.rows(), 3);
  for (Eigen::Index q = 0; q < u.rows(); ++q) {
    result.middleRows(q * v.rows(), v.rows()).noalias() =
        v * Eigen::Map<const Points>(lines.data() + q * 3 * m, m, 3);
  }
  return result;
}

Points SurfaceNet::load(const Points& f) const {
  const int n = space_.counts[0], m = space_.counts[1];
  const Dense &u = axes_[0].functions[0], &v = axes_[1].functions[0];
  const Dense lines = u.transpose() * Eigen::Map<const Dense>(f.data(), u.rows(), 3 * v.rows());
  Points result(n * m, 3);
  for (int i = 0; i < n; ++i) {
    result.middleRows(i * m, m).noalias() =
        v.transpose() * Eigen::Map<const Points>(lines.data() + i * 3 * v.rows(), v.rows(), 3);
  }
  return result;
}

Eigen::VectorXd SurfaceNet::functions_at(double u, double v) const {
  const int p = space_.degree, m = space_.counts[1];
  Eigen::VectorXd all = Eigen::VectorXd::Zero(space_.unknowns());
  std::vector<double> values[2];
  int first[2];
  for (std::size_t d = 0; d < 2; ++d) {
    const KnotVector& knots = axes_[d].knots;
    const double at = std::clamp(d == 0 ? u : v, knots.domain().lower, knots.domain().upper);
    const int span = knots.find_span(at);
    values[d].resize(static_cast<std::size_t>(p + 1));
    basis_values(knots, span, at, values[d].data());
    first[d] = span - p;
  }
  for (int r = 0; r <= p; ++r) {
    for (int s = 0; s <= p; ++s) {
      all[(first[0] + r) % space_.counts[0] * m + (first[1] + s) % m] +=
          values[0][static_cast<std::size_t>(r)] * values[1][static_cast<std::size_t>(s)];
    }
  }
  return all;
}

// Of the column at the pole its mean is left; of the next one wave 1, about the pole. Moves obey
// these conditions already, except where their length was limited, which is not linear.
void SurfaceNet::keep_poles(Points& c) const {
  if (space_.form == SurfaceForm::torus) return;
  const int n = space_.counts[0], m = space_.counts[1];
  for (const auto& [column, next] : {std::pair{0, 1}, std::pair{m - 1, m - 2}}) {
    Eigen::RowVector3d pole = Eigen::RowVector3d::Zero(), even = pole, odd = pole;
    for (int i = 0; i < n; ++i) {
      pole += c.row(i * m + column) / n;
      even += 2.0 / n * std::cos(2 * pi * i / n) * c.row(i * m + next);
      odd += 2.0 / n * std::sin(2 * pi * i / n) * c.row(i * m + next);
    }
    for (int i = 0; i < n; ++i) {
      c.row(i * m + column) = pole;
      c.row(i * m + next) = pole + std::cos(2 * pi * i / n) * even + std::sin(2 * pi * i / n) * odd;
    }
  }
}

Expected<ClosedSurface> SurfaceNet::surface(const Points& c) const {
  const int rows = axes_[0].knots.count(), columns = axes_[1].knots.count();
  Points all(rows * columns, 3);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      all.row(i * columns + j) =
          c.row(i % space_.counts[0] * space_.counts[1] + j % space_.counts[1]);
    }
  }
  auto made = Surface::create({axes_[0].knots, axes_[1].knots}, std::move(all));
  if (!made) return std::unexpected(made.error());
  return ClosedSurface{std::move(*made), space_.form};
}

Points SurfaceNet::unknowns_of(const Surface& surface) const {
  const int columns = axes_[1].knots.count(), m = space_.counts[1];
  Points c(space_.unknowns(), 3);
  for (int i = 0; i < space_.counts[0]; ++i) {
    for (int j = 0; j < m; ++j) c.row(i * m + j) = surface.control_points().row(i * columns + j);
  }
  return c;
}

Expected<Points> projected(const SurfaceSpace& space, const Points& places) {
  auto net = SurfaceNet::create(space, 0, 0);
  if (!net) return std::unexpected(net.error());
  if (auto status = net->factor(1, true); !status) return std::unexpected(status.error());
  return net->solve(net->load(net->weights_on_domain().asDiagonal() * places));
}

Expected<Points> projected(const SurfaceSpace& space, const ClosedSurface& snake) {
  const auto net = SurfaceNet::create(space, 0, 0);
  if (!net) return std::unexpected(net.error());
  const auto places = evaluate_grid(snake.surface, {std::span(net->quadrature(0).parameters),
                                                    std::span(net->quadrature(1).parameters)});
  if (!places) return std::unexpected(places.error());
  return projected(space, places->points());
}

}  // namespace knead
