#include "boundary_edges.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "knead/spline/evaluate.hpp"
#include "model_builder.hpp"

namespace knead::brep {
namespace {

// Makes edges and vertices of boundaries that a file gives as loose curves, face by face (IGES
// entities 141 and 143, STEP curve-bounded surfaces): a curve becomes an edge once, and what runs
// along it again, within the same distance, is another use of that edge.
// Candidates are found by the x coordinate of a vertex, or of the middle of an edge, in an ordered
// map: O(log n) each if the model is not flat in x. For one that is, `most_compared` bounds the
// work; what is not found in time becomes an edge of its own, and the faces stay unconnected there.
constexpr std::size_t most_compared = 4000;  // edges or vertices with about the same x
constexpr double least_length = 4;   // of sewn pieces, in distances within which points are one
constexpr double least_same = 1e-6;  // of the size of a boundary
constexpr std::array quarters = {0.25, 0.5, 0.75};

}  // namespace

void BoundaryPiece::set(std::shared_ptr<const Curve> curve, const Interval& range) {
  geometry = CurveGeometry{curve};
  at = [curve = std::move(curve), range](double t) {
    const double u = range.lower + t * range.length();
    const auto p = evaluate_point<1>(*curve, {std::clamp(u, range.lower, range.upper)});
    return p ? *p : Point(curve->control_points().row(0).transpose());
  };
}

/// Turns pieces, and returns the distance within which their points are one. A piece that is closed
/// to this begins and ends there both ways: it keeps its direction, in which roundings of its ends
/// say nothing.
/// Formats differ in whether directions of pieces mean anything. The first piece is turned so that
/// it ends nearer to the second, each other one so that it begins nearer to the end of the one
/// before.
double BoundaryEdges::chain(const std::vector<BoundaryPiece*>& pieces, double resolution) {
  Eigen::AlignedBox3d box;
  for (const BoundaryPiece* piece : pieces) box.extend(piece->from()).extend(piece->at(0.5));
  const double same = std::max(resolution, least_same * box.diagonal().norm());
  if (pieces.size() < 2 ||
      (pieces.size() == 2 && (pieces[0]->to() - pieces[1]->from()).norm() == 0))
    return same;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    BoundaryPiece& piece = *pieces[k];
    if ((piece.from() - piece.to()).norm() <= same && (piece.at(0.5) - piece.from()).norm() > same)
      continue;
    if (k == 0) {
      const BoundaryPiece& next = *pieces[1];
      const auto gap = [&](const Point& p) {
        return std::min((next.from() - p).norm(), (next.to() - p).norm());
      };
      if (gap(piece.from()) < gap(piece.to())) piece.reversed = !piece.reversed;
      continue;
    }
    const Point end = pieces[k - 1]->to();
    if ((piece.to() - end).norm() < (piece.from() - end).norm()) piece.reversed = !piece.reversed;
  }
  return same;
}

void BoundaryEdges::begin(double same, Group group) {
  ++loop_;
  same_ = same;
  group_ = group;
}

Index BoundaryEdges::vertex(const Point& p) {
  const auto end = corners_.upper_bound(p.x() + same_);
  std::size_t compared = 0;
  for (auto at = corners_.lower_bound(p.x() - same_); at != end && compared < most_compared;
       ++at, ++compared) {
    const Corner& corner = at->second;
    if ((sews(corner.group) || corner.loop == loop_) && meet(corner.place, p)) return corner.vertex;
  }
  const Index made = add_vertex(model_, fresh_(), p);
  corners_.emplace(p.x(), Corner{loop_, group_, p, made});
  return made;
}

std::optional<bool> BoundaryEdges::against(const Known& known, const BoundaryPiece& piece) const {
  const BoundaryPiece& other = known.piece;
  const auto run = [&](double t) { return piece.at(piece.reversed ? 1 - t : t); };
  // Within one loop only a seam counts, traversed there and back: two sides of a narrow face may be
  // as near to each other, and run the same way.
  if (known.loop == loop_) {  // there and back
    if (!meet(other.from(), piece.to()) || !meet(other.to(), piece.from()) ||
        !meet(other.at(0.5), piece.at(0.5)))
      return std::nullopt;
    return !other.reversed;
  }
  if (!sews(known.group)) return std::nullopt;
  // Pieces shorter than a few resolutions would match whatever is beside them.
  const auto far = [&](double t) { return (run(t) - run(0)).norm() > least_length * same_; };
  if (!std::ranges::any_of(quarters, far)) return std::nullopt;
  // Ends, middle and quarters: five points tell curves apart that files do give, such as both
  // halves of a circle, which share their ends.
  for (const bool back : {true, false}) {
    const auto same = [&](double t) { return meet(other.at(back ? 1 - t : t), run(t)); };
    if (same(0) && same(1) && std::ranges::all_of(quarters, same)) return back;
  }
  return std::nullopt;
}

BoundaryEdges::Use BoundaryEdges::of(const BoundaryPiece& piece) {
  const double x = piece.at(0.5).x();
  const auto end = known_.upper_bound(x + same_);
  std::size_t compared = 0;
  for (auto at = known_.lower_bound(x - same_); at != end && compared < most_compared;
       ++at, ++compared) {
    const auto back = against(at->second, piece);
    if (back) return {at->second.edge, !*back, *back != piece.reversed};
  }
  const Index from = vertex(piece.at(0)), to = vertex(piece.at(1));
  const Index edge = add(piece, from, to);
  known_.emplace(x, Known{edge, loop_, group_, piece});
  return {edge, !piece.reversed, false};
}

Index BoundaryEdges::add(const BoundaryPiece& piece, Index from, Index to) {
  const bool named = !piece.name.empty() && named_.insert(piece.name).second;
  return add_edge(model_, named ? piece.name : fresh_(), from, to, piece.geometry);
}

}  // namespace knead::brep
