#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "edge_curve.hpp"

namespace knead::step {

/// Points around a bound of a face, without repeating the first.
using Loop = std::vector<Point>;

/// The piece of a curve that an EDGE_CURVE is.
struct EdgePiece {
  EdgeCurve curve;
  double from = 0, to = 0;         ///< parameters, from < to; up to one period past the domain of a closed curve
  bool backwards = false;          ///< the edge runs from `to` to `from`
  std::uint32_t start_vertex = 0;  ///< the instances of its VERTEX_POINTs
  std::uint32_t end_vertex = 0;
  Point start = Point::Zero(), end = Point::Zero();
};

/// Errors (input): the curve's type is unknown, or something is missing.
[[nodiscard]] Expected<EdgePiece> edge_piece(const Reader& reader, std::uint32_t instance);

/// The edges of a file as points, each sampled once: two faces that meet at an edge have the same points there.
class EdgeSampler {
 public:
  /// \param chord as in `EdgeCurve::subdivided`
  EdgeSampler(const Reader& reader, ChordLimit chord) : reader_(&reader), chord_(chord) {}

  /// From the start vertex of an EDGE_CURVE to its end vertex. Errors (input): the curve's type is unknown, or
  /// something is missing.
  [[nodiscard]] Expected<const Loop*> edge(std::uint32_t instance);
  /// Adds points to an edge: each of its chords becomes so many, even in the parameter of the curve. Loops given out
  /// before keep theirs.
  [[nodiscard]] Expected<void> divide(std::uint32_t instance, std::span<const int> pieces);

  /// The loops of a list of FACE_BOUNDs, each in the direction given by the bound: with the face on its left as seen
  /// from the tip of the face's normal. Loops that bound nothing are omitted: a VERTEX_LOOP, and a loop that runs along
  /// all of its edges in both directions, as along the seams of a whole torus (not necessarily in the order of its
  /// parameters).
  [[nodiscard]] Expected<std::vector<Loop>> loops(std::uint32_t bounds);

 private:
  struct Sampled {
    EdgeCurve curve;
    std::vector<double> parameters;  // from the start vertex to the end vertex
    Loop points;
  };
  [[nodiscard]] Expected<Sampled> sample(std::uint32_t instance) const;
  [[nodiscard]] Expected<Sampled>& sampled(std::uint32_t instance);
  [[nodiscard]] Expected<Loop> loop(std::uint32_t instance);

  const Reader* reader_;
  ChordLimit chord_;
  std::unordered_map<std::uint32_t, Expected<Sampled>> edges_;
};

}  // namespace knead::step
