#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "knead/exchange/source.hpp"

// The surfaces of a CAD file follow data: displacements at points, a pair of meshes, a scan, or a
// map of space (docs/morph.md).

namespace knead {

/// A file in memory; `name` stands for it in errors, and its ending tells formats that their bytes
/// do not.
struct MorphFile {
  std::string bytes, name;
};

/// Where the points of a model should go: one of the four.
struct MorphData {
  std::optional<MorphFile> vectors = {};        ///< points with displacements
  std::optional<MorphFile> from = {}, to = {};  ///< the same mesh before and after
  /// The displacement at every point: three formulas of x, y and z separated by ";"; or "lattice:"
  /// and a block of space of which control points are moved, as JSON (docs/morph.md).
  std::string space = {};
  std::function<Expected<Point>(const Point&)> map = {};  ///< the same; null: `space` says it
  std::optional<MorphFile> scan = {};  ///< points or a mesh of where the visible faces should lie

  [[nodiscard]] bool known_everywhere() const { return map || !space.empty(); }
};

/// How a model follows data. Lengths are in units of the model.
struct MorphSettings {
  double scale = 1;                      ///< of the displacements; −1 compensates
  std::optional<double> tolerance = {};  ///< largest residual wanted; none: 1e-5 of the size
  std::vector<std::string> faces = {};   ///< ids of faces or surfaces that may move; none: all
  std::vector<std::string> keep = {};    ///< ids of those that stay
  /// Of parts in several places: paths of those that the data are about ("engine/valve").
  std::vector<std::string> places = {};
  bool convert = true;               ///< planes and the like become B-splines, to move
  double refinement = 8;             ///< control points at most, as a multiple
  std::optional<double> reach = {};  ///< farthest that a point may be from a face; none: 1 % of the
                                     ///< model's box
  bool along_normal = false;         ///< only the part of displacements along the normal
  std::string unit = {};             ///< of the data; empty: that of the model
  std::vector<std::string> columns = {};  ///< of CSV: the six of point and displacement
  std::string field = {};                 ///< of VTK: the vector field at points
  bool align = false;                ///< a scan is laid onto the model before, by a rigid motion
  std::optional<double> noise = {};  ///< standard deviation of each coordinate of the data; none:
                                     ///< of a scan it is estimated, other data are exact
};

/// Lengths over all points of a set: their mean, root mean square, the values that 95 and 99 % of
/// them do not exceed, and the largest; and their parts along the outward normals, above 0 where
/// data lie outside of the model: mean, least and largest.
struct Deviation {
  double mean = 0, rms = 0, of_95 = 0, of_99 = 0, largest = 0;
  double signed_mean = 0, signed_least = 0, signed_most = 0;
};

/// How many points have a part along the outward normal in each of equal intervals from −limit to
/// limit.
struct MorphHistogram {
  double limit = 0;  ///< what 99 % of the magnitudes do not exceed; others are in the outermost
  std::vector<int> counts = {};
};

/// How the points on one surface were followed.
struct MorphedSurface {
  std::string id = {};
  std::vector<std::string> faces = {};  ///< on it
  int points = 0;
  Deviation before = {}, after = {};
  int control_points_before = 0, control_points_after = 0;
};

/// A surface or edge that did not take part, and why.
struct MorphException {
  std::string id = {}, reason = {};
};

/// A point of the data that is farther from every face than the reach.
struct MorphLeftOut {
  int number = 0;  ///< of the point in the data, from 1
  std::array<double, 3> place = {};
  std::optional<double> distance = {};  ///< none: more than a hundred times the reach
};

/// An edge with other figures than before.
struct MorphedEdge {
  std::string id = {}, kind = {};
  std::optional<double> gap_before = {}, gap_after = {};      ///< the larger of gap and off_curve
  std::optional<double> angle_before = {}, angle_after = {};  ///< degrees
  std::optional<double> curvature_before = {}, curvature_after = {};  ///< percent
};

/// The rigid motion x → rotation · x + shift that has laid a scan onto the model.
struct MorphAlignment {
  std::array<std::array<double, 3>, 3> rotation = {};  ///< rows
  std::array<double, 3> shift = {};
  double angle = 0;                      ///< of the rotation, degrees
  double rms_before = 0, rms_after = 0;  ///< distances of the scan from the model
};

/// How a scan was followed. Points that are neither used nor left out are counted here.
struct MorphScan {
  std::optional<MorphAlignment> alignment = {};
  double noise = 0;  ///< of each coordinate, given or estimated; 0: taken as exact
  bool noise_estimated = false;
  int turns = 0;          ///< times that partners were sought and followed
  int beyond_border = 0;  ///< points beside the model
  int turned_away = 0;    ///< points whose normals are more than 45° from those of the model
  int outliers = 0;       ///< points more than six deviations from the moved model
  double rms_before = 0, rms_after = 0;  ///< distances of partners from the model
};

/// What is above what was wanted after the fit.
struct MorphExcess {
  std::string measure = {};  ///< "residual", "parting", "angle", "contradiction"
  std::string surface = {}, edge = {};
  std::array<double, 3> place = {};
  double found = 0, wanted = 0;
  int count = 1;  ///< of data that contradict: how many on that surface; this is the worst
};

/// What `knead morph` says of its work. Lengths are in units of the model, times in seconds.
struct MorphReport {
  std::string file = {}, format = {}, unit = {};
  std::string data = {};       ///< what they are, and their files or formulas
  std::string data_unit = {};  ///< if it was given
  double scale = 1, size = 0, tolerance = 0, reach = 0;
  double refinement = 8;
  bool along_normal = false;
  std::vector<std::string> only = {}, kept = {}, places = {};  ///< as asked for
  int points = 0, used = 0, left_out = 0;                      ///< of the data
  std::vector<MorphLeftOut> listed = {};          ///< the first of those that were left out
  double largest_distance = 0, rms_distance = 0;  ///< of the points used from the model
  Deviation before = {}, after = {};  ///< of displacements that are wanted from those made
  MorphHistogram histogram_before = {}, histogram_after = {};
  int points_between = 0;
  std::optional<Deviation> between = {};  ///< after, of a map of space: between the data
  std::vector<MorphedSurface> surfaces = {};
  std::vector<std::string> converted = {};
  std::vector<MorphException> fixed = {};          ///< surfaces that stay, but for those asked for
  std::vector<MorphException> unknown_edges = {};  ///< that could not be followed
  std::optional<MorphScan> scan = {};              ///< if the data are one
  std::vector<MorphedEdge> edges = {};
  std::vector<MorphExcess> above = {};
  int control_points_before = 0, control_points_after = 0;
  double bytes_before = 0, bytes_after = 0;
  double lambda = 0;
  int rounds = 0, refinements = 0;
  double time_model = 0, time_data = 0, time_fit = 0, time_deviation = 0, time_save = 0,
         time_check = 0;
};

/// A point of the data on the model, and the parts along the outward normal of what is wanted there
/// and of what of it is missing.
struct MorphedPoint {
  int surface = 0;  ///< position in the surfaces of the report
  std::array<double, 3> place = {};
  double before = 0, after = 0;
};

/// The file after it has followed the data.
struct MorphedFile {
  std::string bytes;
  MorphReport report;
  std::vector<std::string> edges = {};  ///< ids of those that were written anew
  std::vector<MorphedPoint> points = {};
};

/// What `morph_file` does, in this order.
inline constexpr std::array<std::string_view, 6> morph_phases = {
    "Preparing the model",  "Seeking partners on the faces", "Fitting the faces",
    "Measuring deviations", "Writing faces and edges",       "Checking edges"};

/// Told how many parts are done, of how many; each phase has as many of them. An error ends it.
using MorphTold = std::function<Expected<void>(int, int)>;

/// Moves the faces of a file so that they follow data, with every edge and vertex written anew, and
/// everything else as it was. Every point of the data stands for its nearest visible point; one
/// least-squares fit moves all surfaces together (docs/morph.md). Planes and other forms become
/// B-splines before, exactly. A scale of 0 gives the bytes of the file.
///
/// Afterwards all edges are measured. One whose faces, or whose curve and faces, are parted by more
/// than the largest of what they were (+ 1 %), the uncertainty that the file states, and 1e-6 of
/// the size is an error (numerical), and nothing is returned.
///
/// Errors (input): a file without B-spline surfaces; not one kind of data; those of the readers; no
/// point within reach of a face; the boxes of data and model differ by more than five times, and no
/// unit was said; an id that is neither a face nor a surface; a part in several places that has
/// data; (numerical) those of the fit; those of `told`, and of an `Interruption`. Cost: a minute or
/// less for a thousand faces.
[[nodiscard]] Expected<MorphedFile> morph_file(const std::shared_ptr<const Source>& source,
                                               const MorphData& data,
                                               const MorphSettings& settings = {},
                                               const MorphTold& told = {});

/// A report as JSON, over several lines, and the schema of that.
[[nodiscard]] std::string morph_json(const MorphReport& report);
[[nodiscard]] std::string morph_schema();

/// A report for people, as Markdown; without links to pictures.
[[nodiscard]] std::string morph_page(const MorphReport& report);

/// A picture in rows from the top, red, green and blue.
struct MorphPicture {
  std::string name = {};  ///< "before.png"
  int width = 0, height = 0;
  std::vector<unsigned char> colours = {};
};

/// A page with the pictures that it shows.
struct IllustratedPage {
  std::string text;                                           ///< README.md
  std::vector<std::pair<std::string, std::string>> drawings;  ///< names and SVG texts
  std::vector<MorphPicture> pictures;
};

/// `morph_page` with pictures: a histogram, and the parts along the normal as colours on the model,
/// seen from two opposite directions: before and after on one scale, and after on a scale of its
/// own. A place has the colour of the nearest datum on its surface, and is grey where there is none
/// near. Without data, as at a scale of 0, there are no pictures. Errors: those of the faces'
/// triangles. Cost: that of the triangles, and of drawing each datum as a disc.
[[nodiscard]] Expected<IllustratedPage> illustrated_page(const Source& opened,
                                                         const MorphedFile& morphed);

}  // namespace knead
