#pragma once

#include "describe/describe.hpp"
#include "knead/exchange/morph.hpp"

namespace knead {

void describe(Deviation& d, Fields& fields);
void describe(MorphAlignment& a, Fields& fields);
void describe(MorphReport& r, Fields& fields);

}  // namespace knead
