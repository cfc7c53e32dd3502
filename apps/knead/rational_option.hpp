#pragma once

#include <string>

#include "cli.hpp"
#include "knead/energy/stiffness.hpp"

namespace knead::cli {

/// --tolerance and --denominator: how energies of rational surfaces are integrated.
struct RationalOption {
  double tolerance = default_rational_tolerance;
  std::string denominator = "exact";

  void add_to(CLI::App& command);
  /// Usage errors: a denominator of another name, a tolerance that cannot be kept.
  [[nodiscard]] Expected<StiffnessOptions> read() const;
  /// A `Stiffness::error_bound` in words.
  [[nodiscard]] static std::string describe(double error_bound);
};

}  // namespace knead::cli
