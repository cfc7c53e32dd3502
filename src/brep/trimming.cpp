#include "trimming.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel_for.hpp"
#include "boundary_curve.hpp"
#include "curve_table.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::brep {
namespace {

// One of the four boundary isocurves, and how much of it the edges of a face cover.
// Whether a face shows all of its surface: each of its edges lies on the boundary of the domain,
// and together they cover all four sides that are neither seams nor points. Compared in space, by
// sampled points against the boundary's isocurves, since parameter curves are often missing. The
// tolerance is twice the file's uncertainty (edge and vertex may each be off by one), bounded from
// below by 1e-5 and from above by 1e-4 of the surface's size: what differs less is a smaller error
// than taking a whole surface for a trimmed one, with all of its holds.
struct BoundarySide {
  CurveTable table;
  bool required = false;  // to be covered: neither a seam nor a single point
  bool closed = false;
  std::vector<Interval> covered = {};
};

class NaturalBoundary {
 public:
  static std::optional<NaturalBoundary> create(const Surface& surface, double tolerance) {
    NaturalBoundary result;
    result.tolerance_ = tolerance;
    for (int direction = 0; direction < 2; ++direction) {
      for (int end = 0; end < 2; ++end) {
        auto curve = boundary_curve(surface, direction, end);
        auto table = curve ? CurveTable::create(*std::move(curve))
                           : Expected<CurveTable>(std::unexpected(curve.error()));
        if (!table) return std::nullopt;
        BoundarySide side{*std::move(table)};
        side.required = net_diagonal(side.table.points()) > tolerance;
        side.closed = side.table.closed(tolerance);
        result.sides_.push_back(std::move(side));
      }
      auto& first = result.sides_[result.sides_.size() - 2];
      auto& last = result.sides_.back();
      if ((first.table.points() - last.table.points()).rowwise().norm().maxCoeff() <= tolerance) {
        first.required = last.required = false;  // a seam
      }
    }
    return result;
  }

  void begin_face() {
    for (auto& side : sides_) side.covered.clear();
  }

  // False if some point lies off the boundary.
  bool add(const Points& edge) {
    std::vector<std::optional<double>> before(sides_.size());
    for (Eigen::Index k = 0; k < edge.rows(); ++k) {
      bool on = false;
      for (std::size_t s = 0; s < sides_.size(); ++s) {
        // Two consecutive points on one side cover the interval between their parameters. A point
        // at a corner is on two sides, so that both intervals begin there.
        const auto foot = sides_[s].table.closest(edge.row(k).transpose(), tolerance_);
        const auto now = foot.distance <= tolerance_ ? std::optional(foot.parameter) : std::nullopt;
        on = on || now.has_value();
        const auto last = std::exchange(before[s], now);
        if (now && last) cover(sides_[s], *last, *now);
      }
      if (!on) return false;
    }
    return true;
  }

  [[nodiscard]] bool covered() const {
    return std::all_of(sides_.begin(), sides_.end(),
                       [this](const BoundarySide& side) { return !side.required || full(side); });
  }

 private:
  static void cover(BoundarySide& side, double from, double to) {
    const auto domain = side.table.curve().knots(0).domain();
    const auto [lower, upper] = std::minmax(from, to);
    if (side.closed && upper - lower > domain.length() / 2) {
      // Across the start of the closed curve.
      side.covered.push_back({upper, domain.upper});
      side.covered.push_back({domain.lower, lower});
    } else {
      side.covered.push_back({lower, upper});
    }
  }

  // Gaps may be as long as the error of the vertices: twice the tolerance at each end. The chord
  // alone does not decide: that of a whole closed curve is zero.
  [[nodiscard]] bool short_arc(const Curve& curve, double from, double to) const {
    constexpr int pieces = 8;
    for (int k = 1; k <= pieces; ++k) {
      const double t = from + (to - from) * k / pieces;
      const auto a = evaluate_point<1>(curve, {from});
      const auto b = evaluate_point<1>(curve, {std::min(t, to)});
      if (!a || !b || (*a - *b).norm() > 4 * tolerance_) return false;
    }
    return true;
  }

  [[nodiscard]] bool full(const BoundarySide& side) const {
    const auto domain = side.table.curve().knots(0).domain();
    auto covered = side.covered;
    std::sort(covered.begin(), covered.end(),
              [](const Interval& a, const Interval& b) { return a.lower < b.lower; });
    covered.push_back({domain.upper, domain.upper});
    double reached = domain.lower;
    for (const auto& interval : covered) {
      if (interval.lower > reached && !short_arc(side.table.curve(), reached, interval.lower))
        return false;
      reached = std::max(reached, interval.upper);
    }
    return true;
  }

  std::vector<BoundarySide> sides_;
  double tolerance_ = 0;
};

constexpr int samples_per_edge = 17;
constexpr int most_samples = 129;

struct Ends {
  Point start;
  Point end;
};

Points segment(const Point& from, const Point& to) {
  Points result(samples_per_edge, 3);
  for (int k = 0; k < samples_per_edge; ++k) {
    const double t = static_cast<double>(k) / (samples_per_edge - 1);
    result.row(k) = ((1 - t) * from + t * to).transpose();
  }
  return result;
}

// C + a cos t + b sin t.
Points ellipse(const Conic& conic, const Ends& ends) {
  const auto angle = [&](const Point& p) {
    return std::atan2((p - conic.centre).dot(conic.b) / conic.b.squaredNorm(),
                      (p - conic.centre).dot(conic.a) / conic.a.squaredNorm());
  };
  const double from = angle(ends.start);
  double to = angle(ends.end);
  // Counter-clockwise from start to end; the same vertex twice means the whole circle.
  if (to <= from + 1e-9) to += 2 * std::numbers::pi;
  Points result(2 * samples_per_edge, 3);
  for (Eigen::Index k = 0; k < result.rows(); ++k) {
    const double t =
        from + (to - from) * static_cast<double>(k) / static_cast<double>(result.rows() - 1);
    result.row(k) = (conic.centre + std::cos(t) * conic.a + std::sin(t) * conic.b).transpose();
  }
  return result;
}

// Its corners, and the middles between them.
Points polyline(const Curve& curve) {
  const Points& corners = curve.control_points();
  Points result(2 * corners.rows() - 1, 3);
  for (Eigen::Index k = 0; k < corners.rows(); ++k) {
    if (k > 0) result.row(2 * k - 1) = (corners.row(k - 1) + corners.row(k)) / 2;
    result.row(2 * k) = corners.row(k);
  }
  return result;
}

std::optional<Points> spline(const Curve& curve, const Ends& ends) {
  const auto table = CurveTable::create(curve);
  if (!table) return std::nullopt;
  const auto domain = table->curve().knots(0).domain();
  const double size =
      (table->points().colwise().maxCoeff() - table->points().colwise().minCoeff()).norm();
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
      std::min(most_samples,
               samples_per_edge + 4 * static_cast<int>(table->curve().knots(0).spans().size()));
  Parameters<1> parameters(count);
  for (int k = 0; k < count; ++k) {
    double t = from + (to - from) * static_cast<double>(k) / (count - 1);
    if (closed && t > domain.upper) t -= domain.length();
    parameters(k) = std::clamp(t, domain.lower, domain.upper);
  }
  const auto evaluation = evaluate<1>(table->curve(), parameters);
  return evaluation ? std::optional(evaluation->points()) : std::nullopt;
}

// Points along an edge, one per row; their number grows with the spans of its curve. None for
// hyperbolas and parabolas, and for edges that cannot be read.
std::optional<Points> sampled(const Model& model, const Edge& edge) {
  if (edge.wrong || model.vertices[edge.start].wrong || model.vertices[edge.end].wrong)
    return std::nullopt;
  Ends ends{model.vertices[edge.start].place, model.vertices[edge.end].place};
  if (edge.same_sense == edge.curve->turned) std::swap(ends.start, ends.end);
  if (std::holds_alternative<Line>(edge.curve->form)) return segment(ends.start, ends.end);
  if (const auto* conic = std::get_if<Conic>(&edge.curve->form)) {
    return conic->form == Conic::Form::ellipse ? std::optional(ellipse(*conic, ends))
                                               : std::nullopt;
  }
  const Curve& curve = *std::get<std::shared_ptr<const Curve>>(edge.curve->form);
  return edge.curve->polyline ? std::optional(polyline(curve)) : spline(curve, ends);
}

// The bounds of one face; false if they leave the boundary or are of an unknown type.
bool add_bounds(const Model& model, const Face& face, NaturalBoundary& boundary) {
  for (const Bound& bound : face.bounds) {
    if (bound.kind == Bound::Kind::vertex) continue;  // a pole, or a point that bounds nothing
    if (bound.kind != Bound::Kind::edges || bound.wrong) return false;
    for (const EdgeUse& use : bound.edges) {
      const auto points = sampled(model, model.edges[use.edge]);
      if (!points || !boundary.add(*points)) return false;
    }
  }
  return true;
}

// What all faces on one surface make of it.
void use_surface(const Model& model, std::span<const Index> faces, SplineSurface& surface) {
  const double diagonal = net_diagonal(surface.surface.control_points());
  const double tolerance = std::clamp(2 * surface.uncertainty, 1e-5 * diagonal, 1e-4 * diagonal);
  std::optional<NaturalBoundary> boundary;
  surface.faces = static_cast<int>(faces.size());
  for (const Index face : faces) {
    if (surface.trimmed) return;
    if (!boundary) boundary = NaturalBoundary::create(surface.surface, tolerance);
    surface.trimmed = true;
    if (!boundary) continue;  // it cannot be evaluated
    boundary->begin_face();
    surface.trimmed = !add_bounds(model, model.faces[face], *boundary) || !boundary->covered();
  }
}

}  // namespace

// Surfaces are independent, and are looked at in parallel.
void find_trimming(Model& model) {
  constexpr double work_per_surface = 2e5;  // multiplications
  std::vector<std::vector<Index>> faces(model.surfaces.size());
  for (Index f = 0; f < model.faces.size(); ++f) {
    if (model.spline_under(model.faces[f]) == nullptr) continue;
    faces[model.supports[model.faces[f].support].spline].push_back(f);
  }
  const auto count = static_cast<std::ptrdiff_t>(faces.size());
  detail::parallel_for(count, detail::block_size(count, work_per_surface),
                       [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                         for (auto k = static_cast<std::size_t>(begin);
                              k < static_cast<std::size_t>(end); ++k) {
                           if (!faces[k].empty()) use_surface(model, faces[k], model.surfaces[k]);
                         }
                       });
}

}  // namespace knead::brep
