#pragma once

#include <vector>

#include "brep/face_loops.hpp"

namespace knead::brep {

/// An edge of one face, as a piece of its curve. Only pieces of the same part meet: each part has
/// coordinates of its own.
struct LooseEdge {
  Index edge = none;
  const EdgePiece* piece = nullptr;
  Index part = 0;
};

/// A part of a loose edge along which it meets the same other one all along, or none.
struct EdgeMeeting {
  double from = 0, to = 0;  ///< parameters of its piece
  Index other = none;       ///< an edge
  bool same_way = true;     ///< both curves run the same way
  bool several = false;     ///< others meet it there too
};

/// Divides each loose edge into the parts along which another one runs beside it at less than 25
/// degrees, and those where none does; in a T-junction a long edge is divided among the short ones
/// that it meets. Both come as near as `reach` somewhere on the part, and are nowhere farther apart
/// than `parted` times that; where they run farther apart, as from a common vertex, the part ends
/// at `reach`. Of two edges that meet the part is that of the first; in the list of
/// the other it is left out. Ends of parts are right to 1e-14 of the edge; parts shorter than 1e-3
/// of it, or than ten times `reach`, count as their neighbours.
///
/// Both are polylines within a quarter of `reach`; the nearest segments are found in a `BoxTree`,
/// and the ends of parts by bisection. Cost: n log n for n segments.
[[nodiscard]] std::vector<std::vector<EdgeMeeting>> meetings_of(const std::vector<LooseEdge>& edges,
                                                                double reach, double parted);

}  // namespace knead::brep
