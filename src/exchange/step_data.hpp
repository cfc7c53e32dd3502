#pragma once

#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "knead/exchange/step_file.hpp"
#include "part21.hpp"

namespace knead::step {

/// The data of a `File`.
struct File::Data {
  explicit Data(Part21File parsed) : records(std::move(parsed)) {}

  Part21File records;
  std::string schema;
  std::shared_ptr<const std::vector<SurfaceEntity>> surfaces;  // may outlive the file
  std::vector<std::uint32_t> surface_instances;                // of each of `surfaces`
  std::unordered_map<std::string, std::size_t> surface_index;  // by id
  std::vector<UnreadableSurface> unreadable;
  std::vector<CurveEntity> curves;
  std::vector<std::uint32_t> curve_instances;                // of each of `curves`
  std::vector<std::vector<std::uint32_t>> curve_point_refs;  // for each: the values that refer to its control points
  std::vector<Instance> instances;
  std::vector<LengthUnit> units;
};

}  // namespace knead::step
