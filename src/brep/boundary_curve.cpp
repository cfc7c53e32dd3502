#include "boundary_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "knead/brep/model.hpp"
#include "knead/spline/basis.hpp"

namespace knead::brep {

Expected<Curve> boundary_curve(const Surface& surface, int direction, int end) {
  const Interval domain = surface.knots(direction).domain();
  return end == 0 ? isocurve(surface, direction, domain.lower, Side::right)
                  : isocurve(surface, direction, domain.upper, Side::left);
}

// S(u, v) at fixed u is the curve with the control points Σ_i N_i(u) w_ij P_ij / w_j and the
// weights w_j = Σ_i N_i(u) w_ij, on the other direction's knots: exact, in O(n (p + 1)). At a knot
// of multiplicity p + 1 the surface may jump; `side` says which limit is meant.
Expected<Curve> isocurve(const Surface& surface, int direction, double at, Side side) {
  const auto& across = surface.knots(direction);
  const auto& along = surface.knots(1 - direction);
  const int span = across.find_span(at, side);
  std::array<double, max_degree + 1> basis{};
  basis_values(across, span, at, basis.data());

  const auto net = surface.net();
  const Eigen::Index step_across = direction == 0 ? net[1] : 1;
  const Eigen::Index step_along = direction == 0 ? 1 : net[1];
  Points points = Points::Zero(along.count(), 3);
  std::vector<double> weights(surface.rational() ? static_cast<std::size_t>(along.count()) : 0,
                              0.0);
  for (int j = 0; j < along.count(); ++j) {
    double denominator = 0;
    for (int r = 0; r <= across.degree(); ++r) {
      const Eigen::Index k = (span - across.degree() + r) * step_across + j * step_along;
      const double factor =
          basis[static_cast<std::size_t>(r)] *
          (surface.rational() ? surface.weights()[static_cast<std::size_t>(k)] : 1.0);
      points.row(j) += factor * surface.control_points().row(k);
      denominator += factor;
    }
    if (!surface.rational()) continue;
    weights[static_cast<std::size_t>(j)] = denominator;
    // A weight of 0 is legal, as a point at infinity or one that a file repeats; its place means
    // nothing.
    points.row(j) = denominator == 0 ? Points::RowXpr::PlainObject::Zero().eval()
                                     : (points.row(j) / denominator).eval();
  }
  return Curve::create({along}, std::move(points), std::move(weights));
}

// t → t_first + t_last − t, so that both directions have the same domain.
Curve turned(const Curve& curve) {
  const auto knot_values = curve.knots(0).knots();
  const double sum = knot_values.front() + knot_values.back();
  std::vector<double> knots(knot_values.rbegin(), knot_values.rend()), weights;
  for (double& t : knots) t = sum - t;
  if (curve.rational()) weights.assign(curve.weights().rbegin(), curve.weights().rend());
  return *Curve::create({*KnotVector::create(curve.knots(0).degree(), std::move(knots))},
                        Points(curve.control_points().colwise().reverse()), std::move(weights));
}

double net_diagonal(const Points& points) {
  return points.rows() == 0 ? 0.0
                            : (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
}

// Closed: both boundary curves of a direction coincide, compared by their control points and
// weights, since both are on the same knots and B-splines are independent there. 1e-9 of the size
// is far below any file's tolerance and far above the rounding of an evaluation at the ends of
// unclamped knots.
std::array<bool, 2> closed_directions(const Surface& surface) {
  constexpr double relative = 1e-9;
  const double tolerance = relative * net_diagonal(surface.control_points());
  std::array<bool, 2> closed = {false, false};
  for (int direction = 0; direction < 2; ++direction) {
    const auto first = boundary_curve(surface, direction, 0);
    const auto last = boundary_curve(surface, direction, 1);
    if (!first || !last) continue;
    bool same =
        (first->control_points() - last->control_points()).rowwise().norm().maxCoeff() <= tolerance;
    // Weights with a common factor describe the same curve.
    if (surface.rational()) {
      const auto a = first->weights();
      const auto b = last->weights();
      const auto largest = std::max_element(
          a.begin(), a.end(), [](double x, double y) { return std::abs(x) < std::abs(y); });
      const double w_a = *largest;
      const double w_b = b[static_cast<std::size_t>(largest - a.begin())];
      for (std::size_t k = 0; k < a.size(); ++k)
        same = same && std::abs(a[k] / w_a - b[k] / w_b) <= relative;
    }
    // A net collapsed along this whole direction has no interior to close around.
    const auto net = surface.net();
    const Eigen::Index step = direction == 0 ? net[1] : 1;
    bool collapsed = true;
    for (Eigen::Index k = 0; k < surface.size() && collapsed; ++k) {
      const auto position = direction == 0 ? k / net[1] : k % net[1];
      if (position == 0) continue;
      collapsed =
          (surface.control_points().row(k) - surface.control_points().row(k - step)).norm() <=
          tolerance;
    }
    closed[static_cast<std::size_t>(direction)] = same && !collapsed;
  }
  return closed;
}

}  // namespace knead::brep
