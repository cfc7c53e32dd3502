#include "covered_part.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "brep/tessellation/face_chart.hpp"

namespace knead::brep {
namespace {

using Eigen::Vector2d;

// The exact B-spline form of what faces cover of a plane, cylinder, cone, sphere, torus or swept
// surface. Those are unbounded or closed, and a net is a rectangle of the parameters: the problem
// is to find the smallest that contains all faces and whose ends lie well.
// 1. Edges are followed, and each face is made a region of the parameters (`charted_face`), whose
// extents in u and v are parts that are covered.
// 2. In a closed direction the rectangle begins and ends in the largest gap between these parts;
// where none is left, a whole turn is taken, from a line along which an edge runs.
// 3. An end along which an edge runs is taken as it is, so that the edge becomes a side of the net.
// Any other end is moved outwards by 2 %, as chords lie inside of a curve that bulges.
// 4. At poles the rectangle ends; it neither passes one nor ends a little before it.
constexpr double fine_chord = 2e-4;    // at which edges are followed
constexpr double beyond_edges = 0.02;  // of the extent, where no edge runs along an end
constexpr double least_gap = 0.02;     // of a turn: what is left open is not worth two ends
constexpr double on_line = 1e-7;       // of the size of the faces
constexpr double most_on_line = 1e-4;  // whatever the file's uncertainty
constexpr double parallel = 1e-6;      // sine of the angle between straight edges

/// An edge of the faces, with how often they run along it.
struct CoveredEdge {
  const Loop* points = nullptr;
  int uses = 0;
};

/// What faces and their edges say about one direction of the parameters.
struct Direction {
  double period = 0;
  double tolerance = 0;           // in parameters
  std::vector<Interval> covered;  // by parts of faces
  std::vector<double> seams,
      lines;  // where edges run along it: those on both sides of a face, and the others
};

Interval hull(const std::vector<Interval>& parts) {
  Interval all = parts.front();
  for (const Interval& part : parts)
    all = {std::min(all.lower, part.lower), std::max(all.upper, part.upper)};
  return all;
}

/// The direction of a straight edge to which most others, by length, are parallel or perpendicular.
/// Only of planes, whose axes a file may choose at random: a rectangle along the edges is covered
/// best. O(n²) in the straight edges of one plane.
std::optional<Point> main_direction(const std::vector<CoveredEdge>& edges) {
  std::vector<Point> sides;
  for (const CoveredEdge& edge : edges) {
    if (edge.points->size() == 2) sides.push_back(edge.points->back() - edge.points->front());
  }
  std::optional<Point> best;
  double most = 0;
  for (const Point& side : sides) {
    double length = 0;
    for (const Point& other : sides) {
      const double along = std::abs(side.dot(other)), across = side.cross(other).norm();
      if (std::min(along, across) <= parallel * side.norm() * other.norm()) length += other.norm();
    }
    if (length <= most * (1 + parallel)) continue;
    most = length;
    best = side;
  }
  return best;
}

/// Where the direction d is constant along an edge.
std::optional<double> line_along(const FaceSurface& surface, const Loop& points, int d,
                                 const Direction& direction) {
  std::optional<double> first;
  for (const Point& p : points) {
    const Foot foot = surface.foot(p);
    if (foot.free[std::size_t(d)]) continue;
    double off = foot.parameters[d] - first.value_or(foot.parameters[d]);
    if (direction.period > 0) off -= direction.period * std::round(off / direction.period);
    if (!first) first = foot.parameters[d];
    if (std::abs(off) > direction.tolerance) return std::nullopt;
  }
  return first;
}

/// Whether an edge runs along this parameter.
bool on_a_line(const Direction& direction, double at) {
  const auto near = [&](double line) {
    double off = line - at;
    if (direction.period > 0) off -= direction.period * std::round(off / direction.period);
    return std::abs(off) <= direction.tolerance;
  };
  return std::ranges::any_of(direction.seams, near) || std::ranges::any_of(direction.lines, near);
}

/// The ends of what is covered, or `beyond` farther where no edge runs along them: a curve may
/// bulge between the points at which it was followed.
Interval with_ends(const Direction& direction, Interval covered, double beyond) {
  if (!on_a_line(direction, covered.lower)) covered.lower -= beyond;
  if (!on_a_line(direction, covered.upper)) covered.upper += beyond;
  return covered;
}

/// All but the largest gap between the covered parts; a whole turn where that is small.
/// Parts are brought into one period by their lower ends, sorted, and swept; `reached` begins with
/// what the last parts cover beyond the period. The gap is left out where it is more than 2 % of a
/// turn.
Interval covered_of_turn(const Direction& direction) {
  const double period = direction.period;
  std::vector<Interval> parts;
  double gap = 0, after = 0, before = 0;
  for (const Interval& part : direction.covered) {
    const double shift = period * std::floor(part.lower / period);
    parts.push_back({part.lower - shift, part.upper - shift});
  }
  std::ranges::sort(parts, {}, &Interval::lower);
  double reached = parts.back().upper - period;
  for (const Interval& part : parts) reached = std::max(reached, part.upper - period);
  for (const Interval& part : parts) {
    if (part.lower - reached > gap) {
      gap = part.lower - reached;
      after = part.lower;
      before = reached;
    }
    reached = std::max(reached, part.upper);
  }
  if (gap > least_gap * period) {
    const Interval open{after, before + period};
    // Both ends may take a third of the gap: they must not meet.
    return with_ends(direction, open, std::min(beyond_edges * open.length(), gap / 3));
  }
  double start = 0;
  if (!direction.lines.empty()) start = direction.lines.front();
  if (!direction.seams.empty()) start = direction.seams.front();
  return {start, start + period};
}

Interval covered_of(const Direction& direction) {
  if (direction.period > 0) return covered_of_turn(direction);
  const Interval all = hull(direction.covered);
  return with_ends(direction, all, beyond_edges * all.length());
}

/// The limits of v at poles: none is passed, and one that is reached is met.
Interval within_poles(const Interval& range, const Interval& covered,
                      const std::array<std::optional<double>, 2>& poles, double tolerance) {
  Interval result = range;
  if (poles[0] && result.lower < *poles[0] + tolerance) {
    result.lower =
        covered.lower > *poles[0] + tolerance ? (covered.lower + *poles[0]) / 2 : *poles[0];
  }
  if (poles[1] && result.upper > *poles[1] - tolerance) {
    result.upper =
        covered.upper < *poles[1] - tolerance ? (covered.upper + *poles[1]) / 2 : *poles[1];
  }
  return result;
}

/// Faces on one surface, their edges, and the surface.
class CoveredPart {
 public:
  CoveredPart(const Model& model, std::span<const Face* const> faces)
      : model_(model),
        support_(model.supports[faces.front()->support]),
        faces_(faces),
        sampler_(model, {fine_chord}) {}

  Expected<Surface> spline() {
    if (auto read = read_surface(); !read) return std::unexpected(read.error());
    if (auto cut = cut_open(); !cut) return std::unexpected(cut.error());
    std::array<Interval, 2> range;
    for (int d = 0; d < 2; ++d) {
      const Direction& direction = directions_[std::size_t(d)];
      const auto whole = surface_->whole()[std::size_t(d)];
      range[std::size_t(d)] = whole ? *whole : covered_of(direction);
      if (!(range[std::size_t(d)].length() > 0)) return error("the faces on it cover no area");
    }
    if (!surface_->whole()[1] && !(directions_[1].period > 0)) {
      range[1] = within_poles(range[1], hull(directions_[1].covered), surface_->poles(),
                              directions_[1].tolerance);
    }
    auto made = surface_->patch(range[0], range[1]);
    if (!made) return error(made.error().what);
    return made;
  }

 private:
  std::unexpected<Error> error(std::string what) const {
    return model_.error(support_, std::move(what),
                        "it stays as it is: hold the edges of its faces");
  }

  Expected<void> read_surface() {
    std::map<Index, CoveredEdge> edges;
    for (const Face* face : faces_) {
      for (const Index edge : edges_around(*face)) {
        const auto points = sampler_.edge(edge);
        if (!points) return std::unexpected(points.error());
        auto& known = edges[edge];
        known.points = *points;
        ++known.uses;
      }
    }
    for (const auto& [instance, edge] : edges) {
      edges_.push_back(edge);
      points_.insert(points_.end(), edge.points->begin(), edge.points->end());
    }
    auto surface = FaceSurface::create(model_, support_, points_);
    if (!surface)
      return error("it has no exact B-spline form that is known here: " + surface.error().what);
    if (surface->turned()) return error("its swept curve is trimmed against its own direction");
    if (const auto direction = main_direction(edges_)) surface->align(*direction);
    surface_ = *std::move(surface);
    return {};
  }

  /// What is covered, and along which lines edges run.
  Expected<void> cut_open() {
    for (const Face* face : faces_) {
      const auto loops = sampler_.loops(*face);
      auto read =
          loops ? FaceSurface::under(model_, *face, *loops) : std::unexpected(loops.error());
      if (!read) return std::unexpected(read.error());
      read->set_steps({fine_chord});
      const auto charted = charted_face(model_, *face, sampler_,
                                        std::make_shared<const FaceSurface>(*std::move(read)));
      if (!charted) return std::unexpected(charted.error());
      for (const RegionPart& part : charted->parts) add(part, charted->chart);
    }
    Eigen::AlignedBox3d box;
    for (const Point& p : points_) box.extend(p);
    const double size = points_.empty() ? 0 : box.diagonal().norm();
    // The file's uncertainty, a length, divided by the largest |∂S| becomes one of parameters.
    const double near = std::clamp(support_.uncertainty, on_line * size, most_on_line * size);
    for (int d = 0; d < 2; ++d) {
      Direction& direction = directions_[std::size_t(d)];
      if (direction.covered.empty()) return error("the faces on it cover no area");
      direction.period = surface_->periods()[std::size_t(d)];
      const double speed = speed_along(d);
      if (speed > 0) direction.tolerance = near / speed;
      for (const CoveredEdge& edge : edges_) {
        const auto line = line_along(*surface_, *edge.points, d, direction);
        if (line)
          // An edge that one face uses twice is the seam of a closed surface: the best place to cut
          // it open.
          (edge.uses > 1 && faces_.size() == 1 ? direction.seams : direction.lines)
              .push_back(*line);
      }
    }
    return {};
  }

  void add(const RegionPart& part, const Chart& chart) {
    Vector2d lower = Vector2d::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
    for (const RegionPoint& p : part.outer) {
      Vector2d at = chart.from(p.at);
      if (surface_->plane())
        at = surface_->foot(chart.surface().at(at)).parameters;  // it may have been aligned
      lower = lower.cwiseMin(at);
      upper = upper.cwiseMax(at);
    }
    for (int d = 0; d < 2; ++d) directions_[std::size_t(d)].covered.push_back({lower[d], upper[d]});
  }

  /// Largest |∂S| in one direction at the points of the edges.
  double speed_along(int d) const {
    double speed = 0;
    for (const Point& p : points_) {
      const Vector2d at = surface_->foot(p).parameters;
      const auto& covered = directions_[std::size_t(d)].covered.front();
      Vector2d step = Vector2d::Zero();
      step[d] = 1e-4 * covered.length();
      if (!(step[d] > 0)) continue;
      speed = std::max(speed, (surface_->at(at + step) - surface_->at(at)).norm() / step[d]);
    }
    return speed;
  }

  const Model& model_;
  const Support& support_;
  std::span<const Face* const> faces_;
  EdgeSampler sampler_;
  std::vector<CoveredEdge> edges_;
  std::vector<Point> points_;
  std::optional<FaceSurface> surface_;
  std::array<Direction, 2> directions_;
};

}  // namespace

Expected<Surface> spline_of_faces(const Model& model, std::span<const Face* const> faces) {
  return CoveredPart(model, faces).spline();
}

}  // namespace knead::brep
