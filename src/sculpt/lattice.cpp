#include "lattice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/counts.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {

constexpr std::int64_t max_lattice_size = 1000000;

Expected<Lattice> Lattice::create(const BoundingBox& box, double margin,
                                  const std::array<int, 3>& degree, const std::array<int, 3>& net) {
  if (!box.lower.allFinite() || !box.upper.allFinite() || !(box.diagonal() > 0)) {
    return input_error("the box has no size", "lattice");
  }
  if (!(std::isfinite(margin) && margin > 0)) {
    return input_error(fmt::format("{} is not a margin", margin), "margin", "use a number > 0");
  }
  return between(box.lower.array() - margin * box.diagonal(),
                 box.upper.array() + margin * box.diagonal(), degree, net);
}

// Control points at Greville abscissae reproduce x = lower + u ∘ (upper − lower) (linear
// precision): the volume at rest is the identity of its box.
Expected<Lattice> Lattice::between(const Point& lower, const Point& upper,
                                   const std::array<int, 3>& degree,
                                   const std::array<int, 3>& net) {
  if (!lower.allFinite() || !upper.allFinite() || !((upper - lower).array() > 0).all())
    return input_error("the box has no size", "upper", "give a corner above the other in x, y, z");
  if (std::ranges::all_of(net, [](int n) { return n > 0; }) && !product_of(net, max_lattice_size)) {
    return input_error("the lattice has more than a million control points", "net", "use fewer");
  }
  std::vector<KnotVector> knots;
  for (std::size_t d = 0; d < 3; ++d) {
    auto made = KnotVector::clamped_uniform(degree[d], net[d]);
    if (!made) return std::unexpected(made.error().within("net"));
    knots.push_back(std::move(*made));
  }
  const Eigen::Index size = static_cast<Eigen::Index>(net[0]) * net[1] * net[2];
  Points points(size, 3);
  Eigen::Index row = 0;
  for (int i = 0; i < net[0]; ++i) {
    for (int j = 0; j < net[1]; ++j) {
      for (int k = 0; k < net[2]; ++k, ++row) {
        const Point u(knots[0].greville(i), knots[1].greville(j), knots[2].greville(k));
        points.row(row) = (lower + u.cwiseProduct(upper - lower)).transpose();
      }
    }
  }
  auto rest = Volume::create({knots[0], knots[1], knots[2]}, std::move(points));
  if (!rest) return std::unexpected(rest.error());
  return Lattice(std::move(*rest), lower, upper - lower);
}

// x + D(u(x)) and not V(u(x)): V at rest reproduces x only to rounding, D = 0 exactly.
Expected<Points> Lattice::deformed(const Points& points, const Points& control_points) const {
  const auto displacement = rest_.with_control_points(control_points - rest_.control_points());
  if (!displacement) return std::unexpected(displacement.error());
  Parameters<3> parameters(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Point u = (points.row(i).transpose() - lower_).cwiseQuotient(size_);
    if (!((u.array() >= 0).all() && (u.array() <= 1).all())) {
      return input_error("the point is outside of the lattice", fmt::format("point {}", i),
                         "make the lattice larger");
    }
    parameters.row(i) = u.transpose();
  }
  const auto moved = evaluate<3>(*displacement, parameters);
  if (!moved) return std::unexpected(moved.error());
  return Points(points + moved->points());
}

Expected<std::function<Expected<Point>(const Point&)>> Lattice::displacement(
    const Points& control_points) const {
  auto volume = rest_.with_control_points(control_points - rest_.control_points());
  if (!volume) return std::unexpected(volume.error());
  return [volume = *std::move(volume), lower = lower_,
          size = size_](const Point& x) -> Expected<Point> {
    const Point u = (x - lower).cwiseQuotient(size);
    if (!((u.array() >= 0).all() && (u.array() <= 1).all())) return Point(Point::Zero());
    return evaluate_point<3>(volume, {u[0], u[1], u[2]});
  };
}

Expected<Points> Lattice::moved(Points control_points, std::span<const int> which,
                                const std::array<double, 3>& by) const {
  const int count = rest_.size();
  if (which.empty())
    return input_error("no control points are named", "which",
                       "give their numbers, counted from 0");
  const Eigen::RowVector3d move(by.data());
  if (!move.allFinite()) return input_error("the move is not finite", "by", "give three numbers");
  std::vector<bool> moved(static_cast<std::size_t>(count), false);
  for (std::size_t k = 0; k < which.size(); ++k) {
    const int number = which[k];
    if (number < 0 || number >= count) {
      return input_error(fmt::format("the block has no control point {}", number),
                         fmt::format("which[{}]", k),
                         fmt::format("use numbers from 0 to {}", count - 1));
    }
    if (!moved[static_cast<std::size_t>(number)]) control_points.row(number) += move;
    moved[static_cast<std::size_t>(number)] = true;
  }
  return control_points;
}

Expected<std::vector<bool>> Lattice::faces(std::span<const std::string> names, int rows) const {
  static constexpr const char* known[] = {"u0", "u1", "v0", "v1", "w0", "w1"};
  std::vector<bool> result(static_cast<std::size_t>(rest_.size()), false);
  const std::array<int, 3> net = rest_.net();
  for (const std::string& name : names) {
    const auto* const found = std::ranges::find(known, name);
    if (found == std::end(known)) {
      return input_error(fmt::format("\"{}\" is not a face", name), "hold",
                         "the faces are: u0, u1, v0, v1, w0, w1");
    }
    const auto face = static_cast<std::size_t>(found - known), d = face / 2;
    std::size_t row = 0;
    std::array<int, 3> i;
    for (i[0] = 0; i[0] < net[0]; ++i[0]) {
      for (i[1] = 0; i[1] < net[1]; ++i[1]) {
        for (i[2] = 0; i[2] < net[2]; ++i[2], ++row) {
          const int depth = face % 2 == 0 ? i[d] : net[d] - 1 - i[d];
          if (depth < rows) result[row] = true;
        }
      }
    }
  }
  return result;
}

}  // namespace knead
