#include "face_loops.hpp"

#include <algorithm>
#include <cassert>

namespace knead::brep {
namespace {

Expected<Point> vertex_place(const Vertex& vertex) {
  if (vertex.wrong) return std::unexpected(*vertex.wrong);
  return vertex.place;
}

}  // namespace

// The parameters of an edge's ends are those of its vertices on the curve (ISO 10303-42,
// clause 5.5, edge_curve: it has no parameters of its own). `backwards` is the edge's sense against
// the curve as it is parametrised here. A closed curve may start anywhere: the end is then one
// period further, at most.
Expected<EdgePiece> edge_piece(const Model& model, Index edge) {
  const Edge& stored = model.edges[edge];
  if (stored.start == none || stored.end == none) return std::unexpected(*stored.wrong);
  const bool same_vertex = stored.start == stored.end;
  const auto start = vertex_place(model.vertices[stored.start]);
  const auto end = vertex_place(model.vertices[stored.end]);
  if (!start) return std::unexpected(start.error());
  if (!end) return std::unexpected(end.error());
  if (stored.wrong) return std::unexpected(*stored.wrong);
  auto curve = EdgeCurve::create(*stored.curve);
  if (!curve) return std::unexpected(std::move(curve.error()));

  bool backwards = !stored.same_sense != curve->turned();
  double from = curve->parameter(backwards ? *end : *start);
  double to = curve->parameter(backwards ? *start : *end);
  const auto domain = curve->domain();
  if (curve->closed()) {
    // Forwards from one to the other; the same vertex twice means the whole curve.
    const double near = 1e-9 * domain->length();
    if (from >= domain->upper - near) from = domain->lower;
    if (same_vertex) to = from;
    if (to <= from + near) to += domain->length();
  } else if (same_vertex && domain) {
    from = domain->lower;
    to = domain->upper;
  } else if (to < from) {
    std::swap(from, to);  // against the stated sense of the edge, yet the same points
    backwards = !backwards;
  }
  return EdgePiece{*std::move(curve), from, to, backwards, stored.start, stored.end, *start, *end};
}

Expected<EdgeSampler::Sampled> EdgeSampler::sample(Index edge) const {
  auto piece = edge_piece(*model_, edge);
  if (!piece) return std::unexpected(piece.error());
  Sampled result{{}, std::move(piece->curve)};
  result.parameters = result.curve.subdivided(piece->from, piece->to, chord_);
  if (piece->backwards) std::reverse(result.parameters.begin(), result.parameters.end());
  for (const double t : result.parameters) result.points.push_back(result.curve.at(t));
  // The vertices themselves, so that the edges that meet in one share its bits, and triangles of
  // neighbouring faces close.
  result.points.front() = piece->start;
  result.points.back() = piece->end;
  return result;
}

Expected<EdgeSampler::Sampled>& EdgeSampler::sampled(Index edge) {
  auto found = edges_.find(edge);
  if (found == edges_.end()) found = edges_.emplace(edge, sample(edge)).first;
  return found->second;
}

Expected<const Loop*> EdgeSampler::edge(Index edge) {
  const auto& found = sampled(edge);
  if (!found) return std::unexpected(found.error());
  return &found->points;
}

Expected<void> EdgeSampler::divide(Index edge, std::span<const int> pieces) {
  auto& found = sampled(edge);
  if (!found) return std::unexpected(found.error());
  assert(pieces.size() + 1 == found->points.size());
  Sampled finer{{{found->parameters.front()}, {found->points.front()}}, std::move(found->curve)};
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const double from = found->parameters[k], to = found->parameters[k + 1];
    for (int i = 1; i < pieces[k]; ++i) {
      finer.parameters.push_back(from + (to - from) * i / pieces[k]);
      finer.points.push_back(finer.curve.at(finer.parameters.back()));
    }
    finer.parameters.push_back(to);
    finer.points.push_back(found->points[k + 1]);
  }
  *found = std::move(finer);
  return {};
}

Expected<EdgeSampler::Division> EdgeSampler::division(Index edge) {
  const auto& found = sampled(edge);
  if (!found) return std::unexpected(found.error());
  return *found;
}

void EdgeSampler::restore(Index edge, Division division) {
  if (auto& found = sampled(edge)) static_cast<Division&>(*found) = std::move(division);
}

Expected<Loop> EdgeSampler::loop(const Bound& bound) {
  Loop result;
  if (bound.kind == Bound::Kind::vertex) return result;
  if (bound.wrong && bound.edges.empty()) return std::unexpected(*bound.wrong);
  if (bound.kind == Bound::Kind::polygon) return bound.polygon;
  std::unordered_map<Index, std::array<int, 2>> ways;  // how often along each edge, and against it
  for (const EdgeUse& use : bound.edges) {
    const auto points = edge(use.edge);
    if (!points) return std::unexpected(points.error());
    Loop piece = **points;
    if (!use.forward) std::reverse(piece.begin(), piece.end());
    ++ways[use.edge][use.forward ? 0 : 1];
    result.insert(result.end(), piece.begin(),
                  piece.end() - 1);  // the last one begins the next piece
  }
  if (bound.wrong) return std::unexpected(*bound.wrong);
  // A loop that goes back along every edge it came by encloses nothing: the boundary of a whole
  // closed surface, such as the seam of a sphere. It is no bound of its region.
  const bool seams = std::all_of(ways.begin(), ways.end(),
                                 [](const auto& edge) { return edge.second[0] == edge.second[1]; });
  if (seams) result.clear();
  return result;
}

Expected<std::vector<Loop>> EdgeSampler::loops(const Face& face) {
  std::vector<Loop> result;
  for (const Bound& bound : face.bounds) {
    auto points = loop(bound);
    if (!points) return std::unexpected(std::move(points.error()));
    if (points->empty()) continue;
    if (!bound.forward) std::reverse(points->begin(), points->end());
    result.push_back(*std::move(points));
  }
  return result;
}

}  // namespace knead::brep
