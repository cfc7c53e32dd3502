#include "displacements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "knead/base/printable.hpp"
#include "line_reader.hpp"
#include "mesh_points.hpp"
#include "point_fields.hpp"

namespace knead::fields {
namespace {

std::string_view without_comment(std::string_view line) {
  return trimmed(line.substr(0, line.find('#')));
}

/// How the cells of a table are separated.
char separator_of(std::string_view header) {
  for (const char c : {';', ','}) {
    if (header.find(c) != header.npos) return c;
  }
  return ' ';
}

std::vector<std::string_view> cells_of(std::string_view line, char separator) {
  if (separator == ' ') return words_of(line);
  std::vector<std::string_view> cells;
  for (;;) {
    const auto stop = line.find(separator);
    auto cell = trimmed(line.substr(0, stop));
    if (cell.size() > 1 && cell.front() == '"' && cell.back() == '"')
      cell = trimmed(cell.substr(1, cell.size() - 2));
    cells.push_back(cell);
    if (stop == line.npos) return cells;
    line.remove_prefix(stop + 1);
  }
}

using Six = std::array<double, 6>;

void append(const Six& row, Displacements& result) {
  result.points.emplace_back(row[0], row[1], row[2]);
  result.vectors.emplace_back(row[3], row[4], row[5]);
}

Expected<std::array<std::size_t, 6>> columns_in(const std::vector<std::string_view>& names,
                                                const std::array<std::string, 6>& wanted,
                                                std::string_view file, int line) {
  std::array<std::size_t, 6> result{};
  for (std::size_t k = 0; k < 6; ++k) {
    const auto found = std::ranges::find(names, std::string_view(wanted[k]));
    if (found == names.end()) {
      std::string list;
      for (const auto name : names) list += (list.empty() ? "" : ", ") + printable(name, 40);
      return data_error(file, line,
                        fmt::format("there is no column \"{}\"; the columns are {}",
                                    printable(wanted[k], 40), printable(list, 400)),
                        "name those of the point and of the displacement with --columns");
    }
    result[k] = static_cast<std::size_t>(found - names.begin());
  }
  return result;
}

Expected<Six> row_of(const std::vector<std::string_view>& cells,
                     const std::array<std::size_t, 6>& columns, std::string_view file, int line) {
  Six row{};
  for (std::size_t k = 0; k < 6; ++k) {
    if (columns[k] >= cells.size())
      return data_error(file, line,
                        fmt::format("there are {} columns, fewer than in the first "
                                    "line",
                                    cells.size()));
    const auto value = finite_number(cells[columns[k]], file, line);
    if (!value) return std::unexpected(value.error());
    row[k] = *value;
  }
  return row;
}

Expected<Displacements> read_table(std::string_view bytes, std::string_view file,
                                   const DisplacementColumns& which) {
  Displacements result;
  bool first = true, named = false;
  char separator = ' ';
  std::array<std::size_t, 6> columns = {0, 1, 2, 3, 4, 5};
  for (LineReader lines(bytes); lines.next();) {
    const auto text = without_comment(lines.line());
    if (text.empty()) continue;
    if (std::exchange(first, false)) {
      const auto words = words_of(text, ",;");
      double number = 0;
      named = std::ranges::any_of(words, [&](auto word) { return !is_number(word, number); });
      if (named) {
        separator = separator_of(text);
        const auto found =
            columns_in(cells_of(text, separator), which.columns, file, lines.number());
        if (!found) return std::unexpected(found.error());
        columns = *found;
        continue;
      }
    }
    const auto cells = named ? cells_of(text, separator) : words_of(text, ",;");
    if (!named && cells.size() != 6)
      return data_error(file, lines.number(), fmt::format("there are {} columns", cells.size()),
                        "write x y z dx dy dz on every line, or name the columns in the first");
    const auto row = row_of(cells, columns, file, lines.number());
    if (!row) return std::unexpected(row.error());
    append(*row, result);
  }
  if (result.points.empty()) return data_error(file, 0, "there are no displacements");
  return result;
}

std::string list_of(const PointFields& read) {
  std::string list;
  for (const auto& field : read.fields) {
    list += fmt::format("{}\"{}\"{}", list.empty() ? "" : ", ", printable(field.name, 60),
                        field.components == 3 ? "" : fmt::format(" of {}", field.components));
  }
  return list.empty() ? "there are none" : "there are " + list;
}

Expected<Displacements> field_of(Expected<PointFields> read, std::string_view file,
                                 const DisplacementColumns& which) {
  if (!read) return std::unexpected(std::move(read.error()));
  PointFields::Field* found = nullptr;
  int vectors = 0;
  for (auto& field : read->fields) {
    if (field.components != 3) continue;
    ++vectors;
    if (which.field.empty() || field.name == which.field) found = &field;
  }
  if (found == nullptr) {
    return data_error(file, 0,
                      which.field.empty()
                          ? fmt::format("no field of vectors at points; {}", list_of(*read))
                          : fmt::format("no field of vectors at points is called \"{}\"; {}",
                                        printable(which.field, 60), list_of(*read)),
                      which.field.empty() ? "" : "name one of three components with --field");
  }
  if (which.field.empty() && vectors > 1) {
    return data_error(
        file, 0, fmt::format("there are several fields of vectors: {}", list_of(*read).substr(10)),
        "name the displacement with --field");
  }
  return Displacements{std::move(read->points), std::move(found->vectors)};
}

// Corners of STL that agree in both files are one point. Where the second file has torn a point of
// the first, its places differ, and each is kept.
Displacements joined_pairs(const std::vector<Point>& from, const std::vector<Point>& to) {
  const auto key = [&](std::size_t k) {
    return Six{from[k][0], from[k][1], from[k][2], to[k][0], to[k][1], to[k][2]};
  };
  std::vector<std::size_t> order(from.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  std::vector<bool> again(from.size(), false);
  for (std::size_t k = 1; k < order.size(); ++k)
    again[order[k]] = key(order[k]) == key(order[k - 1]);
  Displacements result;
  for (std::size_t k = 0; k < from.size(); ++k) {
    if (again[k]) continue;
    result.points.push_back(from[k]);
    result.vectors.emplace_back(to[k] - from[k]);
  }
  return result;
}

}  // namespace

Expected<Displacements> read_displacements(std::string_view bytes, std::string_view file,
                                           const DisplacementColumns& which) {
  if (is_vtk_legacy(bytes)) return field_of(read_vtk_legacy(bytes, file), file, which);
  if (is_vtk_xml(bytes)) return field_of(read_vtk_xml(bytes, file), file, which);
  return read_table(bytes, file, which);
}

Expected<Displacements> mesh_pair(std::string_view from, std::string_view from_file,
                                  std::string_view to, std::string_view to_file) {
  auto first = read_mesh_points(from, from_file);
  if (!first) return std::unexpected(std::move(first.error()));
  auto second = read_mesh_points(to, to_file);
  if (!second) return std::unexpected(std::move(second.error()));
  const bool corners = first->format == "STL" && second->format == "STL";
  if (!corners) {
    for (auto* mesh : {&*first, &*second}) {
      if (mesh->format == "STL") *mesh = joined(std::move(*mesh));
    }
  }
  const auto count = first->points.size(), other = second->points.size();
  if (count != other) {
    const std::string what = corners ? "triangles" : "points";
    const std::size_t of_each = corners ? 3 : 1;
    return data_error(to_file, 0,
                      fmt::format("it has {} {} and {} has {}", other / of_each, what,
                                  printable(from_file), count / of_each),
                      "both must be the same mesh, with its points in the same order");
  }
  if (corners) return joined_pairs(first->points, second->points);
  Displacements result{std::move(first->points), {}};
  for (std::size_t k = 0; k < count; ++k)
    result.vectors.emplace_back(second->points[k] - result.points[k]);
  return result;
}

}  // namespace knead::fields
