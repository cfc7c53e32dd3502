#include "model_walls.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "contact_search.hpp"
#include "knead/spline/extremum.hpp"

namespace knead {
namespace {

/// By which a triangle may miss its face: h²/8 of the curvature along its sides, κ h being the turn
/// of the normals.
double sag_of(const FaceMesh& face, const std::array<std::uint32_t, 3>& triangle) {
  double most = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto a = triangle[k], b = triangle[(k + 1) % 3];
    most = std::max(most, (face.points[a] - face.points[b]).norm() *
                              (face.normals[a] - face.normals[b]).norm() / 8);
  }
  return most;
}

}  // namespace

ModelWalls::ModelWalls(std::shared_ptr<const Surroundings> around) : around_(std::move(around)) {
  if (!around_) return;
  for (std::uint32_t k = 0; k < around_->faces.size(); ++k) {
    const FaceMesh& face = around_->faces[k];
    Around& part = parts_[around_->part_of(face.id)];
    const auto first = static_cast<std::uint32_t>(part.patch.from.size());
    part.patch.from.insert(part.patch.from.end(), face.points.begin(), face.points.end());
    for (const auto& triangle : face.triangles) {
      part.patch.triangles.push_back(
          {first + triangle[0], first + triangle[1], first + triangle[2]});
      part.sags.push_back(sag_of(face, triangle));
      part.faces.push_back(k);
    }
  }
  for (auto& [_, part] : parts_) {
    part.patch.to = part.patch.from;
    std::vector<Eigen::AlignedBox3d> boxes;
    for (const auto& triangle : part.patch.triangles) {
      boxes.emplace_back();
      for (const auto k : triangle) boxes.back().extend(part.patch.from[k]);
    }
    part.tree = BoxTree(boxes);
  }
}

ModelWalls::~ModelWalls() = default;

// Grids of surfaces that stay are kept from step to step, under their name and the shape they were
// made of; those of surfaces that move serve one comparison.
SpanGrid* ModelWalls::grid_of(const WallMotion& wall) {
  const Motion& motion = wall.motion;
  if (!motion.from || !motion.to) return nullptr;
  auto& known = motion.moves() ? moving_ : still_;
  const auto found = known.find(wall.id);
  if (found != known.end() &&
      (motion.moves() || (found->second && found->second->motion().to == motion.to))) {
    return found->second ? &*found->second : nullptr;
  }
  auto& made = known[wall.id] = SpanGrid::create(motion);
  return made ? &*made : nullptr;
}

namespace {

/// A span shows something if its middle is visible or a chord of an edge may enter it.
/// A chord counts for all spans that its box meets, so that no visible span is missed and some
/// hidden ones are taken; O(spans + chords · spans met). What is then found is tested for
/// visibility at its own point.
std::vector<char> spans_shown(const VisibleRegion& region, const Surface& surface) {
  if (region.faces.empty()) return {};
  std::array<std::vector<Interval>, 2> spans;  // in fractions
  for (int d = 0; d < 2; ++d) {
    const KnotVector& knots = surface.knots(d);
    const Interval domain = knots.domain();
    for (const int s : knots.spans()) {
      spans[static_cast<std::size_t>(d)].push_back(
          {(knots[s] - domain.lower) / domain.length(),
           (knots[s + 1] - domain.lower) / domain.length()});
    }
  }
  const std::size_t rows = spans[0].size(), columns = spans[1].size();
  std::vector<char> shown(rows * columns, 0);
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      const Eigen::Vector2d middle(0.5 * (spans[0][i].lower + spans[0][i].upper),
                                   0.5 * (spans[1][j].lower + spans[1][j].upper));
      shown[i * columns + j] = region.contains(middle) ? 1 : 0;
    }
  }
  const auto enter = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const Eigen::Vector2d lower = a.cwiseMin(b), upper = a.cwiseMax(b);
    const auto meets = [&](const Interval& span, int d) {
      return span.upper >= lower[d] && span.lower <= upper[d];
    };
    for (std::size_t i = 0; i < rows; ++i) {
      if (!meets(spans[0][i], 0)) continue;
      for (std::size_t j = 0; j < columns; ++j) {
        if (meets(spans[1][j], 1)) shown[i * columns + j] = 1;
      }
    }
  };
  for (const auto& face : region.faces) {
    for (const auto& loop : face) {
      for (std::size_t k = 0; k < loop.size(); ++k) enter(loop[k], loop[(k + 1) % loop.size()]);
    }
  }
  return shown;
}

}  // namespace

const std::vector<char>& ModelWalls::shown_spans(const WallMotion& wall) {
  ShownSpans& known = shown_[wall.id];
  const std::shared_ptr<const Surface>& shape = wall.motion.from;
  if (known.like && known.region == wall.visible && same_basis(*known.like, *shape))
    return known.shown;
  known = {wall.visible, shape,
           wall.visible ? spans_shown(*wall.visible, *shape) : std::vector<char>()};
  return known.shown;
}

double ModelWalls::diagonal(std::span<const WallMotion> motions) {
  Eigen::AlignedBox3d box;
  for (const WallMotion& wall : motions) {
    if (!wall.motion.moves()) {
      if (const SpanGrid* grid = grid_of(wall)) box.extend(grid->box());
    } else {
      // Of the shape as opened, so that tolerances do not grow with what is pulled out.
      const Points& net = wall.opened->control_points();
      box.extend(Point(net.colwise().minCoeff().transpose()))
          .extend(Point(net.colwise().maxCoeff().transpose()));
    }
  }
  for (const auto& [_, part] : parts_) box.extend(part.tree.box());
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

std::optional<FaceContact> ModelWalls::first_contact(std::span<const WallMotion> motions,
                                                     double tolerance) {
  moving_.clear();
  ContactSearch search(*this, motions, tolerance);
  return search.first();
}

}  // namespace knead
