#include "iges_edges.hpp"

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

int Edges::vertex(const Point& p) {
  const auto end = points_.upper_bound(p.x() + same_);
  std::size_t compared = 0;
  for (auto at = points_.lower_bound(p.x() - same_); at != end && compared < most_compared; ++at, ++compared) {
    const auto& [loop, corner] = at->second;
    if ((sews_ || loop == loop_) && meet(corner.first, p)) return corner.second;
  }
  const int record = records_.vertex(p);
  points_.emplace(p.x(), std::pair(loop_, std::pair(p, record)));
  return record;
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

std::pair<int, bool> Edges::of(const Piece& piece) {
  const double x = piece.at(0.5).x();
  const auto end = known_.upper_bound(x + same_);
  std::size_t compared = 0;
  for (auto at = known_.lower_bound(x - same_); at != end && compared < most_compared; ++at, ++compared) {
    const auto back = against(at->second, piece);
    if (!back) continue;
    note(at->second.edge, piece, *back != piece.reversed);
    return {at->second.edge, *back};
  }
  const int from = vertex(piece.at(0)), to = vertex(piece.at(1));
  const int edge = add(piece, from, to);
  known_.emplace(x, Known{edge, loop_, piece});
  return {edge, piece.reversed};
}

int Edges::add(const Piece& piece, int from, int to) {
  const std::string record = fmt::format("EDGE_CURVE('',#{},#{},#{},.T.)", from, to, piece.geometry);
  int edge = piece.number;
  if (named_.insert(edge).second) {
    records_.put(edge, record);
  } else {
    edge = records_.add(record);
  }
  note(edge, piece, false);
  return edge;
}

void Edges::note(int edge, const Piece& piece, bool turned) {
  auto& curves = sources_.edges[edge];
  if (piece.in_space && std::ranges::find(curves, piece.number, &EdgeCurve::number) == curves.end()) {
    curves.push_back({piece.number, piece.move, turned});
  }
}

}  // namespace knead::iges
