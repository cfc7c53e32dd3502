#include "knead/exchange/numerical_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace knead {
namespace {

/// All fields of all grids by their names, in the order of their first appearance.
std::vector<std::pair<std::string, int>> fields_of(std::span<const FieldGrid> grids) {
  std::vector<std::pair<std::string, int>> fields;
  for (const FieldGrid& grid : grids) {
    for (const GridField& field : grid.fields) {
      const std::pair known(field.name, field.components);
      if (std::ranges::find(fields, known) == fields.end()) fields.push_back(known);
    }
  }
  return fields;
}

std::string data_array(const std::string& type, const std::string& name, int components,
                       const std::string& values) {
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" "
      "format=\"ascii\">\n{}</DataArray>\n",
      type, name, components, values);
}

void append_number(std::string& text, double value) {
  fmt::format_to(std::back_inserter(text), "{:.9g} ", std::isfinite(value) ? value : 0.0);
}

std::string values_of(std::span<const FieldGrid> grids, const std::string& name, int components) {
  std::string text;
  for (const FieldGrid& grid : grids) {
    const auto field = std::ranges::find_if(grid.fields, [&](const GridField& f) {
      return f.name == name && f.components == components;
    });
    const auto count = static_cast<std::size_t>(grid.points.rows() * components);
    for (std::size_t k = 0; k < count; ++k)
      append_number(text, field == grid.fields.end() ? 0 : field->values[k]);
    text += "\n";
  }
  return text;
}

}  // namespace

std::string vtu_text(std::span<const FieldGrid> grids) {
  std::string points, cells, ends, types;
  Eigen::Index first = 0, count = 0;
  for (const FieldGrid& grid : grids) {
    for (Eigen::Index k = 0; k < grid.points.rows(); ++k) {
      for (int c = 0; c < 3; ++c) append_number(points, grid.points(k, c));
      points += "\n";
    }
    const auto [m, n] = grid.counts;
    for (int i = 0; i + 1 < m; ++i) {
      for (int j = 0; j + 1 < n; ++j, ++count) {
        const Eigen::Index a = first + i * n + j;
        cells += fmt::format("{} {} {} {}\n", a, a + n, a + n + 1, a + 1);
        ends += fmt::format("{}\n", 4 * (count + 1));
        types += "9\n";
      }
    }
    first += grid.points.rows();
  }
  std::string fields;
  for (const auto& [name, components] : fields_of(grids)) {
    fields += data_array("Float64", name, components, values_of(grids, name, components));
  }
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n"
      "<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n"
      "<Points>\n{}</Points>\n<Cells>\n{}{}{}</Cells>\n<PointData>\n{}</PointData>\n"
      "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n",
      first, count, data_array("Float64", "points", 3, points),
      data_array("Int64", "connectivity", 1, cells), data_array("Int64", "offsets", 1, ends),
      data_array("UInt8", "types", 1, types), fields);
}

}  // namespace knead
