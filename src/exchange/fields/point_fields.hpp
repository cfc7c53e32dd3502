#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/spline/spline.hpp"

namespace knead::fields {

/// Points, and vectors at them under a name.
struct PointFields {
  struct Field {
    std::string name;
    int components = 0;
    std::vector<Point> vectors;  ///< one per point, of those with three components; else empty
  };
  std::vector<Point> points;
  std::vector<Field> fields;  ///< each once, in the order of the file
};

/// Whether bytes begin like a file of VTK, legacy or XML.
[[nodiscard]] bool is_vtk_legacy(std::string_view bytes);
[[nodiscard]] bool is_vtk_xml(std::string_view bytes);

/// Points and point data of a legacy file of VTK (The VTK User's Guide, "Simple legacy formats",
/// and version 5.1 of it): POLYDATA, UNSTRUCTURED_GRID or STRUCTURED_GRID, ASCII or BINARY. Data at
/// cells are passed over. Errors (input): it violates the format, is a kind without points, has
/// fewer numbers than it announces, or a number that is not finite; with the line, of binary parts
/// that of the text before them. Cost: linear in the bytes, whatever counts they announce.
[[nodiscard]] Expected<PointFields> read_vtk_legacy(std::string_view bytes, std::string_view file);

/// The same of an XML file of VTK (VTU and VTP): ASCII, base64 within the element ("binary") or
/// appended, raw or in base64, in both byte orders, with UInt32 and UInt64 headers; several pieces
/// are joined. Errors (input): the same; compressed blocks, by the name of the compressor.
[[nodiscard]] Expected<PointFields> read_vtk_xml(std::string_view bytes, std::string_view file);

}  // namespace knead::fields
