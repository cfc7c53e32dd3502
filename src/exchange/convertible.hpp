#pragma once

#include "knead/exchange/source.hpp"

namespace knead {

/// Whether surfaces of other forms become B-spline surfaces by `Source::with_splines`: in files of
/// these formats.
[[nodiscard]] inline bool converts_surfaces(const Source& source) {
  return source.format() == "STEP" || source.format() == "IGES";
}

}  // namespace knead
