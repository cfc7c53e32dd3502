#pragma once

#include "knead/brep/model.hpp"

namespace knead::brep {

/// Fills `faces` of the B-spline surfaces of a model, and `trimmed` where it is not set already.
/// Cost: some searches for the nearest point of a side per span of every edge, by several threads
/// where there is much to do.
void find_trimming(Model& model);

}  // namespace knead::brep
