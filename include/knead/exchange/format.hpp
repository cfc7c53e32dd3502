#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/source.hpp"

namespace knead {

namespace detail {
struct FacePlan;
}

/// A surface to write.
struct NamedSurface {
  std::string name;  ///< UTF-8; may be empty
  Surface surface;
  std::optional<Colour> colour = {};
  std::string id = {};  ///< what errors call it, such as "#1"; its name if empty
  [[nodiscard]] const std::string& called() const { return id.empty() ? name : id; }
};

/// A curve to write.
struct NamedCurve {
  std::string name;  ///< UTF-8; may be empty
  Curve curve;
  std::string id = {};  ///< what errors call it; its name if empty
  [[nodiscard]] const std::string& called() const { return id.empty() ? name : id; }
};

/// Triangles to write, one mesh.
struct NamedMesh {
  std::string name;        ///< UTF-8; may be empty
  Points points, normals;  ///< one normal per point, unit, or zero where there is none
  std::vector<std::array<std::uint32_t, 3>>
      triangles;                      ///< counter-clockwise seen from the tip of the normal
  std::optional<Colour> colour = {};  ///< in formats that hold colours
};

/// How to write surfaces.
struct SaveOptions {
  int detail = 96;  ///< for triangles: desired grid lines per direction and surface, 1 to 2000
  std::string unit = {};                ///< of the coordinates, such as "mm"; empty: unknown
  std::string title = "surfaces";       ///< the title in formats that have one
  std::vector<NamedCurve> curves = {};  ///< after the surfaces, in formats that hold curves
  std::string_view schema = "ap214";    ///< of STEP: "ap214" or "ap242"
  bool faces = false;  ///< in STEP and IGES: as faces on their natural bounds, in shells
};

/// What a format stores of a surface.
enum class FormatContent {
  surfaces,   ///< the surface itself: degrees, knots, weights, control points
  triangles,  ///< a picture of it
};

/// A file format: how programs present it, and how its files are opened and written.
struct Format {
  std::string_view id;    ///< "stl": its name in scripts and options
  std::string_view name;  ///< "STL"
  std::span<const std::string_view>
      endings;                  ///< of file names, lower case, the usual one first: ".step", ".stp"
  std::string_view media_type;  ///< "model/stl"
  FormatContent content = FormatContent::triangles;
  std::string_view holds;  ///< its content, for menus and tables
  bool writes_curves = false;
  /// Its readers know a whole sphere as such alone: they cannot follow a loop along the seam from
  /// pole to pole.
  bool keeps_whole_spheres = false;
  /// Whether bytes look like a file of this format, by how they begin. Null: it cannot be opened.
  bool (*recognises)(std::string_view bytes) = nullptr;
  /// Opens bytes; `name` stands for the file in errors. Null where `recognises` is.
  Expected<std::shared_ptr<const Source>> (*open)(std::string bytes, std::string name) = nullptr;
  /// The bytes of a new file of these surfaces. Null for formats of triangles.
  Expected<std::string> (*save)(std::span<const NamedSurface> surfaces,
                                const SaveOptions& options) = nullptr;
  /// The bytes of a new file of faces with their trims (save_model.hpp). Null for formats that hold
  /// none.
  Expected<std::string> (*save_faces)(const detail::FacePlan& plan,
                                      const SaveOptions& options) = nullptr;
  /// The bytes of a new file of these meshes. Null for formats of surfaces.
  Expected<std::string> (*save_meshes)(std::span<const NamedMesh> meshes,
                                       const SaveOptions& options) = nullptr;
};

/// Whether new files can have this length unit, "mm", "inch", ….
[[nodiscard]] bool is_length_unit(std::string_view name);

/// The length of this unit in mm; none: it is not one of these.
[[nodiscard]] std::optional<double> millimetres_of(std::string_view unit);

/// All of these, in words.
[[nodiscard]] std::string list_of_length_units();

/// All formats, those that store surfaces first.
[[nodiscard]] std::span<const Format> formats();

/// The format of this id, or null.
[[nodiscard]] const Format* find_format(std::string_view id);

/// The format given by the ending of a file name, in any case, among those of this content; the
/// endings of compression are taken off before, but for triangles. Error (input): an unknown
/// ending; the remedy lists the endings.
[[nodiscard]] Expected<const Format*> format_of_name(std::string_view file_name,
                                                     FormatContent content);

/// The endings of these formats for messages: ".stl, .obj or .ply"; if `opened`, of the formats
/// that can be opened.
[[nodiscard]] std::string list_of_endings(FormatContent content, bool opened = false);

/// How to open a file.
struct OpenOptions {
  std::size_t max_unpacked = max_file_size;  ///< bytes that a compressed file may hold
};

/// Opens the bytes of a file of any format: the one that recognises them or, if none does, the one
/// given by the ending of the name, whose reader then reports what is wrong. Compressed files are
/// told by their content, opened as what they hold, and saved compressed (file_io.hpp). Errors
/// (input): no format; the message names them all.
[[nodiscard]] Expected<std::shared_ptr<const Source>> open_source(std::string bytes,
                                                                  std::string name,
                                                                  const OpenOptions& options = {});

/// A table of the formats in Markdown, as docs/formats.md has it.
[[nodiscard]] std::string format_table();

/// The list as JSON, for user interfaces: [{"id", "name", "endings", "media_type", "content",
/// "holds", "opens"}].
[[nodiscard]] std::string format_json();

/// The bytes of a file with all surfaces: the surfaces themselves in a format that stores surfaces,
/// a picture of them in one that stores triangles.
///
/// Triangles: each surface, whole and untrimmed, is a grid with every knot line on it
/// (`grid_lines`); the points lie on the surface to rounding, or to single precision in formats
/// that use it. Triangles run counterclockwise seen from where S_u × S_v points. Degenerate ones,
/// at poles, are left out. Vertices are not shared between surfaces, nor across the seam of a
/// closed one: equal control points along a seam give equal coordinates, but nothing promises a
/// watertight mesh. Normals are S_u × S_v / |S_u × S_v|, or, where that vanishes, the mean over
/// adjacent triangles. Errors: no surface, a detail out of range, more than 2³¹ triangles (input);
/// a denominator that is not positive, a coordinate too large for the format (numerical).
///
/// The trimmed model of a STEP file is written by `save_model` (model_mesh.hpp).
[[nodiscard]] Expected<std::string> save_surfaces(std::span<const NamedSurface> surfaces,
                                                  const Format& format,
                                                  const SaveOptions& options = {});

/// The surfaces, by index, that no new file can hold as faces: all their sides are points, to 1e-9
/// of the largest surface's size. `save_surfaces` refuses them where it makes faces. Errors: those
/// of evaluating a side. Cost: linear in the control points.
[[nodiscard]] Expected<std::vector<std::size_t>> without_faces(
    std::span<const NamedSurface> surfaces);

/// The bytes of a file of these meshes; the format must be one of triangles. Errors: another
/// format, more than 2³¹ triangles (input); a coordinate too large for the format (numerical).
[[nodiscard]] Expected<std::string> save_meshes(std::span<const NamedMesh> meshes,
                                                const Format& format,
                                                const SaveOptions& options = {});

}  // namespace knead
