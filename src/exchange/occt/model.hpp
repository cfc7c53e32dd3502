#pragma once

#include <map>
#include <string>
#include <vector>

#include "file.hpp"
#include "knead/brep/model.hpp"

namespace knead::occt {

/// A file of Open CASCADE's shapes as a model, and what of the file its entities stand for.
struct ReadModel {
  brep::Model model;
  std::vector<std::size_t> surfaces;  ///< of each of the model's: the surface of the file, from 0
  std::vector<Eigen::Affine3d>
      places;  ///< of the surfaces of the file: from its coordinates to the model's
  /// The shape that an edge or vertex stands for, and where it puts the curve or point.
  struct Source {
    std::size_t shape = 0;
    Eigen::Affine3d move = Eigen::Affine3d::Identity();
  };
  struct Sources {
    std::map<std::string, Source> edges, vertices;  ///< by id
  } sources;
  /// Faces that are used a second time where they are, or sheared, which are left out.
  std::size_t again = 0;
};

/// Surface k of the file, from 1, becomes #k; with S surfaces, shape j becomes #(S + j).
/// Coordinates are the model's: locations are applied. What is used again elsewhere is a part with
/// several places. What cannot be read is told where it is needed. Cost: linear in the file.
[[nodiscard]] ReadModel read_model(const BrepFile& file, std::string name);

}  // namespace knead::occt
