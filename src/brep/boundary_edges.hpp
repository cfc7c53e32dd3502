#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "knead/brep/model.hpp"

namespace knead::brep {

/// A piece of a boundary: a curve from one point to another.
struct BoundaryPiece {
  std::string name = {};  ///< the id of its edge, where that is free; empty: none
  Expected<CurveGeometry> geometry = CurveGeometry{};  ///< or why it is not known
  std::function<Point(double)> at = {};                ///< from 0 to 1, as the curve runs
  bool reversed = false;                               ///< the boundary runs from 1 to 0
  [[nodiscard]] Point from() const { return at(reversed ? 1 : 0); }
  [[nodiscard]] Point to() const { return at(reversed ? 0 : 1); }

  /// Makes it the part of a spline over an interval.
  void set(std::shared_ptr<const Curve> curve, const Interval& range);
};

/// Makes pieces of boundaries edges with their vertices, in files whose boundaries share nothing.
///
/// Pieces of one boundary that run there and back along the same curve are one edge: a seam. So are
/// pieces of several boundaries of a group whose ends and quarters agree to `same`, if they are
/// longer than four times that: faces meet there.
class BoundaryEdges {
 public:
  using Group = std::optional<std::uint32_t>;
  /// A piece as an edge.
  struct Use {
    Index edge = none;
    bool forward = true;  ///< the boundary runs along the edge
    bool turned = false;  ///< the curve of the piece runs against the edge
  };

  /// \param fresh makes an id that is not taken
  BoundaryEdges(Model& model, std::function<std::string()> fresh)
      : model_(model), fresh_(std::move(fresh)) {}

  /// What follows belongs to another boundary. \param same distance within which points are one
  void begin(double same, Group group);
  /// The edge along a piece of the boundary.
  [[nodiscard]] Use of(const BoundaryPiece& piece);
  /// A new edge between two vertices, under the name of its piece where that is free.
  Index add(const BoundaryPiece& piece, Index from, Index to);

  /// The bound along these pieces, each of which is turned so that it begins where the one before
  /// it ends. \param resolution of the file; points are one within it, or within 1e-6 of the
  /// boundary's size \param note is told each piece and its edge
  template <class Piece, class Note>
  [[nodiscard]] Bound bound(std::vector<Piece>& pieces, double resolution, Group group,
                            const Note& note) {
    std::vector<BoundaryPiece*> all;
    for (Piece& piece : pieces) all.push_back(&piece);
    begin(chain(all, resolution), group);
    Bound bound;
    bound.kind = Bound::Kind::edges;
    for (const Piece& piece : pieces) {
      const Use use = of(piece);
      note(piece, use);
      bound.edges.push_back({use.edge, use.forward});
    }
    return bound;
  }

 private:
  struct Known {
    Index edge = none;
    std::size_t loop = 0;
    Group group;
    BoundaryPiece piece;
  };
  struct Corner {
    std::size_t loop = 0;
    Group group;
    Point place;
    Index vertex = none;
  };
  [[nodiscard]] static double chain(const std::vector<BoundaryPiece*>& pieces, double resolution);
  [[nodiscard]] bool meet(const Point& a, const Point& b) const { return (a - b).norm() <= same_; }
  [[nodiscard]] bool sews(const Group& group) const { return group_ && group == group_; }
  /// Whether the piece, as the boundary runs, is the known edge along its curve or against it;
  /// neither: none.
  [[nodiscard]] std::optional<bool> against(const Known& known, const BoundaryPiece& piece) const;
  [[nodiscard]] Index vertex(const Point& p);

  Model& model_;
  std::function<std::string()> fresh_;
  double same_ = 0;
  std::size_t loop_ = 0;
  Group group_;
  std::set<std::string> named_;
  std::multimap<double, Known> known_;     // by x of their middles
  std::multimap<double, Corner> corners_;  // by x
};

}  // namespace knead::brep
