#pragma once

#include "knead/hold/seams.hpp"

namespace knead::seams {

/// How the two sides of a seam meet at rest, at the samples of both edges.
struct RestMeeting {
  double angle = 0;      ///< largest angle between the tangent planes
  double fold = 0;       ///< largest angle between them and a fold: π minus the smallest angle
  double ratio = 0;      ///< ρ by least squares of S_a' + ρ S_b'; 0 if S_b' vanishes
  double deviation = 0;  ///< largest |S_a' + ρ S_b'| / |S_a'|
  double lowest = 0, highest = 0;  ///< of |S_a'|/|S_b'|
};

/// Samples at which a side's derivative is below 1e-6 of its largest (poles) are left out.
[[nodiscard]] Expected<RestMeeting> rest_meeting(const Surface& a, const Surface& b,
                                                 const Seam& seam);

/// Equalises ratios that differ only by rounding in the file. Per normalised parameter, treating ρ
/// and 1/ρ alike, each takes the nearest earlier value, 1 or that of a seam with less deviation,
/// within 1e-7 or three times its own deviation. Around a corner of four patches opposite seams
/// have the same ratio; if it differed in the last digits, both conditions together would fix the
/// tangents at the corner. `deviation` grows by the change. Null entries are skipped.
void agree_ratios(std::span<const Surface* const> patches, std::span<const Seam> seams,
                  std::span<RestMeeting* const> rests);

}  // namespace knead::seams
