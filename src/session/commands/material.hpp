#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Materials that there are by name.
enum class MaterialPreset { clay, wax, rubber, sheet_metal, cloth, membrane };

/// What resists: the linear active model, a shell, or the fundamental forms of a surface; a plate
/// is a linear model with the coefficients of `thin_plate`.
enum class MaterialModel { linear, shell, fundamental, plate };

/// What lengths of a material are counted in.
enum class LengthUnit { radii, file };

std::span<const Choice> choices(MaterialPreset);
std::span<const Choice> choices(LengthUnit);
std::span<const Choice> choices(MaterialModel);

/// A material that has a name, as pages show it: α11 = α22 and β11 = β12 = β22.
struct NamedMaterial {
  std::string name, help;
  double alpha = 0, beta = 0;
};
[[nodiscard]] std::vector<NamedMaterial> named_materials();
void describe(NamedMaterial& m, Fields& fields);

/// The material by name that a surface has; none where it has one of its own.
[[nodiscard]] std::optional<MaterialPreset> preset_of(const SceneSurface& surface);

/// Sets stretch and bend coefficients, mass and damping of the selected surfaces, everywhere or in
/// a region. What is not named stays as it is.
struct MaterialCommand {
  static constexpr ActsOn acts_on = ActsOn::shapes;
  /// In the order 11, 12, 22 of surfaces; 11 of curves; 11, 12, 13, 22, 23, 33 of volumes.
  std::optional<std::vector<double>> alpha, beta;
  std::optional<double> mass, damping;
  std::optional<FractionBox> region;
  double falloff = 0.1;  ///< width of the border between old and new, in fractions
  /// One coefficient alone ("alpha11" … "beta22", "mass", "damping") by samples on a grid over the
  /// domain.
  std::optional<std::string> coefficient;
  std::array<int, 2> counts = {0, 0};
  std::vector<double> samples;         ///< last direction fastest, linear in between
  std::optional<std::string> formula;  ///< the same by a formula, to a tolerance
  std::optional<double> tolerance;
  std::optional<MaterialPreset> preset;  ///< of whole surfaces
  /// What strokes leave; default: that of the preset, else as it was.
  std::optional<double> plasticity, yield, locality;
  std::optional<LengthUnit> lengths;  ///< default: radii
  std::optional<MaterialModel> model;
  std::optional<double> young, poisson, thickness,
      density;                     ///< of a shell, in units of the file; poisson of a plate
  std::optional<double> rigidity;  ///< of a plate, in units of beta
  std::optional<std::array<double, 3>> w1,
      w2;              ///< of the fundamental forms, in the order 11, 12, 22
  bool reset = false;  ///< first, all is as of a new surface
};

/// What resists, and what strokes leave, are as of a new shape.
template <int D>
void reset_material(SceneShape<D>& s) {
  s.material = {};
  s.elasticity = {};
  if constexpr (D == 2) s.plastic = {};
}

/// What it does to the selected curve or volume: fields that only surfaces have are errors.
[[nodiscard]] Expected<void> set_body_material(Act& act, const MaterialCommand& c);

Expected<void> execute(const MaterialCommand& c, Act& act);
void describe(MaterialCommand& c, Fields& fields);

}  // namespace knead
