#include "knead/scene/body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "knead/spline/evaluate.hpp"
#include "knead/spline/spline_refinement.hpp"

namespace knead {
namespace {

/// p + 3 places per span, ends included.
std::vector<double> samples_of(const KnotVector& knots) {
  std::vector<double> places;
  const int count = knots.degree() + 2;
  for (const int span : knots.spans()) {
    for (int k = 0; k < count; ++k) places.push_back(knots[span] + (knots[span + 1] - knots[span]) * k / count);
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
  return values ? values->points().rowwise().norm().maxCoeff() : std::numeric_limits<double>::quiet_NaN();
}

template <int D>
Expected<std::shared_ptr<const Spline<D>>> halved(const Spline<D>& spline) {
  std::array<Interval, D> all;
  for (std::size_t d = 0; d < D; ++d) all[d] = spline.knots()[d].domain();
  auto finer = refine_region<D>(spline, all);
  if (!finer) return std::unexpected(finer.error());
  return std::make_shared<const Spline<D>>(*std::move(finer));
}

template <int D>
Expected<void> halve(SceneBody& body, BodyShapes<D>& shapes) {
  const auto net = shapes.current;
  const auto points_on_finer = [&](Points& points) -> Expected<void> {
    auto field = net->with_control_points(points);
    if (!field) return std::unexpected(field.error());
    const auto finer = halved<D>(*field);
    if (!finer) return std::unexpected(finer.error());
    points = (*finer)->control_points();
    return {};
  };
  // The velocity and what is held are splines on the present basis, as the shapes are.
  if (body.velocity.rows() > 0) {
    if (auto done = points_on_finer(body.velocity); !done) return done;
  }
  for (KeptBodyHold& kept : body.holds) {
    if (auto done = points_on_finer(kept.where); !done) return done;
  }
  std::vector<std::pair<const Spline<D>*, std::shared_ptr<const Spline<D>>>> made;
  for (auto* shape : {&shapes.opened, &shapes.reference, &shapes.rest, &shapes.current}) {
    const auto known = std::ranges::find(made, shape->get(), [](const auto& pair) { return pair.first; });
    if (known != made.end()) {
      *shape = known->second;
      continue;
    }
    auto finer = halved<D>(**shape);
    if (!finer) return std::unexpected(finer.error());
    made.emplace_back(shape->get(), *finer);
    *shape = *std::move(finer);
  }
  return {};
}

}  // namespace

const char* kind_of(const SceneBody& body) { return body.is_curve() ? "curve" : "volume"; }

std::vector<int> degrees_of(const SceneBody& body) {
  return std::visit(
      [](const auto& shapes) {
        std::vector<int> degrees;
        for (const KnotVector& knots : shapes.current->knots()) degrees.push_back(knots.degree());
        return degrees;
      },
      body.shapes);
}

std::vector<int> net_of(const SceneBody& body) {
  return std::visit(
      [](const auto& shapes) {
        const auto net = shapes.current->net();
        return std::vector<int>(net.begin(), net.end());
      },
      body.shapes);
}

const Points& control_points_of(const SceneBody& body) {
  return std::visit([](const auto& shapes) -> const Points& { return shapes.current->control_points(); }, body.shapes);
}

double diagonal_of(const SceneBody& body) {
  return std::visit(
      [](const auto& shapes) {
        const Points& points = shapes.reference->control_points();
        return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
      },
      body.shapes);
}

double largest_displacement(const SceneBody& body) {
  return std::visit(
      [](const auto& shapes) {
        if (shapes.current == shapes.opened) return 0.0;
        const auto field =
            shapes.current->with_control_points(shapes.current->control_points() - shapes.opened->control_points());
        return field ? largest_norm_at_samples(*field) : std::numeric_limits<double>::quiet_NaN();
      },
      body.shapes);
}

int moved_control_points(const SceneBody& body) {
  return std::visit(
      [](const auto& shapes) {
        const Points &opened = shapes.opened->control_points(), &current = shapes.current->control_points();
        int moved = 0;
        for (Eigen::Index i = 0; i < current.rows(); ++i) {
          moved += std::memcmp(opened.row(i).data(), current.row(i).data(), 3 * sizeof(double)) != 0;
        }
        return moved;
      },
      body.shapes);
}

Expected<void> halve_spans(SceneBody& body) {
  if (!body.pins.empty()) {
    return input_error("control points are pinned by their numbers, which change with the net", body.id,
                       "release them first, or pin points (at) instead");
  }
  return std::visit([&](auto& shapes) { return halve(body, shapes); }, body.shapes);
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
      // The other directions in cyclic order: their tangents' cross product points along the third; swapped at the
      // lower end, so that it points outward.
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
      auto side = Surface::create({volume.knots(first), volume.knots(second)}, std::move(points), std::move(weights));
      if (!side) return std::unexpected(side.error());
      sides.push_back(*std::move(side));
    }
  }
  return sides;
}

}  // namespace knead
