#pragma once

#include <functional>
#include <string>

#include "iges_geometry.hpp"
#include "step_records.hpp"

namespace knead::iges {

using step::list_of;
using step::StepRecords;

/// A curve that is not made of others.
struct Piece {
  int number = 0;                   ///< its entity
  int geometry = 0;                 ///< its record
  std::function<Point(double)> at;  ///< from 0 to 1
  int samples = 1;                  ///< chords that show its shape
  bool reversed = false;            ///< run along from 1 to 0
  bool in_space = true;             ///< the entity is this curve, not one in parameters or one that is not known
  Eigen::Affine3d move = Eigen::Affine3d::Identity();  ///< from the entity's own coordinates to the model's
  [[nodiscard]] Point from() const { return at(reversed ? 1 : 0); }
  [[nodiscard]] Point to() const { return at(reversed ? 0 : 1); }
};

/// Makes curves records of STEP; of composite curves (102) each of their parts.
class CurveReader {
 public:
  CurveReader(const File& file, StepRecords& records) : file_(file), records_(records) {}
  /// Adds the pieces of a curve in the coordinates of the model. Errors (input): it cannot be read; too many pieces.
  [[nodiscard]] Expected<void> add(int number, const Eigen::Affine3d& outer, std::vector<Piece>& pieces);

 private:
  [[nodiscard]] Expected<void> add_nested(int number, const Eigen::Affine3d& outer, std::vector<Piece>& pieces,
                                          int depth);
  [[nodiscard]] Expected<Piece> arc(int number, const Eigen::Affine3d& move);
  [[nodiscard]] Expected<Piece> line(int number, const Eigen::Affine3d& move);
  [[nodiscard]] Expected<Piece> points(int number, const Eigen::Affine3d& move);
  [[nodiscard]] Expected<Piece> spline(int number, const Eigen::Affine3d& outer);

  const File& file_;
  StepRecords& records_;
};

/// A surface of another form than 128 as a record in the words of STEP, moved by `outer` and its own matrix: planes
/// (108, 190), 192 to 198, 120 and 122 with their curves; "IGES_SURFACE_118('D15')" for what STEP does not have.
[[nodiscard]] std::string surface_record(const File& file, int number, const Eigen::Affine3d& outer,
                                         StepRecords& records, CurveReader& curves);

/// Whether the records take more than 64 times the file: entities that are used again and again are written each time.
[[nodiscard]] bool exceeds(const File& file, const StepRecords& records);

}  // namespace knead::iges
