#pragma once

#include <vector>

#include "file.hpp"
#include "knead/exchange/source.hpp"

namespace knead::step {

/// What of a STEP file is not read: free curves that cannot be, faces without bounds or a surface;
/// points, curves of other forms, planes and the like that stand for themselves in representations
/// and sets of geometry; edges that bound no face; solids that are no boundary representations,
/// volumes, tessellated items, finite elements, annotations; items of unknown kinds; parts without
/// geometry. Cost: linear in the file.
[[nodiscard]] std::vector<LeftOut> left_out(const File& file);

}  // namespace knead::step
