#pragma once

#include "binding.hpp"
#include "knead/exchange/numerical_files.hpp"

namespace knead::python {

/// Results on grids, shared with the arrays that show them.
struct Grids {
  std::shared_ptr<const std::vector<FieldGrid>> list;
};

}  // namespace knead::python
