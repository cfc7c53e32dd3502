#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "knead/base/error.hpp"
#include "knead/spline/spline.hpp"

namespace knead::step {

/// A surface for a file that does not exist yet.
struct NewSurface {
  std::string name;                                  ///< its label, UTF-8
  Surface surface;                                   ///< coordinates in `TextOptions::unit`
  std::optional<std::array<double, 3>> colour = {};  ///< red, green and blue from 0 to 1
  std::string id = {};                               ///< what errors call it; its label if empty
};

/// A curve for a file that does not exist yet.
struct NewCurve {
  std::string name;     ///< its label, UTF-8
  Curve curve;          ///< coordinates in `TextOptions::unit`
  std::string id = {};  ///< what errors call it; its label if empty
};

/// The application protocol of a new file (ISO 10303-214, ISO 10303-242).
enum class Schema { ap214, ap242 };

struct TextOptions {
  std::string unit = "mm";           ///< one of `is_length_unit`, "mm", "inch", …
  std::string product = "surfaces";  ///< name of the product and its representation, UTF-8
  std::string file_name = {};        ///< of the header, UTF-8
  /// Of the header, as in "2024-05-17T12:00:00"; the text depends on nothing else.
  std::string time_stamp = {};
  Schema schema = Schema::ap214;
  /// Each surface is a face on its natural bounds, in shells with those it meets.
  bool faces = false;
};

/// A STEP file (ISO 10303-21, AP214 or AP242) that contains these surfaces and curves and nothing
/// else.
///
/// One product with one GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION whose GEOMETRIC_SET
/// lists the surfaces in order, each on its natural bounds, as B_SPLINE_SURFACE_WITH_KNOTS, with
/// weights as a complex instance with RATIONAL_B_SPLINE_SURFACE; then the curves likewise, as
/// B_SPLINE_CURVE_WITH_KNOTS. Without surfaces it is a
/// GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION with a GEOMETRIC_CURVE_SET. Coordinates
/// have 17 significant digits, knots and weights the fewest that restore the same bits:
/// `File::parse` reads the same surfaces bit for bit. With `faces` the surfaces are ADVANCED_FACEs
/// whose EDGE_CURVEs are the sides of the surfaces, exactly; sides that are the same curve are one
/// edge, and faces that share edges a shell of a SHELL_BASED_SURFACE_MODEL, CLOSED_SHELL where
/// every edge has two faces; curves are then a representation of their own. Colours are
/// STYLED_ITEMs. The closed flags are those of `SplineSurface::closed`. Cost: linear in the number
/// of control points. Errors (input): neither surfaces nor curves; an unknown unit; a knot inside
/// the domain repeated more often than the degree.
[[nodiscard]] Expected<std::string> text_of(std::span<const NewSurface> surfaces,
                                            const TextOptions& options = {},
                                            std::span<const NewCurve> curves = {});

}  // namespace knead::step
