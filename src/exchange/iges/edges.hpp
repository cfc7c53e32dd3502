#pragma once

#include <map>
#include <string>
#include <vector>

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

/// What of the file the edges and vertices of its model stand for, by id. An edge that is only
/// given in parameters has no curves, and moves with its surface by itself; a vertex that is no
/// entry of a list is where edges end.
struct EdgeSources {
  std::map<std::string, std::vector<EdgeCurve>> edges;
  std::map<std::string, EdgeVertex> vertices;

  /// \param turned the curve of the piece runs against the edge
  void note(const std::string& edge, const Piece& piece, bool turned);
};

}  // namespace knead::iges
