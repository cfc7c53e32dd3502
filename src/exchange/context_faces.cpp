#include "knead/exchange/context_faces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "face_loops.hpp"
#include "face_surface.hpp"
#include "parameter_region.hpp"
#include "step_data.hpp"
#include "step_faces.hpp"
#include "step_surfaces.hpp"
#include "triangulate.hpp"

namespace knead {

using namespace step;

namespace {

using Eigen::Vector2d;

constexpr double clearance = 0.35;    // of interior points from the outline, in steps
constexpr double off_surface = 0.02;  // of the extent of the face: how far edges may be from its surface
constexpr double most_inside = 1e5;   // points

// Chart coordinates: whole steps where the surface is curved; where it is straight the face is one step long.
class Chart {
 public:
  Chart(const FaceSurface& surface, std::span<const Foot> feet) : surface_(surface) {
    const auto straight = surface.straight();
    Vector2d lower = Vector2d::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
    for (const Foot& foot : feet) {
      const Vector2d c = surface.chart(foot.parameters);
      lower = lower.cwiseMin(c);
      upper = upper.cwiseMax(c);
    }
    if (feet.empty()) return;
    for (int d = 0; d < 2; ++d) {
      const double extent = surface.plane() ? (upper - lower).maxCoeff() : upper[d] - lower[d];
      if (straight[std::size_t(d)] && extent > 0) scale_[d] = 1 / extent;
    }
  }
  Vector2d to(const Vector2d& uv) const { return surface_.chart(uv).cwiseProduct(scale_); }
  Vector2d from(const Vector2d& c) const { return surface_.from_chart(c.cwiseQuotient(scale_)); }

  ParameterSpace space() const {
    ParameterSpace space;
    for (int d = 0; d < 2; ++d) {
      Vector2d turn = Vector2d::Zero();
      turn[d] = surface_.periods()[std::size_t(d)];
      const Vector2d base = surface_.foot(surface_.at({0, 0})).parameters;
      if (turn[d] > 0) space.periods[std::size_t(d)] = to(base + turn)[d] - to(base)[d];
      if (surface_.poles()[std::size_t(d)])
        space.poles[1][std::size_t(d)] = to({0, *surface_.poles()[std::size_t(d)]})[1];
    }
    return space;
  }

 private:
  const FaceSurface& surface_;
  Vector2d scale_ = Vector2d::Ones();
};

double distance_to_segment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d side = b - a;
  const double length = side.squaredNorm();
  const double share = length > 0 ? std::clamp((p - a).dot(side) / length, 0.0, 1.0) : 0;
  return (a + share * side - p).norm();
}

// At the midpoint of every whole step across a straight direction.
std::vector<Vector2d> points_between(std::span<const std::vector<Vector2d>> loops, int straight) {
  std::vector<Vector2d> result;
  const int across = 1 - straight;
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;
  for (const auto& loop : loops) {
    for (const Vector2d& p : loop) {
      lower = std::min(lower, p[across]);
      upper = std::max(upper, p[across]);
    }
  }
  if (upper - lower > most_inside) return result;
  for (double x = std::floor(lower) + 0.5; x < upper; ++x) {
    std::vector<double> crossings;
    for (const auto& loop : loops) {
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vector2d &a = loop[k], &b = loop[(k + 1) % loop.size()];
        if ((a[across] > x) == (b[across] > x)) continue;
        crossings.push_back(a[straight] + (b[straight] - a[straight]) * (x - a[across]) / (b[across] - a[across]));
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
bool too_wide(std::span<const std::vector<Vector2d>> loops, std::span<const Triangle> triangles, int across) {
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
std::vector<Vector2d> points_inside(std::span<const std::vector<Vector2d>> loops) {
  std::vector<std::pair<Vector2d, Vector2d>> sides;
  double lower = std::numeric_limits<double>::infinity(), upper = -lower, left = lower, right = -lower;
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
  if ((upper - lower) * (right - left) > most_inside) return result;
  for (double y = std::ceil(lower); y <= upper; ++y) {
    std::vector<double> crossings;
    std::vector<std::pair<Vector2d, Vector2d>> near;
    for (const auto& [a, b] : sides) {
      if ((a.y() > y) != (b.y() > y)) crossings.push_back(a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()));
      if (std::min(a.y(), b.y()) < y + clearance && std::max(a.y(), b.y()) > y - clearance) near.emplace_back(a, b);
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
    if (std::lround(y) % 2 != 0) std::reverse(result.begin() + static_cast<std::ptrdiff_t>(begin), result.end());
  }
  return result;
}

class Tessellator {
 public:
  Tessellator(const Reader& reader, double chord)
      : reader_(reader), chord_(chord), edges_(reader, chord), angle_units_(plane_angle_units(reader)) {}

  Expected<FaceMesh> mesh(const Face& face) {
    auto loops = edges_.loops(face.bounds);
    if (!loops) return std::unexpected(std::move(loops.error()));
    std::vector<Point> on_it;
    for (const Loop& loop : *loops) on_it.insert(on_it.end(), loop.begin(), loop.end());
    auto surface = surface_of(face, on_it);
    if (!surface) return std::unexpected(std::move(surface.error()));
    surface->set_steps(chord_);
    // Now on the left as seen from the tip of the surface's normal, not the face's.
    if (!face.same_sense) {
      for (Loop& loop : *loops) std::reverse(loop.begin(), loop.end());
    }
    Eigen::AlignedBox3d box;
    for (const Point& p : on_it) box.extend(p);
    std::vector<Foot> feet;
    for (const Loop& loop : *loops) {
      for (const Point& p : loop) {
        feet.push_back(surface->foot(p));
        const double off = (surface->at(feet.back().parameters) - p).norm();
        if (!(off <= off_surface * box.diagonal().norm())) {
          return reader_.error(face.instance, "its edges do not lie on its surface");
        }
      }
    }
    const Chart chart(*surface, feet);
    std::vector<std::vector<LoopPoint>> in_chart;
    auto foot = feet.begin();
    for (const Loop& loop : *loops) {
      auto& points = in_chart.emplace_back();
      for (std::size_t k = 0; k < loop.size(); ++k, ++foot) points.push_back({chart.to(foot->parameters), foot->free});
    }
    auto parts = parameter_region(chart.space(), in_chart);
    if (!parts) return reader_.error(face.instance, parts.error().what);
    FaceMesh result{"#" + std::to_string(reader_.file().instance(face.instance).id), {}, {}, {}};
    for (const RegionPart& part : *parts) {
      if (!add(part, *loops, *surface, chart, face.same_sense, result)) {
        return reader_.error(face.instance, "its bounds cross themselves or each other");
      }
    }
    return result;
  }

 private:
  Expected<FaceSurface> surface_of(const Face& face, std::span<const Point> on_it) const {
    if (face.surface != no_instance) return FaceSurface::read(reader_, face.surface, on_it, angle_units_);
    auto plane = FaceSurface::plane_of(on_it);
    if (!plane) return reader_.error(face.instance, "it has no surface, and its bounds span no plane");
    return *std::move(plane);
  }

  static bool add(const RegionPart& part, const std::vector<Loop>& loops, const FaceSurface& surface,
                  const Chart& chart, bool same_sense, FaceMesh& mesh) {
    std::vector<std::vector<Vector2d>> outline;
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    const auto append = [&](const Vector2d& at, const Point& point) {
      mesh.points.push_back(point);
      mesh.normals.push_back((same_sense ? 1 : -1) * surface.normal(chart.from(at)));
    };
    const auto outline_of = [&](const std::vector<RegionPoint>& polygon) {
      auto& flat = outline.emplace_back();
      for (const RegionPoint& p : polygon) {
        flat.push_back(p.at);
        append(p.at, p.loop < 0 ? surface.at(chart.from(p.at)) : loops[std::size_t(p.loop)][std::size_t(p.index)]);
      }
    };
    outline_of(part.outer);
    for (const auto& hole : part.holes) outline_of(hole);
    const auto straight = surface.straight();
    // Where the surface is straight in one direction, points on the outline usually suffice.
    auto inside = straight[0] || straight[1] ? std::vector<Vector2d>() : points_inside(outline);
    auto triangles = triangulate(outline, inside);
    if (!triangles) return false;
    if (straight[0] != straight[1] && too_wide(outline, *triangles, straight[0] ? 1 : 0)) {
      inside = points_between(outline, straight[0] ? 0 : 1);
      triangles = triangulate(outline, inside);
      if (!triangles) return false;
    }
    for (const Vector2d& p : inside) append(p, surface.at(chart.from(p)));
    for (Triangle t : *triangles) {
      for (auto& k : t) k += first;
      const Point &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
      if (a == b || b == c || c == a) continue;  // at a pole
      if (!same_sense) std::swap(t[1], t[2]);
      mesh.triangles.push_back(t);
    }
    return true;
  }

  const Reader& reader_;
  double chord_;
  EdgeSampler edges_;
  std::vector<double> angle_units_;
};

}  // namespace

Expected<ContextFaces> context_faces(const step::File& file, double chord) {
  if (!(chord >= 1e-6 && chord <= 0.2)) {
    return std::unexpected(Error{ErrorKind::usage, "the tolerance of chords is out of range", {}, "use 1e-6 to 0.2"});
  }
  const step::File::Data& data = file.data();
  const Reader reader(data.records);
  const std::unordered_set<std::uint32_t> drawn(data.surface_instances.begin(), data.surface_instances.end());
  Tessellator tessellator(reader, chord);
  ContextFaces result;
  for (const Face& face : read_faces(reader)) {
    if (drawn.contains(face.surface)) continue;
    if (auto mesh = tessellator.mesh(face))
      result.faces.push_back(*std::move(mesh));
    else
      result.skipped.push_back(
          {"#" + std::to_string(reader.file().instance(face.instance).id), std::move(mesh.error())});
  }
  return result;
}

}  // namespace knead
