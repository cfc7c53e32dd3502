#pragma once

#include "brep/boundary_edges.hpp"
#include "geometry.hpp"
#include "knead/brep/model.hpp"

namespace knead::iges {

/// A curve that is not made of others.
struct Piece : brep::BoundaryPiece {
  int number = 0;                    ///< its entity
  std::vector<double> corners = {};  ///< where it may turn, from 0 to 1
  /// The entity is this curve, not one in parameters or one that is not known.
  bool in_space = true;
  /// From the entity's own coordinates to the model's.
  Eigen::Affine3d move = Eigen::Affine3d::Identity();
};

/// Reads curves; of composite curves (102) each of their parts.
class CurveReader {
 public:
  explicit CurveReader(const File& file) : file_(file) {}
  /// Adds the pieces of a curve in the coordinates of the model. Errors (input): it cannot be read;
  /// too many pieces.
  [[nodiscard]] Expected<void> add(int number, const Eigen::Affine3d& outer,
                                   std::vector<Piece>& pieces);

  /// Whether the pieces that were read are more than a file of this size has: entities may be used
  /// again and again.
  [[nodiscard]] bool exceeded() const;

 private:
  [[nodiscard]] Expected<void> add_nested(int number, const Eigen::Affine3d& outer,
                                          std::vector<Piece>& pieces, int depth);
  [[nodiscard]] Piece unknown(int number, const Eigen::Affine3d& move) const;
  [[nodiscard]] Expected<Piece> arc(int number, const Eigen::Affine3d& move) const;
  [[nodiscard]] Expected<Piece> line(int number, const Eigen::Affine3d& move) const;
  [[nodiscard]] Expected<Piece> points(int number, const Eigen::Affine3d& move);
  [[nodiscard]] Expected<Piece> spline(int number, const Eigen::Affine3d& outer);

  const File& file_;
  std::size_t points_ = 0;  // of the pieces so far, and the pieces
};

/// The form of another surface than a B-spline, moved by `outer` and its own matrix: planes (108,
/// 190), 192 to 198, 120 and 122 with their curves; of other types the name alone,
/// "IGES_SURFACE_140".
[[nodiscard]] brep::Support other_surface(const File& file, int number,
                                          const Eigen::Affine3d& outer, CurveReader& curves);

}  // namespace knead::iges
