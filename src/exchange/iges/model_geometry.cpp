#include "model_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exchange/part21/part21_text.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "text.hpp"

namespace knead::iges {
namespace {

constexpr double same_axes = 1e-14;   // of the longer semi-axis: an ellipse is a circle
constexpr double whole_turn = 1e-12;  // of a turn

std::string pointer(int number) { return std::to_string(number); }

}  // namespace

// IGES limits a curve by V0 < V1 within its knots, so that an edge across the start of a closed
// curve needs another start. Knots are inserted there up to multiplicity p, and the two parts
// change places: control points and weights of the first go behind those of the second, its knots a
// period further. Where the weights at both ends differ, one part is multiplied by their ratio,
// which does not change it.
Expected<Curve> starting_at(const Curve& curve, double start) {
  const int p = curve.knots(0).degree();
  const int missing = p - curve.knots(0).multiplicity(start);
  auto split = insert_knots<1>(
      curve, {std::vector<double>(static_cast<std::size_t>(std::max(missing, 0)), start)});
  if (!split) return split;
  const auto knots = split->knots(0).knots();
  const double period = split->knots(0).domain().length();
  // Control point `at` is the point of the curve at `start`: its knots are start, …, p times.
  const auto first =
      static_cast<std::size_t>(std::ranges::lower_bound(knots, start) - knots.begin());
  const auto at = static_cast<Eigen::Index>(first) - 1,
             n = static_cast<Eigen::Index>(split->size());
  std::vector<double> turned = {start};
  turned.insert(turned.end(), knots.begin() + static_cast<std::ptrdiff_t>(first), knots.end() - 1);
  for (auto k = static_cast<std::size_t>(p) + 1; k < first + static_cast<std::size_t>(p); ++k)
    turned.push_back(knots[k] + period);
  turned.push_back(turned.back());
  Points points(n, 3);
  points.topRows(n - at) = split->control_points().bottomRows(n - at);
  points.bottomRows(at) = split->control_points().middleRows(1, at);
  std::vector<double> weights;
  if (split->rational()) {
    const auto its_weights = split->weights();
    const double ratio = its_weights.back() / its_weights.front();
    weights.assign(its_weights.begin() + at, its_weights.end());
    for (Eigen::Index k = 1; k <= at; ++k)
      weights.push_back(ratio * its_weights[static_cast<std::size_t>(k)]);
  }
  auto vector = KnotVector::create(p, std::move(turned));
  if (!vector) return std::unexpected(std::move(vector.error()));
  return Curve::create({*std::move(vector)}, std::move(points), std::move(weights));
}

Values matrix_values(const Eigen::Affine3d& move) {
  Values values;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 4; ++k) values.push_back(format_real(move.matrix()(i, k)));
  }
  return values;
}

int ModelGeometry::point(const Point& p) {
  Values values;
  append(values, std::span(p.data(), 3));
  values.emplace_back("0");
  return to_.add(116, std::move(values), {.dependent = true});
}

int ModelGeometry::direction(const Point& d) {
  Values values;
  append(values, std::span(d.data(), 3));
  return to_.add(123, std::move(values), {.dependent = true});
}

int ModelGeometry::matrix(const brep::Frame& frame) {
  Eigen::Affine3d move = Eigen::Affine3d::Identity();
  move.linear() << frame.x, frame.y, frame.z;
  move.translation() = frame.origin;
  return to_.add(124, matrix_values(move), {.dependent = true});
}

/// Its parameters are those of its frame: form 1, with a reference direction.
int ModelGeometry::elementary(const brep::ElementarySurface& surface) {
  using Kind = brep::ElementarySurface::Kind;
  brep::Frame frame = surface.frame;
  double second = surface.second;
  if (surface.kind == Kind::cone && second < 0) {  // it opens along its axis
    frame.z = -frame.z;
    second = -second;
  }
  Values values = {pointer(point(frame.origin))};
  const std::string axis = pointer(direction(frame.z)), along = pointer(direction(frame.x)),
                    radius = format_real(surface.radius);
  const Entry entry{.form = 1, .dependent = true};
  switch (surface.kind) {
    case Kind::plane:
      values.insert(values.end(), {axis, along});
      return to_.add(190, std::move(values), entry);
    case Kind::cylinder:
      values.insert(values.end(), {axis, radius, along});
      return to_.add(192, std::move(values), entry);
    case Kind::cone:
      values.insert(values.end(),
                    {axis, radius, format_real(second * 180 / std::numbers::pi), along});
      return to_.add(194, std::move(values), entry);
    case Kind::sphere:
      values.insert(values.end(), {radius, axis, along});
      return to_.add(196, std::move(values), entry);
    case Kind::torus:
      break;
  }
  values.insert(values.end(), {axis, radius, format_real(second), along});
  return to_.add(198, std::move(values), entry);
}

Expected<int> ModelGeometry::surface(brep::Index support) {
  const auto known = surfaces_.find(support);
  if (known != surfaces_.end()) return known->second;
  const brep::Support& stored = model_.supports[support];
  if (stored.spline != brep::none) {
    const brep::SplineSurface& s = model_.surfaces[stored.spline];
    const int number = to_.add(128, surface_values(s.surface), {.name = s.name, .dependent = true});
    return surfaces_[support] = number;
  }
  const auto* form = std::get_if<brep::ElementarySurface>(&stored.form);
  if (form == nullptr) return input_error("IGES cannot hold this surface", stored.id, "write STEP");
  return surfaces_[support] = elementary(*form);
}

int ModelGeometry::arc(const brep::Conic& circle, const Interval& range) {
  const double radius = circle.a.norm();
  brep::Frame frame{circle.centre, circle.a / radius, circle.b / circle.b.norm()};
  frame.z = frame.x.cross(frame.y);
  Values values = {"0.", "0.", "0."};
  const bool whole = range.length() >= 2 * std::numbers::pi * (1 - whole_turn);
  for (const double t : {range.lower, whole ? range.lower : range.upper})
    append(values, std::array{radius * std::cos(t), radius * std::sin(t)});
  return to_.add(100, std::move(values), {.dependent = true, .transform = matrix(frame)});
}

Expected<int> ModelGeometry::curve(brep::Index edge) {
  const brep::CurveGeometry& geometry = *model_.edges[edge].curve;
  const Interval range = plan_.edges[edge]->range;
  if (const auto* line = std::get_if<brep::Line>(&geometry.form)) {
    Values values;
    for (const double t : {range.lower, range.upper}) {
      const Point p = line->origin + t * line->direction;
      append(values, std::span(p.data(), 3));
    }
    return to_.add(110, std::move(values), {.dependent = true});
  }
  if (const auto* conic = std::get_if<brep::Conic>(&geometry.form)) {
    const double a = conic->a.norm(), b = conic->b.norm();
    if (conic->form == brep::Conic::Form::ellipse && std::abs(a - b) <= same_axes * std::max(a, b))
      return arc(*conic, range);
  }
  const auto edge_curve = brep::EdgeCurve::create(geometry);
  if (!edge_curve) return std::unexpected(edge_curve.error());
  auto spline = edge_curve->spline(range);
  if (!spline) return std::unexpected(std::move(spline.error()));
  const bool whole = range.lower <= spline->knots(0).domain().lower &&
                     range.upper >= spline->knots(0).domain().upper;
  if (range.upper > spline->knots(0).domain().upper && !whole && spline->knots(0).clamped()) {
    spline = starting_at(*spline, range.lower);
    if (!spline) return std::unexpected(std::move(spline.error()));
  }
  Values values = curve_values(*spline);
  const Interval domain = spline->knots(0).domain();
  const std::size_t limits = values.size() - 5;  // before the normal of a plane
  values[limits] = format_real(std::clamp(range.lower, domain.lower, domain.upper));
  values[limits + 1] = format_real(std::clamp(range.upper, domain.lower, domain.upper));
  return to_.add(126, std::move(values), {.dependent = true});
}

}  // namespace knead::iges
