#pragma once

#include "describe/describe.hpp"
#include "knead/exchange/morph.hpp"

namespace knead {

void describe(MorphReport& r, Fields& fields);

}  // namespace knead
