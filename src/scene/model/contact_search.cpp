#include "contact_search.hpp"

#include <algorithm>
#include <cmath>

#include "knead/spline/evaluate.hpp"
#include "scene/triangle_meeting.hpp"

namespace knead {
namespace {

constexpr double beside = 2;  // cells: parts of a face that are nearer to each other touch anyway
constexpr std::size_t most_seen = 400;  // candidates, of which many may lie on what is trimmed away
constexpr int most_tried = 48, most_solved = 12, most_of_a_pair = 4;
constexpr std::size_t most_places = 6;  // whose neighbourhoods are searched

Eigen::AlignedBox3d box_round(const std::vector<Point>& from, const std::vector<Point>& to,
                              double wider) {
  Eigen::AlignedBox3d box;
  for (const auto* points : {&from, &to}) {
    for (const Point& p : *points) box.extend(p);
  }
  return {box.min() - Point::Constant(wider), box.max() + Point::Constant(wider)};
}

Eigen::Vector2d fractions_of(const Surface& s, const std::array<double, 2>& at) {
  const Interval u = s.knots(0).domain(), v = s.knots(1).domain();
  return {(at[0] - u.lower) / u.length(), (at[1] - v.lower) / v.length()};
}

bool is_visible(const WallMotion& wall, const std::array<double, 2>& at) {
  return wall.visible == nullptr || wall.visible->contains(fractions_of(*wall.motion.from, at));
}

/// S, S_u and S_v; not finite where they cannot be evaluated.
std::array<Point, 3> jet(const Surface& s, const std::array<double, 2>& at) {
  Parameters<2> place(1, 2);
  place << at[0], at[1];
  const auto found = evaluate<2>(s, place, 1);
  if (!found) return {Point::Constant(std::nan("")), Point::Zero(), Point::Zero()};
  return {found->derivatives[0].row(0), found->derivatives[1].row(0), found->derivatives[2].row(0)};
}

Point point_of(const Surface& s, const std::array<double, 2>& at) {
  return evaluate_point<2>(s, at).value_or(Point::Constant(std::nan("")));
}

}  // namespace

/// Those of which triangles tell the side come first, then the earlier ones.
/// A point that begins nearer to a face than the triangles are exact may already lie behind it;
/// such a candidate must not crowd out one that certainly arrives.
bool ContactSearch::before(const Candidate& a, const Candidate& b) {
  return a.sure != b.sure ? a.sure : a.time < b.time;
}

std::optional<FaceContact> ContactSearch::first() {
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    if (motions_[k].motion.moves()) look(k);
  }
  std::ranges::sort(candidates_, before);
  if (candidates_.size() > most_seen) candidates_.resize(most_seen);
  return earliest(solved());
}

/// The candidates that come to a face indeed, or may between the corners, by the time at which they
/// do.
/// The limits hold for sure and unsure ones separately.
std::vector<ContactSearch::Candidate> ContactSearch::solved() const {
  std::array<int, 2> tried = {0, 0}, some = {0, 0};
  std::vector<Candidate> result;
  for (Candidate c : candidates_) {
    if (tried[c.sure] >= most_tried || some[c.sure] >= most_solved) continue;
    if ((c.met && !is_visible(motions_[*c.met], c.there)) || !counts(c, c.at)) continue;
    ++tried[c.sure];
    const auto found = passage(c, c.at, c.there);
    if (!found) continue;
    ++some[c.sure];
    c.time = found->share(tolerance_);
    c.sooner = c.margin / found->closing;
    c.there = found->there;
    if (c.time - c.sooner <= 1) result.push_back(c);
  }
  std::ranges::sort(result, {}, &Candidate::time);
  return result;
}

/// The first contact near some of them. A dent may have several deepest places: each is looked for
/// once.
/// Candidates are sorted by time. One that could not beat the contact already found, even if its
/// own time is too late by what triangles are off, is passed over.
std::optional<FaceContact> ContactSearch::earliest(std::span<const Candidate> solved) const {
  std::optional<FaceContact> first;
  std::vector<const Candidate*> looked_for;
  for (const Candidate& c : solved) {
    if (looked_for.size() >= most_places) break;
    if (first && c.time - c.sooner >= first->share) continue;
    const SpanGrid* const grid = walls_.grid_of(motions_[c.surface]);
    const auto beside_it = [&](const Candidate* other) {
      return other->surface == c.surface && grid->cells_between(other->at, c.at) <= beside;
    };
    if (std::ranges::any_of(looked_for, beside_it)) continue;
    looked_for.push_back(&c);
    auto found = refined(c);
    if (found && (!first || found->share < first->share)) first = std::move(found);
  }
  return first;
}

// Walls in other parts of an assembly do not count: parts may overlap as they are placed.
void ContactSearch::look(std::size_t surface) {
  const WallMotion& stored = motions_[surface];
  SpanGrid* const grid = walls_.grid_of(stored);
  if (grid == nullptr) return;
  const Point wider = Point::Constant(tolerance_);
  const Eigen::AlignedBox3d all(grid->box().min() - wider, grid->box().max() + wider);
  std::vector<std::pair<std::size_t, SpanGrid*>> met;
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    if (k == surface || motions_[k].part != stored.part) continue;
    SpanGrid* const other = walls_.grid_of(motions_[k]);
    if (other != nullptr && other->box().intersects(all)) met.emplace_back(k, other);
  }
  const auto around = walls_.parts_.find(stored.part);
  const bool some_around =
      around != walls_.parts_.end() && around->second.tree.box().intersects(all);
  if (grid->may_meet_itself()) met.emplace_back(surface, grid);
  if (met.empty() && !some_around) return;
  const std::vector<char>& shown = walls_.shown_spans(stored);
  for (std::size_t span = 0; span < grid->boxes().size(); ++span) {
    if (!grid->moves(span) || (!shown.empty() && shown[span] == 0)) continue;
    const Eigen::AlignedBox3d box(grid->boxes()[span].min() - wider,
                                  grid->boxes()[span].max() + wider);
    if (some_around) look_around(surface, *grid, span, box);
    for (const auto& [k, other] : met) look_at(surface, *grid, span, box, k, *other);
  }
}

/// Whether the net of a span lies on one side of a triangle that stays, all along its way, and
/// comes no nearer; or stays farther from its plane than the tolerance.
/// By the convex hull: if all control points of a span are on one side of a plane before and after,
/// so is the span on all of its way.
bool ContactSearch::separated(const SpanGrid& grid, std::size_t span, const Patch& wall,
                              std::uint32_t triangle) const {
  const auto& corners = wall.triangles[triangle];
  const Point &a = wall.from[corners[0]],
              normal = (wall.from[corners[1]] - a).cross(wall.from[corners[2]] - a);
  const double area = normal.norm(), tolerance = tolerance_ * area;
  double lowest = HUGE_VAL, highest = -HUGE_VAL, falls = 0, rises = 0;
  grid.net_of(span, [&](const auto& from, const auto& to) {
    const double before = normal.dot(from.transpose() - a), after = normal.dot(to.transpose() - a);
    lowest = std::min({lowest, before, after});
    highest = std::max({highest, before, after});
    falls = std::max(falls, before - after);
    rises = std::max(rises, after - before);
  });
  if (lowest > tolerance || highest < -tolerance) return true;
  return (lowest >= -tolerance && falls <= tolerance) ||
         (highest <= tolerance && rises <= tolerance);
}

void ContactSearch::look_around(std::size_t surface, SpanGrid& grid, std::size_t span,
                                const Eigen::AlignedBox3d& box) {
  const ModelWalls::Around& part = walls_.parts_.at(motions_[surface].part);
  std::vector<std::uint32_t> triangles;
  double sag = 0;
  part.tree.meeting(box, [&](std::uint32_t k) {
    if (separated(grid, span, part.patch, k)) return;
    triangles.push_back(k);
    sag = std::max(sag, part.sags[k]);
  });
  if (triangles.empty()) return;
  Candidate like;
  like.surface = surface;
  like.margin = sag;
  compare(grid.patch(span), part.patch, triangles, like);
}

void ContactSearch::look_at(std::size_t surface, SpanGrid& grid, std::size_t span,
                            const Eigen::AlignedBox3d& box, std::size_t wall, SpanGrid& met) {
  std::vector<std::uint32_t> triangles;
  met.tree().meeting(box, [&](std::uint32_t other) {
    const Patch& patch = met.patch(other);
    triangles.clear();
    for (std::uint32_t k = 0; k < patch.triangles.size(); ++k) {
      Eigen::AlignedBox3d around;
      for (const auto corner : patch.triangles[k])
        around.extend(patch.from[corner]).extend(patch.to[corner]);
      const Point wider = Point::Constant(patch.sag);
      around.extend(around.min() - wider).extend(around.max() + wider);
      if (!around.intersects(box)) continue;
      if (!met.motion().moves() && patch.sag <= tolerance_ && separated(grid, span, patch, k))
        continue;
      triangles.push_back(k);
    }
    if (triangles.empty()) return;
    Candidate like;
    like.surface = surface;
    like.met = wall;
    like.margin = patch.sag;
    compare(grid.patch(span), patch, triangles, like);
  });
}

/// The corners of each of two patches with the triangles of the other, of the wall only these.
void ContactSearch::compare(const Patch& patch, const Patch& wall,
                            std::span<const std::uint32_t> triangles, Candidate like) {
  like.margin += patch.sag;
  // Of faces around, triangles are the face: what they are off is never corrected by a later stage.
  const double exact = like.met ? 0 : like.margin - patch.sag;
  // Beside a point its own face has no side that triangles could tell.
  const bool own_face = like.met == like.surface;
  const double nearest = tolerance_ + (own_face ? like.margin : exact), along = like.margin;
  const Reach reach{nearest, along, tolerance_ + like.margin - patch.sag},
      back{nearest, along, tolerance_ + patch.sag};
  const SpanGrid* const self = own_face ? walls_.grid_of(motions_[like.surface]) : nullptr;
  const auto keep = [&](const PlaneMeeting& found) {
    like.time = found.time - tolerance_ / found.closing;
    like.sure = found.time * found.closing > tolerance_ + like.margin;
    if (self == nullptr || self->cells_between(like.at, like.there) > beside)
      candidates_.push_back(like);
  };
  const auto first = static_cast<std::ptrdiff_t>(candidates_.size());
  // The other side of a face looks the other way.
  const std::vector<Point> normals = own_face ? normals_of(patch) : std::vector<Point>(),
                           facing = own_face ? normals_of(wall) : std::vector<Point>();
  const Eigen::AlignedBox3d whole = box_round(patch.from, patch.to, back.aside);
  for (const std::uint32_t k : triangles) {
    const auto& corners = wall.triangles[k];
    Eigen::AlignedBox3d box;
    for (const auto corner : corners) box.extend(wall.from[corner]).extend(wall.to[corner]);
    const Point wider = Point::Constant(reach.aside + like.margin);
    box = {box.min() - wider, box.max() + wider};
    for (std::size_t i = 0; i < patch.from.size(); ++i) {
      if (!box.intersects(Eigen::AlignedBox3d(patch.from[i]).extend(patch.to[i]))) continue;
      if (own_face && !faces_away(wall, corners, normals[i])) continue;
      const auto found = meeting(patch.from[i], patch.to[i], wall, corners, tolerance_, reach);
      if (!found) continue;
      like.at = patch.at[i];
      if (like.met) like.there = place_in(wall, corners, found->weights);
      keep(*found);
    }
    for (const auto corner : corners) {
      if (!whole.intersects(Eigen::AlignedBox3d(wall.from[corner]).extend(wall.to[corner])))
        continue;
      for (const auto& triangle : patch.triangles) {
        if (own_face && !faces_away(patch, triangle, facing[corner])) continue;
        const auto found =
            meeting(wall.from[corner], wall.to[corner], patch, triangle, tolerance_, back);
        if (!found) continue;
        like.at = place_in(patch, triangle, found->weights);
        if (like.met) like.there = wall.at[corner];
        keep(*found);
      }
    }
  }
  // A dent gives dozens of vertices of one pair, which all lead stage 3 to the same place.
  if (candidates_.size() <= static_cast<std::size_t>(first) + most_of_a_pair) return;
  std::partial_sort(candidates_.begin() + first, candidates_.begin() + first + most_of_a_pair,
                    candidates_.end(), before);
  candidates_.resize(static_cast<std::size_t>(first) + most_of_a_pair);
}

/// Whether a point is visible, and goes farther from the surface as opened.
/// What returns towards the shape as opened may pass a wall: so a surface that is already behind
/// one can be brought back.
bool ContactSearch::counts(const Candidate& c, const std::array<double, 2>& at) const {
  const WallMotion& stored = motions_[c.surface];
  if (!is_visible(stored, at)) return false;
  const Point home = point_of(*stored.opened, at);
  return (point_of(*stored.motion.to, at) - home).norm() >
         (point_of(*stored.motion.from, at) - home).norm();
}

std::optional<ContactSearch::Passage> ContactSearch::passage(
    const Candidate& c, const std::array<double, 2>& at, const std::array<double, 2>& there) const {
  const Motion& motion = motions_[c.surface].motion;
  const std::array<Point, 2> way = {point_of(*motion.from, at), point_of(*motion.to, at)};
  return c.met ? passage_of(c, at, way, there) : passage_around(c, way);
}

/// The first of the triangles around that the way of a point leads to.
std::optional<ContactSearch::Passage> ContactSearch::passage_around(
    const Candidate& c, const std::array<Point, 2>& way) const {
  const ModelWalls::Around& part = walls_.parts_.at(motions_[c.surface].part);
  Eigen::AlignedBox3d box;
  box.extend(way[0]).extend(way[1]);
  const Point wider = Point::Constant(c.margin + tolerance_);
  box = {box.min() - wider, box.max() + wider};
  std::optional<Passage> first;
  part.tree.meeting(box, [&](std::uint32_t k) {
    const Reach reach{tolerance_ + part.sags[k], c.margin, tolerance_};
    const auto found =
        meeting(way[0], way[1], part.patch, part.patch.triangles[k], tolerance_, reach);
    if (!found || (first && found->time >= first->time)) return;
    first = Passage{found->time, found->closing, {}, part.faces[k]};
  });
  return first;
}

/// Newton's method for W(u', v', t) = S(t), from where triangles met.
/// Three equations in three unknowns. With W = (1 − t) W_0 + t W_1 and r the velocity of the wall
/// relative to the point, the Jacobian is (r, W_u, W_v), solved by Cramer's rule: its determinant
/// is r · (W_u × W_v), the speed of approach along the normal times the cell's area, and vanishes
/// only for grazing motion, which is no contact. Convergence is quadratic from triangles that are
/// right to a fraction of a cell. |determinant| / |W_u × W_v| is how far the two come nearer along
/// the normal during the whole motion.
std::optional<ContactSearch::Passage> ContactSearch::passage_of(const Candidate& c,
                                                                const std::array<double, 2>& at,
                                                                const std::array<Point, 2>& way,
                                                                std::array<double, 2> there) const {
  constexpr int most_iterations = 12;
  constexpr double accuracy = 1e-3;  // of the tolerance
  const WallMotion& wall = motions_[*c.met];
  const Surface &from = *wall.motion.from, &to = *wall.motion.to;
  // Of the domain: at its end may be a pole, where there is no normal.
  constexpr double inside = 1e-3;
  for (std::size_t d = 0; d < 2; ++d) {
    const Interval domain = from.knots()[d].domain();
    const double margin = inside * domain.length();
    there[d] = std::clamp(there[d], domain.lower + margin, domain.upper - margin);
  }
  double time = std::clamp(c.time, 0.0, 1.0);
  for (int k = 0; k < most_iterations; ++k) {
    const auto before = jet(from, there), after = wall.motion.moves() ? jet(to, there) : before;
    std::array<Point, 3> w;
    for (std::size_t d = 0; d < 3; ++d) w[d] = (1 - time) * before[d] + time * after[d];
    const Point gap = w[0] - ((1 - time) * way[0] + time * way[1]);
    const Point relative = after[0] - before[0] - (way[1] - way[0]), normal = w[1].cross(w[2]);
    const double volume = relative.dot(normal);
    if (!gap.allFinite() || volume == 0) return std::nullopt;
    if (gap.norm() <= accuracy * tolerance_) {
      const double closing = std::abs(volume) / normal.norm();
      const bool near =
          c.met == c.surface && walls_.grid_of(wall)->cells_between(at, there) <= beside;
      if (near || !(closing > tolerance_ && time * closing > tolerance_) ||
          !is_visible(wall, there)) {
        return std::nullopt;
      }
      return Passage{time, closing, there, 0};
    }
    time -= gap.dot(normal) / volume;
    there[0] -= gap.dot(w[2].cross(relative)) / volume;
    there[1] -= gap.dot(relative.cross(w[1])) / volume;
    for (std::size_t d = 0; d < 2; ++d) {
      const Interval domain = from.knots()[d].domain();
      there[d] = std::clamp(there[d], domain.lower, domain.upper);
    }
  }
  return std::nullopt;
}

/// The first point of the neighbourhood to come to the face, by a compass search.
/// The time of arrival is a function of two parameters that need not be smooth: it ends at trims
/// and changes wall. A compass search needs no derivative and always descends (Kolda, Lewis and
/// Torczon, SIAM Review 45, 2003). Steps are halved thirteen times, from a cell to 1e-4 of it.
std::optional<FaceContact> ContactSearch::refined(const Candidate& c) const {
  constexpr int halvings = 13, most_rounds = 60;
  const Surface& shape = *motions_[c.surface].motion.from;
  auto best = passage(c, c.at, c.there);
  if (!best) return std::nullopt;
  std::array<double, 2> at = c.at, step{};
  for (std::size_t d = 0; d < 2; ++d) {
    const KnotVector& knots = shape.knots()[d];
    const int s = knots.find_span(at[d]);
    step[d] = (knots[s + 1] - knots[s]) / SpanGrid::cells;
  }
  for (int halved = 0, round = 0; halved < halvings && round < most_rounds; ++round) {
    bool any = false;
    for (const auto& [d, sign] : {std::pair{0U, 1.0}, {0U, -1.0}, {1U, 1.0}, {1U, -1.0}}) {
      std::array<double, 2> next = at;
      const Interval domain = shape.knots()[d].domain();
      next[d] = std::clamp(at[d] + sign * step[d], domain.lower, domain.upper);
      if (next[d] == at[d] || !counts(c, next)) continue;
      const auto found = passage(c, next, best->there);
      if (!found || found->share(tolerance_) >= best->share(tolerance_)) continue;
      best = found;
      at = next;
      any = true;
    }
    if (any) continue;
    for (double& s : step) s /= 2;
    ++halved;
  }
  FaceContact result;
  result.share = best->share(tolerance_);
  if (result.share > 1) return std::nullopt;
  // The share of the motion that leaves twice the tolerance: the next step then begins outside of
  // the tolerance, and a wall that was stopped at is not met at once again.
  result.room = std::clamp(best->share(2 * tolerance_), 0.0, 1.0);
  result.surface = c.surface;
  result.met = c.met;
  if (!c.met) result.face = walls_.around_->faces[best->face].id;
  result.at = at;
  const Motion& motion = motions_[c.surface].motion;
  result.place =
      (1 - result.share) * point_of(*motion.from, at) + result.share * point_of(*motion.to, at);
  return result;
}

}  // namespace knead
