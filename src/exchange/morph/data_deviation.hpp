#pragma once

#include <memory>
#include <string>
#include <vector>

#include "describe/bytes.hpp"
#include "knead/exchange/morph.hpp"

namespace knead {

/// How far data are from the visible faces of a model. Lengths are in units of the model, places in
/// its coordinates. Of each point, in the order of the data: numbers as Float64, little-endian.
struct DataDeviation {
  std::string unit = {};
  double size = 0, reach = 0;
  int points = 0, used = 0;
  int left_out = 0, beyond_border = 0, turned_away = 0;  ///< why the others have no partner
  Deviation deviation = {};  ///< of the sizes of the distances of points that are used
  std::optional<MorphAlignment> alignment = {};
  Bytes places = {};     ///< x, y, z of the points, of a scan once it is aligned
  Bytes feet = {};       ///< x, y, z of the partners on the model, 0 where there is none
  Bytes normals = {};    ///< of length 1, outward, of the faces at the feet; 0 likewise
  Bytes wanted = {};     ///< the displacements that are wanted at the feet, unscaled; 0 likewise
  Bytes distances = {};  ///< the parts of these along the normals of the faces; 0 likewise
  /// One byte each: 0 used, 1 farther than the reach, 2 beside the model, 3 facing another way.
  Bytes states = {};
};
void describe(DataDeviation& d, Fields& fields);

namespace detail {

/// Compares data with a model as it is; nothing is fitted. Of the settings those about the data
/// count: `align`, `reach`, `unit`, `along_normal`, `columns`, `field`, `places`, `faces`, `keep`
/// and `convert`. Errors: those of `morph_file` but for the fit. Cost: its first two phases.
[[nodiscard]] Expected<DataDeviation> data_deviation(const std::shared_ptr<const Source>& source,
                                                     const MorphData& data, MorphSettings settings);

}  // namespace detail
}  // namespace knead
