#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exchange/nets/surface_text.hpp"

namespace knead::occt {

using detail::ListedSurface;
using detail::TextRange;
using detail::WordReader;

/// A curve in space or in the parameters of a surface: 1 line, 2 circle, 3 ellipse, 4 parabola, 5
/// hyperbola, 6 Bézier, 7 B-spline, 8 a part of another, 9 an offset of another.
struct BrepCurve {
  int type = 0;
  std::vector<double> numbers;  ///< of types 1 to 5 as the file lists them
  std::optional<Curve> spline;  ///< of types 6 and 7, unless periodic; z is 0 of flat ones
  std::shared_ptr<const BrepCurve> basis;  ///< of types 8 and 9
};

/// A surface: 1 plane, 2 cylinder, 3 cone, 4 sphere, 5 torus, 6 extrusion, 7 revolution, 8 Bézier,
/// 9 B-spline, 10 a part of another, 11 an offset of another.
struct BrepSurface {
  int type = 0;  ///< of what it is a part of, where it is one
  std::vector<double> numbers;
  std::shared_ptr<const BrepCurve> profile;
  std::optional<Expected<ListedSurface>> spline;  ///< of types 8 and 9
};

/// The next curve of 2 or 3 dimensions, or surface. Errors (input), with their line: counts,
/// degrees or numbers that cannot be those of one; more than 8 curves or surfaces within each
/// other.
[[nodiscard]] Expected<BrepCurve> read_brep_curve(WordReader& words, int dimension);
[[nodiscard]] Expected<BrepSurface> read_brep_surface(WordReader& words);

enum class Shape { vertex, edge, wire, face, group };

/// A use of a shape: '+', '-', 'i' or 'e', its index, and where it is put.
struct Use {
  char orientation = '+';
  std::size_t shape = 0;
  Eigen::Affine3d place = Eigen::Affine3d::Identity();
};

/// The curve of an edge in the parameters of a surface; of a closed one's seam there are two. All
/// from 1.
struct BrepFlatCurve {
  int curve = 0, other = 0;  ///< 0: no second one
  int surface = 0;
  Eigen::Affine3d place = Eigen::Affine3d::Identity();  ///< of the surface
  std::array<double, 2> range = {0, 1};
};

struct BrepShape {
  Shape kind = Shape::group;
  Point point = Point::Zero();  ///< of a vertex
  double tolerance = 0;         ///< of a vertex or an edge
  TextRange tolerance_word;
  std::array<TextRange, 3> coordinates = {};  ///< of a vertex
  bool degenerated = false;                   ///< of an edge
  bool same_parameter = true;            ///< its curves are at the same points at equal parameters
  std::array<double, 2> range = {0, 1};  ///< of the parameters of its curve
  TextRange curve_word;                  ///< that says which curve it has
  int geometry = 0;  ///< the curve of an edge, the surface of a face, from 1; 0: none
  Eigen::Affine3d place = Eigen::Affine3d::Identity();  ///< of the geometry
  std::vector<BrepFlatCurve> flat;                      ///< of an edge
  std::vector<TextRange> polygons;  ///< the words that give an edge its polygons
  TextRange triangulation;  ///< the words that give a face its triangles; empty: it has none
  std::vector<Use> uses;
};

/// A file of Open CASCADE's `BRepTools`, text, versions 1 to 3: everything but polygons and
/// triangulations, which are skipped. Shapes refer to earlier ones only.
struct BrepFile {
  std::vector<BrepCurve> flat_curves;
  std::vector<BrepCurve> curves;
  std::vector<TextRange> curve_blocks;  ///< of each
  TextRange curve_count;                ///< the word
  std::vector<BrepSurface> surfaces;
  std::vector<BrepShape> shapes;
  std::vector<Use> roots;

  /// Errors (input), with their line: what is not of this format, counts beyond the text,
  /// references to nothing.
  [[nodiscard]] static Expected<BrepFile> parse(std::string_view bytes, std::string_view name);
};

}  // namespace knead::occt
