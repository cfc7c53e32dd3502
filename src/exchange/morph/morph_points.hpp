#pragma once

#include <vector>

#include "exchange/fields/displacements.hpp"
#include "exchange/fields/space_map.hpp"
#include "morph/align.hpp"
#include "morph/scan_fit.hpp"
#include "moving_model.hpp"

namespace knead::detail {

/// Data as points of the surfaces, and where they came from.
struct MorphPoints {
  morph::Correspondences found;  ///< displacements in the coordinates of the model
  std::size_t count = 0;         ///< of points in the data
  double reach = 0;
  double size = 0;                       ///< diagonal of the box of what is visible, in the model
  std::optional<morph::Scan> scan = {};  ///< in the model, aligned; `found` is empty then at first
  std::optional<morph::Alignment> alignment = {};
  std::vector<Point> places = {};  ///< of displacements and of a mesh: where they are, in the model
  /// Of a scan where nothing is to move (scale 0): its partners, without `found`.
  std::optional<morph::ScanPartners> first = {};
  std::optional<fields::SpaceMap> map = {};  ///< that all of them follow, scaled, in the model
};

[[nodiscard]] MorphAlignment as_reported(const morph::Alignment& alignment);

/// Errors (input): a number that cannot be, with its field.
[[nodiscard]] Expected<void> check_settings(const MorphSettings& settings);

/// The displacements of the data, unscaled, in their own unit. Errors: those of the readers; not
/// one kind of data is given (input).
[[nodiscard]] Expected<fields::Displacements> given_displacements(const MorphData& data,
                                                                  const MorphSettings& settings);

/// Fits a model to `points.scan`, and makes `points.found` the data that were followed at last, and
/// the report on the scan. Errors: no point has a partner; a part in
/// several places that has data (input); those of `fit_scan` and of `told`, the turns.
[[nodiscard]] Expected<morph::FitResult> follow_scan(const MovingModel& model,
                                                     const MorphSettings& settings,
                                                     MorphPoints& points, MorphReport& report,
                                                     const MorphTold& told);

/// The points that they are about. Errors: those of `morph_file`.
[[nodiscard]] Expected<MorphPoints> points_of(const MovingModel& model, const MorphData& data,
                                              const MorphSettings& settings);

/// Of a map of space: a point in the middle of four data each, with the displacement that is wanted
/// there. Of other data none: what is true between them is not known. Errors: those of the map.
[[nodiscard]] Expected<std::vector<morph::Datum>> points_between(const MovingModel& model,
                                                                 const MorphData& data,
                                                                 const MorphSettings& settings);

}  // namespace knead::detail
