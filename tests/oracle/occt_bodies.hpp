#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <vector>

namespace knead::oracle {

/// Faces together, as Open CASCADE measures them on their exact surfaces.
struct OcctBody {
  double area = 0;
  double volume = 0;  ///< of a shell of a solid: below zero where its faces look inwards, as those
                      ///< of a hollow do
  Eigen::AlignedBox3d box;
};

/// A STEP, IGES or .brep file with its assemblies put together; lengths in mm.
struct OcctBodies {
  int faces = 0, solids = 0;
  OcctBody whole;                ///< its volume: of the solids
  std::vector<OcctBody> shells;  ///< of solids
  std::vector<OcctBody>
      sewn;  ///< without solids: the closed shells of its faces sewn together, outwards
};

/// None where it cannot be read, or nothing is in it.
[[nodiscard]] std::optional<OcctBodies> occt_bodies(const std::filesystem::path& path);

}  // namespace knead::oracle
