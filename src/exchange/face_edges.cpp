#include "knead/exchange/face_edges.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "face_region.hpp"
#include "knead/spline/evaluate.hpp"
#include "step_data.hpp"
#include "step_faces.hpp"
#include "step_surfaces.hpp"
#include "step_units.hpp"

namespace knead {

using namespace step;
namespace {

using Eigen::Vector2d;

constexpr double edge_chord = 2e-4;  // of edges in space
constexpr double straight = 2e-4;    // of an edge's extent: how far a chord may be from its course
constexpr int max_halvings = 7;

/// All of a surface, within its sides.
VisibleRegion within_sides(const Surface& surface, const ParameterSpace& space) {
  constexpr int chords = 4;  // of a side, per span
  VisibleRegion result;
  for (std::size_t d = 0; d < 2; ++d) {
    result.closed[d] = space.periods[d] > 0;
    for (std::size_t end = 0; end < 2; ++end) result.poles[d][end] = space.poles[d][end].has_value();
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
          append((along[span] + (along[span + 1] - along[span]) * k / chords - domain.lower) / domain.length());
        }
      }
      append(1);
      result.edges.push_back(std::move(side));
    }
  }
  return result;
}

/// Faces that belong to a shell.
std::set<std::uint32_t> faces_in_shells(const Reader& reader) {
  std::set<std::uint32_t> result;
  for (const auto k : reader.file().named({"CLOSED_SHELL", "OPEN_SHELL"})) {
    const auto own = reader.attributes(k, "CONNECTED_FACE_SET", 1, 1);
    if (own.empty()) continue;
    for (const auto face : reader.references(own[0])) result.insert(face);
  }
  return result;
}

/// Follows edges over a surface.
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
  void halve(TrimEdge& edge, const Point& p, const Vector2d& a, const Point& q, const Vector2d& b, int depth) {
    const Point middle = 0.5 * (p + q);
    // The midpoint of a chord is not on the surface, and where two sides of the surface are close together, as at the
    // trailing edge of a blade, the other side may be nearer.
    LoopPoint m = foot(middle, LoopPoint{0.5 * (a + b)}, near_ + 0.1 * (q - p).norm());
    if (m.free[0] || m.free[1]) return;
    unwrap(m.at, a);
    const double off = (m.at - 0.5 * (a + b)).cwiseAbs().maxCoeff();
    if (off <= straight * extent_ || depth == max_halvings) {
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

/// The faces of a file by surface and by edge: one pass over it.
struct VisibleRegions::Faces {
  explicit Faces(const step::File& of)
      : file(of), reader(of.data().records), shells(faces_in_shells(reader)), faces(read_faces(reader)) {
    const step::File::Data& data = file.data();
    for (std::size_t k = 0; k < faces.size(); ++k) {
      edges.push_back(edges_around(reader, faces[k]));
      surface_of[faces[k].instance] = faces[k].surface;
      on_surface[faces[k].surface].push_back(k);
      for (const auto edge : edges.back()) around[edge].push_back(faces[k].instance);
    }
    uncertainties = uncertainties_of(reader, data.surface_instances);
  }

  Expected<VisibleRegion> of(std::size_t k) const;
  void tell_neighbours(std::uint32_t edge, TrimEdge& made) const;

  step::File file;
  Reader reader;
  std::set<std::uint32_t> shells;  // faces in one
  std::vector<Face> faces;
  std::vector<std::vector<std::uint32_t>> edges;      // of every face
  std::map<std::uint32_t, std::uint32_t> surface_of;  // of every face, by instance
  std::map<std::uint32_t, std::vector<std::size_t>> on_surface;
  std::map<std::uint32_t, std::vector<std::uint32_t>> around;  // faces at every edge
  std::vector<double> uncertainties;                           // of every surface
};

/// Of the surface with this position in the file.
Expected<VisibleRegion> VisibleRegions::Faces::of(std::size_t k) const {
  const step::File::Data& data = file.data();
  const double size = net_diagonal((*data.surfaces)[k].surface.control_points());
  const auto feet = SurfaceFoot::create((*data.surfaces)[k].surface);
  if (!feet) return std::unexpected(feet.error());

  const auto on = on_surface.find(data.surface_instances[k]);
  if (on == on_surface.end()) {
    VisibleRegion bare = within_sides((*data.surfaces)[k].surface, feet->space());
    bare.uncertainty = uncertainties[k];
    return bare;
  }
  VisibleRegion result;
  result.uncertainty = uncertainties[k];
  for (std::size_t d = 0; d < 2; ++d) {
    result.closed[d] = feet->space().periods[d] > 0;
    for (std::size_t end = 0; end < 2; ++end) result.poles[d][end] = feet->space().poles[d][end].has_value();
  }
  EdgeSampler sampler(reader, {edge_chord});
  Course course(*feet, size);
  std::map<std::uint32_t, std::size_t> known;  // edges of the result, by instance
  for (const std::size_t f : on->second) {
    const Face& face = faces[f];
    result.in_shell = result.in_shell || shells.contains(face.instance);
    if ((*data.surfaces)[k].trimmed) {
      auto parts = region_of(reader, face, sampler, *feet, size);
      if (!parts) return std::unexpected(parts.error());
      for (const RegionPart& part : *parts) add_turns(part, feet->space(), result.faces);
    }
    for (const auto edge : edges[f]) {
      if (!known.emplace(edge, result.edges.size()).second) continue;
      const auto points = sampler.edge(edge);
      if (!points) return std::unexpected(points.error());
      TrimEdge& made = result.edges.emplace_back(course.follow(**points));
      made.id = name_of(reader, edge);
    }
  }
  for (const auto& [edge, at] : known) tell_neighbours(edge, result.edges[at]);
  return result;
}

void VisibleRegions::Faces::tell_neighbours(std::uint32_t edge, TrimEdge& made) const {
  const auto& at = around.at(edge);
  std::set<std::uint32_t> others;
  for (const auto face : at) {
    made.seam = made.seam || std::ranges::count(at, face) > 1;
    others.insert(face);
  }
  for (const auto face : others) {
    const std::uint32_t surface = surface_of.at(face);
    made.neighbours.push_back(name_of(reader, face));
    made.supports.push_back(surface == no_instance ? "no surface" : reader.label(surface));
  }
}

VisibleRegions::VisibleRegions(const step::File& file) : faces_(std::make_unique<const Faces>(file)) {}
VisibleRegions::~VisibleRegions() = default;

Expected<VisibleRegion> VisibleRegions::of(const std::string& surface) const {
  const auto& index = faces_->file.data().surface_index;
  const auto found = index.find(surface);
  if (found == index.end()) return input_error("there is no such surface", surface);
  return faces_->of(found->second);
}

Expected<VisibleRegion> region_of_sides(const Surface& surface) {
  const auto feet = SurfaceFoot::create(surface);
  if (!feet) return std::unexpected(feet.error());
  return within_sides(surface, feet->space());
}

Expected<VisibleRegion> visible_region(const step::File& file, const std::string& surface) {
  return VisibleRegions(file).of(surface);
}

}  // namespace knead
