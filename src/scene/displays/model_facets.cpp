#include "model_facets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "knead/spline/evaluate.hpp"
#include "spline/grid_lines.hpp"

namespace knead {
namespace {

struct Triangles {
  std::vector<Point> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  void add(const FaceMesh& face) {
    const auto first = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), face.points.begin(), face.points.end());
    for (const auto& [a, b, c] : face.triangles)
      triangles.push_back({first + a, first + b, first + c});
  }
};

/// Whether a triangle has an area but for rounding; at poles some have none.
bool has_area(const Point& a, const Point& b, const Point& c) {
  constexpr double flat = 1e-10;  // of the longest side: the height on it
  const double longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return (b - a).cross(c - a).norm() > flat * longest;
}

/// Whether a region contains a point or one beside it, so that faces which meet leave no gap
/// between them.
bool shows(const VisibleRegion& region, const Eigen::Vector2d& at) {
  constexpr double beside = 1e-6;  // of the domain
  if (region.contains(at)) return true;
  for (const double s : {-beside, beside}) {
    for (const double t : {-beside, beside}) {
      if (region.contains(at + Eigen::Vector2d(s, t))) return true;
    }
  }
  return false;
}

/// Of the box round the surfaces as opened and the faces around them, so that it stays while they
/// are sculpted.
double diagonal_of(const Scene& scene, const Surroundings* around) {
  Eigen::AlignedBox3d box;
  for (const SceneSurface& s : scene.surfaces) {
    box.extend(Point(s.opened->control_points().colwise().minCoeff().transpose()));
    box.extend(Point(s.opened->control_points().colwise().maxCoeff().transpose()));
  }
  if (around != nullptr) {
    for (const FaceMesh& face : around->faces) {
      for (const Point& p : face.points) box.extend(p);
    }
  }
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

}  // namespace

Expected<ModelFacets::FacetTree> ModelFacets::tree_of(std::shared_ptr<const Surface> surface,
                                                      Surroundings::Shown shown, double tolerance) {
  ChordOptions options;
  options.detail = 1;
  options.tolerance =
      tolerance > 0 ? tolerance / 3 : 1;  // both directions, and the twist between them
  const auto lines = grid_lines(*surface, options);
  if (!lines) return std::unexpected(lines.error());
  const auto &us = (*lines)[0].parameters, &vs = (*lines)[1].parameters;
  const auto grid = evaluate_grid<2>(*surface, {us, vs});
  if (!grid) return std::unexpected(grid.error());
  FacetTree part{std::move(surface), std::move(shown), {}, {}};
  const auto columns = static_cast<std::uint32_t>(vs.size());
  std::vector<Point> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t i = 0; i < us.size(); ++i) {
    for (std::uint32_t j = 0; j < columns; ++j) {
      const std::uint32_t k = i * columns + j;
      points.emplace_back(grid->points().row(k).transpose());
      if (part.shown.visible) {
        part.fractions.emplace_back((us[i] - us.front()) / (us.back() - us.front()),
                                    (vs[j] - vs.front()) / (vs.back() - vs.front()));
      }
      if (i + 1 == us.size() || j + 1 == columns) continue;
      triangles.push_back({k, k + columns, k + columns + 1});
      triangles.push_back({k, k + columns + 1, k + 1});
    }
  }
  std::erase_if(triangles,
                [&](const auto& t) { return !has_area(points[t[0]], points[t[1]], points[t[2]]); });
  part.tree = TriangleTree(std::move(points), std::move(triangles));
  return part;
}

// A surface is cut into triangles again only if its shape, its trims, its side, its part or the
// diagonal changed, compared by object. The tree over the boxes of all is cheap and made anew.
Expected<void> ModelFacets::refresh(const Scene& scene, bool opened,
                                    std::shared_ptr<const Surroundings> around) {
  const double diagonal = diagonal_of(scene, around.get());
  const std::size_t count = scene.surfaces.size();
  bool changed = parts_.size() != count || around != around_;
  if (changed || diagonal != diagonal_) parts_.resize(count);
  if (changed) see(around.get());
  for (std::size_t k = 0; k < count; ++k) {
    const SceneSurface& s = scene.surfaces[k];
    const auto& drawn = opened ? s.opened : s.current;
    Surroundings::Shown shown;
    if (around) {
      if (const auto found = around->shown.find(s.id); found != around->shown.end())
        shown = found->second;
    }
    const std::size_t part = around ? around->part_of(s.id) : 0;
    if (parts_[k].of == drawn && parts_[k].part == part &&
        parts_[k].shown.visible == shown.visible && parts_[k].shown.sense == shown.sense &&
        diagonal == diagonal_) {
      continue;
    }
    auto made = tree_of(drawn, shown, chord * diagonal);
    if (!made) {
      parts_.clear();
      return std::unexpected(made.error());
    }
    parts_[k] = *std::move(made);
    parts_[k].part = part;
    changed = true;
  }
  around_ = std::move(around);
  diagonal_ = diagonal;
  if (!changed) return {};
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const FacetTree& part : parts_) boxes.push_back(part.tree.box());
  for (const FacetTree& part : others_) boxes.push_back(part.tree.box());
  boxes_ = BoxTree(boxes);
  return {};
}

void ModelFacets::see(const Surroundings* around) {
  std::map<std::size_t, Triangles> by_part;
  if (around != nullptr) {
    for (const FaceMesh& face : around->faces) by_part[around->part_of(face.id)].add(face);
  }
  others_.clear();
  for (auto& [part, found] : by_part) {
    others_.push_back(
        {{}, {{}, 1}, {std::move(found.points), std::move(found.triangles)}, {}, part});
  }
}

double ModelFacets::outward(int surface) const {
  return parts_[static_cast<std::size_t>(surface)].shown.sense < 0 ? -1 : 1;
}

// The nearest face along the inward normal at which the ray leaves material: that is, which looks
// along the ray, facet · inward > 0. Orientation excludes the start itself, whose face looks
// against the ray, without an offset that thin walls would not allow. A face whose side is not
// known counts from `near` on, twice what triangles may be off. Barycentric interpolation of the
// corners' fractions gives the parameters of a hit, by which trims decide whether it counts.
std::optional<double> ModelFacets::thickness(int surface, const Point& from,
                                             const Point& inward) const {
  const Ray ray{from, inward};
  const double near = 2 * chord * diagonal_;
  double to = std::numeric_limits<double>::infinity();
  boxes_.along(ray, to, [&](std::uint32_t k) {
    const FacetTree& part = k < parts_.size() ? parts_[k] : others_[k - parts_.size()];
    if (part.part != parts_[static_cast<std::size_t>(surface)].part) return;
    const bool is_own = k == static_cast<std::uint32_t>(surface);
    (void)part.tree.nearest(ray, to, [&](const TriangleTree::Hit& hit) {
      const Point facet = part.tree.facet(hit.triangle);
      const double cosine = (part.shown.sense < 0 ? -1 : 1) * facet.dot(inward) / facet.norm();
      if (!(std::abs(cosine) > grazing)) return false;
      const bool leaves = cosine > 0 && (is_own || part.shown.sense != 0);
      if (!leaves && (is_own || hit.distance <= near)) return false;
      if (part.fractions.empty()) return true;
      Eigen::Vector2d at = Eigen::Vector2d::Zero();
      const auto& corners = part.tree.triangles()[hit.triangle];
      for (std::size_t c = 0; c < 3; ++c) at += hit.weights[c] * part.fractions[corners[c]];
      return shows(*part.shown.visible, at);
    });
  });
  return std::isfinite(to) ? std::optional(to) : std::nullopt;
}

}  // namespace knead
