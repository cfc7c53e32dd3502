#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

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

/// What a list of a file's surfaces and curves leaves out: what the reader of the format does not read
/// (`Source::left_out`), surfaces that cannot be read, and faces whose edges or surface cannot. Cost: samples every
/// edge coarsely.
[[nodiscard]] std::vector<LeftOut> left_out_of_list(const Source& source);

/// What a list of the faces leaves out: the same, and the faces that cannot be drawn, which are tried coarsely. Cost:
/// about that of a coarse picture of all faces.
[[nodiscard]] std::vector<LeftOut> left_out_of_faces(const Source& source);

/// What a picture of the faces, surfaces and curves leaves out: the same, with the faces that it has skipped.
[[nodiscard]] std::vector<LeftOut> left_out_of_picture(const Source& source, std::span<const SkippedFace> skipped);

/// What a mesh of the faces leaves out: likewise, and the curves.
[[nodiscard]] std::vector<LeftOut> left_out_of_mesh(const Source& source, std::span<const SkippedFace> skipped);

/// What a new file of the whole B-spline surfaces leaves out: what the reader does not read, surfaces that cannot be
/// read, those of other forms, curves where the format holds none, the places of parts, and, in formats of surfaces,
/// the cuts by faces.
[[nodiscard]] std::vector<LeftOut> left_out_of_surfaces(const Source& source, const Format& format);

}  // namespace knead
