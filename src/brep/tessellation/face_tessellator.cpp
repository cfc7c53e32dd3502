#include "face_tessellator.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_set>

#include "brep/boundary_curve.hpp"
#include "brep/face_region.hpp"
#include "brep/surfaces/spline_face.hpp"
#include "knead/brep/model.hpp"
#include "triangulate.hpp"

namespace knead::brep {

using Eigen::Vector2d;

namespace {

constexpr double clearance = 0.35;    // of interior points from the outline, in steps
constexpr double most_inside = 1e6;   // points
constexpr double most_pieces = 1000;  // of a chord
constexpr int most_rounds = 6;  // of adding points where triangles are too far from the surface
constexpr int most_edge_halvings = 8;  // of the chords round a face
constexpr std::size_t most_edge_chords = 4000,
                      most_tried_chords = 100'000;  // then: their cost is quadratic
// Of the extent of the face: points that are added beside its edges.
constexpr double same_place = 1e-7;

double distance_to_segment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d side = b - a;
  const double length = side.squaredNorm();
  const double share = length > 0 ? std::clamp((p - a).dot(side) / length, 0.0, 1.0) : 0;
  return (a + share * side - p).norm();
}

// At the midpoint of every whole step across a straight direction.
std::optional<std::vector<Vector2d>> points_between(std::span<const std::vector<Vector2d>> loops,
                                                    int straight) {
  std::vector<Vector2d> result;
  const int across = 1 - straight;
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;
  for (const auto& loop : loops) {
    for (const Vector2d& p : loop) {
      lower = std::min(lower, p[across]);
      upper = std::max(upper, p[across]);
    }
  }
  if (upper - lower > most_inside) return std::nullopt;
  for (double x = std::floor(lower) + 0.5; x < upper; ++x) {
    std::vector<double> crossings;
    for (const auto& loop : loops) {
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vector2d &a = loop[k], &b = loop[(k + 1) % loop.size()];
        if ((a[across] > x) == (b[across] > x)) continue;
        crossings.push_back(a[straight] + (b[straight] - a[straight]) * (x - a[across]) /
                                              (b[across] - a[across]));
      }
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
      if (!(crossings[k + 1] - crossings[k] > 1e-3)) continue;
      Vector2d& p = result.emplace_back();
      p[across] = x;
      p[straight] = (crossings[k] + crossings[k + 1]) / 2;
    }
  }
  return result;
}

// Whether some triangle spans more steps than chords of one step allow.
bool too_wide(std::span<const std::vector<Vector2d>> loops, std::span<const Triangle> triangles,
              int across) {
  std::vector<double> places;
  for (const auto& loop : loops) {
    for (const Vector2d& p : loop) places.push_back(p[across]);
  }
  return std::any_of(triangles.begin(), triangles.end(), [&](const Triangle& t) {
    const auto [least, most] = std::minmax({places[t[0]], places[t[1]], places[t[2]]});
    return most - least > 1.5;
  });
}

// Whole steps within the loops, row by row, every other row backwards.
std::optional<std::vector<Vector2d>> points_inside(std::span<const std::vector<Vector2d>> loops) {
  std::vector<std::pair<Vector2d, Vector2d>> sides;
  double lower = std::numeric_limits<double>::infinity(), upper = -lower, left = lower,
         right = -lower;
  for (const auto& loop : loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      sides.emplace_back(loop[k], loop[(k + 1) % loop.size()]);
      lower = std::min(lower, loop[k].y());
      upper = std::max(upper, loop[k].y());
      left = std::min(left, loop[k].x());
      right = std::max(right, loop[k].x());
    }
  }
  std::vector<Vector2d> result;
  if ((upper - lower) * (right - left) > most_inside) return std::nullopt;
  for (double y = std::ceil(lower); y <= upper; ++y) {
    std::vector<double> crossings;
    std::vector<std::pair<Vector2d, Vector2d>> near;
    for (const auto& [a, b] : sides) {
      if ((a.y() > y) != (b.y() > y))
        crossings.push_back(a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()));
      if (std::min(a.y(), b.y()) < y + clearance && std::max(a.y(), b.y()) > y - clearance)
        near.emplace_back(a, b);
    }
    std::sort(crossings.begin(), crossings.end());
    const auto begin = result.size();
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
      for (double x = std::ceil(crossings[k]); x <= crossings[k + 1]; ++x) {
        const bool free = std::all_of(near.begin(), near.end(), [&](const auto& side) {
          return distance_to_segment({x, y}, side.first, side.second) >= clearance;
        });
        if (free) result.emplace_back(x, y);
      }
    }
    if (std::lround(y) % 2 != 0)
      std::reverse(result.begin() + static_cast<std::ptrdiff_t>(begin), result.end());
  }
  return result;
}

// Points added on both sides of a cut, and those at a pole, take the place of the first one there:
// they were evaluated at other parameters, and differ by rounding.
void weld(std::vector<Point>& points, std::uint32_t first,
          const std::vector<std::uint32_t>& added) {
  Eigen::AlignedBox3d box;
  for (auto k = first; k < points.size(); ++k) box.extend(points[k]);
  const double near = same_place * box.diagonal().norm();
  for (const auto k : added) {
    const auto begin = points.begin() + first;
    const auto same = std::find_if(begin, points.end(),
                                   [&](const Point& p) { return (p - points[k]).norm() <= near; });
    points[k] = *same;
  }
}

}  // namespace

Expected<void> FaceTessellator::legible(const Face& face) {
  const auto loops = edges_.loops(face);
  if (!loops) return std::unexpected(loops.error());
  if (const SplineSurface* spline_surface = model_.spline_under(face)) {
    return check_extent(model_, face, *loops,
                        net_diagonal(spline_surface->surface.control_points()));
  }
  const auto surface = FaceSurface::under(model_, face, *loops);
  return surface ? Expected<void>() : std::unexpected(surface.error());
}

Expected<std::unique_ptr<ChartedSurface>> FaceTessellator::surface_of(
    const Face& face, const std::vector<Loop>& loops) {
  if (const SplineSurface* spline_surface = model_.spline_under(face)) {
    const double size = net_diagonal(spline_surface->surface.control_points());
    if (auto checked = check_extent(model_, face, loops, size); !checked)
      return std::unexpected(checked.error());
    auto spline = SplineFace::create(spline_surface->surface);
    if (!spline) return model_.error(face, spline.error().what);
    return std::make_unique<SplineFace>(*std::move(spline));
  }
  auto surface = FaceSurface::under(model_, face, loops);
  if (!surface) return std::unexpected(std::move(surface.error()));
  return std::make_unique<FaceSurface>(*std::move(surface));
}

Expected<FaceOnSurface> FaceTessellator::face_on_surface(const Face& face) {
  const auto loops = edges_.loops(face);
  if (!loops) return std::unexpected(loops.error());
  auto surface = surface_of(face, *loops);
  if (!surface) return std::unexpected(std::move(surface.error()));
  (*surface)->set_steps(chord_);
  return FaceOnSurface{&face, *std::move(surface)};
}

Expected<void> FaceTessellator::divide_edges(const FaceOnSurface& on) {
  const auto straight = on.surface->straight();
  if (on.surface->plane()) return {};
  const ParameterSpace space = on.surface->space();
  const auto edges = edges_around(*on.face);
  for (const auto edge : std::set<Index>(edges.begin(), edges.end())) {
    const auto points = edges_.edge(edge);
    if (!points) return std::unexpected(points.error());
    const std::vector<Foot> feet = on.surface->feet(**points);
    std::vector<int> pieces;
    for (std::size_t k = 0; k + 1 < feet.size(); ++k) {
      Vector2d to = feet[k + 1].parameters;
      for (int d = 0; d < 2; ++d) {
        const double period = space.periods[static_cast<std::size_t>(d)];
        if (period > 0) to[d] -= period * std::round((to[d] - feet[k].parameters[d]) / period);
      }
      const Vector2d way = on.surface->chart(to) - on.surface->chart(feet[k].parameters);
      double steps = 0;
      for (std::size_t d = 0; d < 2; ++d) {
        if (straight[d] || feet[k].free[d] || feet[k + 1].free[d]) continue;
        steps = std::max(steps, std::abs(way[static_cast<Eigen::Index>(d)]));
      }
      pieces.push_back(static_cast<int>(std::clamp(std::ceil(steps - 1e-6), 1.0, most_pieces)));
    }
    if (auto status = edges_.divide(edge, pieces); !status) return status;
  }
  return {};
}

/// Returns how many chords there are then.
Expected<std::size_t> FaceTessellator::halve_edges(std::span<const Index> edges) {
  std::size_t count = 0;
  for (const auto edge : edges) {
    const auto points = edges_.edge(edge);
    if (!points) return std::unexpected(points.error());
    std::vector<int> pieces;
    for (std::size_t k = 0; k + 1 < (*points)->size(); ++k) {
      pieces.push_back((**points)[k] == (**points)[k + 1] ? 1 : 2);
      count += static_cast<std::size_t>(pieces.back());
    }
    if (auto status = edges_.divide(edge, pieces); !status)
      return std::unexpected(std::move(status.error()));
  }
  return count;
}

/// Halves the chords round a face that cannot be made triangles until it can. False where that does
/// not help: its edges are as they were. `spent` counts the chords that were tried.
bool FaceTessellator::refine_edges(const FaceOnSurface& on, std::size_t& spent) {
  std::vector<Index> edges = edges_around(*on.face);
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<EdgeSampler::Division> before;
  for (const auto edge : edges) {
    auto division = edges_.division(edge);
    if (!division) return false;
    before.push_back(*std::move(division));
  }
  for (int k = 0; k < most_edge_halvings; ++k) {
    const auto chords = halve_edges(edges);
    if (!chords || *chords > most_edge_chords || spent + *chords > most_tried_chords) break;
    spent += *chords;
    if (mesh(on)) return true;
  }
  for (std::size_t k = 0; k < edges.size(); ++k) edges_.restore(edges[k], std::move(before[k]));
  return false;
}

std::vector<Expected<FaceMesh>> FaceTessellator::meshes(std::span<const FaceOnSurface> faces) {
  std::vector<Expected<FaceMesh>> result;
  std::unordered_set<Index> finer;  // edges
  std::size_t spent = 0;
  for (const FaceOnSurface& on : faces) {
    result.push_back(mesh(on));
    if (result.back() || !refine_edges(on, spent)) continue;
    for (const auto edge : edges_around(*on.face)) finer.insert(edge);
  }
  for (std::size_t k = 0; k < faces.size() && !finer.empty(); ++k) {
    const auto edges = edges_around(*faces[k].face);
    const auto is_finer = [&](Index edge) { return finer.contains(edge); };
    if (std::ranges::any_of(edges, is_finer)) result[k] = mesh(faces[k]);
  }
  return result;
}

Expected<FaceMesh> FaceTessellator::mesh(const FaceOnSurface& on) {
  const Face& face = *on.face;
  const auto charted = charted_face(model_, face, edges_, on.surface);
  if (!charted) return std::unexpected(charted.error());
  FaceMesh result{face.id, {}, {}, {}, {}};
  if (const SplineSurface* spline = model_.spline_under(face)) result.surface = spline->id;
  for (const RegionPart& part : charted->parts) {
    if (const char* fault = add(part, charted->loops, charted->chart, face.sense(), result)) {
      return model_.error(face, fault);
    }
  }
  return result;
}

/// Triangles within an outline, and the points that were added inside it.
struct FaceTessellator::Filling {
  std::vector<Vector2d> inside;
  std::vector<Triangle> triangles;
};

namespace {

constexpr const char* crossed = "its bounds cross themselves or each other";
constexpr const char* too_many = "it would need more than a million points at this tolerance";

}  // namespace

/// The centres of triangles that are farther from the surface than the limit, along its normal, at
/// their own centre or at that of a side inside. `bounds`: the points of the outline.
std::vector<Vector2d> FaceTessellator::off(const Chart& chart,
                                           std::span<const std::vector<Vector2d>> outline,
                                           std::span<const Point> bounds,
                                           const Filling& filling) const {
  const ChartedSurface& surface = chart.surface();
  std::vector<Vector2d> flat;
  std::vector<std::size_t> next;  // along the outline
  for (const auto& loop : outline) {
    for (std::size_t k = 0; k < loop.size(); ++k)
      next.push_back(flat.size() + (k + 1) % loop.size());
    flat.insert(flat.end(), loop.begin(), loop.end());
  }
  const auto count = flat.size();
  std::vector<Point> inner;
  for (const Vector2d& p : filling.inside) inner.push_back(surface.at(chart.from(p)));
  const auto place = [&](std::uint32_t k) {
    return k < count ? flat[k] : filling.inside[k - count];
  };
  const auto point = [&](std::uint32_t k) { return k < count ? bounds[k] : inner[k - count]; };
  const auto far = [&](const Vector2d& at, const Point& p) {
    const Vector2d uv = chart.from(at);
    return std::abs((surface.at(uv) - p).dot(surface.normal(uv))) > chord_.length;
  };
  std::vector<Vector2d> result;
  for (const Triangle& t : filling.triangles) {
    const std::array<Vector2d, 3> at = {place(t[0]), place(t[1]), place(t[2])};
    const std::array<Point, 3> p = {point(t[0]), point(t[1]), point(t[2])};
    if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) continue;
    const Vector2d centre = (at[0] + at[1] + at[2]) / 3;
    bool found = far(centre, (p[0] + p[1] + p[2]) / 3);
    for (std::size_t k = 0; k < 3 && !found; ++k) {
      const std::size_t l = (k + 1) % 3;
      const bool bound = t[k] < count && t[l] < count && (next[t[k]] == t[l] || next[t[l]] == t[k]);
      found = !bound && far((at[k] + at[l]) / 2, (p[k] + p[l]) / 2);
    }
    if (found) result.push_back(centre);
  }
  return result;
}

std::expected<FaceTessellator::Filling, const char*> FaceTessellator::fill(
    const Chart& chart, std::span<const std::vector<Vector2d>> outline,
    std::span<const Point> bounds) const {
  const ChartedSurface& surface = chart.surface();
  const auto straight = surface.straight();
  Filling result;
  const auto complete = [&](std::optional<std::vector<Vector2d>> inside) -> const char* {
    if (!inside || static_cast<double>(inside->size()) > most_inside) return too_many;
    auto triangles = triangulate(outline, *inside);
    if (!triangles) return crossed;
    result = {*std::move(inside), *std::move(triangles)};
    return nullptr;
  };
  // Where the surface is straight in one direction, points on the outline usually suffice.
  const char* fault =
      complete(straight[0] || straight[1] ? std::vector<Vector2d>() : points_inside(outline));
  if (fault == nullptr && straight[0] != straight[1] &&
      too_wide(outline, result.triangles, straight[0] ? 1 : 0)) {
    fault = complete(points_between(outline, straight[0] ? 0 : 1));
  }
  const bool measured = std::isfinite(chord_.length) && !surface.plane();
  for (int round = 0; measured && fault == nullptr && round < most_rounds; ++round) {
    const auto more = off(chart, outline, bounds, result);
    if (more.empty()) break;
    auto inside = result.inside;
    inside.insert(inside.end(), more.begin(), more.end());
    fault = complete(std::move(inside));
  }
  if (fault != nullptr) return std::unexpected(fault);
  return result;
}

/// None, or why not.
const char* FaceTessellator::add(const RegionPart& part, const std::vector<Loop>& loops,
                                 const Chart& chart, int sense, FaceMesh& mesh) const {
  const ChartedSurface& surface = chart.surface();
  std::vector<std::vector<Vector2d>> outline;
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  const auto append = [&](const Vector2d& at, const Point& point) {
    mesh.points.push_back(point);
    mesh.normals.push_back(sense * surface.normal(chart.from(at)));
  };
  std::vector<std::uint32_t> added;  // points on cuts and at poles
  const auto outline_of = [&](const std::vector<RegionPoint>& polygon) {
    auto& flat = outline.emplace_back();
    for (const RegionPoint& p : polygon) {
      if (p.loop < 0) added.push_back(static_cast<std::uint32_t>(mesh.points.size()));
      flat.push_back(p.at);
      append(p.at, p.loop < 0 ? surface.at(chart.from(p.at))
                              : loops[std::size_t(p.loop)][std::size_t(p.index)]);
    }
  };
  outline_of(part.outer);
  for (const auto& hole : part.holes) outline_of(hole);
  weld(mesh.points, first, added);
  const auto filling = fill(chart, outline, std::span(mesh.points).subspan(first));
  if (!filling) return filling.error();
  for (const Vector2d& p : filling->inside) append(p, surface.at(chart.from(p)));
  for (Triangle t : filling->triangles) {
    for (auto& k : t) k += first;
    const Point &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    if (a == b || b == c || c == a) continue;  // at a pole
    if (sense < 0) std::swap(t[1], t[2]);
    mesh.triangles.push_back(t);
  }
  return nullptr;
}

}  // namespace knead::brep
