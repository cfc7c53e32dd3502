#pragma once

#include "knead/exchange/morph.hpp"
#include "morph_points.hpp"
#include "moving_model.hpp"

namespace knead::detail {

/// Measures what is wanted at the data, and what of it the moved surfaces miss: the figures of the
/// report, overall and by surface, and the points of `result`. \param between data that were not
/// fitted, for the figures of the report on these. Errors: those of evaluation. Cost: two
/// evaluations per datum, shared among threads.
[[nodiscard]] Expected<void> add_deviations(const MovingModel& model,
                                            std::span<const morph::Datum> data,
                                            std::span<const morph::Datum> between,
                                            const std::vector<Surface>& moved, MorphedFile& result);

}  // namespace knead::detail
