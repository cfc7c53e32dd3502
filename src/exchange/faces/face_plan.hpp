#pragma once

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "knead/exchange/format.hpp"
#include "knead/exchange/source.hpp"
#include "prepared_model.hpp"
#include "written_shells.hpp"

namespace knead::detail {

/// The piece of its curve that an edge is.
struct WrittenEdge {
  Interval range;  ///< of the curve, as `EdgeCurve` counts; up to a turn past the domain of a
                   ///< closed curve
  bool backwards = false;  ///< the edge runs from the upper end of the range to the lower one
};

/// What one product of a new file holds.
struct WrittenPart {
  std::string name;  ///< of the product; empty: it has none
  std::string unit;  ///< of its coordinates
  WrittenShells shells;
  std::vector<NamedSurface> surfaces;  ///< without faces: each a face on its natural bounds
  std::vector<NamedCurve> curves;
  std::vector<brep::PartPlace> places;  ///< rigid, but for the ratio of the units; at least one
  double uncertainty = 0;               ///< the largest of its surfaces
};

/// A new file of a model, before it is in any format.
struct FacePlan {
  std::shared_ptr<const brep::Model> model;  ///< its cones in radians, its bounds edges or vertices
  std::vector<std::optional<WrittenEdge>>
      edges;  ///< of the model; none: no face that is written has it
  std::unordered_map<std::string, Colour> colours;  ///< of faces and surfaces, by id
  std::string unit;                                 ///< of the model
  std::vector<WrittenPart> parts;
  std::vector<LeftOut> left_out;
  std::size_t faces = 0, solids = 0, surfaces = 0, curves = 0;  ///< of `parts`

  /// It takes more than one product: several parts, or one that does not stand once at its own
  /// origin.
  [[nodiscard]] bool placed() const;
  /// Of a face or, if it has none, of its surface.
  [[nodiscard]] std::optional<Colour> colour_of(const brep::Face& face) const;
};

/// What a new file of a source with faces holds, and what it leaves out: faces that cannot be read
/// or whose edges cannot, whose B-spline surfaces are then written whole; tessellated items; places
/// that mirror, shear or scale a part; whatever `Source::left_out` and `Source::unreadable` name.
/// \param unit of lengths where the source has none
/// Errors (input): nothing to write. Cost: that of `written_shells`, and of a pass over the edges.
[[nodiscard]] Expected<FacePlan> face_plan(const Source& source, const std::string& unit,
                                           Conversion conversion);

}  // namespace knead::detail
