#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "entity.hpp"
#include "exchange/step/bounded/bounded_faces.hpp"
#include "faces.hpp"
#include "knead/brep/model.hpp"
#include "tessellated.hpp"

namespace knead::step {

/// The records that entities of a model were read from.
struct ModelRecords {
  std::vector<std::uint32_t> surfaces, curves;  ///< of each of the model's
  std::vector<std::vector<std::uint32_t>>
      curve_point_refs;           ///< of each curve: the values that refer to its points
  std::vector<FaceRecord> faces;  ///< of each of the model's
  BoundarySources boundaries;
  TessellatedRecords tessellated;
};

/// Everything of a file that `brep::Model` tells. Errors (input): faces that repeat loops beyond
/// what a file may hold
/// (`check_loop_uses`); what else is wrong is told where it is needed. Cost: linear in the file.
[[nodiscard]] Expected<brep::Model> read_model(const Reader& reader, ModelRecords& records);

}  // namespace knead::step
