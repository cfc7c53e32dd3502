#pragma once

#include "knead/exchange/morph.hpp"
#include "morph_points.hpp"
#include "moving_model.hpp"

namespace knead::detail {

/// What is wanted at a datum, or is missing there: the length of the difference, and its part along
/// the outward normal.
struct Difference {
  double length = 0, outward = 0;
};

/// Of these; zeros of none.
[[nodiscard]] Deviation deviation_of(const std::vector<Difference>& differences);

/// 1 where the outward normal of a surface is ∂u × ∂v, as it stands in the model, else −1. Faces of
/// both kinds, or none, leave it at 1.
[[nodiscard]] std::vector<int> outward_senses(const MovingModel& model);

/// Measures what is wanted at the data, and what of it the moved surfaces miss: the figures of the
/// report, overall and by surface, and the points of `result`. \param between data that were not
/// fitted, for the figures of the report on these. Errors: those of evaluation. Cost: two
/// evaluations per datum, shared among threads.
[[nodiscard]] Expected<void> add_deviations(const MovingModel& model,
                                            std::span<const morph::Datum> data,
                                            std::span<const morph::Datum> between,
                                            const std::vector<Surface>& moved, MorphedFile& result);

}  // namespace knead::detail
