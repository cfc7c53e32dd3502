#pragma once

#include <string>

#include "knead/brep/edge_measures.hpp"

namespace knead::cli {

/// What `knead check` prints: edges counted by kind, the ten worst by each measure, what is not
/// known, and the verdict.
[[nodiscard]] std::string check_text(const brep::EdgeCheckReport& report);

/// The verdict, one line.
[[nodiscard]] std::string check_verdict(const brep::EdgeCheckReport& report);

}  // namespace knead::cli
