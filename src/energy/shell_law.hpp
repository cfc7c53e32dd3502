#pragma once

#include <array>
#include <variant>

#include "knead/energy/shell_energy.hpp"
#include "shell_point.hpp"

namespace knead::detail {

/// The numbers of a shell that may vary over it.
struct ShellCoefficients {
  double young = 0, thickness = 0;
};

/// What an energy makes of the geometry of a rest shape: the measure per du dv, and stress
/// resultants per strain.
struct ShellLaw {
  std::variant<ShellMaterial, FundamentalMaterial> material;

  [[nodiscard]] double measure(const ShellPoint& rest) const {
    return std::holds_alternative<ShellMaterial>(material) ? rest.area : 1;
  }
  /// The energy per measure is quadratic in ε and κ, written 11, 22, 2·12. `here` is of a shell the
  /// one at the point.
  [[nodiscard]] std::array<Eigen::Matrix3d, 2> stiffness(const ShellPoint& rest,
                                                         const ShellCoefficients& here) const {
    if (const auto* shell = std::get_if<ShellMaterial>(&material)) {
      const double t = here.thickness;
      const Eigen::Matrix3d elastic = plane_stress(rest.inverse, here.young, shell->poisson);
      return {t * elastic, t * t * t / 12 * elastic};
    }
    const auto& [w1, w2] = std::get<FundamentalMaterial>(material);
    return {Eigen::Vector3d(8 * w1[0], 8 * w1[2], 4 * w1[1]).asDiagonal(),
            Eigen::Vector3d(2 * w2[0], 2 * w2[2], w2[1]).asDiagonal()};
  }
  /// Per area, where the thickness is this.
  [[nodiscard]] double mass(double thickness) const {
    const auto* shell = std::get_if<ShellMaterial>(&material);
    return shell != nullptr ? shell->density * thickness : 0;
  }
  [[nodiscard]] double mass() const {
    const auto* shell = std::get_if<ShellMaterial>(&material);
    return shell != nullptr ? shell->density * shell->thickness : 0;
  }
  /// Fields of the material; null where it is the same everywhere.
  [[nodiscard]] std::array<const SplineField<2>*, 2> fields() const {
    const auto* shell = std::get_if<ShellMaterial>(&material);
    if (shell == nullptr) return {nullptr, nullptr};
    return {shell->young_field ? &*shell->young_field : nullptr,
            shell->thickness_field ? &*shell->thickness_field : nullptr};
  }
};

}  // namespace knead::detail
