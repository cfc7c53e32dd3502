#pragma once

#include <span>
#include <string>
#include <vector>

#include "morph_points.hpp"
#include "moving_model.hpp"

namespace knead::detail {

/// How much longer the data make short distances between faces near a place: faces that are parted
/// by g as opened are parted by up to s g where a map with this stretch s moves them. s is at least
/// 1, and the largest singular value of I + A:
///
/// - Of a map of space x ↦ x + D(x), A = ∂D by differences over 1e-6 of `size`, along each axis on
///   that side of the place on which D changes less, beside the place: what jumps there is torn,
///   not stretched.
/// - Of other data, D ≈ c_f + A (x − m_f) is the affine map that fits the data on each of the faces
///   f best, with weights (1 − r²/h²)² of their distances r from the place. A is common to the
///   faces, but each has a shift c_f of its own: data that tear faces apart do not count as a
///   stretch. h is 2 % of `size`, or as far as the 24th datum of each face. Directions in which the
///   data extend by less than 0.3 of the most are not known, and left out: of a sheet that is
///   nearly flat, how it bends would pass for a stretch across it.
///
/// 1 where a face stays, and of data that are fewer on a face, or known along one direction only.
/// Accuracy: exact for affine data, else to what ∂D varies within h.
/// \param at in the coordinates of the part of the faces \param size of the model. Errors: those of
/// evaluation and of the map. Cost: an evaluation for each datum on the faces.
[[nodiscard]] Expected<double> data_stretch(const MovingModel& model, const MorphPoints& data,
                                            std::span<const std::string> faces,
                                            std::span<const Point> at, double size);

}  // namespace knead::detail
