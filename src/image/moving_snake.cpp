#include "moving_snake.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "region_term.hpp"

namespace knead {
namespace {

constexpr double most_uneven = 2;

}  // namespace

// Area ½ ∮ x dy − y dx and intensity ∮ J dy (Green), J the sums to the left. Signed: which side is
// inside follows from the sign, not from the order of points.
Inside MovingSnake::inside(const ImagePotential& image) const {
  Inside sum;
  if (!settings.closed) return sum;
  const Points v = net.at_gauss(c, 0), t = net.at_gauss(c, 1);
  for (Eigen::Index q = 0; q < v.rows(); ++q) {
    const double w = net.quadrature().weights[static_cast<std::size_t>(q)];
    sum.area += w * (v(q, 0) * t(q, 1) - v(q, 1) * t(q, 0)) / 2;
    if (image.settings().region != 0)
      sum.intensity += w * t(q, 1) * image.intensity_to_the_left(v(q, 0), v(q, 1));
  }
  return sum;
}

// v' of clamped knots: p (c₁ − c₀) over the length of the first span, and the same at the end.
std::array<Eigen::RowVector3d, 2> MovingSnake::end_tangents() const {
  const KnotVector& knots = net.knots();
  const int p = knots.degree();
  const auto n = c.rows();
  const double first = knots[p + 1] - knots[p],
               final = knots[knots.count()] - knots[knots.count() - 1];
  return {p * (c.row(1) - c.row(0)) / first, p * (c.row(n - 1) - c.row(n - 2)) / final};
}

// Stretch draws a free end inwards by α |v'|. A force as large outwards, that of the start,
// balances it: lengths are then the image's affair, and the end still turns with its tangent.
std::array<Eigen::RowVector3d, 2> MovingSnake::pulls() const {
  std::array<Eigen::RowVector3d, 2> pulls = {Eigen::RowVector3d::Zero(),
                                             Eigen::RowVector3d::Zero()};
  if (end_pull[0] == 0 && end_pull[1] == 0) return pulls;
  const auto tangents = end_tangents();
  for (std::size_t e = 0; e < 2; ++e)
    pulls[e] = (e == 0 ? -1 : 1) * end_pull[e] * tangents[e].normalized();
  return pulls;
}

bool MovingSnake::uneven() const {
  const Eigen::VectorXd speed = net.at_gauss(c, 1).rowwise().norm();
  return speed.maxCoeff() > most_uneven * speed.minCoeff();
}

// Forces along the normal leave the parametrisation alone, and control points gather where the
// contour has shrunk. Fitting the same contour over its chord length moves it within itself only,
// to the accuracy of the net.
Expected<void> MovingSnake::spread() {
  const auto curve = net.curve(c);
  if (!curve) return std::unexpected(curve.error());
  auto even = fitted(polyline({*curve, true}, 8), net.breaks(), settings);
  if (!even) return std::unexpected(even.error());
  c = std::move(*even);
  return {};
}

// γ v is the inertial part of the right side (γ M c as a load), so that one load vector serves the
// whole step. Pressure acts along (y', −x'), not along its unit vector: the same force per length
// of the contour for any parametrisation, as ds = |v'| du.
Points MovingSnake::forces(const ImagePotential& image, double side,
                           const std::optional<Sides>& sides) const {
  const Points v = net.at_gauss(c, 0), t = net.at_gauss(c, 1);
  Points f = viscosity() * v;
  for (Eigen::Index q = 0; q < v.rows(); ++q) {
    const double x = v(q, 0), y = v(q, 1);
    const auto external = image.force(x, y);
    Eigen::Vector2d force(external[0], external[1]);
    double pressure = settings.balloon;
    if (sides) {
      const bool relative = image.settings().relative_region;
      pressure += image.settings().region * region_pressure(*sides, static_cast<std::size_t>(q),
                                                            image.intensity(x, y), relative);
    }
    if (settings.closed) force += side * pressure * Eigen::Vector2d(t(q, 1), -t(q, 0));
    for (const SnakeVolcano& volcano : settings.volcanoes) {
      const Eigen::Vector2d away(x - volcano.at[0], y - volcano.at[1]);
      const double distance = away.norm(),
                   share = volcano.radius / std::max(distance, volcano.radius);
      if (distance > 0) force += volcano.strength * share * share * away / distance;
    }
    f.row(q).head<2>() += force.transpose();
  }
  return f;
}

// Semi-implicit Euler of Kass, Witkin and Terzopoulos (1988): (γ M + K) c⁺ = γ M c + F(c), stiff
// terms implicit, the image explicit. K alone allows any step; F allows about a pixel, as an image
// says nothing of what is further, hence the limit on moves.
Expected<void> MovingSnake::step(const ImagePotential& image, double side,
                                 const std::optional<Sides>& sides) {
  const Points next = net.solve(forces(image, side, sides), c, pulls());
  const Points move = limited(next - c, settings.max_move);
  c += move;
  ++iterations;
  motion.went_to(c, settings.motion);
  if (motion.steadied(move)) {
    if (auto status = net.set_viscosity(viscosity()); !status) return status;
  }
  const bool normal = image.settings().region != 0 || settings.balloon != 0;
  const bool may =
      normal && settings.closed && settings.springs.empty() && settings.redistribute > 0;
  const bool spreads =
      may && !motion.resting() && iterations % settings.redistribute == 0 && uneven();
  return spreads ? spread() : Expected<void>{};
}

// The pull on free ends is that of the start for the whole run: one that followed |v'| would grow
// with the snake and never find a length.
Expected<MovingSnake> snake_on(const Curve& start, const SnakeSettings& settings) {
  if (auto checked = check_settings(settings); !checked) return std::unexpected(checked.error());
  auto net = SnakeNet::create(breaks_of(start), settings);
  if (!net) return std::unexpected(net.error());
  if (!std::ranges::equal(net->knots().knots(), start.knots()[0].knots())) {
    return input_error("its knots are not those of a snake", "", "use curve_through");
  }
  Points c = net->unknowns_of(start);
  MovingSnake snake{settings, std::move(*net), std::move(c)};
  if (!settings.closed && !settings.hold_ends && settings.end_tension > 0) {
    const auto tangents = snake.end_tangents();
    for (std::size_t e = 0; e < 2; ++e) {
      snake.end_pull[e] = settings.end_tension * settings.alpha * tangents[e].norm();
    }
  }
  return snake;
}

// Where the spans only grow in number the space contains the old one, and the contour stays to
// rounding.
Expected<MovingSnake> moved_to(const MovingSnake& snake, std::span<const double> breaks) {
  const auto curve = snake.net.curve(snake.c);
  if (!curve) return std::unexpected(curve.error());
  auto c = projected(*curve, breaks, snake.settings);
  if (!c) return std::unexpected(c.error());
  auto net = SnakeNet::create(breaks, snake.settings);
  if (!net) return std::unexpected(net.error());
  MovingSnake moved{snake.settings, std::move(*net), std::move(*c), snake.iterations};
  moved.end_pull = snake.end_pull;
  return moved;
}

std::vector<double> halved(const std::vector<double>& breaks, const std::vector<bool>& marked) {
  std::vector<double> result;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    result.push_back(breaks[k]);
    if (marked[k]) result.push_back(std::midpoint(breaks[k], breaks[k + 1]));
  }
  result.push_back(breaks.back());
  return result;
}

// Both at the Gauss points of the coarse net, as parameters are the same: the distance across the
// coarse contour, as points may slide along it without moving it.
std::vector<bool> spans_that_differ(const MovingSnake& coarse, const MovingSnake& fine) {
  const auto& at = coarse.net.quadrature().parameters;
  std::vector<bool> marked(coarse.net.breaks().size() - 1, false);
  const auto basis = tabulate_basis(fine.net.knots(), at, 0);
  if (!basis) return marked;
  const Points v = coarse.net.at_gauss(coarse.c, 0), t = coarse.net.at_gauss(coarse.c, 1);
  const auto per_span = static_cast<std::size_t>(coarse.net.points_per_span());
  for (std::size_t q = 0; q < at.size(); ++q) {
    Eigen::RowVector3d there = Eigen::RowVector3d::Zero();
    const int first = basis->first[q];
    for (int r = 0; r <= basis->degree; ++r) {
      there +=
          basis->row(static_cast<int>(q), 0)[r] * fine.c.row((first + r) % fine.net.unknowns());
    }
    const auto row = static_cast<Eigen::Index>(q);
    const Eigen::RowVector2d d = (there - v.row(row)).head<2>(), along = t.row(row).head<2>();
    const double across =
        std::abs(d[0] * along[1] - d[1] * along[0]) / std::max(along.norm(), 1e-300);
    if (across > coarse.settings.refine) marked[q / per_span] = true;
  }
  return marked;
}

}  // namespace knead
