#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "knead/energy/stiffness.hpp"

namespace knead {

/// Where the unknowns of a system lie on grids: those that depend on each other are near in each
/// direction.
struct GridPlaces {
  int directions = 0;
  std::vector<int> indices;  ///< of unknown i: `directions` of them, from i · directions on

  [[nodiscard]] int at(int unknown, int direction) const {
    return indices[static_cast<std::size_t>(unknown) * static_cast<std::size_t>(directions) +
                   static_cast<std::size_t>(direction)];
  }
};

/// The places of the control points of patches, one patch after the other. Direction 0 goes from
/// patch to patch, farther than any net is wide.
template <int D>
[[nodiscard]] GridPlaces grid_places(std::span<const Spline<D>> patches);

/// An order of elimination that divides the unknowns: into two parts that do not depend on each
/// other, and a separator behind them; each part again.
struct Dissection {
  /// The unknowns at places begin … end − 1 of the order: a separator, or a part that is not
  /// divided into nodes. They depend on themselves and on nodes from which there is a way to this
  /// one along `parent` alone.
  struct Node {
    int begin, end;
    int parent;  ///< of the separator behind; −1: none
  };
  Eigen::VectorXi order;    ///< order[i] is the place of unknown i
  std::vector<Node> nodes;  ///< one after the other; parents come after their children
};

/// Nested dissection of a grid (George 1973, "Nested dissection of a regular finite element mesh")
/// by places: every part is cut across its longest direction, and the separator is what depends on
/// the other side of the cut. Which entries the matrix has decides alone, so that any places give a
/// right order; good ones a good one. Fills less than approximate minimum degree on large grids,
/// and its parts can be eliminated side by side.
/// \param a symmetric: its pattern, both triangles.
/// \param node_size parts of at most so many unknowns are one node: some 0.1 ms of substitution for
/// a thread.
/// Cost: O((entries of A + size · log size) · log size).
[[nodiscard]] Dissection dissect(const SparseMatrix& a, const GridPlaces& places,
                                 int node_size = 2000);

/// Approximate minimum degree (Amestoy, Davis, Duff 1996), without nodes. The pattern of A, both
/// triangles.
[[nodiscard]] Dissection minimum_degree(const SparseMatrix& a);

}  // namespace knead
