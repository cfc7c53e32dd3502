#include "knead/brep/face_edges.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "boundary_curve.hpp"
#include "face_region.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {

using namespace brep;
namespace {

using Eigen::Vector2d;

// The edges of faces as polygons in the parameters of their surface, with a bound on how far each
// polygon is from its edge. `VisibleRegion` is made of them; holds use the bound to find all spans
// that an edge meets. A file's own parameter curves are not used.
constexpr double edge_chord = 2e-4;  // of edges in space
constexpr double straight = 2e-4;    // of an edge's extent: how far a chord may be from its course
constexpr int max_halvings = 7;

/// All of a surface, within its sides.
VisibleRegion within_sides(const Surface& surface, const ParameterSpace& space) {
  constexpr int chords = 4;  // of a side, per span
  VisibleRegion result;
  for (std::size_t d = 0; d < 2; ++d) {
    result.closed[d] = space.periods[d] > 0;
    for (std::size_t end = 0; end < 2; ++end)
      result.poles[d][end] = space.poles[d][end].has_value();
  }
  for (std::size_t d = 0; d < 2; ++d) {
    const KnotVector& along = surface.knots()[1 - d];
    const Interval domain = along.domain();
    for (std::size_t end = 0; end < 2; ++end) {
      if (result.closed[d] || result.poles[d][end]) continue;
      TrimEdge side;
      side.id = {d == 0 ? 'u' : 'v', end == 0 ? '0' : '1'};
      const auto append = [&](double fraction) {
        Vector2d at;
        at[static_cast<Eigen::Index>(d)] = static_cast<double>(end);
        at[static_cast<Eigen::Index>(1 - d)] = fraction;
        const auto place = evaluate_point<2>(surface, parameters_of(surface, at));
        if (!place) return;
        side.course.push_back(at);
        side.points.push_back(*place);
      };
      for (const int span : along.spans()) {
        for (int k = 0; k < chords; ++k) {
          append((along[span] + (along[span + 1] - along[span]) * k / chords - domain.lower) /
                 domain.length());
        }
      }
      append(1);
      result.edges.push_back(std::move(side));
    }
  }
  return result;
}

/// Follows edges over a surface.
/// Follows the foot of a point along an edge. The foot before is the start of the next search,
/// which keeps to one sheet where others are near, and halves the time; a foot that is farther away
/// than `near` is looked for on all of the surface.
class Course {
 public:
  Course(const SurfaceFoot& feet, double size) : feet_(feet), near_(on_surface * size) {}

  TrimEdge follow(const Loop& points) {
    TrimEdge edge;
    std::vector<LoopPoint> feet;
    for (const Point& p : points) {
      feet.push_back(foot(p, feet.empty() ? std::nullopt : std::optional(feet.back()), near_));
    }
    // At a pole the parameter around it is that of the point before or after.
    for (std::size_t k = 1; k < feet.size(); ++k) settle(feet[k], feet[k - 1]);
    for (std::size_t k = feet.size() - 1; k-- > 0;) settle(feet[k], feet[k + 1]);
    for (std::size_t k = 1; k < feet.size(); ++k) unwrap(feet[k].at, feet[k - 1].at);
    Vector2d lower = feet.front().at, upper = lower;
    for (const LoopPoint& f : feet) {
      lower = lower.cwiseMin(f.at);
      upper = upper.cwiseMax(f.at);
    }
    extent_ = std::max((upper - lower).maxCoeff(), 1e-6);
    edge.deviation = edge_chord * extent_;
    append(edge, points.front(), feet.front().at);
    for (std::size_t k = 1; k < points.size(); ++k) {
      halve(edge, points[k - 1], feet[k - 1].at, points[k], feet[k].at, 0);
      append(edge, points[k], feet[k].at);
    }
    return edge;
  }

 private:
  /// The foot nearest to p; one found from `before` is accepted if it is within `near`.
  LoopPoint foot(const Point& p, const std::optional<LoopPoint>& before, double near) const {
    std::optional<Vector2d> hint;
    if (before && !before->free[0] && !before->free[1]) hint = before->at;
    const auto found = feet_.nearest(p, hint, near).foot;
    return {found.parameters, found.free};
  }
  static void settle(LoopPoint& at, const LoopPoint& next) {
    for (std::size_t d = 0; d < 2; ++d) {
      if (!at.free[d] || next.free[d]) continue;
      at.at[static_cast<Eigen::Index>(d)] = next.at[static_cast<Eigen::Index>(d)];
      at.free[d] = false;
    }
  }
  void unwrap(Vector2d& at, const Vector2d& before) const {
    for (int d = 0; d < 2; ++d) {
      const double period = feet_.space().periods[static_cast<std::size_t>(d)];
      if (period > 0) at[d] += period * std::round((before[d] - at[d]) / period);
    }
  }
  static void append(TrimEdge& edge, const Point& p, const Vector2d& at) {
    edge.points.push_back(p);
    edge.course.push_back(at);
  }
  void halve(TrimEdge& edge, const Point& p, const Vector2d& a, const Point& q, const Vector2d& b,
             int depth) {
    const Point middle = 0.5 * (p + q);
    // The midpoint of a chord is not on the surface, and where two sides of the surface are close
    // together, as at the trailing edge of a blade, the other side may be nearer.
    LoopPoint m = foot(middle, LoopPoint{0.5 * (a + b)}, near_ + 0.1 * (q - p).norm());
    if (m.free[0] || m.free[1]) return;
    unwrap(m.at, a);
    const double off = (m.at - 0.5 * (a + b)).cwiseAbs().maxCoeff();
    if (off <= straight * extent_ || depth == max_halvings) {
      // The polygon's own deviation from the course, at the middle, plus what the chord in space is
      // off the edge.
      edge.deviation = std::max(edge.deviation, off + edge_chord * extent_);
      return;
    }
    halve(edge, p, a, middle, m.at, depth + 1);
    append(edge, middle, m.at);
    halve(edge, middle, m.at, q, b, depth + 1);
  }

  const SurfaceFoot& feet_;
  double near_, extent_ = 0;
};

}  // namespace

/// The faces of a model by surface and by edge: one pass over it.
struct VisibleRegions::Faces {
  explicit Faces(std::shared_ptr<const Model> of)
      : held(std::move(of)), model(*held), on_surface(model.surfaces.size()) {
    for (const Shell& shell : model.shells) in_shell.insert(shell.faces.begin(), shell.faces.end());
    for (Index k = 0; k < model.faces.size(); ++k) {
      const Face& face = model.faces[k];
      edges.push_back(edges_around(face));
      if (model.spline_under(face) != nullptr)
        on_surface[model.supports[face.support].spline].push_back(k);
      for (const Index edge : edges.back()) around[edge].push_back(k);
    }
  }

  Expected<VisibleRegion> of(Index k) const;
  void tell_neighbours(Index edge, TrimEdge& made) const;

  const std::shared_ptr<const Model> held;
  const Model& model;
  std::set<Index> in_shell;                    // faces
  std::vector<std::vector<Index>> edges;       // of every face
  std::vector<std::vector<Index>> on_surface;  // faces, of every B-spline surface
  std::map<Index, std::vector<Index>> around;  // faces at every edge
};

/// Of the surface with this position in the file.
/// Cost: one foot search per point of an edge, which exceeds all else. An edge that a face uses
/// twice, or that several faces on this surface share, is followed once.
Expected<VisibleRegion> VisibleRegions::Faces::of(Index k) const {
  const SplineSurface& surface = model.surfaces[k];
  const double size = net_diagonal(surface.surface.control_points());
  const auto feet = SurfaceFoot::create(surface.surface);
  if (!feet) return std::unexpected(feet.error());

  if (on_surface[k].empty()) {
    VisibleRegion bare = within_sides(surface.surface, feet->space());
    bare.uncertainty = surface.uncertainty;
    return bare;
  }
  VisibleRegion result;
  result.uncertainty = surface.uncertainty;
  for (std::size_t d = 0; d < 2; ++d) {
    result.closed[d] = feet->space().periods[d] > 0;
    for (std::size_t end = 0; end < 2; ++end)
      result.poles[d][end] = feet->space().poles[d][end].has_value();
  }
  EdgeSampler sampler(model, {edge_chord});
  Course course(*feet, size);
  std::map<Index, std::size_t> known;  // edges of the result
  for (const Index f : on_surface[k]) {
    const Face& face = model.faces[f];
    result.in_shell = result.in_shell || in_shell.contains(f);
    if (surface.trimmed) {
      auto parts = region_of(model, face, sampler, *feet, size);
      if (!parts) return std::unexpected(parts.error());
      for (const RegionPart& part : *parts) add_turns(part, feet->space(), result.faces);
    }
    for (const Index edge : edges[f]) {
      if (!known.emplace(edge, result.edges.size()).second) continue;
      const auto points = sampler.edge(edge);
      if (!points) return std::unexpected(points.error());
      TrimEdge& made = result.edges.emplace_back(course.follow(**points));
      made.id = model.edges[edge].id;
    }
  }
  for (const auto& [edge, at] : known) tell_neighbours(edge, result.edges[at]);
  return result;
}

void VisibleRegions::Faces::tell_neighbours(Index edge, TrimEdge& made) const {
  const auto& at = around.at(edge);
  std::set<Index> others;
  for (const Index face : at) {
    made.seam = made.seam || std::ranges::count(at, face) > 1;
    others.insert(face);
  }
  for (const Index face : others) {
    made.neighbours.push_back(model.faces[face].id);
    made.supports.push_back(model.label_under(model.faces[face]));
  }
}

VisibleRegions::VisibleRegions(std::shared_ptr<const Model> model)
    : faces_(std::make_unique<const Faces>(std::move(model))) {}
VisibleRegions::~VisibleRegions() = default;

Expected<VisibleRegion> VisibleRegions::of(const std::string& surface) const {
  const Index found = faces_->model.surface_index(surface);
  if (found == none) return input_error("there is no such surface", surface);
  return faces_->of(found);
}

Expected<VisibleRegion> region_of_sides(const Surface& surface) {
  const auto feet = SurfaceFoot::create(surface);
  if (!feet) return std::unexpected(feet.error());
  return within_sides(surface, feet->space());
}

Expected<VisibleRegion> visible_region(const Model& model, const std::string& surface) {
  return VisibleRegions(std::shared_ptr<const Model>(std::shared_ptr<const Model>(), &model))
      .of(surface);
}

}  // namespace knead
