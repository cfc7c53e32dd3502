#include "shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "knead/base/error_code.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/spline_refinement.hpp"

namespace knead {
namespace {

/// p + 3 places per span, ends included.
/// A displacement that is a polynomial of degree p in a span is described by p + 1 values; two more
/// places come near to the maximum of its norm, which is shown and decides nothing.
std::vector<double> samples_of(const KnotVector& knots) {
  std::vector<double> places;
  const int count = knots.degree() + 2;
  for (const int span : knots.spans()) {
    for (int k = 0; k < count; ++k)
      places.push_back(knots[span] + (knots[span + 1] - knots[span]) * k / count);
  }
  places.push_back(knots.domain().upper);
  return places;
}

template <int D>
double largest_norm_at_samples(const Spline<D>& field) {
  std::array<std::vector<double>, D> places;
  std::array<std::span<const double>, D> at;
  for (std::size_t d = 0; d < D; ++d) at[d] = places[d] = samples_of(field.knots()[d]);
  const auto values = evaluate_grid<D>(field, at);
  return values ? values->points().rowwise().norm().maxCoeff()
                : std::numeric_limits<double>::quiet_NaN();
}

// One knot at the middle of every span in every direction: exact, and 2^D times the control points.
template <int D>
Expected<std::shared_ptr<const Spline<D>>> halved(const Spline<D>& spline) {
  std::array<Interval, D> all;
  for (std::size_t d = 0; d < D; ++d) all[d] = spline.knots()[d].domain();
  auto finer = refine_region<D>(spline, all);
  if (!finer) return std::unexpected(finer.error());
  return std::make_shared<const Spline<D>>(*std::move(finer));
}

// As in `change_net` of surfaces: every shape is refined once however many places share it, and the
// velocity with them.
template <int D>
Expected<void> halve(SceneShape<D>& s) {
  if (!s.pins.empty()) {
    return input_error("control points are pinned by their numbers, which change with the net",
                       s.id, "release them first, or pin points (at) instead",
                       {ErrorCode::pins_by_number, {{"surface", s.id}}});
  }
  if (s.velocity.rows() > 0) {  // a spline on the present basis, as the shapes are
    auto field = s.current->with_control_points(s.velocity);
    if (!field) return std::unexpected(field.error());
    const auto finer = halved<D>(*field);
    if (!finer) return std::unexpected(finer.error());
    s.velocity = (*finer)->control_points();
  }
  std::vector<std::shared_ptr<const Spline<D>>*> shapes = {&s.opened, &s.reference, &s.rest,
                                                           &s.current};
  for (KeptConstraintOf<D>& kept : s.constraints) shapes.push_back(&kept.where);
  std::vector<std::pair<std::shared_ptr<const Spline<D>>, std::shared_ptr<const Spline<D>>>> made;
  for (auto* shape : shapes) {
    const auto known = std::ranges::find(made, *shape, [](const auto& pair) { return pair.first; });
    if (known != made.end()) {
      *shape = known->second;
      continue;
    }
    auto finer = halved<D>(**shape);
    if (!finer) return std::unexpected(finer.error());
    made.emplace_back(*shape, *finer);
    *shape = *std::move(finer);
  }
  return {};
}

}  // namespace

const char* kind_of(int directions) {
  return directions == 1 ? "curve" : directions == 2 ? "surface" : "volume";
}

const char* kind_of(const SceneBody& body) {
  return std::visit([]<int D>(const SceneShape<D>&) { return kind_of(D); }, body);
}

const ShapeCommon& common_of(const SceneBody& body) {
  return std::visit([](const auto& shape) -> const ShapeCommon& { return shape; }, body);
}

std::vector<int> degrees_of(const SceneBody& body) {
  return std::visit(
      [](const auto& shape) {
        std::vector<int> degrees;
        for (const KnotVector& knots : shape.current->knots()) degrees.push_back(knots.degree());
        return degrees;
      },
      body);
}

std::vector<int> net_of(const SceneBody& body) {
  return std::visit(
      [](const auto& shapes) {
        const auto net = shapes.current->net();
        return std::vector<int>(net.begin(), net.end());
      },
      body);
}

const Points& control_points_of(const SceneBody& body) {
  return std::visit(
      [](const auto& shapes) -> const Points& { return shapes.current->control_points(); }, body);
}

double diagonal_of(const SceneBody& body) {
  return std::visit(
      [](const auto& shapes) {
        const Points& points = shapes.reference->control_points();
        return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
      },
      body);
}

double largest_displacement(const SceneBody& body) {
  return std::visit(
      [](const auto& shapes) {
        if (shapes.current == shapes.opened) return 0.0;
        const auto field = shapes.current->with_control_points(shapes.current->control_points() -
                                                               shapes.opened->control_points());
        return field ? largest_norm_at_samples(*field) : std::numeric_limits<double>::quiet_NaN();
      },
      body);
}

int moved_control_points(const SceneBody& body) {
  return std::visit(
      [](const auto& shapes) {
        const Points &opened = shapes.opened->control_points(),
                     &current = shapes.current->control_points();
        int moved = 0;
        for (Eigen::Index i = 0; i < current.rows(); ++i) {
          moved +=
              std::memcmp(opened.row(i).data(), current.row(i).data(), 3 * sizeof(double)) != 0;
        }
        return moved;
      },
      body);
}

Expected<void> halve_spans(SceneBody& body) {
  return std::visit([](auto& shape) { return halve(shape); }, body);
}

Expected<std::vector<Surface>> sides_of(const Volume& volume) {
  const auto net = volume.net();
  std::vector<Surface> sides;
  for (int direction = 0; direction < 3; ++direction) {
    const KnotVector& across = volume.knots(direction);
    if (!across.clamped()) {
      return input_error("a volume whose ends are not clamped has no control points on its sides",
                         fmt::format("direction {}", "uvw"[direction]),
                         "clamp its knots: repeat the end knots p + 1 times");
    }
    for (const bool upper : {false, true}) {
      // The other directions in cyclic order: their tangents' cross product points along the third;
      // swapped at the lower end, so that it points outward.
      int first = (direction + 1) % 3, second = (direction + 2) % 3;
      if (!upper) std::swap(first, second);
      const int m = net[static_cast<std::size_t>(first)], n = net[static_cast<std::size_t>(second)];
      Points points(static_cast<Eigen::Index>(m) * n, 3);
      std::vector<double> weights;
      std::array<int, 3> at{};
      at[static_cast<std::size_t>(direction)] = upper ? across.count() - 1 : 0;
      for (int i = 0; i < m; ++i) {
        for (int j = 0; j < n; ++j) {
          at[static_cast<std::size_t>(first)] = i;
          at[static_cast<std::size_t>(second)] = j;
          const int row = (at[0] * net[1] + at[1]) * net[2] + at[2];
          points.row(i * n + j) = volume.control_points().row(row);
          if (volume.rational()) weights.push_back(volume.weights()[static_cast<std::size_t>(row)]);
        }
      }
      auto side = Surface::create({volume.knots(first), volume.knots(second)}, std::move(points),
                                  std::move(weights));
      if (!side) return std::unexpected(side.error());
      sides.push_back(*std::move(side));
    }
  }
  return sides;
}

}  // namespace knead
