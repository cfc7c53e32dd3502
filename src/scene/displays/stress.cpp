#include <algorithm>
#include <limits>

#include "all.hpp"
#include "knead/energy/shell_energy.hpp"

namespace knead {
namespace {

/// One of the results of a shell; not a number on surfaces that are no shells, 0 of the shape as
/// opened.
template <class Take>
Expected<std::vector<double>> of_shell(const DisplayInput& input, Take take) {
  const SceneSurface& s = input.scene.surfaces[static_cast<std::size_t>(input.surface)];
  const auto count = static_cast<std::size_t>(input.normals.rows());
  const auto* shell = std::get_if<ShellMaterial>(&s.elasticity);
  if (shell == nullptr) return std::vector<double>(count, std::numeric_limits<double>::quiet_NaN());
  if (input.opened) return std::vector<double>(count, 0.0);
  const auto& [u, v] = input.parameters;
  Parameters<2> at(static_cast<Eigen::Index>(count), 2);
  Eigen::Index k = 0;
  for (const double a : u) {
    for (const double b : v) at.row(k++) << a, b;
  }
  const auto results = shell_results(*s.rest, *s.current, *shell, at);
  if (!results) return std::unexpected(results.error());
  std::vector<double> values;
  values.reserve(count);
  for (const ShellPointResults& r : *results) values.push_back(take(r));
  return values;
}

Expected<std::vector<double>> larger(const DisplayInput& input) {
  return of_shell(
      input, [](const ShellPointResults& r) { return std::max(r.von_mises[0], r.von_mises[1]); });
}

Expected<std::vector<double>> outer(const DisplayInput& input) {
  return of_shell(input, [](const ShellPointResults& r) { return r.von_mises[0]; });
}

Expected<std::vector<double>> inner(const DisplayInput& input) {
  return of_shell(input, [](const ShellPointResults& r) { return r.von_mises[1]; });
}

Expected<std::vector<double>> bending(const DisplayInput& input) {
  return of_shell(input, [](const ShellPointResults& r) { return 100 * r.bending_strain; });
}

Display stress(std::string_view name, std::string_view title, std::string_view help,
               Expected<std::vector<double>> (*values)(const DisplayInput&)) {
  return {.name = name,
          .title = title,
          .unit = "force/length²",
          .palette = DisplayPalette::rising,
          .help = help,
          .percentiles = {0, 1},
          .values = values};
}

}  // namespace

Display von_mises_display() {
  return stress("von_mises", "Von Mises stress",
                "Of shells: the larger stress of the two faces, in units of Young's modulus.",
                larger);
}

Display von_mises_outer_display() {
  return stress("von_mises_outer", "Von Mises stress outside",
                "Of shells: the stress on the face that the normal leaves.", outer);
}

Display von_mises_inner_display() {
  return stress("von_mises_inner", "Von Mises stress inside",
                "Of shells: the stress on the face that the normal enters.", inner);
}

Display bending_strain_display() {
  Display display =
      stress("bending_strain", "Bending strain",
             "Of shells: half the thickness times the largest change of curvature.", bending);
  display.unit = "%";
  return display;
}

}  // namespace knead
