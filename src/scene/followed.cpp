#include "followed.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_map>

#include "knead/spline/evaluate.hpp"
#include "places.hpp"

namespace knead {
namespace {

using Sample = SharedEdge::Sample;

// How the shapes of several surfaces stay together along an edge C(t) that their faces share. Where
// it is sampled, edge.feet[k] are the fractions of surface k at C(t); conditions D_a(u_a(t)) =
// D_b(u_b(t)) are asked at `coupled_per_span` points in every span that the edge crosses of either
// surface (`coupled_edges`), and what the step did is measured at `measured_per_span` (`parting`).
// The two counts have no common divisor, so that most places of measurement lie between those of
// the conditions, where nothing forces the distance to be small.
constexpr double least_distance = 1e-6;  // of the size
constexpr double share_of_uncertainty = 0.1;
constexpr int coupled_per_span = 4, measured_per_span = 7;

/// The samples of an edge's course, with so many parts of every span that it crosses.
std::vector<Sample> fine_samples(const SharedEdge& edge, std::span<const Surface* const> surfaces,
                                 int per_span) {
  return finer_samples(edge.samples(), surfaces,
                       {[=](const KnotVector&) { return per_span; },
                        [&](const Sample& a, const Sample& b, double share) {
                          return edge.at(std::lerp(a.parameter, b.parameter, share));
                        }});
}

// A tenth of the file's uncertainty, so that the displacement spends only a part of what the file
// allows for the edge as a whole; where the file states none, a millionth of the largest net.
double tolerance_of(const Scene& scene, const SharedEdge& edge) {
  double size = 0;
  for (const std::string& id : edge.surfaces()) {
    size = std::max(size, net_size(*find_surface(scene, id)->opened));
  }
  return std::max(share_of_uncertainty * edge.uncertainty(), least_distance * size);
}

}  // namespace

// The last hold that names an edge is the one that counts.
bool follows(const SceneSurface& surface, const std::string& edge) {
  bool result = false;
  for (const KeptConstraint& kept : surface.constraints) {
    const auto* hold = std::get_if<TrimEdgeHold>(&kept.constraint);
    if (hold != nullptr && hold->id == edge) result = hold->follow;
  }
  return result;
}

// An edge follows in a step only if all of its surfaces are selected and let it follow: with one of
// them missing there would be nobody to share its displacements. O(surfaces + Σ surfaces of edges),
// by one table of the selection.
std::vector<FollowedInput> followed_inputs(const Scene& scene) {
  std::vector<FollowedInput> result;
  const std::vector<int> selection = scene.selection();
  std::unordered_map<std::string_view, int> place;  // in the selection
  for (std::size_t k = 0; k < selection.size(); ++k) {
    place.try_emplace(scene.surfaces[static_cast<std::size_t>(selection[k])].id,
                      static_cast<int>(k));
  }
  for (const FollowedEdge& edge : scene.followed) {
    if (!edge.course) continue;
    FollowedInput made{edge.course, {}};
    for (const std::string& id : edge.course->surfaces()) {
      const auto found = place.find(id);
      if (found == place.end()) continue;
      const int surface = selection[static_cast<std::size_t>(found->second)];
      if (follows(scene.surfaces[static_cast<std::size_t>(surface)], edge.id))
        made.patches.push_back(found->second);
    }
    if (made.patches.size() == edge.course->surfaces().size()) result.push_back(std::move(made));
  }
  return result;
}

const SharedEdge* followed_at(const std::vector<FollowedInput>& followed, const Seam& seam) {
  const SharedEdge* result = nullptr;
  for (const FollowedInput& edge : followed) {
    const auto has = [&](int patch) {
      return std::ranges::find(edge.patches, patch) != edge.patches.end();
    };
    if (seam.a.patch == seam.b.patch || !has(seam.a.patch) || !has(seam.b.patch)) continue;
    if (result == nullptr || is_smooth(*edge.course)) result = edge.course.get();
  }
  return result;
}

// The places of the conditions, in parameters of each patch, and at smooth edges the directions w_k
// across the edge. Samples have w_k per fraction of the domain; conditions take derivatives by
// parameters, hence the factor of the domain's length: a change of s by w is one of u by L w. An
// edge of one surface alone, whose faces lie on that surface, moves with it and needs no condition.
std::vector<CoupledEdge> coupled_edges(const std::vector<FollowedInput>& followed,
                                       std::span<const Surface* const> patches) {
  std::vector<CoupledEdge> result;
  for (const FollowedInput& edge : followed) {
    if (edge.patches.size() < 2) continue;
    const bool smooth = is_smooth(*edge.course);
    CoupledEdge made{"edge " + edge.course->id(), {}};
    std::vector<const Surface*> surfaces;
    for (const int patch : edge.patches)
      surfaces.push_back(patches[static_cast<std::size_t>(patch)]);
    for (const Sample& sample : fine_samples(*edge.course, surfaces, coupled_per_span)) {
      SharedPoint point;
      for (std::size_t k = 0; k < surfaces.size(); ++k) {
        point.emplace_back(edge.patches[k], parameters_at_foot(*surfaces[k], sample.feet[k]));
      }
      made.points.push_back(std::move(point));
      if (!smooth) continue;
      made.across.emplace_back();
      for (std::size_t k = 0; k < sample.across.size(); ++k) {
        const Interval u = surfaces[k]->knots(0).domain(), v = surfaces[k]->knots(1).domain();
        made.across.back().emplace_back(u.length() * sample.across[k].x(),
                                        v.length() * sample.across[k].y());
      }
    }
    result.push_back(std::move(made));
  }
  return result;
}

namespace {

/// Notes the angles between the tangent planes of shapes at a sample, of which the neighbour gives
/// the edge's direction.
/// The angle φ between two planes is split by the line about which they turn, n_1 × n_2. Its share
/// along the edge, |cos|, is the part that conditions on derivatives across the edge must reduce;
/// the sine is the part that comes from the slope of the distance between both sides, which those
/// on positions must reduce. Both are in units of what is asked, `may_bend` and twice the angle as
/// opened at the same sample. A chord to the neighbouring sample is direction enough: it only
/// weighs the two parts.
Expected<void> look_for_kink(std::span<const Surface* const> now, const Sample& sample,
                             const Sample& next, double may_bend, Parting& parting) {
  const auto first = normal_at_foot(*now[0], sample.feet[0]);
  if (!first) return std::unexpected(first.error());
  if (first->isZero() || sample.across.empty()) return {};
  const auto here = evaluate_point<2>(*now[0], parameters_at_foot(*now[0], sample.feet[0]));
  if (!here) return std::unexpected(here.error());
  const auto there = evaluate_point<2>(*now[0], parameters_at_foot(*now[0], next.feet[0]));
  if (!there) return std::unexpected(there.error());
  const Point along = (*there - *here).normalized();
  const double asked = may_bend + 2 * sample.angle;
  for (std::size_t k = 1; k < now.size(); ++k) {
    const auto n = normal_at_foot(*now[k], sample.feet[k]);
    if (!n) return std::unexpected(n.error());
    if (n->isZero()) continue;
    const double angle = angle_between_planes(*first, *n);
    // Derivatives across that differ turn a plane about the edge; those along it, about what is
    // perpendicular to it.
    const double share = std::min(1.0, std::abs(first->cross(*n).normalized().dot(along)));
    parting.kink_across = std::max(parting.kink_across, share * angle / asked);
    parting.kink_along = std::max(parting.kink_along, std::sqrt(1 - share * share) * angle / asked);
    if (angle <= parting.angle) continue;
    parting.angle = angle;
    parting.kink_place = sample.point;
  }
  return {};
}

}  // namespace

/// Displacements are compared, not positions: the gap that the file has between its surfaces is no
/// fault of the step. Cost: one evaluation of each surface before and after at each sample, and one
/// more of first derivatives at smooth edges.
Expected<Parting> parting(const Scene& scene, const SharedEdge& edge) {
  Parting result;
  std::vector<const Surface*> now, then;
  for (const std::string& id : edge.surfaces()) {
    const SceneSurface* s = find_surface(scene, id);
    now.push_back(s->current.get());
    then.push_back(s->opened.get());
  }
  result.tolerance = tolerance_of(scene, edge);
  result.angle_before = edge.angle();
  const std::vector<Sample> samples = fine_samples(edge, now, measured_per_span);
  for (std::size_t at = 0; at < samples.size(); ++at) {
    const Sample& sample = samples[at];
    Point first = Point::Zero();
    for (std::size_t k = 0; k < now.size(); ++k) {
      const auto way = displacement_at(*then[k], *now[k], sample.feet[k]);
      if (!way) return std::unexpected(way.error());
      if (k == 0) first = *way;
      const double distance = (*way - first).norm();
      if (distance <= result.distance) continue;
      result.distance = distance;
      result.place = sample.point;
    }
    if (!is_smooth(edge)) continue;
    const Sample& next = samples[at + 1 < samples.size() ? at + 1 : at - 1];
    if (auto looked = look_for_kink(now, sample, next, scene.bend, result); !looked)
      return std::unexpected(looked.error());
  }
  return result;
}

// At an end of the edge other edges end too. If one of these does not follow, its curve stays in
// the file as it is, and the vertex cannot move without parting from it.
Expected<std::optional<StuckVertex>> stuck_vertex(const Scene& scene, const SharedEdge& edge) {
  const SceneSurface& s = *find_surface(scene, edge.surfaces().front());
  const auto is_followed = [&](const std::string& id) {
    return std::ranges::any_of(scene.followed, [&](const FollowedEdge& other) {
      return other.id == id && other.course &&
             std::ranges::all_of(other.course->surfaces(), [&](const std::string& surface) {
               const SceneSurface* at = find_surface(scene, surface);
               return at != nullptr && follows(*at, id);
             });
    });
  };
  for (std::size_t v = 0; v < 2; ++v) {
    const Sample& end = v == 0 ? edge.samples().front() : edge.samples().back();
    const auto way = displacement_at(*s.opened, *s.current, end.feet.front());
    if (!way) return std::unexpected(way.error());
    if (way->norm() <= tolerance_of(scene, edge)) continue;
    for (const std::string& other : edge.edges_at_vertices()[v]) {
      if (!is_followed(other)) return StuckVertex{edge.vertices()[v], other, way->norm()};
    }
  }
  return std::nullopt;
}

}  // namespace knead
