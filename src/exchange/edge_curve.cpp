#include "edge_curve.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "knead/spline/evaluate.hpp"

namespace knead::step {
namespace {

constexpr int max_curve_nesting = 8;   // nested curves; more is a loop
constexpr int max_halvings = 12;       // of one piece of a curve
constexpr double close_enough = 1e-6;  // of the extent: ends of a closed spline

std::optional<std::uint32_t> reference_at(const Reader& reader, std::uint32_t instance, const char* entity,
                                          std::size_t inherited, std::size_t k) {
  const auto own = reader.attributes(instance, entity, inherited, k + 1);
  return own.empty() ? std::nullopt : reader.reference(own[k]);
}

// POLYLINE(points) as a spline of degree 1.
Expected<Curve> polyline_curve(const Reader& reader, std::uint32_t instance) {
  const auto own = reader.attributes(instance, "POLYLINE", 1, 1);
  const auto targets = own.empty() ? std::vector<std::uint32_t>() : reader.references(own[0]);
  if (targets.size() < 2) return reader.error(instance, "it has fewer than two points");
  Points points(static_cast<Eigen::Index>(targets.size()), 3);
  std::vector<double> knots = {0};
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const auto point = reader.point(targets[k]);
    if (!point) return std::unexpected(point.error());
    points.row(static_cast<Eigen::Index>(k)) = point->transpose();
    knots.push_back(static_cast<double>(k));
  }
  knots.push_back(knots.back());
  auto vector = KnotVector::create(1, std::move(knots));
  if (!vector) return std::unexpected(std::move(vector.error()));
  return Curve::create({*std::move(vector)}, std::move(points));
}

}  // namespace

std::optional<Frame> frame_of(const AxisPlacement& placement) {
  Frame frame{placement.origin};
  frame.z = placement.axis.normalized();
  const Point across = placement.ref_direction - placement.ref_direction.dot(frame.z) * frame.z;
  if (!(across.norm() > 1e-9 * placement.ref_direction.norm()) || !(placement.axis.norm() > 0)) return std::nullopt;
  frame.x = across.normalized();
  frame.y = frame.z.cross(frame.x);
  return frame;
}

double chord_angle(double chord) { return 2 * std::acos(1 - std::clamp(chord, 1e-8, 0.5)); }

std::optional<EdgeCurve::Conic> EdgeCurve::conic(const Reader& reader, std::uint32_t instance, ConicForm form) {
  // CONIC(position); then CIRCLE(radius), PARABOLA(focal_dist), or both semi-axes.
  const auto position = reference_at(reader, instance, "CONIC", reader.file().instance(instance).complex ? 0 : 1, 0);
  const auto placement = position ? read_placement(reader, *position) : std::nullopt;
  const auto frame = placement ? frame_of(*placement) : std::nullopt;
  const bool one = reader.is(instance, "CIRCLE") || form == ConicForm::parabola;
  const char* entity = form == ConicForm::parabola     ? "PARABOLA"
                       : form == ConicForm::hyperbola  ? "HYPERBOLA"
                       : reader.is(instance, "CIRCLE") ? "CIRCLE"
                                                       : "ELLIPSE";
  const auto own = reader.attributes(instance, entity, 2, one ? 1 : 2);
  if (!frame || own.empty()) return std::nullopt;
  const auto a = reader.length(own[0]);
  const auto b = one ? a : reader.length(own[1]);
  if (!a || !b || !(*a > 0) || !(*b > 0)) return std::nullopt;
  return Conic{form, frame->origin, *a * frame->x, *b * frame->y};
}

Expected<EdgeCurve> EdgeCurve::read(const Reader& reader, std::uint32_t instance) {
  return read_nested(reader, instance, 0);
}

Expected<EdgeCurve> EdgeCurve::read_nested(const Reader& reader, std::uint32_t instance, int depth) {
  if (depth > max_curve_nesting) return reader.error(instance, "it is made of itself");
  if (reader.is(instance, "LINE")) {
    // LINE(pnt, dir) with VECTOR(orientation, magnitude).
    const auto from = reference_at(reader, instance, "LINE", 1, 0);
    const auto vector = reference_at(reader, instance, "LINE", 1, 1);
    const auto orientation = vector ? reference_at(reader, *vector, "VECTOR", 1, 0) : std::nullopt;
    const auto point = from ? reader.point(*from) : Expected<Point>(reader.error(instance, "it has no point"));
    const auto direction = orientation ? reader.direction(*orientation) : std::nullopt;
    if (!point || !direction || !(direction->norm() > 0)) return reader.error(instance, "it has no point or direction");
    const auto own = reader.attributes(*vector, "VECTOR", 1, 2);
    const double magnitude = own.empty() ? 1 : reader.length(own[1]).value_or(1);
    return EdgeCurve(Line{*point, direction->normalized(), magnitude > 0 ? magnitude : 1});
  }
  for (const auto& [entity, form] :
       {std::pair("CIRCLE", ConicForm::ellipse), std::pair("ELLIPSE", ConicForm::ellipse),
        std::pair("HYPERBOLA", ConicForm::hyperbola), std::pair("PARABOLA", ConicForm::parabola)}) {
    if (!reader.is(instance, entity)) continue;
    const auto read = conic(reader, instance, form);
    if (!read) return reader.error(instance, "its position or its lengths cannot be read");
    EdgeCurve curve(*read);
    if (form == ConicForm::ellipse) {
      curve.domain_ = Interval{0, 2 * std::numbers::pi};
      curve.closed_ = true;
    }
    return curve;
  }
  for (const auto* entity : {"SURFACE_CURVE", "SEAM_CURVE", "INTERSECTION_CURVE", "BOUNDED_SURFACE_CURVE"}) {
    if (!reader.is(instance, entity)) continue;
    const auto inner = reference_at(reader, instance, "SURFACE_CURVE", 1, 0);
    if (!inner) return reader.error(instance, "it has no curve in space");
    return read_nested(reader, *inner, depth + 1);
  }
  if (reader.is(instance, "TRIMMED_CURVE")) {
    const auto own = reader.attributes(instance, "TRIMMED_CURVE", 1, 4);
    const auto basis = own.empty() ? std::nullopt : reader.reference(own[0]);
    if (!basis) return reader.error(instance, "it has no basis curve");
    auto curve = read_nested(reader, *basis, depth + 1);
    if (curve && reader.enumeration(own[3]) == "F") curve->turned_ = !curve->turned_;
    return curve;
  }
  auto spline =
      reader.is(instance, "POLYLINE") ? polyline_curve(reader, instance) : read_b_spline_curve(reader, instance);
  if (!spline) return std::unexpected(std::move(spline.error()));
  auto table = CurveTable::create(*std::move(spline));
  if (!table) return std::unexpected(std::move(table.error()));
  const double extent = (table->points().colwise().maxCoeff() - table->points().colwise().minCoeff()).norm();
  const bool closed = table->closed(close_enough * extent);
  const auto domain = table->curve().knots(0).domain();
  EdgeCurve curve(*std::move(table));
  curve.domain_ = domain;
  curve.closed_ = closed;
  return curve;
}

Point EdgeCurve::at(double t) const {
  if (const auto* line = std::get_if<Line>(&form_)) return line->origin + t * line->direction;
  if (const auto* conic = std::get_if<Conic>(&form_)) {
    switch (conic->form) {
      case ConicForm::ellipse:
        return conic->centre + std::cos(t) * conic->a + std::sin(t) * conic->b;
      case ConicForm::hyperbola:
        return conic->centre + std::cosh(t) * conic->a + std::sinh(t) * conic->b;
      case ConicForm::parabola:
        return conic->centre + t * t * conic->a + 2 * t * conic->b;
    }
  }
  const auto& curve = std::get<CurveTable>(form_).curve();
  if (closed_ && t > domain_->upper) t -= domain_->length();
  if (closed_ && t < domain_->lower) t += domain_->length();
  const auto point = evaluate_point<1>(curve, {std::clamp(t, domain_->lower, domain_->upper)});
  return point ? *point : Point(curve.control_points().row(0).transpose());
}

Point EdgeCurve::derivative(double t) const {
  if (const auto* line = std::get_if<Line>(&form_)) return line->direction;
  if (const auto* conic = std::get_if<Conic>(&form_)) {
    switch (conic->form) {
      case ConicForm::ellipse:
        return -std::sin(t) * conic->a + std::cos(t) * conic->b;
      case ConicForm::hyperbola:
        return std::sinh(t) * conic->a + std::cosh(t) * conic->b;
      case ConicForm::parabola:
        return 2 * t * conic->a + 2 * conic->b;
    }
  }
  const double h = 1e-6 * domain_->length();
  const double before = closed_ ? t - h : std::max(t - h, domain_->lower);
  const double after = closed_ ? t + h : std::min(t + h, domain_->upper);
  return (at(after) - at(before)) / (after - before);
}

double EdgeCurve::parameter(const Point& p) const {
  if (const auto* line = std::get_if<Line>(&form_)) return (p - line->origin).dot(line->direction);
  if (const auto* conic = std::get_if<Conic>(&form_)) {
    const double x = (p - conic->centre).dot(conic->a) / conic->a.squaredNorm();
    const double y = (p - conic->centre).dot(conic->b) / conic->b.squaredNorm();
    switch (conic->form) {
      case ConicForm::ellipse: {
        const double t = std::atan2(y, x);
        return t < 0 ? t + 2 * std::numbers::pi : t;
      }
      case ConicForm::hyperbola:
        return std::asinh(y);
      case ConicForm::parabola:
        return y / 2;
    }
  }
  return std::get<CurveTable>(form_).closest(p).parameter;
}

double EdgeCurve::file_parameter(double t) const {
  const auto* line = std::get_if<Line>(&form_);
  return line != nullptr ? t / line->magnitude : t;
}

std::vector<double> EdgeCurve::corners() const {
  std::vector<double> result;
  const auto* table = std::get_if<CurveTable>(&form_);
  if (table == nullptr) return result;
  const KnotVector& knots = table->curve().knots(0);
  for (const int s : knots.spans()) {
    if (knots[s] > knots.domain().lower && knots.multiplicity(knots[s]) >= knots.degree()) result.push_back(knots[s]);
  }
  return result;
}

std::vector<double> EdgeCurve::subdivided(double from, double to, ChordLimit chord) const {
  if (straight()) return {from, to};
  const auto* conic = std::get_if<Conic>(&form_);
  const double angle =
      chord_angle(conic != nullptr && domain_ ? chord.of(std::max(conic->a.norm(), conic->b.norm())) : chord.share);
  std::vector<double> coarse = {from, to};
  if (const auto* table = std::get_if<CurveTable>(&form_)) {
    const auto& knots = table->curve().knots(0);
    for (const int s : knots.spans()) {
      for (const double shift : {0.0, domain_->length()}) {
        const double t = knots[s] + shift;
        if (t > from && t < to && (shift == 0 || closed_)) coarse.push_back(t);
      }
    }
    std::sort(coarse.begin(), coarse.end());
    coarse.erase(std::unique(coarse.begin(), coarse.end()), coarse.end());
  } else {
    // An ellipse is divided evenly by angle: its chords are then within `chord` times the longer semi-axis. The others
    // are refined from a few pieces.
    const int pieces = domain_ ? std::max(1, static_cast<int>(std::ceil((to - from) / angle - 1e-9))) : 4;
    coarse.clear();
    for (int k = 0; k <= pieces; ++k) coarse.push_back(k == pieces ? to : from + (to - from) * k / pieces);
    if (domain_) return coarse;
  }
  Eigen::AlignedBox3d box;
  for (std::size_t k = 0; k < coarse.size(); ++k) {
    box.extend(at(coarse[k]));
    if (k > 0) box.extend(at((coarse[k - 1] + coarse[k]) / 2));
  }
  const double tolerance = std::min(chord.share * box.diagonal().norm() / 2, chord.length);
  // Halved from the left, with the far ends on a stack.
  std::vector<double> result = {from};
  std::vector<std::pair<double, int>> waiting;
  for (std::size_t k = coarse.size(); k-- > 1;) waiting.emplace_back(coarse[k], 0);
  while (!waiting.empty()) {
    const auto [end, halvings] = waiting.back();
    const double middle = (result.back() + end) / 2;
    const Point a = at(result.back()), m = at(middle), b = at(end);
    const Point chord_ab = b - a;
    const double length = chord_ab.norm();
    const auto distance = [&](const Point& p) {
      return length > 0 ? (p - a).cross(chord_ab).norm() / length : (p - a).norm();
    };
    double off = distance(m);
    // A piece that turns both ways may meet its chord in the middle.
    if (off <= tolerance && std::isfinite(chord.length)) {
      const double start = result.back();
      off = std::max({off, distance(at(start + (end - start) / 4)), distance(at(start + (end - start) * 3 / 4))});
    }
    const double turn = std::atan2((m - a).cross(b - m).norm(), (m - a).dot(b - m));
    // Halves of a circular arc turn by half its angle.
    const bool fine = off <= tolerance && (turn <= 0.51 * angle || off <= 0.02 * tolerance);
    if (fine || halvings >= max_halvings) {
      result.push_back(end);
      waiting.pop_back();
    } else {
      waiting.back().second = halvings + 1;
      waiting.emplace_back(middle, halvings + 1);
    }
  }
  return result;
}

}  // namespace knead::step
