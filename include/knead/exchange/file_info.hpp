#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "knead/brep/edge_measures.hpp"
#include "knead/exchange/source.hpp"

namespace knead {

// What is in a CAD file, as plain values with descriptions: what programs list of it.

using Corner = std::array<double, 3>;

/// A B-spline surface of a file. Coordinates are in the surface's own frame and units.
struct FileSurface {
  std::string id, name;
  std::array<int, 2> degree = {0, 0}, net = {0, 0};
  bool rational = false;
  /// The least and the largest; none of a polynomial one.
  std::optional<std::array<double, 2>> weights = {};
  std::array<bool, 2> clamped = {}, closed = {};
  std::array<std::vector<double>, 2> knots = {};
  std::array<int, 2> max_interior_multiplicity = {0, 0};
  std::optional<int> faces = {};  ///< on it; none where the format has none
  bool trimmed = false;
  std::array<Corner, 2> bounding_box = {};  ///< of the whole surface, untrimmed
};

/// A surface of another form, on which faces lie.
struct FileOtherSurface {
  std::string id, form;
  std::vector<std::string> faces;
  bool convertible = false;  ///< into a B-spline surface of the file
  std::string reason = {};   ///< why not
  /// Its exact B-spline form, of any format: degree and net, or why it has none.
  Expected<std::array<std::array<int, 2>, 2>> spline = {};
};

struct FileCurve {
  std::string id, name;
  int degree = 0, control_points = 0;
  bool rational = false, clamped = false;
  std::vector<double> knots = {};
};

struct FileUnreadable {
  std::string id, reason;
};

struct FileTessellation {
  std::string id, name, unit;
  int triangles = 0;
};

struct FilePlacement {
  Corner origin = {}, axis = {}, ref_direction = {};
};

/// A placement of a component in an assembly.
struct FileInstance {
  std::string id, name, parent, child;
  std::optional<FilePlacement> placement = {}, frame = {};
};

struct FilePlace {
  std::string path;
  /// Rows; from the part's coordinates to the model's.
  std::array<std::array<double, 4>, 3> matrix = {};
};

struct FilePart {
  std::string name, unit;
  std::vector<std::string> surfaces, faces, curves;
  std::vector<FilePlace> places;
};

/// The parts of the file and where they stand; or only the reason why that is not known.
struct FileAssembly {
  std::string reason = {};
  std::string unit = {};
  std::optional<std::vector<FilePart>> parts = {};
  std::optional<std::vector<std::string>> warnings = {};
};

struct FileLeftOut {
  std::string what;
  int count = 0;
  std::string reason;
  std::optional<std::string> remedy;
  std::vector<std::string> ids;
  std::string sentence;  ///< all that in words
};

/// An edge of the visible part of a surface, in fractions of its domain.
struct FileVisibleEdge {
  std::string id;
  std::array<double, 2> from = {0, 0}, to = {0, 0};
  std::vector<std::string> faces;
  bool seam = false;
};

/// What faces show of a surface; or only the reason why that is not known.
struct FileVisible {
  std::string surface, reason = {};
  bool in_shell = false;
  std::array<std::array<double, 2>, 2> extent = {};  ///< fractions of the domain
  std::array<Corner, 2> box = {};                    ///< of the edges
  std::optional<std::array<double, 2>> middle = {};  ///< `visible_middle`, in fractions
  double distance = 0;                               ///< of the middle from the nearest edge
  std::vector<FileVisibleEdge> edges = {};
};

struct FileInfo {
  std::string file, format, schema, units;
  std::vector<FileSurface> surfaces;
  std::vector<FileUnreadable> unreadable_surfaces;
  std::vector<FileOtherSurface> other_surfaces;
  std::vector<FileCurve> curves;
  std::vector<FileTessellation> tessellated_items;
  std::vector<FileInstance> instances;
  std::optional<FileAssembly> assembly;  ///< none where the format has none
  std::vector<FileLeftOut> left_out;
  std::vector<std::string> remarks;
  std::vector<FileVisible> visible;  ///< of surfaces with edges of faces, if asked for
};

/// The length unit of a file as a whole, "mm" or another; of several in a STEP file all their
/// names; "unknown".
[[nodiscard]] std::string unit_of(const Source& source);

/// What `file_info` computes besides reading.
struct FileInfoOptions {
  bool conversions = false;  ///< whether other surfaces can be converted
  bool faces = false;        ///< what faces show of the surfaces
  /// Called with the number of surfaces listed, and of all.
  std::function<void(std::size_t, std::size_t)> progress = {};
};

/// Cost: a bounding box of every surface and `left_out_of_list`; conversions:
/// `brep::exact_splines`; faces: `VisibleRegions` and `left_out_of_faces`.
[[nodiscard]] FileInfo file_info(const Source& source, const FileInfoOptions& options = {});

/// It as JSON, over several lines (docs/command-line.md).
[[nodiscard]] std::string file_json(const FileInfo& info);

/// What the edges of a file are judged by: gap in the file's units, angle in degrees up to
/// `brep::meant_smooth`, curvature in percent.
struct EdgeCheckRequest {
  std::optional<double> gap = {}, angle = {}, curvature = {};
  /// Gap and angle where they are not given, of "a" 0.01 mm and 0.1°, "b" 0.02 and 0.2, "c" 0.05
  /// and 0.5; empty: none.
  std::string grade = {};
  std::vector<std::string> edges = {};  ///< only these, by id; empty: all
  std::string unit = {};  ///< of the coordinates, for a class, where the file does not say it
  bool courses = false;   ///< with points along the edges, for drawing
};

/// How the faces of a file meet at its edges, and what of that exceeds a threshold; with `against`,
/// an earlier version of the file, what is worse than there by more than a threshold. A file
/// without faces has no edges. Errors (usage), `where` being the member's name ("class" of
/// `grade`): a threshold out of its range; a class without a unit, or a unit without a class;
/// `against` without thresholds; an edge that is not there. Cost: `brep::measure_edges` of either
/// file.
[[nodiscard]] Expected<brep::EdgeCheckReport> check_edges(const Source& source,
                                                          const EdgeCheckRequest& check,
                                                          const Source* against = nullptr);

}  // namespace knead
