#include "knead/hold/seams.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "seams_edge.hpp"

namespace knead {
namespace {

/// A tenth of an edge: a shorter common part is a corner, not a seam.
constexpr double least_common_part = 0.1;

struct Edge {
  PatchEdge id;
  const Surface* surface = nullptr;
  std::vector<double> t;
  Points points;
  Point lower, upper;
  double length = 0, longest = 0;  // of the polyline, and of its longest piece
  /// For piece k, from sample k to the next, a bound on the deviation of the curve from it: an arc
  /// with second differences d of its samples deviates by d/8.
  std::vector<double> stray;
  struct Block {
    Eigen::Index begin, end;  // pieces
    Point lower, upper;
  };
  std::vector<Block> blocks;  // of neighbouring pieces, to skip many at once
};

constexpr Eigen::Index block_size = 16;

// The curve between two samples strays from its chord by about |second difference|/8; the whole
// second difference of either end is taken, eight times as much, as a bound for curves that are not
// arcs.
void complete(Edge& edge) {
  const Eigen::Index pieces = edge.points.rows() - 1;
  std::vector<double> bends(static_cast<std::size_t>(pieces + 1), 0.0);
  for (Eigen::Index k = 1; k < pieces; ++k) {
    bends[static_cast<std::size_t>(k)] =
        (edge.points.row(k + 1) - 2 * edge.points.row(k) + edge.points.row(k - 1)).norm();
  }
  for (Eigen::Index k = 0; k < pieces; ++k) {
    const double piece = (edge.points.row(k + 1) - edge.points.row(k)).norm();
    edge.length += piece;
    edge.longest = std::max(edge.longest, piece);
    edge.stray.push_back(
        std::max(bends[static_cast<std::size_t>(k)], bends[static_cast<std::size_t>(k + 1)]));
  }
  for (Eigen::Index k = 0; k < pieces; k += block_size) {
    const Eigen::Index end = std::min(k + block_size, pieces);
    const auto rows = edge.points.middleRows(k, end - k + 1);
    edge.blocks.push_back({k, end, rows.colwise().minCoeff(), rows.colwise().maxCoeff()});
  }
}

Expected<Edge> sampled(const PatchEdge& id, const Surface& surface) {
  Edge edge;
  edge.id = id;
  edge.surface = &surface;
  edge.t = seams::edge_samples(surface.knots(edge_along(id.edge)));
  auto points = seams::evaluate_edge(surface, id.edge, edge.t, 0);
  if (!points) return std::unexpected(points.error());
  edge.points = std::move(points->derivatives.front());
  edge.lower = edge.points.colwise().minCoeff();
  edge.upper = edge.points.colwise().maxCoeff();
  complete(edge);
  return edge;
}

/// The position of an edge relative to a curve: the nearest points of its samples.
struct Beside {
  bool all = true;
  double gap = 0,
         common = 0;  // over the samples within the tolerance; length of the pieces between such
};

double distance_to_segment(const Point& x, const Point& a, const Point& b, double& s) {
  const Point d = b - a;
  const double squared = d.squaredNorm();
  s = squared > 0 ? std::clamp((x - a).dot(d) / squared, 0.0, 1.0) : 0;
  return (x - a - s * d).norm();
}

double box_distance(const Point& lower, const Point& upper, const Point& x) {
  return (lower - x).cwiseMax(x - upper).cwiseMax(0).norm();
}

/// The nearest point of a curve.
struct Foot {
  double distance = INFINITY, t = 0;
};

/// That of the edge's curve to x, where it is nearer than `limit`: on the nearest piece of the
/// polyline, then by Gauss–Newton on |C(t) − x|² about it.
///
/// The polyline says which piece is nearest, within its own deviation (`stray`), and Gauss–Newton
/// refines: t ← t + (x − C)·C'/|C'|², quadratic where x is on the curve and linear with a small
/// factor near it. t stays within one piece to either side, or it might slip to another branch of
/// the curve.
std::optional<Foot> foot_on(const Point& x, const Edge& edge, double limit) {
  double nearest = limit + edge.longest, t = 0;
  std::size_t piece = edge.t.size();
  for (const Edge::Block& block : edge.blocks) {
    if (box_distance(block.lower, block.upper, x) >= nearest) continue;
    for (Eigen::Index k = block.begin; k < block.end; ++k) {
      double s = 0;
      const double d = distance_to_segment(x, edge.points.row(k), edge.points.row(k + 1), s);
      if (d >= nearest) continue;
      nearest = d;
      piece = static_cast<std::size_t>(k);
      t = edge.t[piece] + s * (edge.t[piece + 1] - edge.t[piece]);
    }
  }
  if (piece == edge.t.size() || nearest > limit + edge.stray[piece]) return std::nullopt;
  const double low = edge.t[piece > 0 ? piece - 1 : 0],
               high = edge.t[std::min(piece + 2, edge.t.size() - 1)];
  const double scale = edge.surface->knots(edge_along(edge.id.edge)).domain().length();
  Foot best;
  for (int iteration = 0; iteration < 12; ++iteration) {
    const auto at = seams::evaluate_edge(*edge.surface, edge.id.edge, {&t, 1}, 1);
    if (!at) return std::nullopt;
    const Point offset = x - at->points().row(0).transpose();
    const Point tangent =
        scale * at->at(edge_along(edge.id.edge) == 0 ? MultiIndex<2>{1, 0} : MultiIndex<2>{0, 1})
                    .row(0)
                    .transpose();
    if (offset.norm() < best.distance) best = {offset.norm(), t};
    if (tangent.squaredNorm() == 0) break;
    const double next = std::clamp(t + offset.dot(tangent) / tangent.squaredNorm(), low, high);
    if (std::abs(next - t) <= 1e-14) break;
    t = next;
  }
  return best.distance <= limit ? std::optional(best) : std::nullopt;
}

Beside beside(const Edge& edge, const Edge& curve, double tolerance) {
  Beside result;
  bool before = false;
  for (Eigen::Index k = 0; k < edge.points.rows(); ++k) {
    const auto foot = foot_on(edge.points.row(k), curve, tolerance);
    if (foot) {
      result.gap = std::max(result.gap, foot->distance);
      if (before) result.common += (edge.points.row(k) - edge.points.row(k - 1)).norm();
    }
    result.all = result.all && foot;
    before = foot.has_value();
  }
  return result;
}

/// Largest distance of the samples of `edge` from the points of `other` at the mapped parameters.
///
/// Parameters normalised to [0, 1] at both sides: a seam is `whole` only if the same t is the same
/// point, which is what conditions on coefficients need.
double mapped_gap(const Edge& edge, const Edge& other, bool reversed) {
  std::vector<double> t = edge.t;
  if (reversed) {
    for (double& s : t) s = 1 - s;
  }
  const auto there = seams::evaluate_edge(*other.surface, other.id.edge, t, 0);
  return there ? (there->points() - edge.points).rowwise().norm().maxCoeff() : INFINITY;
}

/// Whether the isocurves between two opposite edges stay within the tolerance of the edge.
///
/// Opposite sides of a patch that is thinner than the tolerance are near each other without being a
/// seam: then everything between them is near as well.
bool flat_between(const Edge& edge, double tolerance) {
  const int across = edge_across(edge.id.edge);
  const Interval domain = edge.surface->knots(across).domain(),
                 along = edge.surface->knots(1 - across).domain();
  std::vector<double> line;
  for (double s : edge.t)
    line.push_back(std::clamp(along.lower + s * along.length(), along.lower, along.upper));
  for (int quarter = 1; quarter < 4; ++quarter) {
    const double middle = domain.lower + domain.length() * quarter / 4;
    const std::span<const double> fixed(&middle, 1);
    const auto isocurve = across == 0 ? evaluate_grid<2>(*edge.surface, {fixed, line})
                                      : evaluate_grid<2>(*edge.surface, {line, fixed});
    if (!isocurve || (isocurve->points() - edge.points).rowwise().norm().maxCoeff() > tolerance)
      return false;
  }
  return true;
}

// From the strictest to the loosest: the same curve with the same parameters (either way), the same
// curve with others, part of it, nothing.
std::optional<Seam> compare(const Edge& a, const Edge& b, double tolerance) {
  const bool itself = a.id == b.id;
  if (a.id.patch == b.id.patch && !itself && edge_across(a.id.edge) == edge_across(b.id.edge) &&
      flat_between(a, tolerance)) {
    return std::nullopt;
  }
  const Eigen::Index last_a = a.points.rows() - 1, last_b = b.points.rows() - 1;
  const auto near = [&](Eigen::Index i, Eigen::Index j) {
    return (a.points.row(i) - b.points.row(j)).norm() <= tolerance;
  };
  Seam seam{a.id, b.id};
  seam.gap = INFINITY;
  for (bool reversed : {false, true}) {
    if (itself && !reversed) continue;
    if (reversed ? !(near(0, last_b) && near(last_a, 0)) : !(near(0, 0) && near(last_a, last_b)))
      continue;
    const double gap = std::max(mapped_gap(a, b, reversed), mapped_gap(b, a, reversed));
    if (gap <= tolerance && gap < seam.gap) {
      seam.gap = gap;
      seam.reversed = reversed;
    }
  }
  if (seam.gap <= tolerance) return seam;
  if (itself) return std::nullopt;

  const Beside ab = beside(a, b, tolerance);
  if (ab.common == 0) return std::nullopt;
  const Beside ba = beside(b, a, tolerance);
  seam.gap = std::max(ab.gap, ba.gap);
  seam.reversed =
      (a.points.row(last_a) - a.points.row(0)).dot(b.points.row(last_b) - b.points.row(0)) < 0;
  if (ab.all && ba.all) {
    seam.kind = SeamKind::reparametrised;
  } else if (ab.common >= least_common_part * a.length ||
             ba.common >= least_common_part * b.length) {
    seam.kind = SeamKind::partial;
  } else {
    return std::nullopt;
  }
  return seam;
}

/// The side of its normal on which a patch lies along its edge: that of (edge's tangent) ×
/// (inwards) · (S_u × S_v).
double turn_along(SurfaceEdge edge) {
  return edge == SurfaceEdge::u0 || edge == SurfaceEdge::v1 ? -1 : 1;
}

}  // namespace

// From the first patch along seams until nothing is added. On a one-sided surface the result
// depends on the way; all patches get a side.
std::vector<double> seam_sides(std::span<const Seam> seams, int patches, int first) {
  std::vector<double> sides(static_cast<std::size_t>(patches), 0);
  const auto side = [&sides](int patch) -> double& {
    return sides[static_cast<std::size_t>(patch)];
  };
  side(first) = 1;
  for (bool more = true; more;) {
    more = false;
    for (const Seam& seam : seams) {
      const bool from_a = side(seam.a.patch) != 0;
      if (seam.kind == SeamKind::reparametrised || from_a == (side(seam.b.patch) != 0)) continue;
      // The patches lie on both sides of the edge: the same turn along it is a turn of the normal.
      const double same =
          -turn_along(seam.a.edge) * turn_along(seam.b.edge) * (seam.reversed ? -1 : 1);
      if (from_a) {
        side(seam.b.patch) = same * side(seam.a.patch);
      } else {
        side(seam.a.patch) = same * side(seam.b.patch);
      }
      more = true;
    }
  }
  std::ranges::replace(sides, 0., 1.);
  return sides;
}

// Cost: O(edges · those whose boxes overlap along x), each comparison O(samples · pieces near). A
// side is compared with itself, too: it may be folded, one half on the other.
Expected<FoundSeams> find_seams(std::span<const Surface* const> patches, double tolerance) {
  if (!(tolerance > 0) || !std::isfinite(tolerance)) {
    return input_error("the tolerance of seams is not a positive length", {},
                       "a small part of the model's size");
  }
  FoundSeams found;
  std::vector<Edge> edges;
  for (std::size_t patch = 0; patch < patches.size(); ++patch) {
    for (SurfaceEdge side : {SurfaceEdge::u0, SurfaceEdge::u1, SurfaceEdge::v0, SurfaceEdge::v1}) {
      const PatchEdge id{static_cast<int>(patch), side};
      auto edge = sampled(id, *patches[patch]);
      if (!edge) {
        found.unusable.emplace_back(id, edge.error());
      } else if (const double size = (edge->upper - edge->lower).norm(); size <= tolerance) {
        found.collapsed.push_back({id, size});
      } else {
        edges.push_back(*std::move(edge));
      }
    }
  }

  // Sweep along x; between samples a curve deviates by less than a piece of its polyline.
  std::vector<const Edge*> order;
  for (const Edge& edge : edges) order.push_back(&edge);
  const auto begin = [](const Edge* edge) { return edge->lower.x() - edge->longest; };
  std::ranges::stable_sort(order, {}, begin);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Edge& first = *order[i];
    for (std::size_t j = i; j < order.size(); ++j) {
      const Edge& second = *order[j];
      if (begin(&second) > first.upper.x() + first.longest + tolerance) break;
      const double margin = tolerance + first.longest + second.longest;
      if (((first.lower - second.upper).array() > margin).any() ||
          ((second.lower - first.upper).array() > margin).any()) {
        continue;
      }
      const bool ordered = &first <= &second;
      if (auto seam = compare(ordered ? first : second, ordered ? second : first, tolerance))
        found.seams.push_back(*seam);
    }
  }
  std::ranges::sort(found.seams, {}, [](const Seam& s) {
    return std::tuple(s.a.patch, static_cast<int>(s.a.edge), s.b.patch, static_cast<int>(s.b.edge));
  });
  return found;
}

// Parameters whose points lay together before are compared: where the sides of a seam slide along
// each other there is a gap, too.
Expected<double> moved_gap(const Seam& seam, std::span<const Surface* const> before,
                           std::span<const Surface* const> now) {
  const auto patch = [](std::span<const Surface* const> all, const PatchEdge& e) -> const Surface& {
    return *all[static_cast<std::size_t>(e.patch)];
  };
  double gap = 0;
  for (const auto& [of, on] : {std::pair{seam.a, seam.b}, std::pair{seam.b, seam.a}}) {
    const auto edge = sampled(of, patch(before, of)), other = sampled(on, patch(before, on));
    if (!edge) return std::unexpected(edge.error());
    if (!other) return std::unexpected(other.error());
    std::vector<double> here, there;  // parameters of points that were together
    for (std::size_t k = 0; k < edge->t.size(); ++k) {
      std::optional<double> t;
      if (seam.kind == SeamKind::whole) {
        t = seam.reversed ? 1 - edge->t[k] : edge->t[k];
      } else if (const auto foot =
                     foot_on(edge->points.row(static_cast<Eigen::Index>(k)), *other, seam.gap)) {
        t = foot->t;
      }
      if (!t) continue;
      here.push_back(edge->t[k]);
      there.push_back(*t);
    }
    if (here.empty()) continue;
    const auto a = seams::evaluate_edge(patch(now, of), of.edge, here, 0);
    if (!a) return std::unexpected(a.error());
    const auto b = seams::evaluate_edge(patch(now, on), on.edge, there, 0);
    if (!b) return std::unexpected(b.error());
    gap = std::max(gap, (a->points() - b->points()).rowwise().norm().maxCoeff());
  }
  return gap;
}

double suggested_seam_tolerance(std::span<const Surface* const> patches) {
  Point lower = Point::Constant(INFINITY), upper = -lower;
  for (const Surface* patch : patches) {
    lower = lower.cwiseMin(patch->control_points().colwise().minCoeff().transpose());
    upper = upper.cwiseMax(patch->control_points().colwise().maxCoeff().transpose());
  }
  return patches.empty() ? 0 : 1e-4 * (upper - lower).norm();
}

}  // namespace knead
