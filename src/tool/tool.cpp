#include "knead/tool/tool.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include "shape_kernel.hpp"

namespace knead {

Expected<Tool> validated(const Tool& tool) {
  if (!(tool.stiffness >= 0 && tool.stiffness <= max_tool_stiffness)) {
    return input_error(fmt::format("{} is not a stiffness", tool.stiffness), "stiffness",
                       fmt::format("use a number from 0 to {}", max_tool_stiffness));
  }
  if (!std::isfinite(tool.range) || (!tool.collides() && tool.range <= 0)) {
    return input_error(fmt::format("{} is not a range", tool.range), "range", "use a number > 0");
  }
  if (!std::isfinite(tool.friction) || tool.friction < 0) {
    return input_error(fmt::format("{} is not a friction coefficient", tool.friction), "friction",
                       "use a number >= 0");
  }
  if (!(tool.plasticity >= 0 && tool.plasticity <= 1)) {
    return input_error(fmt::format("{} is not a plasticity", tool.plasticity), "plasticity",
                       "use a number from 0 (springs back) to 1 (keeps its shape)");
  }
  return tool;
}

namespace {

/// The surface with x and u reversed, so that its outside stays outside.
Expected<Surface> flipped(const Surface& s) {
  const auto [m, n] = s.net();
  std::vector<double> knots(s.knots(0).knots().begin(), s.knots(0).knots().end()), weights;
  std::ranges::reverse(knots);
  for (double& x : knots) x = 0.0 - x;
  auto u = KnotVector::create(s.knots(0).degree(), std::move(knots));
  if (!u) return std::unexpected(u.error());
  Points points(s.size(), 3);
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      const int from = (m - 1 - i) * n + j;
      points.row(i * n + j) =
          s.control_points().row(from).cwiseProduct(Eigen::RowVector3d(-1, 1, 1));
      if (s.rational()) weights.push_back(s.weights()[static_cast<std::size_t>(from)]);
    }
  }
  return Surface::create({std::move(*u), s.knots(1)}, std::move(points), std::move(weights));
}

}  // namespace

Expected<std::optional<Tool>> mirrored(const Tool& tool, const Point& point, const Point& normal) {
  // All shapes but surfaces are symmetric in their own x: reflected in space and in x they are
  // merely rotated.
  const Placement& at = tool.shape.placement();
  const Eigen::Matrix3d reflection = Eigen::Matrix3d::Identity() - 2 * normal * normal.transpose();
  const Eigen::Matrix3d turn =
      reflection * at.rotation.toRotationMatrix() * Eigen::Vector3d(-1, 1, 1).asDiagonal();
  Placement image = at;
  image.rotation = Eigen::Quaterniond(turn).normalized();
  image.position = at.position - 2 * normal.dot(at.position - point) * normal;
  Shape shape = tool.shape.shape();
  if (const auto* spline = std::get_if<SplineShape>(&shape)) {
    auto surface = flipped(*spline->surface);
    if (!surface) return std::unexpected(surface.error());
    shape = SplineShape{std::make_shared<const Surface>(std::move(*surface))};
  }
  auto placed = PlacedShape::create(shape, image);
  if (!placed) return std::unexpected(placed.error());
  // A tool that is its own image has the same distances everywhere; a few dozen places suffice.
  const double size = std::isfinite(tool.shape.size()) ? tool.shape.size() : 1;
  bool same = true;
  for (int k = 0; k < 40 && same; ++k) {
    const double t = 2.399963 * k, z = (k + 0.5) / 20 - 1,
                 r = std::sqrt(1 - z * z);  // a spiral around the tool
    const Point x =
        at.position + (1 + 0.1 * (k % 7)) * size * Point(r * std::cos(t), r * std::sin(t), z);
    same = std::abs(tool.shape.nearest(x).distance - placed->nearest(x).distance) <= 1e-9 * size;
  }
  if (same) return std::nullopt;
  Tool result = tool;
  result.shape = std::move(*placed);
  return result;
}

ModelTool::ModelTool(const Tool& tool, const Point& centre, double length)
    : tool_(tool), length_(length), range_(tool.range / length) {
  const Placement& at = tool.shape.placement();
  // Finite minus finite: the placement stays valid unless it overflows, in which case the shape is
  // out of reach anyway.
  if (auto moved = tool.shape.moved(at.rotation, at.position - centre))
    tool_.shape = std::move(*moved);
  size_ = std::min(tool.shape.size() / length, 1.0);
  const BoundingBox box = tool_.shape.bounding_box();
  const double margin = tool.collides() ? 0 : range_;
  lower_ = (box.lower / length).array() - margin;
  upper_ = (box.upper / length).array() + margin;
  centre_ = tool_.shape.placement().position / length;
  radius_ = std::numeric_limits<double>::infinity();
  if (const auto* sphere = std::get_if<SphereShape>(&tool_.shape.shape()))
    radius_ = sphere->radius * *std::ranges::max_element(at.scale) / length + margin;
}

void ModelTool::set_offset(double offset) {
  lower_ = lower_.array() - (offset - offset_);
  upper_ = upper_.array() + (offset - offset_);
  radius_ += offset - offset_;
  offset_ = offset;
}

double ModelTool::distance(const Point& x) const {
  return tool_.shape.nearest(Point(length_ * x)).distance / length_;
}

bool ModelTool::may_reach(const Point& lower, const Point& upper) const {
  if (!overlaps(lower, upper)) return false;
  // Distances are 1-Lipschitz.
  const Point middle = 0.5 * (lower + upper);
  const double radius = 0.5 * (upper - lower).norm(),
               phi = tool_.shape.nearest(Point(length_ * middle)).distance / length_;
  if (tool_.collides()) return phi <= radius + offset_;
  return std::abs(phi) <= radius + range_;
}

ToolAction ModelTool::action(const Point& x) const {
  ToolAction action;
  const Point beyond = (lower_ - x).cwiseMax(x - upper_);
  if (beyond.maxCoeff() > 0) {
    action.clear = beyond.cwiseMax(0).norm();
    return action;
  }
  if (tool_.collides() && offset_ == 0 && detail::is_outside(tool_.shape, length_ * x))
    return action;
  const Nearest near = tool_.shape.nearest(Point(length_ * x));
  const double phi = near.distance / length_ - offset_, k = tool_.stiffness;
  double slope = 0, curvature = 0;  // ψ'(φ) and ψ''(φ)
  if (tool_.collides()) {
    if (phi >= 0) {
      if (near.converged && !jumps()) action.clear = phi;
      return action;
    }
    action.potential = 0.5 * k * phi * phi;
    action.entry = -phi;
    slope = k * phi;
    curvature = k;
  } else {
    const double r2 = range_ * range_, s = 1 - phi * phi / r2;
    if (s <= 0) {
      if (near.converged) action.clear = std::max(0.0, std::abs(phi) - range_);
      return action;
    }
    const double sign = tool_.direction == ToolDirection::pull ? 1 : -1;
    action.potential = -sign * k * r2 / 6 * s * s * s;
    slope = sign * k * s * s * phi;
    curvature = sign * k * s * (5 * s - 4);
  }
  if (near.normal == Point::Zero()) return action;
  action.active = true;
  action.normal = near.normal;
  action.force = -slope * near.normal;
  action.hessian =
      curvature * near.normal * near.normal.transpose() + slope * length_ * near.hessian;
  return action;
}

}  // namespace knead
