#include "face_loops.hpp"

#include <algorithm>
#include <cassert>

namespace knead::step {
namespace {

Expected<Point> vertex_place(const Reader& reader, std::uint32_t vertex) {
  const auto own = reader.attributes(vertex, "VERTEX_POINT", 1, 1);
  const auto geometry = own.empty() ? std::nullopt : reader.reference(own[0]);
  if (!geometry) return reader.error(vertex, "a VERTEX_POINT is needed here");
  return reader.point(*geometry);
}

}  // namespace

Expected<EdgePiece> edge_piece(const Reader& reader, std::uint32_t instance) {
  // EDGE(start, end) and EDGE_CURVE(geometry, same_sense).
  const auto ends = reader.attributes(instance, "EDGE", 1, 2);
  const auto own = reader.attributes(instance, "EDGE_CURVE", 3, 2);
  const auto geometry = own.empty() ? std::nullopt : reader.reference(own[0]);
  const auto first = ends.empty() ? no_instance : reader.reference(ends[0]).value_or(no_instance);
  const auto last = ends.empty() ? no_instance : reader.reference(ends[1]).value_or(no_instance);
  if (!reader.is(instance, "EDGE_CURVE") || !geometry || first == no_instance || last == no_instance) {
    return reader.error(instance, "an EDGE_CURVE with two vertices is needed here");
  }
  const bool same_vertex = first == last;
  const auto start = vertex_place(reader, first);
  const auto end = vertex_place(reader, last);
  auto curve = EdgeCurve::read(reader, *geometry);
  if (!start) return std::unexpected(start.error());
  if (!end) return std::unexpected(end.error());
  if (!curve) return std::unexpected(std::move(curve.error()));

  bool backwards = (reader.enumeration(own[1]) == "F") != curve->turned();
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
  return EdgePiece{*std::move(curve), from, to, backwards, first, last, *start, *end};
}

Expected<EdgeSampler::Sampled> EdgeSampler::sample(std::uint32_t instance) const {
  auto piece = edge_piece(*reader_, instance);
  if (!piece) return std::unexpected(piece.error());
  Sampled result{std::move(piece->curve), {}, {}};
  result.parameters = result.curve.subdivided(piece->from, piece->to, chord_);
  if (piece->backwards) std::reverse(result.parameters.begin(), result.parameters.end());
  for (const double t : result.parameters) result.points.push_back(result.curve.at(t));
  result.points.front() = piece->start;
  result.points.back() = piece->end;
  return result;
}

Expected<EdgeSampler::Sampled>& EdgeSampler::sampled(std::uint32_t instance) {
  auto found = edges_.find(instance);
  if (found == edges_.end()) found = edges_.emplace(instance, sample(instance)).first;
  return found->second;
}

Expected<const Loop*> EdgeSampler::edge(std::uint32_t instance) {
  const auto& found = sampled(instance);
  if (!found) return std::unexpected(found.error());
  return &found->points;
}

Expected<void> EdgeSampler::divide(std::uint32_t instance, std::span<const int> pieces) {
  auto& found = sampled(instance);
  if (!found) return std::unexpected(found.error());
  assert(pieces.size() + 1 == found->points.size());
  Sampled finer{std::move(found->curve), {found->parameters.front()}, {found->points.front()}};
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

Expected<Loop> EdgeSampler::loop(std::uint32_t instance) {
  const Reader& reader = *reader_;
  Loop result;
  if (reader.is(instance, "VERTEX_LOOP")) return result;
  if (reader.is(instance, "POLY_LOOP")) {
    const auto own = reader.attributes(instance, "POLY_LOOP", 1, 1);
    for (const auto k : own.empty() ? std::vector<std::uint32_t>() : reader.references(own[0])) {
      const auto point = reader.point(k);
      if (!point) return std::unexpected(point.error());
      result.push_back(*point);
    }
    return result;
  }
  const auto path = reader.attributes(instance, "PATH", 1, 1);
  if (!reader.is(instance, "EDGE_LOOP") || path.empty())
    return reader.error(instance, "a loop of a known form is needed here");
  std::unordered_map<std::uint32_t, std::array<int, 2>> ways;  // how often along each edge, and against it
  for (const auto oriented : reader.references(path[0])) {
    const auto own = reader.attributes(oriented, "ORIENTED_EDGE", 3, 2);
    const auto element = own.empty() ? std::nullopt : reader.reference(own[0]);
    if (!element) return reader.error(oriented, "an ORIENTED_EDGE is needed here");
    const auto points = edge(*element);
    if (!points) return std::unexpected(points.error());
    Loop piece = **points;
    const bool against = reader.enumeration(own[1]) == "F";
    if (against) std::reverse(piece.begin(), piece.end());
    ++ways[*element][against ? 1 : 0];
    result.insert(result.end(), piece.begin(), piece.end() - 1);  // the last one begins the next piece
  }
  const bool seams =
      std::all_of(ways.begin(), ways.end(), [](const auto& edge) { return edge.second[0] == edge.second[1]; });
  if (seams) result.clear();
  return result;
}

Expected<std::vector<Loop>> EdgeSampler::loops(std::uint32_t bounds) {
  std::vector<Loop> result;
  for (const auto bound : reader_->references(bounds)) {
    const auto own = reader_->attributes(bound, "FACE_BOUND", 1, 2);
    const auto target = own.empty() ? std::nullopt : reader_->reference(own[0]);
    if (!target) return reader_->error(bound, "a FACE_BOUND is needed here");
    auto points = loop(*target);
    if (!points) return std::unexpected(std::move(points.error()));
    if (points->empty()) continue;
    if (reader_->enumeration(own[1]) == "F") std::reverse(points->begin(), points->end());
    result.push_back(*std::move(points));
  }
  return result;
}

}  // namespace knead::step
