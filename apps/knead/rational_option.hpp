#pragma once

#include <optional>
#include <string>

#include "cli.hpp"
#include "knead/energy/stiffness.hpp"

namespace knead::cli {

/// --tolerance and --denominator: how energies of rational surfaces are integrated.
struct RationalOption {
  std::optional<double> tolerance;         // `default_rational_tolerance` unless given
  std::optional<std::string> denominator;  // exact unless given

  void add_to(CLI::App& command);
  [[nodiscard]] bool given() const { return tolerance || denominator; }
  /// Usage errors: a denominator of another name, a tolerance that cannot be kept.
  [[nodiscard]] Expected<StiffnessOptions> read() const;
  /// A `Stiffness::error_bound` in words.
  [[nodiscard]] static std::string describe(double error_bound);
};

}  // namespace knead::cli
