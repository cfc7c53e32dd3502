#include "geometry_forms.hpp"

#include <cmath>

namespace knead::brep {
namespace {

bool usable(double number) { return std::abs(number) <= largest_number; }
bool usable(const Point& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() <= largest_number; }
bool is_length(double number) { return number > 0 && usable(number); }

}  // namespace

std::optional<Frame> frame_of(const Point& origin, const Point& axis, const Point& reference) {
  if (!usable(origin)) return std::nullopt;
  Frame frame{origin};
  frame.z = axis.normalized();
  const Point across = reference - reference.dot(frame.z) * frame.z;
  if (!(across.norm() > 1e-9 * reference.norm()) || !(axis.norm() > 0)) return std::nullopt;
  frame.x = across.normalized();
  frame.y = frame.z.cross(frame.x);
  return frame;
}

Expected<CurveGeometry> line_of(const Point& origin, const Point& direction, double magnitude) {
  if (!usable(origin) || !(direction.norm() > 0))
    return input_error("it has no point or direction");
  return CurveGeometry{Line{origin, direction.normalized(), is_length(magnitude) ? magnitude : 1}};
}

Expected<CurveGeometry> conic_of(Conic::Form form, const std::optional<Frame>& frame, double a,
                                 double b) {
  if (!frame || !is_length(a) || !is_length(b))
    return input_error("its position or its lengths cannot be read");
  return CurveGeometry{Conic{form, frame->origin, a * frame->x, b * frame->y}};
}

Expected<CurveGeometry> polyline_of(std::span<const Point> corners) {
  if (corners.size() < 2) return input_error("it has fewer than two points");
  Points points(static_cast<Eigen::Index>(corners.size()), 3);
  std::vector<double> knots = {0};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    points.row(static_cast<Eigen::Index>(k)) = corners[k].transpose();
    knots.push_back(static_cast<double>(k));
  }
  knots.push_back(knots.back());
  auto vector = KnotVector::create(1, std::move(knots));
  if (!vector) return std::unexpected(std::move(vector.error()));
  auto curve = Curve::create({*std::move(vector)}, std::move(points));
  if (!curve) return std::unexpected(std::move(curve.error()));
  CurveGeometry result = spline_of(*std::move(curve));
  result.polyline = true;
  return result;
}

CurveGeometry spline_of(Curve curve) {
  return CurveGeometry{std::make_shared<const Curve>(std::move(curve))};
}

Expected<ElementarySurface> elementary_of(ElementarySurface::Kind kind,
                                          const std::optional<Frame>& frame, double radius,
                                          double second) {
  using Kind = ElementarySurface::Kind;
  if (!frame) return input_error("its position cannot be read");
  if (kind == Kind::plane) return ElementarySurface{kind, *frame};
  if (!is_length(radius) && !(radius == 0 && kind == Kind::cone))
    return input_error("its radius cannot be read");
  const bool two = kind == Kind::cone || kind == Kind::torus;
  if (two && (!usable(second) || !(second != 0)))
    return input_error("its second measure cannot be read");
  return ElementarySurface{kind, *frame, radius, two ? second : 0};
}

Point newell_normal(std::span<const Point> polygon) {
  Point normal = Point::Zero();
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    normal += (polygon[k] - polygon[0]).cross(polygon[(k + 1) % polygon.size()] - polygon[0]);
  }
  return normal;
}

}  // namespace knead::brep
