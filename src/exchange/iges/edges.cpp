#include "edges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace knead::iges {
namespace {

constexpr std::size_t most_compared = 4000;  // edges or vertices with about the same x
constexpr double least_length = 4;           // of sewn pieces, in distances within which points are one
constexpr std::array quarters = {0.25, 0.5, 0.75};

}  // namespace

void Edges::begin_loop(double same) {
  ++loop_;
  same_ = same;
}

brep::Index Edges::vertex(const Point& p) {
  const auto end = points_.upper_bound(p.x() + same_);
  std::size_t compared = 0;
  for (auto at = points_.lower_bound(p.x() - same_); at != end && compared < most_compared; ++at, ++compared) {
    const auto& [loop, corner] = at->second;
    if ((sews_ || loop == loop_) && meet(corner.first, p)) return corner.second;
  }
  const brep::Index made = builder_.add_vertex(builder_.fresh(), p);
  points_.emplace(p.x(), std::pair(loop_, std::pair(p, made)));
  return made;
}

brep::Index Edges::add_vertex(const Point& place, const EdgeVertex& source) {
  const int number = builder_.fresh();
  sources_.vertices.emplace(brep::ModelBuilder::name(number), source);
  return builder_.add_vertex(number, place);
}

std::optional<bool> Edges::against(const Known& known, const Piece& piece) const {
  const Piece& other = known.piece;
  const auto run = [&](double t) { return piece.at(piece.reversed ? 1 - t : t); };
  if (known.loop == loop_) {  // there and back
    if (!meet(other.from(), piece.to()) || !meet(other.to(), piece.from()) || !meet(other.at(0.5), piece.at(0.5)))
      return std::nullopt;
    return !other.reversed;
  }
  if (!sews_) return std::nullopt;
  const auto far = [&](double t) { return (run(t) - run(0)).norm() > least_length * same_; };
  if (!std::ranges::any_of(quarters, far)) return std::nullopt;
  for (const bool back : {true, false}) {
    const auto same = [&](double t) { return meet(other.at(back ? 1 - t : t), run(t)); };
    if (same(0) && same(1) && std::ranges::all_of(quarters, same)) return back;
  }
  return std::nullopt;
}

std::pair<brep::Index, bool> Edges::of(const Piece& piece) {
  const double x = piece.at(0.5).x();
  const auto end = known_.upper_bound(x + same_);
  std::size_t compared = 0;
  for (auto at = known_.lower_bound(x - same_); at != end && compared < most_compared; ++at, ++compared) {
    const auto back = against(at->second, piece);
    if (!back) continue;
    note(at->second.edge, piece, *back != piece.reversed);
    return {at->second.edge, *back};
  }
  const brep::Index from = vertex(piece.at(0)), to = vertex(piece.at(1));
  const brep::Index edge = add(piece, from, to);
  known_.emplace(x, Known{edge, loop_, piece});
  return {edge, piece.reversed};
}

brep::Index Edges::add(const Piece& piece, brep::Index from, brep::Index to) {
  const int number = named_.insert(piece.number).second ? piece.number : builder_.fresh();
  const brep::Index edge = builder_.add_edge(number, from, to, piece.geometry);
  note(edge, piece, false);
  return edge;
}

void Edges::note(brep::Index edge, const Piece& piece, bool turned) {
  auto& curves = sources_.edges[builder_.model().edges[edge].id];
  if (piece.in_space && std::ranges::find(curves, piece.number, &EdgeCurve::number) == curves.end()) {
    curves.push_back({piece.number, piece.move, turned});
  }
}

}  // namespace knead::iges
