#pragma once

#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "brep/model_builder.hpp"
#include "curves.hpp"

namespace knead::iges {

/// A curve of the file along an edge.
struct EdgeCurve {
  int number = 0;                                      ///< its entity
  Eigen::Affine3d move = Eigen::Affine3d::Identity();  ///< from its own coordinates to the model's
  bool turned = false;                                 ///< it runs against the edge
};

/// The entry of a vertex list (502), from 1, that a vertex stands for.
struct EdgeVertex {
  int list = 0, index = 0;
  Eigen::Affine3d move = Eigen::Affine3d::Identity();
};

/// What of the file the edges and vertices of its model stand for, by id. An edge that is only given in parameters has
/// no curves, and moves with its surface by itself; a vertex that is no entry of a list is where edges end.
struct EdgeSources {
  std::map<std::string, std::vector<EdgeCurve>> edges;
  std::map<std::string, EdgeVertex> vertices;
};

/// Makes curves edges with their vertices.
///
/// Boundaries of trimmed surfaces share nothing in a file. Pieces of one boundary that run there and back along the
/// same curve are one edge: a seam. With `sews`, so are pieces of several boundaries whose ends and quarters agree to
/// `same`, if they are longer than four times that: faces meet there.
class Edges {
 public:
  Edges(brep::ModelBuilder& builder, bool sews) : builder_(builder), sews_(sews) {}

  /// What follows belongs to another boundary. \param same distance within which points are one
  void begin_loop(double same);
  /// The edge along a piece of the boundary, and whether that runs against it.
  [[nodiscard]] std::pair<brep::Index, bool> of(const Piece& piece);
  /// A new edge between two vertices, under the name of its curve where that is free.
  brep::Index add(const Piece& piece, brep::Index from, brep::Index to);
  brep::Index add_vertex(const Point& place, const EdgeVertex& source);
  [[nodiscard]] EdgeSources& sources() { return sources_; }

 private:
  struct Known {
    brep::Index edge = brep::none;
    std::size_t loop = 0;
    Piece piece;
  };
  [[nodiscard]] bool meet(const Point& a, const Point& b) const { return (a - b).norm() <= same_; }
  /// Whether the piece, as the boundary runs, is the known edge along its curve or against it; neither: none.
  [[nodiscard]] std::optional<bool> against(const Known& known, const Piece& piece) const;
  [[nodiscard]] brep::Index vertex(const Point& p);
  void note(brep::Index edge, const Piece& piece, bool turned);

  brep::ModelBuilder& builder_;
  bool sews_;
  double same_ = 0;
  std::size_t loop_ = 0;
  std::set<int> named_;
  std::multimap<double, Known> known_;  // by x of their middles
  std::multimap<double, std::pair<std::size_t, std::pair<Point, brep::Index>>>
      points_;  // vertices by x, with their loops
  EdgeSources sources_;
};

}  // namespace knead::iges
