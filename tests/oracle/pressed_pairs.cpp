#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "brep/shared_edge.hpp"
#include "knead/brep/face_edges.hpp"
#include "knead/spline/evaluate.hpp"
#include "oracle/pressed_edges.hpp"
#include "support/long_run.hpp"

namespace knead::oracle {
namespace {

constexpr double least_size = 1e-3;  // of a surface: smaller tools are refused
constexpr double smooth = 0.02;      // degrees
constexpr std::size_t most_pairs = 4, most_smooth = 2, most_closing = 2;

Point normal_at(const Surface& surface, const Eigen::Vector2d& at) {
  const auto u = parameters_of(surface, at);
  Parameters<2> here(1, 2);
  here << u[0], u[1];
  const auto jet = evaluate<2>(surface, here, 1);
  return jet ? Point(
                   Point(jet->at({1, 0}).row(0)).cross(Point(jet->at({0, 1}).row(0))).normalized())
             : Point::Zero();
}

Eigen::Vector2d course_at(const TrimEdge& edge, const Point& p) {
  const auto near =
      std::ranges::min_element(edge.points, {}, [&](const Point& q) { return (p - q).norm(); });
  return edge.course[static_cast<std::size_t>(near - edge.points.begin())];
}

/// Where to press on an edge that surfaces share, or on the seam of a closed one. None where there
/// is no room.
std::optional<Pair> pair_at(const brep::Model& file,
                            const std::map<std::string, VisibleRegion>& regions,
                            const std::string& id, const std::vector<std::string>& surfaces) {
  Pair result{{id}, surfaces};
  result.radius = std::numeric_limits<double>::infinity();
  double size = 0;
  for (const std::string& surface : surfaces) {
    const VisibleRegion& region = regions.at(surface);
    std::vector<bool> others;
    const TrimEdge* edge_here = nullptr;
    for (const TrimEdge& edge : region.edges) {
      others.push_back(edge.id != id);
      if (edge.id == id) edge_here = &edge;
    }
    if (edge_here->neighbours.size() != surfaces.size()) return std::nullopt;
    if (result.normal.isZero()) result.place = edge_here->points[edge_here->points.size() / 2];
    if (edge_here->points.size() == 2 && result.normal.isZero())
      result.place = 0.5 * (edge_here->points[0] + edge_here->points[1]);
    const Surface& shape = file.find_surface(surface)->surface;
    if (result.across.isZero()) {
      const std::size_t k = edge_here->points.size() / 2;
      result.across =
          edge_here->points[k] - edge_here->points[k - 1];  // the direction of the edge, so far
    }
    Eigen::Vector2d at = course_at(*edge_here, result.place);
    if (edge_here->points.size() == 2) at = 0.5 * (edge_here->course[0] + edge_here->course[1]);
    const Point n = normal_at(shape, at);
    result.normal += result.normal.dot(n) < 0 ? Point(-n) : n;
    result.radius = std::min(result.radius, region.distance(result.place, others) / 2);
    const Points& net = shape.control_points();
    size = std::max(size, (net.colwise().maxCoeff() - net.colwise().minCoeff()).norm());
    if (edge_here->seam) {  // small beside the other side of a tube
      const Eigen::VectorXd heights = net * n;
      result.radius = std::min(result.radius, (heights.maxCoeff() - heights.minCoeff()) / 4);
    }
  }
  if (!(result.radius > least_size * size && std::isfinite(result.radius) &&
        result.normal.norm() > 0.1))
    return std::nullopt;
  result.normal.normalize();
  result.across = result.normal.cross(result.across).normalized();
  result.depth = result.radius / 4;
  return result;
}

std::map<std::string, VisibleRegion> regions_of(const brep::Model& file) {
  std::map<std::string, VisibleRegion> regions;
  for (const auto& s : file.surfaces) {
    if (auto region = visible_region(file, s.id)) regions.emplace(s.id, std::move(*region));
  }
  return regions;
}

std::map<std::string, std::vector<std::string>> shared_edges(
    const std::map<std::string, VisibleRegion>& regions) {
  std::map<std::string, std::vector<std::string>> shared;
  for (const auto& [surface, region] : regions) {
    for (const TrimEdge& edge : region.edges) shared[edge.id].push_back(surface);
  }
  std::erase_if(shared, [](const auto& entry) { return entry.second.size() < 2; });
  return shared;
}

/// The edges with the same face on both of their sides.
std::map<std::string, std::vector<std::string>> closing_edges(
    const std::map<std::string, VisibleRegion>& regions) {
  std::map<std::string, std::vector<std::string>> result;
  for (const auto& [surface, region] : regions) {
    for (const TrimEdge& edge : region.edges) {
      if (edge.seam) result[edge.id].push_back(surface);
    }
  }
  return result;
}

/// So many of these at most, spread over them.
std::vector<Pair> spread(const std::vector<Pair>& all, std::size_t most) {
  if (all.size() <= most) return all;
  std::vector<Pair> result;
  for (std::size_t k = 0; k < most; ++k) result.push_back(all[k * (all.size() - 1) / (most - 1)]);
  return result;
}

/// A row of the table in docs/evidence/trims.md, where its file is named.
}  // namespace

std::vector<Pair> pairs_of(
    const brep::Model& file,
    const std::function<bool(const std::vector<std::string>& surfaces)>& wanted) {
  const auto regions = regions_of(file);
  std::vector<Pair> all;
  for (const auto& [id, surfaces] : shared_edges(regions)) {
    if (wanted && !wanted(surfaces)) continue;
    if (auto pair = pair_at(file, regions, id, surfaces)) all.push_back(std::move(*pair));
  }
  std::vector<Pair> result = spread(all, most_pairs);
  std::erase_if(all, [&](const Pair& pair) {
    const auto edge = SharedEdge::create(file, pair.edges[0]);
    return edge->angle() * 180 / std::numbers::pi > smooth ||
           std::ranges::any_of(result,
                               [&](const Pair& known) { return known.edges == pair.edges; });
  });
  std::ranges::copy(spread(all, most_smooth), std::back_inserter(result));
  std::vector<Pair> closing;
  for (const auto& [id, surfaces] : closing_edges(regions)) {
    if (wanted && !wanted(surfaces)) continue;
    if (auto pair = pair_at(file, regions, id, surfaces)) closing.push_back(std::move(*pair));
  }
  std::ranges::copy(spread(closing, most_closing), std::back_inserter(result));
  return result;
}

std::vector<Pair> each_kind(const brep::Model& file, std::vector<Pair> pairs) {
  if (testing::long_run()) return pairs;
  std::set<int> known;
  std::erase_if(pairs, [&](const Pair& pair) {
    const bool closing =
        std::ranges::all_of(pair.surfaces, [&](const auto& id) { return id == pair.surfaces[0]; });
    const auto edge = SharedEdge::create(file, pair.edges[0]);
    const bool is_smooth = edge && edge->angle() * 180 / std::numbers::pi <= smooth;
    return !known.insert(closing ? 2 : is_smooth ? 1 : 0).second;
  });
  return pairs;
}

Pair chain_of(const brep::Model& file, const Point& place) {
  const auto regions = regions_of(file);
  Pair result;
  for (const auto& [id, surfaces] : shared_edges(regions)) result.edges.push_back(id);
  for (const auto& [surface, region] : regions) result.surfaces.push_back(surface);
  result.place = place;
  result.normal = Point::UnitZ();
  result.radius = 25;
  result.depth = 6;
  return result;
}

}  // namespace knead::oracle
