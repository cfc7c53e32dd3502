#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "edge_curve.hpp"

namespace knead::brep {

/// Points around a bound of a face, without repeating the first.
using Loop = std::vector<Point>;

/// The piece of a curve that an edge is.
struct EdgePiece {
  EdgeCurve curve;
  double from = 0,
         to = 0;  ///< parameters, from < to; up to one period past the domain of a closed curve
  bool backwards = false;  ///< the edge runs from `to` to `from`
  Index start_vertex = none, end_vertex = none;
  Point start = Point::Zero(), end = Point::Zero();
};

/// Errors (input): the curve's type is unknown, or something is missing.
[[nodiscard]] Expected<EdgePiece> edge_piece(const Model& model, Index edge);

/// The edges of a file as points, each sampled once: two faces that meet at an edge have the same
/// points there.
class EdgeSampler {
 public:
  /// \param chord as in `EdgeCurve::subdivided`
  EdgeSampler(const Model& model, ChordLimit chord) : model_(&model), chord_(chord) {}

  /// From the start vertex of an edge to its end vertex. Errors (input): the curve's type is
  /// unknown, or something is missing.
  [[nodiscard]] Expected<const Loop*> edge(Index edge);
  /// Adds points to an edge: each of its chords becomes so many, even in the parameter of the
  /// curve. Loops given out before keep theirs.
  [[nodiscard]] Expected<void> divide(Index edge, std::span<const int> pieces);

  /// The points of an edge, from its start vertex to its end vertex, and where they are on its
  /// curve.
  struct Division {
    std::vector<double> parameters;
    Loop points;
  };
  [[nodiscard]] Expected<Division> division(Index edge);
  /// Goes back to what `division` returned.
  void restore(Index edge, Division division);

  /// The loops of a face, each in the direction given by its bound: with the face on its left as
  /// seen from the tip of the face's normal. Loops that bound nothing are omitted: a vertex, and a
  /// loop that runs along all of its edges in both directions, as along the seams of a whole torus
  /// (not necessarily in the order of its parameters).
  [[nodiscard]] Expected<std::vector<Loop>> loops(const Face& face);

 private:
  struct Sampled : Division {
    EdgeCurve curve;
  };
  [[nodiscard]] Expected<Sampled> sample(Index edge) const;
  [[nodiscard]] Expected<Sampled>& sampled(Index edge);
  [[nodiscard]] Expected<Loop> loop(const Bound& bound);

  const Model* model_;
  ChordLimit chord_;
  std::unordered_map<Index, Expected<Sampled>> edges_;
};

}  // namespace knead::brep
