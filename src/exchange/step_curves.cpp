#include "step_curves.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "knead/spline/basis.hpp"
#include "knead/spline/evaluate.hpp"
#include "step_instances.hpp"
#include "step_knots.hpp"

namespace knead::step {
namespace {

constexpr int samples_per_edge = 17;
constexpr int most_samples = 129;
constexpr int max_nesting = 8;  // nested curves; more is a loop

struct Ends {
  Point start;
  Point end;
};

// An attribute that the complex form of an entity declares in another place than the simple form.
std::optional<std::uint32_t> reference_at(const Reader& reader, std::uint32_t instance, std::string_view declared_by,
                                          std::size_t inherited, std::size_t k) {
  const auto own = reader.attributes(instance, declared_by, inherited, k + 1);
  return own.empty() ? std::nullopt : reader.reference(own[k]);
}

std::optional<Point> vertex_point(const Reader& reader, std::uint32_t vertex) {
  if (!reader.is(vertex, "VERTEX_POINT")) return std::nullopt;
  const auto geometry = reference_at(reader, vertex, "VERTEX_POINT", 1, 0);
  if (!geometry) return std::nullopt;
  const auto point = reader.point(*geometry);
  return point ? std::optional(*point) : std::nullopt;
}

Points segment(const Point& from, const Point& to) {
  Points result(samples_per_edge, 3);
  for (int k = 0; k < samples_per_edge; ++k) {
    const double t = static_cast<double>(k) / (samples_per_edge - 1);
    result.row(k) = ((1 - t) * from + t * to).transpose();
  }
  return result;
}

// CIRCLE(position, radius) and ELLIPSE(position, semi_axis_1, semi_axis_2): C + a cos t X + b sin t Y.
std::optional<Points> conic(const Reader& reader, std::uint32_t instance, const Ends& ends) {
  const bool circle = reader.is(instance, "CIRCLE");
  const auto position = reader.file().instance(instance).complex ? reference_at(reader, instance, "CONIC", 0, 0)
                                                                 : reference_at(reader, instance, "CONIC", 1, 0);
  const auto own = reader.attributes(instance, circle ? "CIRCLE" : "ELLIPSE", 2, circle ? 1 : 2);
  const auto frame = position ? read_placement(reader, *position) : std::nullopt;
  if (!frame || own.empty()) return std::nullopt;
  const auto a = reader.length(own[0]);
  const auto b = circle ? a : reader.length(own[1]);
  if (!a || !b || *a <= 0 || *b <= 0) return std::nullopt;
  const Point z = frame->axis.normalized();
  const Point x = (frame->ref_direction - frame->ref_direction.dot(z) * z).normalized();
  const Point y = z.cross(x);
  if (!x.allFinite() || !y.allFinite() || x.norm() < 0.5) return std::nullopt;
  const auto angle = [&](const Point& p) {
    return std::atan2((p - frame->origin).dot(y) / *b, (p - frame->origin).dot(x) / *a);
  };
  const double from = angle(ends.start);
  double to = angle(ends.end);
  // Counter-clockwise from start to end; the same vertex twice means the whole circle.
  if (to <= from + 1e-9) to += 2 * std::numbers::pi;
  Points result(2 * samples_per_edge, 3);
  for (Eigen::Index k = 0; k < result.rows(); ++k) {
    const double t = from + (to - from) * static_cast<double>(k) / static_cast<double>(result.rows() - 1);
    result.row(k) = (frame->origin + *a * std::cos(t) * x + *b * std::sin(t) * y).transpose();
  }
  return result;
}

std::optional<Points> polyline(const Reader& reader, std::uint32_t instance) {
  const auto own = reader.attributes(instance, "POLYLINE", 1, 1);
  if (own.empty()) return std::nullopt;
  std::vector<Point> corners;
  for (const auto k : reader.references(own[0])) {
    const auto point = reader.point(k);
    if (!point) return std::nullopt;
    if (!corners.empty()) corners.push_back((corners.back() + *point) / 2);
    corners.push_back(*point);
  }
  if (corners.size() < 2) return std::nullopt;
  Points result(static_cast<Eigen::Index>(corners.size()), 3);
  for (std::size_t k = 0; k < corners.size(); ++k) result.row(static_cast<Eigen::Index>(k)) = corners[k].transpose();
  return result;
}

std::optional<Points> spline(const Reader& reader, std::uint32_t instance, const Ends& ends) {
  auto curve = read_b_spline_curve(reader, instance);
  if (!curve) return std::nullopt;
  const auto table = CurveTable::create(*std::move(curve));
  if (!table) return std::nullopt;
  const auto domain = table->curve().knots(0).domain();
  const double size = (table->points().colwise().maxCoeff() - table->points().colwise().minCoeff()).norm();
  const double near = 1e-6 * domain.length();
  double from = table->closest(ends.start).parameter;
  double to = table->closest(ends.end).parameter;
  const bool closed = table->closed(1e-6 * size);
  if (closed) {
    if (from >= domain.upper - near) from = domain.lower;
    if (to <= from + near) to += domain.length();
  } else if (to < from) {
    std::swap(from, to);  // against the stated sense of the edge, yet the same points
  }
  const int count =
      std::min(most_samples, samples_per_edge + 4 * static_cast<int>(table->curve().knots(0).spans().size()));
  Parameters<1> parameters(count);
  for (int k = 0; k < count; ++k) {
    double t = from + (to - from) * static_cast<double>(k) / (count - 1);
    if (closed && t > domain.upper) t -= domain.length();
    parameters(k) = std::clamp(t, domain.lower, domain.upper);
  }
  const auto evaluation = evaluate<1>(table->curve(), parameters);
  return evaluation ? std::optional(evaluation->points()) : std::nullopt;
}

std::optional<Points> sample_curve(const Reader& reader, std::uint32_t instance, const Ends& ends, int depth) {
  if (depth > max_nesting) return std::nullopt;
  if (reader.is(instance, "LINE")) return segment(ends.start, ends.end);
  if (reader.is(instance, "CIRCLE") || reader.is(instance, "ELLIPSE")) return conic(reader, instance, ends);
  if (reader.is(instance, "POLYLINE")) return polyline(reader, instance);
  for (const auto* form : {"SURFACE_CURVE", "SEAM_CURVE", "INTERSECTION_CURVE", "BOUNDED_SURFACE_CURVE"}) {
    if (!reader.is(instance, form)) continue;
    const auto curve = reference_at(reader, instance, "SURFACE_CURVE", 1, 0);
    return curve ? sample_curve(reader, *curve, ends, depth + 1) : std::nullopt;
  }
  if (reader.is(instance, "TRIMMED_CURVE")) {
    const auto own = reader.attributes(instance, "TRIMMED_CURVE", 1, 4);
    const auto basis = own.empty() ? std::nullopt : reader.reference(own[0]);
    if (!basis) return std::nullopt;
    const bool agrees = reader.enumeration(own[3]) != "F";
    return sample_curve(reader, *basis, agrees ? ends : Ends{ends.end, ends.start}, depth + 1);
  }
  return spline(reader, instance, ends);
}

}  // namespace

namespace {

/// Leaves out functions with equal knots all along, [t_i, t_(i+p+1)), and their control points: they are zero
/// everywhere. Some writers repeat the first knot and control point of a trimmed curve.
void leave_out_empty(std::size_t degree, std::vector<double>& knots, Points& points, std::vector<double>& weights) {
  for (std::size_t i = 0; i + degree + 1 < knots.size();) {
    const auto rows = static_cast<std::size_t>(points.rows());
    if (knots[i] != knots[i + degree + 1] || rows <= degree + 1) {
      ++i;
      continue;
    }
    knots.erase(knots.begin() + static_cast<std::ptrdiff_t>(i));
    if (weights.size() == rows) weights.erase(weights.begin() + static_cast<std::ptrdiff_t>(i));
    const auto k = static_cast<Eigen::Index>(i), below = points.rows() - 1 - k;
    points.middleRows(k, below) = points.bottomRows(below).eval();
    points.conservativeResize(points.rows() - 1, Eigen::NoChange);
  }
}

}  // namespace

Expected<Curve> read_b_spline_curve(const Reader& reader, std::uint32_t instance) {
  constexpr std::size_t attributes_of_curve = 6;
  std::optional<ImpliedKnots> form;
  if (reader.is(instance, "BEZIER_CURVE")) form = ImpliedKnots::bezier;
  if (reader.is(instance, "QUASI_UNIFORM_CURVE")) form = ImpliedKnots::quasi_uniform;
  if (reader.is(instance, "UNIFORM_CURVE")) form = ImpliedKnots::uniform;
  const bool listed = reader.is(instance, "B_SPLINE_CURVE_WITH_KNOTS");
  if (!form && !listed) return reader.error(instance, "it is not a B-spline curve with knots");
  const auto own = reader.attributes(instance, "B_SPLINE_CURVE", 1, 2);
  const auto degree = own.empty() ? std::nullopt : reader.integer(own[0]);
  if (!degree || *degree < 1 || *degree > max_degree)
    return reader.error(instance, "its degree is not 1 to " + std::to_string(max_degree));
  const auto targets = reader.references(own[1]);
  Points points(static_cast<Eigen::Index>(targets.size()), 3);
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const auto point = reader.point(targets[k]);
    if (!point) return std::unexpected(point.error());
    points.row(static_cast<Eigen::Index>(k)) = point->transpose();
  }
  const int count = static_cast<int>(targets.size());
  const auto lists = reader.attributes(instance, "B_SPLINE_CURVE_WITH_KNOTS", attributes_of_curve, 2);
  if (listed && lists.empty()) return reader.error(instance, "it has no knots");
  std::vector<double> weights;
  if (reader.is(instance, "RATIONAL_B_SPLINE_CURVE")) {
    const auto rational = reader.attributes(instance, "RATIONAL_B_SPLINE_CURVE", attributes_of_curve, 1);
    if (rational.empty() || !reader.is_list(rational[0])) return reader.error(instance, "it has no weights");
    for (const auto k : reader.file().children(rational[0])) {
      weights.push_back(reader.real(k).value_or(std::numeric_limits<double>::quiet_NaN()));
    }
  }
  const auto listed_knots = [&]() -> Expected<KnotVector> {
    auto list = read_knot_list(reader, instance, *degree, count, lists[0], lists[1], "");
    if (!list) return std::unexpected(std::move(list.error()));
    leave_out_empty(static_cast<std::size_t>(*degree), *list, points, weights);
    return knots_of_list(reader, instance, *degree, *std::move(list), "");
  };
  auto knots = listed ? listed_knots() : implied_knots(*form, *degree, count);
  if (!knots) return std::unexpected(std::move(knots.error()));
  return Curve::create({*std::move(knots)}, std::move(points), std::move(weights));
}

std::optional<Points> sample_edge(const Reader& reader, std::uint32_t edge) {
  // EDGE(start, end) and EDGE_CURVE(geometry, same_sense).
  if (!reader.is(edge, "EDGE_CURVE")) return std::nullopt;
  const auto first = reference_at(reader, edge, "EDGE", 1, 0);
  const auto last = reference_at(reader, edge, "EDGE", 1, 1);
  const auto own = reader.attributes(edge, "EDGE_CURVE", 3, 2);
  const auto geometry = own.empty() ? std::nullopt : reader.reference(own[0]);
  if (!first || !last || !geometry) return std::nullopt;
  const auto start = vertex_point(reader, *first);
  const auto end = vertex_point(reader, *last);
  if (!start || !end) return std::nullopt;
  const bool same_sense = reader.enumeration(own[1]) != "F";
  return sample_curve(reader, *geometry, same_sense ? Ends{*start, *end} : Ends{*end, *start}, 0);
}

Expected<CurveTable> CurveTable::create(Curve curve) {
  CurveTable result(std::move(curve));
  const auto& knots = result.curve_.knots(0);
  const auto spans = knots.spans();
  const int per_span = std::max(knots.degree() + 1, spans.size() > 64 ? 4 : 8);
  for (const int s : spans) {
    for (int k = 0; k < per_span; ++k) {
      const double t = static_cast<double>(k) / per_span;
      result.parameters_.push_back(std::clamp((1 - t) * knots[s] + t * knots[s + 1], knots[s], knots[s + 1]));
    }
  }
  result.parameters_.push_back(knots.domain().upper);
  const Parameters<1> parameters = Eigen::Map<const Eigen::VectorXd>(
      result.parameters_.data(), static_cast<Eigen::Index>(result.parameters_.size()));
  auto evaluation = evaluate<1>(result.curve_, parameters);
  if (!evaluation) return std::unexpected(std::move(evaluation.error()));
  result.points_ = evaluation->points();
  result.lower_ = result.points_.colwise().minCoeff().transpose();
  result.upper_ = result.points_.colwise().maxCoeff().transpose();
  for (Eigen::Index k = 1; k < result.points_.rows(); ++k) {
    result.longest_chord_ = std::max(result.longest_chord_, (result.points_.row(k) - result.points_.row(k - 1)).norm());
  }
  return result;
}

/// The curve and its first two derivatives; none where a denominator is not positive. Nothing is allocated: this is
/// asked several times for every point of every edge of a file.
std::optional<std::array<Point, 3>> CurveTable::jet(double t) const {
  const KnotVector& knots = curve_.knots(0);
  const auto p = static_cast<std::size_t>(knots.degree());
  const int span = knots.find_span(t);
  std::array<double, 3 * (max_degree + 1)> basis;
  basis_derivatives(knots, span, t, 2, basis.data());
  const double* const points = curve_.control_points().data() + 3 * (span - knots.degree());
  std::array<Point, 3> result;
  std::array<double, 3> weight{};
  for (std::size_t d = 0; d < 3; ++d) {
    double sum[3] = {0, 0, 0};
    for (std::size_t r = 0; r <= p; ++r) {
      double n = basis[d * (p + 1) + r];
      if (curve_.rational()) n *= curve_.weights()[static_cast<std::size_t>(span) - p + r];
      weight[d] += n;
      for (std::size_t c = 0; c < 3; ++c) sum[c] += n * points[3 * r + c];
    }
    result[d] = Point(sum[0], sum[1], sum[2]);
  }
  if (!curve_.rational()) return result;
  if (!(weight[0] > 0)) return std::nullopt;
  result[0] /= weight[0];
  result[1] = (result[1] - weight[1] * result[0]) / weight[0];
  result[2] = (result[2] - 2 * weight[1] * result[1] - weight[2] * result[0]) / weight[0];
  return result;
}

/// By Newton's iteration from the k-th tabulated point, between its neighbours, if that improves the foot.
void CurveTable::descend(const Point& point, Eigen::Index k, Foot& foot) const {
  const double lower = parameters_[static_cast<std::size_t>(std::max<Eigen::Index>(k - 1, 0))];
  const double upper = parameters_[static_cast<std::size_t>(std::min<Eigen::Index>(k + 1, points_.rows() - 1))];
  double t = parameters_[static_cast<std::size_t>(k)];
  for (int iteration = 0; iteration < 10; ++iteration) {
    const auto value = jet(t);
    if (!value) return;
    const auto& [place, first, second] = *value;
    const Point offset = place - point;
    if (offset.norm() < foot.distance) foot = {t, offset.norm()};
    // Newton on (S - P)·S' where the distance is convex, Gauss-Newton elsewhere.
    const double slope = first.squaredNorm();
    const double curvature = slope + offset.dot(second);
    const double divisor = curvature > 0 ? curvature : slope;
    if (!(divisor > 0)) return;
    const double next = std::clamp(t - offset.dot(first) / divisor, lower, upper);
    if (std::abs(next - t) <= 1e-9 * (upper - lower)) return;
    t = next;
  }
}

CurveTable::Foot CurveTable::closest(const Point& point, double limit) const {
  const double outside = (lower_ - point).cwiseMax(point - upper_).cwiseMax(0).norm();
  if (outside - 2 * longest_chord_ > limit) return {parameters_.front(), outside};
  const Eigen::Index size = points_.rows();
  const auto squared = [&](Eigen::Index k) {
    const double* p = points_.data() + 3 * k;
    const double x = p[0] - point[0], y = p[1] - point[1], z = p[2] - point[2];
    return x * x + y * y + z * z;
  };
  double least = squared(0);
  Eigen::Index best = 0;
  for (Eigen::Index k = 1; k < size; ++k) {
    const double here = squared(k);
    if (here < least) std::tie(least, best) = std::pair(here, k);
  }
  Foot foot{parameters_[static_cast<std::size_t>(best)], std::sqrt(least)};
  // The foot may lie next to any tabulated local minimum whose chords allow a smaller distance.
  const double infinity = std::numeric_limits<double>::infinity();
  double before = infinity, here = squared(0);
  for (Eigen::Index k = 0; k < size; ++k) {
    const double after = k + 1 < size ? squared(k + 1) : infinity;
    if (before >= here && after >= here) {
      const Eigen::Index left = std::max<Eigen::Index>(k - 1, 0), right = std::min<Eigen::Index>(k + 1, size - 1);
      const double reach =
          std::max((points_.row(k) - points_.row(left)).norm(), (points_.row(k) - points_.row(right)).norm());
      if (std::sqrt(here) - 2 * reach <= std::min(foot.distance, limit)) descend(point, k, foot);
    }
    before = here;
    here = after;
  }
  return foot;
}

bool CurveTable::closed(double tolerance) const {
  return (points_.row(0) - points_.row(points_.rows() - 1)).norm() <= tolerance;
}

}  // namespace knead::step
