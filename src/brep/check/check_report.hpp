#pragma once

#include "describe/describe.hpp"
#include "knead/brep/edge_measures.hpp"

namespace knead::brep {

void describe(EdgeCheckReport& r, Fields& fields);

}  // namespace knead::brep
