#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "brep/tessellation/context_faces.hpp"
#include "energy_density.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {

/// A number or 3-vector that the user can set on a display.
struct DisplaySetting {
  std::string_view name, title;
  std::string_view unit;      ///< "" for a direction, else as in `Display`
  std::vector<double> value;  ///< the default; 1 or 3 numbers
  std::string_view help;
};

/// How values become colours. Diverging: two colours that meet at 0; rising: from pale at 0 to
/// dark.
enum class DisplayPalette { diverging, rising };

/// What stands around a surface: the rest of the file, which is no part of a scene.
struct Surroundings {
  /// Of a surface: what faces show of it (null: all), and on which side of it they have no material
  /// (`face_senses`).
  struct Shown {
    std::shared_ptr<const VisibleRegion> visible;
    int sense = 0;
  };
  std::vector<FaceMesh> faces;         ///< those that lie on no surface of the scene
  std::map<std::string, Shown> shown;  ///< by the ids of surfaces; others are shown whole
  /// Numbers of the parts of an assembly, by the ids of surfaces and faces: each part has
  /// coordinates of its own, so that its surfaces see it alone. What is not listed is of part 0.
  std::map<std::string, std::size_t> parts;
  [[nodiscard]] std::size_t part_of(const std::string& id) const {
    const auto found = parts.find(id);
    return found == parts.end() ? 0 : found->second;
  }
};

struct SurfaceTrim;

/// What the faces of a file show of each of its surfaces, as far as loops say; null: all of it.
[[nodiscard]] std::vector<std::shared_ptr<const VisibleRegion>> shown_regions(
    std::span<const SurfaceTrim> trims);

/// The faces of a STEP file around its surfaces in full precision, four times as fine as drawn, and
/// what is shown of each surface. \param visible of each surface of the file, in its order; null,
/// or too few: all of it Cost: that of `context_faces`; faces that fail are left out.
[[nodiscard]] std::shared_ptr<const Surroundings> surroundings(
    const brep::Model& model, std::span<const std::shared_ptr<const VisibleRegion>> visible);

class ModelFacets;

/// What displays keep from one picture to the next: energy units already computed, and what of a
/// grid is visible.
struct DisplayMemory {
  struct Visible {
    std::shared_ptr<const VisibleRegion> region;
    std::array<std::vector<double>, 2> parameters;
    std::vector<bool> samples;
  };
  std::vector<Visible> visible;
  std::vector<std::pair<EnergyScalingInput, Expected<DomainScaling<2>>>> scalings;
  std::shared_ptr<ModelFacets> facets;
};

/// The input of a display: one surface of a scene on a grid of parameters, v fastest.
struct DisplayInput {
  const Scene& scene;
  int surface = 0;      ///< index into its surfaces
  bool opened = false;  ///< the shape as opened is drawn, not the present one
  const std::array<std::vector<double>, 2>& parameters;
  std::array<const BasisTable*, 2> tables;  ///< of the drawn shape at the parameters, to order 2
  const Evaluation<2>& evaluation;          ///< of the drawn shape, to `Display::order` at least
  const Points& normals;  ///< unit normals S_u × S_v; at poles those of a neighbour
  std::span<const std::vector<double>> settings;  ///< in the order of `Display::settings`
  DisplayMemory& memory;
  std::shared_ptr<const VisibleRegion> visible = {};  ///< what faces show of the surface; null: all
  /// For displays that see them; null: the scene is all there is.
  std::shared_ptr<const Surroundings> around = {};
};

/// A field that colours surfaces. Menus, legends and settings follow from it.
struct Display {
  std::string_view name, title;
  std::string_view unit;   ///< with "length" for that of the file: "1/length²"; "°"; "normalised"
  bool is_signed = false;  ///< values may be negative
  DisplayPalette palette = DisplayPalette::diverging;
  std::string_view help;
  /// The values at the ends of the palette, lower and upper; without them, those of
  /// `DisplayRangeFinder`.
  std::optional<std::array<double, 2>> limits = {};
  std::array<double, 2> percentiles = {
      0.02, 0.98};   ///< shares of the area below the ends; 0 and 1: the extremes
  double share = 1;  ///< of the automatic range that the palette spans
  /// The setting up to whose magnitude values have the neutral colour; "" for none.
  std::string_view tolerance = {};
  bool compares = false;    ///< with the shape as it was opened
  bool sees_model = false;  ///< uses `DisplayInput::around`
  int order = 1;            ///< highest order of the derivatives it uses
  std::vector<DisplaySetting> settings = {};
  /// One value for each grid point, in the given unit; not a number where there is none.
  Expected<std::vector<double>> (*values)(const DisplayInput& input) = nullptr;
};

/// All displays, in the order of menus; each is a file in src/scene/displays. The first call makes
/// the list.
[[nodiscard]] std::span<const Display> displays();

/// Errors (usage): an unknown name.
[[nodiscard]] Expected<const Display*> find_display(std::string_view name);

/// The settings of a display: the given ones, and defaults for the others. Errors (usage): a
/// setting that the display does not have, with the wrong number of components, or with one that is
/// not finite.
[[nodiscard]] Expected<std::vector<std::vector<double>>> display_settings(
    const Display& display, std::span<const std::pair<std::string, std::vector<double>>> given);

}  // namespace knead
