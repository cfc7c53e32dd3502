#pragma once

#include <vector>

#include "knead/exchange/source.hpp"

namespace knead::cli {

/// A warning each on standard error.
void warn_left_out(const std::vector<LeftOut>& list);

}  // namespace knead::cli
