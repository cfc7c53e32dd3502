#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/brep/model.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

class Source;
struct Format;
struct SkippedFace;

/// Things of one kind in a file that are not listed, drawn or written, and why.
struct LeftOut {
  static constexpr std::size_t most_ids = 6;

  std::string one, many;  ///< what they are called: "point", "points"
  std::size_t count = 0;
  std::string reason;                 ///< a clause: "a point has no surface"
  std::string remedy = {};            ///< what would help; empty: nothing is known to
  std::vector<std::string> ids = {};  ///< of the first `most_ids`, in the order of the file
  int line = 0;                       ///< of the file, of the first of them, from 1; 0: not known

  /// What that many of them are called.
  [[nodiscard]] const std::string& what() const { return count == 1 ? one : many; }
};

/// One line: "2 points (#7, #9): a point has no surface; …", fit for a terminal.
[[nodiscard]] std::string sentence(const LeftOut& left);

/// What a list of a file's surfaces and curves leaves out: what the reader of the format does not
/// read
/// (`Source::left_out`), surfaces that cannot be read, and faces whose edges or surface cannot.
/// Cost: samples every edge coarsely.
[[nodiscard]] std::vector<LeftOut> left_out_of_list(const Source& source);

/// What a list of the faces leaves out: the same, and the faces that cannot be drawn, which are
/// tried coarsely. Cost: about that of a coarse picture of all faces.
[[nodiscard]] std::vector<LeftOut> left_out_of_faces(const Source& source);

/// What a picture of the faces, surfaces and curves leaves out: the same, with the faces that it
/// has skipped.
[[nodiscard]] std::vector<LeftOut> left_out_of_picture(const Source& source,
                                                       std::span<const SkippedFace> skipped);

/// What a mesh of the faces leaves out: likewise, and the curves.
[[nodiscard]] std::vector<LeftOut> left_out_of_mesh(const Source& source,
                                                    std::span<const SkippedFace> skipped);

/// What a new file of the whole B-spline surfaces leaves out: what the reader does not read,
/// surfaces that cannot be read, those of other forms, curves where the format holds none, the
/// places of parts, and, in formats of surfaces, the cuts by faces.
[[nodiscard]] std::vector<LeftOut> left_out_of_surfaces(const Source& source, const Format& format);

/// Red, green and blue from 0 to 1, as CAD files have them.
using Colour = std::array<double, 3>;

/// A surface of a file, as read.
struct SourceSurface {
  std::string id;    ///< what the file calls it: "#123" in STEP
  std::string name;  ///< its label
  std::string unit;  ///< length unit of its coordinates; "unknown" where the file has none
  std::shared_ptr<const Surface> surface;
};

/// A curve of a file that stands for itself, as read.
struct SourceCurve {
  std::string id, name, unit;
  std::shared_ptr<const Curve> curve;
};

/// An opened file: its surfaces, and the means to write it back with some of them changed and
/// everything else as it was. Immutable; const access is thread-safe.
class Source {
 public:
  virtual ~Source() = default;

  [[nodiscard]] virtual const std::string& name() const = 0;
  /// The name of its format: "STEP".
  [[nodiscard]] virtual std::string_view format() const = 0;
  /// What its header calls its form, as in "AUTOMOTIVE_DESIGN" of STEP; empty where formats have
  /// none.
  [[nodiscard]] virtual std::string schema() const { return {}; }
  /// What else is to be said about the file: one sentence or count each.
  [[nodiscard]] virtual std::vector<std::string> remarks() const { return {}; }
  /// What of the file is not read; `left_out_of_list` and the like add what is read and left out
  /// all the same.
  [[nodiscard]] virtual std::vector<LeftOut> left_out() const { return {}; }
  /// In the order of the file.
  [[nodiscard]] virtual const std::vector<SourceSurface>& surfaces() const = 0;
  [[nodiscard]] virtual const std::vector<brep::UnreadableSurface>& unreadable() const = 0;
  /// Curves that stand for themselves, in the order of the file; formats that are not read for them
  /// have none.
  [[nodiscard]] virtual const std::vector<SourceCurve>& curves() const;
  /// Whether this is a curve of the file that something else is made of, such as an edge, and so is
  /// not free.
  [[nodiscard]] virtual bool is_bound_curve(const std::string& /*id*/) const { return false; }
  /// The bytes of the file with these surfaces, one for each of `surfaces()` in order, in place of
  /// the original ones. A surface that is the original (the same object) keeps its bytes.
  /// `followed`: edges of faces that are written anew where these surfaces have moved them, by id;
  /// formats without faces have none. `curves`: likewise one for each of `curves()`; empty: they
  /// stay.
  [[nodiscard]] virtual Expected<std::string> save(
      std::span<const std::shared_ptr<const Surface>> surfaces,
      std::span<const std::string> followed = {},
      std::span<const std::shared_ptr<const Curve>> curves = {}) const = 0;
  /// The same file with surfaces of other forms, given by their ids or those of faces on them, as
  /// B-spline surfaces; its other surfaces stay the same objects. Errors (input): one cannot be
  /// converted; the format has no others.
  [[nodiscard]] virtual Expected<std::shared_ptr<const Source>> with_splines(
      std::span<const std::string> surfaces) const;
  /// Its faces, their edges and where its parts stand, with the same ids. Null for formats without
  /// faces.
  [[nodiscard]] virtual std::shared_ptr<const brep::Model> model() const { return nullptr; }
  /// The colours that the file gives to faces and surfaces, by id. Cost: linear in what describes
  /// them.
  [[nodiscard]] virtual std::unordered_map<std::string, Colour> colours() const { return {}; }
  /// Whether this edge of its faces can be written anew. Errors (input): it cannot, with the
  /// reason.
  [[nodiscard]] virtual Expected<void> can_move_edge(const std::string& id) const;

 protected:
  Source() = default;
  Source(const Source&) = default;
  Source& operator=(const Source&) = default;
};

}  // namespace knead
