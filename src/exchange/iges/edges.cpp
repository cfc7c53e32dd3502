#include "edges.hpp"

#include <algorithm>

namespace knead::iges {

void EdgeSources::note(const std::string& edge, const Piece& piece, bool turned) {
  auto& curves = edges[edge];
  if (piece.in_space &&
      std::ranges::find(curves, piece.number, &EdgeCurve::number) == curves.end()) {
    curves.push_back({piece.number, piece.move, turned});
  }
}

}  // namespace knead::iges
