#include "checked_edges.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <unordered_map>

#include "base/parallel_for.hpp"

namespace knead::brep {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double least_tolerance = 1e-6;  // of gaps, of the size
constexpr int box_steps = 8;
constexpr double meeting = 5e-5;  // of the size: edges of one face each that come so near meet …
constexpr double parted = 10;     // … as long as they are not so many times as far apart

std::vector<std::vector<FaceUse>> uses_of_edges(const Model& model) {
  std::vector<std::vector<FaceUse>> result(model.edges.size());
  for (Index f = 0; f < model.faces.size(); ++f) {
    for (const Bound& bound : model.faces[f].bounds) {
      for (const EdgeUse& use : bound.edges) {
        if (use.edge < result.size()) result[use.edge].push_back({f, use.forward == bound.forward});
      }
    }
  }
  return result;
}

template <class F>
void each(const std::set<Index>& chosen, const F& f) {
  const std::vector<Index> list(chosen.begin(), chosen.end());
  detail::parallel_for(static_cast<std::ptrdiff_t>(list.size()), 1,
                       [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                         for (std::ptrdiff_t k = begin; k < end; ++k)
                           f(list[static_cast<std::size_t>(k)]);
                       });
}

/// The part of each face and surface; empty where there is no assembly.
std::unordered_map<std::string, Index> parts_of(const Model& model) {
  std::unordered_map<std::string, Index> result;
  if (!model.assembly) return result;
  for (Index k = 0; k < model.assembly->parts.size(); ++k) {
    for (const auto* ids : {&model.assembly->parts[k].faces, &model.assembly->parts[k].surfaces})
      for (const std::string& id : *ids) result.emplace(id, k);
  }
  return result;
}

}  // namespace

CheckedEdges::CheckedEdges(const Model& model, const EdgeTolerances& tolerances)
    : given_(model), faced_(with_bare_faces(model)), uses_(uses_of_edges(this->model())) {
  for (Index e = 0; e < uses_.size(); ++e) {
    if (!uses_[e].empty()) used_.push_back(e);
  }
  find_scale(tolerances);
}

std::vector<CheckedEdge> CheckedEdges::all() const {
  std::vector<LooseEdge> loose;
  const auto part_of = parts_of(model());
  for (const Index e : used_) {
    if (uses_[e].size() != 1 || !*pieces_[e]) continue;
    const auto part = part_of.find(model().faces[uses_[e][0].face].id);
    loose.push_back({e, &**pieces_[e], part == part_of.end() ? none : part->second});
  }
  const auto meetings = meetings_of(loose, std::max(meeting * scale_.size, 2 * gap_), parted);
  std::vector<CheckedEdge> items;
  std::size_t next = 0;
  for (const Index e : used_) {
    const std::string& id = model().edges[e].id;
    if (next == loose.size() || loose[next].edge != e) {
      items.push_back({id, e});
      continue;
    }
    std::map<std::string, int> times;
    const bool is_whole = meetings[next].size() == 1 && meetings[next][0].other == none;
    for (const EdgeMeeting& met : meetings[next]) {
      std::string name = id + (met.other == none ? "" : "+" + model().edges[met.other].id);
      if (const int again = times[name]++; again > 0) name += "/" + std::to_string(again + 1);
      items.push_back({name, e, met.other, is_whole ? std::nullopt : std::optional(met)});
    }
    ++next;
  }
  return items;
}

Expected<EdgePiece> CheckedEdges::piece_of(Index edge) const {
  if (!side(edge)) return edge_piece(model(), edge);
  auto curve = EdgeCurve::create(*model().edges[edge].curve);
  if (!curve) return std::unexpected(curve.error());
  const Interval whole = curve->domain().value_or(Interval{0, 1});
  return EdgePiece{.curve = *std::move(curve), .from = whole.lower, .to = whole.upper};
}

EdgePiece CheckedEdges::piece(const CheckedEdge& edge) const {
  EdgePiece result = *piece(edge.edge);
  if (!edge.part) return result;
  result.from = edge.part->from;
  result.to = edge.part->to;
  return result;
}

Index CheckedEdges::spline_under(Index face) const {
  const Index support = model().faces[face].support;
  return support == none ? none : model().supports[support].spline;
}

std::optional<CheckedFace::Side> CheckedEdges::side(Index edge) const {
  return faced_ ? faced_->sides[edge] : std::nullopt;
}

/// The size is that of all edges, whichever are measured.
void CheckedEdges::find_scale(const EdgeTolerances& tolerances) {
  pieces_.resize(model().edges.size());
  Eigen::AlignedBox3d box;
  for (const Index e : used_) {
    pieces_[e] = piece_of(e);
    if (!*pieces_[e]) continue;
    const EdgePiece& piece = **pieces_[e];
    for (int k = 0; k <= box_steps; ++k) {
      const Point p =
          piece.curve.at(std::lerp(piece.from, piece.to, static_cast<double>(k) / box_steps));
      if (p.allFinite()) box.extend(p);
    }
  }
  if (!box.isEmpty() && box.diagonal().norm() > 0) scale_.size = box.diagonal().norm();
  scale_.tangent = std::max(compared_angle, tolerances.angle) * degree;
  double stated = 0;
  for (const Support& support : model().supports) stated = std::max(stated, support.uncertainty);
  for (const SplineSurface& s : model().surfaces) stated = std::max(stated, s.uncertainty);
  gap_ = tolerances.gap.value_or(std::max(stated, least_tolerance * scale_.size));
}

void CheckedEdges::prepare(std::span<const CheckedEdge> edges) {
  std::set<Index> faces, splines;
  for (const CheckedEdge& item : edges) {
    for (const FaceUse& use : uses_[item.edge]) faces.insert(use.face);
    if (item.other != none) faces.insert(uses_[item.other][0].face);
  }
  for (const Index f : faces) {
    if (spline_under(f) != none) splines.insert(spline_under(f));
  }
  splines_.resize(model().surfaces.size());
  faces_.resize(model().faces.size());
  each(splines, [&](Index s) {
    // The model outlives the measuring.
    splines_[s] = CheckedSpline::create(
        std::shared_ptr<const Surface>(std::shared_ptr<void>(), &model().surfaces[s].surface));
  });
  each(faces, [&](Index f) {
    const Index s = spline_under(f);
    if (s != none && !*splines_[s]) {
      faces_[f] = std::unexpected(splines_[s]->error());
      return;
    }
    faces_[f] = CheckedFace::create(model(), model().faces[f], s == none ? nullptr : **splines_[s]);
  });
}

}  // namespace knead::brep
