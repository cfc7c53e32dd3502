#include "edge_curve.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "knead/spline/evaluate.hpp"

namespace knead::brep {
namespace {

// Curves of edges as they stand in files, in their own parametrisations:
//   line        o + t d, |d| = 1 (a file's own vector has the length `magnitude`),
//   ellipse     c + cos t a + sin t b,     t in [0, 2π), closed,
//   hyperbola   c + cosh t a + sinh t b,
//   parabola    c + t² a + 2 t b,
//   B-spline    its knots, closed where the ends meet.
// These are the parametrisations of ISO 10303-42 (clause 4.5: line, ellipse, hyperbola, parabola);
// a and b contain the radii.
constexpr int max_halvings = 12;       // of one piece of a curve
constexpr double close_enough = 1e-6;  // of the extent: ends of a closed spline
// Of coordinates: what is a point.
constexpr double point_rounding = 64 * std::numeric_limits<double>::epsilon();

}  // namespace

// The arc whose chord is `chord` radii away from it: the sagitta is r (1 − cos(θ/2)).
double chord_angle(double chord) { return 2 * std::acos(1 - std::clamp(chord, 1e-8, 0.5)); }

Expected<EdgeCurve> EdgeCurve::create(const CurveGeometry& geometry) {
  const auto made = [&](auto form) {
    EdgeCurve curve(std::move(form));
    curve.turned_ = geometry.turned;
    return curve;
  };
  if (const auto* line = std::get_if<Line>(&geometry.form)) return made(*line);
  if (const auto* conic = std::get_if<Conic>(&geometry.form)) {
    EdgeCurve curve = made(*conic);
    if (conic->form == Conic::Form::ellipse) {
      curve.domain_ = Interval{0, 2 * std::numbers::pi};
      curve.closed_ = true;
    }
    return curve;
  }
  auto table = CurveTable::create(*std::get<std::shared_ptr<const Curve>>(geometry.form));
  if (!table) return std::unexpected(std::move(table.error()));
  const double extent =
      (table->points().colwise().maxCoeff() - table->points().colwise().minCoeff()).norm();
  const bool closed = table->closed(close_enough * extent);
  const auto domain = table->curve().knots(0).domain();
  EdgeCurve curve = made(*std::move(table));
  curve.domain_ = domain;
  curve.closed_ = closed;
  return curve;
}

Point EdgeCurve::at(double t) const {
  if (const auto* line = std::get_if<Line>(&form_)) return line->origin + t * line->direction;
  if (const auto* conic = std::get_if<Conic>(&form_)) {
    switch (conic->form) {
      case Conic::Form::ellipse:
        return conic->centre + std::cos(t) * conic->a + std::sin(t) * conic->b;
      case Conic::Form::hyperbola:
        return conic->centre + std::cosh(t) * conic->a + std::sinh(t) * conic->b;
      case Conic::Form::parabola:
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
      case Conic::Form::ellipse:
        return -std::sin(t) * conic->a + std::cos(t) * conic->b;
      case Conic::Form::hyperbola:
        return std::sinh(t) * conic->a + std::cosh(t) * conic->b;
      case Conic::Form::parabola:
        return 2 * t * conic->a + 2 * conic->b;
    }
  }
  // Central differences: relative errors of about h² and ε/h, 1e-10 in all, enough for directions
  // and normals, and indifferent to knots, at which the one-sided derivatives differ.
  const double h = 1e-6 * domain_->length();
  const double before = closed_ ? t - h : std::max(t - h, domain_->lower);
  const double after = closed_ ? t + h : std::min(t + h, domain_->upper);
  return (at(after) - at(before)) / (after - before);
}

double EdgeCurve::parameter(const Point& p) const {
  if (const auto* line = std::get_if<Line>(&form_)) return (p - line->origin).dot(line->direction);
  if (const auto* conic = std::get_if<Conic>(&form_)) {
    // a and b are perpendicular, so that the coordinates of p in them are projections. Of a point
    // on the conic this is its parameter exactly; of one beside it, near the nearest.
    const double x = (p - conic->centre).dot(conic->a) / conic->a.squaredNorm();
    const double y = (p - conic->centre).dot(conic->b) / conic->b.squaredNorm();
    switch (conic->form) {
      case Conic::Form::ellipse: {
        const double t = std::atan2(y, x);
        return t < 0 ? t + 2 * std::numbers::pi : t;
      }
      case Conic::Form::hyperbola:
        return std::asinh(y);
      case Conic::Form::parabola:
        return y / 2;
    }
  }
  return std::get<CurveTable>(form_).closest(p).parameter;
}

double EdgeCurve::file_parameter(double t) const {
  const auto* line = std::get_if<Line>(&form_);
  return line != nullptr ? t / line->magnitude : t;
}

// At a knot of multiplicity p a curve is continuous and no more.
std::vector<double> EdgeCurve::corners() const {
  std::vector<double> result;
  const auto* table = std::get_if<CurveTable>(&form_);
  if (table == nullptr) return result;
  const KnotVector& knots = table->curve().knots(0);
  for (const int s : knots.spans()) {
    if (knots[s] > knots.domain().lower && knots.multiplicity(knots[s]) >= knots.degree())
      result.push_back(knots[s]);
  }
  return result;
}

// Parameters at which chords stay within a distance of the curve and turn by a limited angle.
// Splines begin with their spans, so that a short one between long ones is not stepped over. A
// piece is accepted when its middle (and, to a length, its quarters) are near and both halves turn
// by no more than half of the angle; where it is within 2 % of the tolerance, turning is invisible.
// 12 halvings end what no chord follows, such as a corner inside of a span.
std::vector<double> EdgeCurve::subdivided(double from, double to, ChordLimit chord) const {
  if (straight()) return {from, to};
  const auto* conic = std::get_if<Conic>(&form_);
  const double angle =
      chord_angle(conic != nullptr && domain_ ? chord.of(std::max(conic->a.norm(), conic->b.norm()))
                                              : chord.share);
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
    // An ellipse is divided evenly by angle: its chords are then within `chord` times the longer
    // semi-axis. The others are refined from a few pieces.
    const int pieces =
        domain_ ? std::max(1, static_cast<int>(std::ceil((to - from) / angle - 1e-9))) : 4;
    coarse.clear();
    for (int k = 0; k <= pieces; ++k)
      coarse.push_back(k == pieces ? to : from + (to - from) * k / pieces);
    if (domain_) return coarse;
  }
  Eigen::AlignedBox3d box;
  for (std::size_t k = 0; k < coarse.size(); ++k) {
    box.extend(at(coarse[k]));
    if (k > 0) box.extend(at((coarse[k - 1] + coarse[k]) / 2));
  }
  const double tolerance = std::min(chord.share * box.diagonal().norm() / 2, chord.length);
  const double rounding =
      point_rounding * std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
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
      off = std::max({off, distance(at(start + (end - start) / 4)),
                      distance(at(start + (end - start) * 3 / 4))});
    }
    const double turn = std::atan2((m - a).cross(b - m).norm(), (m - a).dot(b - m));
    // Halves of a circular arc turn by half its angle.
    const bool fine = off <= tolerance && (turn <= 0.51 * angle || off <= 0.02 * tolerance);
    const bool is_point = std::max(off, length) <= rounding;  // its turns say nothing
    if (fine || is_point || halvings >= max_halvings) {
      result.push_back(end);
      waiting.pop_back();
    } else {
      waiting.back().second = halvings + 1;
      waiting.emplace_back(middle, halvings + 1);
    }
  }
  return result;
}

}  // namespace knead::brep
