#include "parted_edges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "brep/shared_edge.hpp"
#include "knead/base/error_code.hpp"
#include "knead/spline/evaluate.hpp"
#include "places.hpp"
#include "trims.hpp"

namespace knead {
namespace {

// Whether a file that is to be written is as closed as the one that was read. Along each edge the
// same points of its curve are looked up on every face that meets there, on the surfaces as opened
// and as they are. The largest distance between two sides may be
//   now <= max(uncertainty, 1e-6 size, 1.01 opened),
// and for edges that follow, whose curve is written anew, `opened` plus the uncertainty, or a
// hundredth of itself where that is more. A file that is open by itself is thus not refused, and
// one is not made worse by more than a hundredth of what it was. Otherwise the sides are also
// compared with the edge's curve, which is written as it stands: two surfaces that leave it
// together would be open to it.
constexpr double least_parting = 1e-6;  // of the size
constexpr double more_than_opened = 1.01;
constexpr double on_seam = 1e-4;  // of the domain, as in SharedEdge

using Eigen::Vector2d;

/// Points of one side of an edge, now and as opened, by point of the contact.
struct ShownSide {
  Points now, then;
};

Points rows_of(const std::vector<Point>& points) {
  Points rows(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t k = 0; k < points.size(); ++k)
    rows.row(static_cast<Eigen::Index>(k)) = points[k].transpose();
  return rows;
}

Expected<Points> points_at(const Surface& surface, const std::vector<Vector2d>& feet) {
  Parameters<2> places(static_cast<Eigen::Index>(feet.size()), 2);
  for (std::size_t k = 0; k < feet.size(); ++k) {
    const auto at = parameters_at_foot(surface, feet[k]);
    places.row(static_cast<Eigen::Index>(k)) << at[0], at[1];
  }
  auto jet = evaluate<2>(surface, places);
  if (!jet) return std::unexpected(jet.error());
  return std::move(jet->derivatives.front());
}

Expected<ShownSide> shown_side(const SceneSurface& s, const std::vector<Vector2d>& feet) {
  auto now = points_at(*s.current, feet), then = points_at(*s.opened, feet);
  if (!now) return std::unexpected(now.error());
  if (!then) return std::unexpected(then.error());
  return ShownSide{*std::move(now), *std::move(then)};
}

/// The feet on the other side of the line where a closed surface meets itself, where they all lie
/// on it.
std::optional<std::vector<Vector2d>> across_seam(const std::vector<Vector2d>& feet) {
  for (int d = 0; d < 2; ++d) {
    const auto beside = [&](const Vector2d& foot) {
      return std::abs(foot[d] - std::round(foot[d])) <= on_seam;
    };
    if (!std::ranges::all_of(feet, beside)) continue;
    std::vector<Vector2d> other = feet;
    for (Vector2d& foot : other) foot[d] = std::round(foot[d]) == 0 ? 1 : 0;
    return other;
  }
  return std::nullopt;
}

/// Measures one edge.
class DistanceAtEdge {
 public:
  DistanceAtEdge(const Scene& scene, const EdgeContact& contact) : contact_(contact) {
    followed_ =
        std::ranges::find(scene.followed, contact.id, &FollowedEdge::id) != scene.followed.end();
    result_.id = contact.id;
  }

  // Faces on planes, cylinders and the like never move, so that the two places of a point are the
  // same; those on B-splines are evaluated at the feet found as opened, which remain valid since
  // parameters of material points do not change.
  Expected<void> add(const Scene& scene, const EdgeContactFace& face) {
    result_.faces.push_back(face.id);
    if (face.surface.empty()) {
      if (face.points.size() == contact_.points.size())
        sides_.push_back({rows_of(face.points), rows_of(face.points)});
      return {};
    }
    const auto s = std::ranges::find(scene.surfaces, face.surface, &SceneSurface::id);
    if (s == scene.surfaces.end())
      return input_error("the surface is not in the scene", face.surface);
    result_.surfaces.push_back(s->id);
    result_.freed = result_.freed || may_open(s->constraints, contact_.id);
    size_ = std::max(size_, net_size(*s->opened));
    if (face.feet.size() != contact_.points.size()) return {};
    auto side = shown_side(*s, face.feet);
    if (!side) return std::unexpected(side.error());
    sides_.push_back(*std::move(side));
    // A face that borders on itself has two sides here, and its foot search finds either one.
    const auto across = contact_.seam ? across_seam(face.feet) : std::nullopt;
    if (!across) return {};
    auto other = shown_side(*s, *across);
    if (!other) return std::unexpected(other.error());
    sides_.push_back(*std::move(other));
    return {};
  }

  [[nodiscard]] PartedEdge measured() {
    const Points curve = rows_of(contact_.points);
    for (std::size_t a = 0; a < sides_.size(); ++a) {
      for (std::size_t b = a + 1; b < sides_.size(); ++b) meet(sides_[a], sides_[b]);
      if (!followed_) meet(sides_[a], {curve, curve});
    }
    const double least = std::max(contact_.uncertainty, least_parting * size_);
    result_.allowed =
        followed_ ? result_.opened + std::max(least, (more_than_opened - 1) * result_.opened)
                  : std::max(least, more_than_opened * result_.opened);
    return std::move(result_);
  }

 private:
  void meet(const ShownSide& a, const ShownSide& b) {
    for (Eigen::Index k = 0; k < a.now.rows(); ++k) {
      const double now = (a.now.row(k) - b.now.row(k)).norm(),
                   then = (a.then.row(k) - b.then.row(k)).norm();
      if (now > result_.distance) result_.place = contact_.points[static_cast<std::size_t>(k)];
      result_.distance = std::max(result_.distance, now);
      result_.opened = std::max(result_.opened, then);
    }
  }

  const EdgeContact& contact_;
  bool followed_ = false;
  double size_ = 0;
  std::vector<ShownSide> sides_;
  PartedEdge result_;
};

/// "the face #12", "the faces #12 and #15"
std::string faces_in_words(const std::vector<std::string>& faces) {
  std::string text = faces.size() == 1 ? "the face " : "the faces ";
  for (std::size_t k = 0; k < faces.size(); ++k) {
    text += (k == 0 ? "" : k + 1 == faces.size() ? " and " : ", ") + faces[k];
  }
  return text;
}

std::string place_in_words(const Point& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

}  // namespace

/// Cost: two evaluations per surface and edge, of all of the contact's points at once.
Expected<std::vector<PartedEdge>> parted_edges(const Scene& scene,
                                               const std::vector<EdgeContact>& contacts) {
  std::vector<PartedEdge> result;
  for (const EdgeContact& contact : contacts) {
    DistanceAtEdge distance(scene, contact);
    for (const EdgeContactFace& face : contact.faces) {
      if (auto added = distance.add(scene, face); !added) return std::unexpected(added.error());
    }
    PartedEdge edge = distance.measured();
    if (edge.distance > edge.allowed) result.push_back(std::move(edge));
  }
  return result;
}

Expected<void> check_parted(const std::vector<PartedEdge>& edges) {
  const PartedEdge* worst = nullptr;
  int count = 0;
  const auto excess = [](const PartedEdge& e) { return e.distance / e.allowed; };
  for (const PartedEdge& edge : edges) {
    if (edge.freed) continue;
    ++count;
    if (worst == nullptr || excess(edge) > excess(*worst)) worst = &edge;
  }
  if (worst == nullptr) return {};
  const std::string others =
      count == 1 ? "" : fmt::format("; {} other edge{} likewise", count - 1, count == 2 ? "" : "s");
  const std::string on = worst->surfaces.empty() ? "" : worst->surfaces.front();
  return numerical_error(
      fmt::format("the edge {} would be left {:.3g} from {} at {}, {:.2g} as opened, and {:.2g} is "
                  "allowed{}; nothing is written",
                  worst->id, worst->distance, faces_in_words(worst->faces),
                  place_in_words(worst->place), worst->opened, worst->allowed, others),
      worst->id,
      fmt::format(
          R"(before it moves hold it, {{"do":"hold","mode":"position"}}, or let it follow, )"
          R"({{"do":"edge","edge":"{}","hold":"follow"}}; or let it open: )"
          R"({{"do":"select","surface":"{}"}}, {{"do":"hold","mode":"open"}})",
          worst->id, on),
      {ErrorCode::edge_left_open,
       {{"edge", worst->id},
        {"surface", on},
        {"faces", worst->faces},
        {"distance", worst->distance}}});
}

std::string note_on(const PartedEdge& edge) {
  return fmt::format("the edge {}, which was freed, is open: it is up to {:.3g} from {}, at {}",
                     edge.id, edge.distance, faces_in_words(edge.faces),
                     place_in_words(edge.place));
}

}  // namespace knead
