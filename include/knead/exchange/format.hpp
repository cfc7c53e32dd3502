#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/exchange/source.hpp"

namespace knead {

/// A surface to write.
struct NamedSurface {
  std::string name;  ///< UTF-8; may be empty
  Surface surface;
};

/// How to write surfaces.
struct SaveOptions {
  int detail = 96;                 ///< of triangles: grid lines wanted per direction and surface, 1 to 2000
  std::string unit = {};           ///< of the coordinates, "mm" or the like; empty: not known
  std::string title = "surfaces";  ///< what formats that name their content call it
};

/// What a format keeps of a surface.
enum class FormatContent {
  surfaces,   ///< the surface itself: degrees, knots, weights, control points
  triangles,  ///< a picture of it
};

/// A file format: what programs show of it, and how files of it are opened and written.
struct Format {
  std::string_view id;                        ///< "stl": what scripts and options call it
  std::string_view name;                      ///< "STL"
  std::span<const std::string_view> endings;  ///< of file names, lower case, the usual one first: ".step", ".stp"
  std::string_view media_type;                ///< "model/stl"
  FormatContent content = FormatContent::triangles;
  std::string_view holds;  ///< what a file of it holds, for menus and tables
  /// Whether bytes look like a file of it, by how they begin. Null: files of this format are not opened.
  bool (*recognises)(std::string_view bytes) = nullptr;
  /// Opens bytes; `name` stands for the file in errors. Null where `recognises` is.
  Expected<std::shared_ptr<const Source>> (*open)(std::string bytes, std::string name) = nullptr;
  /// The bytes of a new file of these surfaces.
  Expected<std::string> (*save)(std::span<const NamedSurface> surfaces, const SaveOptions& options) = nullptr;
};

/// All formats, those that keep the surfaces first.
[[nodiscard]] std::span<const Format> formats();

/// The format of this id, or null.
[[nodiscard]] const Format* find_format(std::string_view id);

/// The format that the ending of a file name asks for, in any case, among those of this content. Error (input): another
/// ending; the remedy lists the endings.
[[nodiscard]] Expected<const Format*> format_of_name(std::string_view file_name, FormatContent content);

/// The endings of these formats for messages: ".stl, .obj or .ply"; of formats that can be opened where `opened`.
[[nodiscard]] std::string list_of_endings(FormatContent content, bool opened = false);

/// Opens the bytes of a file of any format: that which recognises them, or, where none does, that which the ending of
/// the name asks for, whose reader then says what is wrong. Errors (input): neither; the message names the formats.
[[nodiscard]] Expected<std::shared_ptr<const Source>> open_source(std::string bytes, std::string name);

/// A table of the formats in Markdown, as docs/formats.md has it.
[[nodiscard]] std::string format_table();

/// The list as JSON, for user interfaces: [{"id", "name", "endings", "media_type", "content", "holds", "opens"}].
[[nodiscard]] std::string format_json();

/// The bytes of a file with all surfaces: of a format that keeps surfaces, these; of one that holds triangles, a
/// picture of them.
///
/// Triangles: each surface, whole and untrimmed, is a grid with every knot line on it (`grid_lines`); the points lie on
/// the surface to rounding, and in formats with single precision to that. Triangles run counterclockwise seen from
/// where S_u × S_v points. Those that are no triangles, at poles, are left out. Vertices are not shared between
/// surfaces, nor across the seam of a closed one: equal control points along a seam give equal coordinates, but nothing
/// promises a watertight mesh. Normals are S_u × S_v / |S_u × S_v|, and where that vanishes the mean of those of the
/// triangles around. Errors: no surface, a detail out of range, more than 2³¹ triangles (input); a denominator that is
/// not positive, a coordinate too large for the format (numerical).
[[nodiscard]] Expected<std::string> save_surfaces(std::span<const NamedSurface> surfaces, const Format& format,
                                                  const SaveOptions& options = {});

}  // namespace knead
