#pragma once

#include <map>
#include <string>
#include <vector>

#include "brep_file.hpp"
#include "knead/exchange/source.hpp"

namespace knead::brep {

/// The faces of a file of Open CASCADE's shapes in the words of STEP.
struct BrepView {
  std::string text;  ///< an exchange structure
  std::vector<std::optional<Surface>>
      splines;                          ///< of each surface, in the coordinates of the model; none: another form
  std::vector<Eigen::Affine3d> places;  ///< of the surfaces: from the file's coordinates to the model's
  std::vector<UnreadableSurface> unreadable;
  /// The shape that a record stands for, and where it puts the curve or point.
  struct Source {
    std::size_t shape = 0;
    Eigen::Affine3d move = Eigen::Affine3d::Identity();
  };
  struct Sources {
    std::map<int, Source> edges, vertices;  ///< by their records
  } sources;
  std::size_t again = 0;  ///< faces that are used a second time, which are left out
};

/// Surface k of the file, from 1, becomes #k; with S surfaces, shape j becomes #(S + j): faces are ADVANCED_FACEs,
/// edges EDGE_CURVEs. Coordinates are the model's: locations are applied. What STEP does not have, or what cannot be
/// read, becomes a record named by its type, which readers report where they need it. Cost: linear in the file.
[[nodiscard]] BrepView step_view(const BrepFile& file);

}  // namespace knead::brep
