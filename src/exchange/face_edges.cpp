#include "knead/exchange/face_edges.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "face_region.hpp"
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

Expected<VisibleRegion> visible_region(const step::File& file, const std::string& surface) {
  const step::File::Data& data = file.data();
  const auto index = data.surface_index.find(surface);
  if (index == data.surface_index.end()) return input_error("there is no such surface", surface);
  const std::size_t k = index->second;
  const Reader reader(data.records);
  const double size = net_diagonal((*data.surfaces)[k].surface.control_points());
  const auto feet = SurfaceFoot::create((*data.surfaces)[k].surface);
  if (!feet) return std::unexpected(feet.error());

  VisibleRegion result;
  result.uncertainty = uncertainties_of(reader, {data.surface_instances[k]}).front();
  for (std::size_t d = 0; d < 2; ++d) {
    result.closed[d] = feet->space().periods[d] > 0;
    for (std::size_t end = 0; end < 2; ++end) result.poles[d][end] = feet->space().poles[d][end].has_value();
  }
  const auto shells = faces_in_shells(reader);
  EdgeSampler sampler(reader, {edge_chord});
  Course course(*feet, size);
  std::map<std::uint32_t, std::size_t> known;                    // edges of the result, by instance
  std::map<std::uint32_t, std::vector<std::uint32_t>> faces_at;  // of every edge
  std::map<std::uint32_t, std::uint32_t> surface_of;             // of every face
  for (const Face& face : read_faces(reader)) {
    const auto edges = edges_around(reader, face);
    surface_of[face.instance] = face.surface;
    for (const auto edge : edges) faces_at[edge].push_back(face.instance);
    if (face.surface != data.surface_instances[k]) continue;
    result.in_shell = result.in_shell || shells.contains(face.instance);
    if ((*data.surfaces)[k].trimmed) {
      auto parts = region_of(reader, face, sampler, *feet, size);
      if (!parts) return std::unexpected(parts.error());
      for (const RegionPart& part : *parts) add_turns(part, feet->space(), result.faces);
    }
    for (const auto edge : edges) {
      if (known.contains(edge)) continue;
      const auto points = sampler.edge(edge);
      if (!points) return std::unexpected(points.error());
      known.emplace(edge, result.edges.size());
      TrimEdge& made = result.edges.emplace_back(course.follow(**points));
      made.id = name_of(reader, edge);
    }
  }
  for (const auto& [edge, at] : known) {
    TrimEdge& made = result.edges[at];
    const auto& around = faces_at[edge];
    std::set<std::uint32_t> others;
    for (const auto face : around) {
      made.seam = made.seam || std::ranges::count(around, face) > 1;
      others.insert(face);
    }
    for (const auto face : others) {
      made.neighbours.push_back(name_of(reader, face));
      made.supports.push_back(surface_of[face] == no_instance ? "no surface" : reader.label(surface_of[face]));
    }
  }
  return result;
}

}  // namespace knead
