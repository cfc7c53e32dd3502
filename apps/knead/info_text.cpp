#include "info_text.hpp"

#include <fmt/format.h>

#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "cli.hpp"
#include "knead/base/printable.hpp"

namespace knead::cli {
namespace {

constexpr std::size_t most_listed = 6;

template <class... T>
void add(std::string& text, fmt::format_string<T...> line, T&&... values) {
  fmt::format_to(std::back_inserter(text), line, std::forward<T>(values)...);
}

std::string title(const FilePart& part) {
  return part.name.empty() ? "without a name" : "\"" + printable(part.name) + "\"";
}

std::string first_of(const std::vector<std::string>& ids) {
  std::string result;
  for (std::size_t k = 0; k < ids.size() && k < most_listed; ++k)
    result += (k == 0 ? "" : ", ") + ids[k];
  if (ids.size() > most_listed) result += fmt::format(" and {} more", ids.size() - most_listed);
  return ids.empty() ? "none" : result;
}

void add_part(std::string& text, const FilePart& part) {
  add(text, "    {}: {}, B-spline surfaces: {}{}\n", title(part),
      counted(part.faces.size(), "face", "faces"), first_of(part.surfaces),
      part.curves.empty() ? "" : ", curves: " + first_of(part.curves));
  std::map<std::string, int> paths;
  for (const FilePlace& place : part.places) ++paths[place.path];
  std::size_t listed = 0;
  for (const auto& [path, count] : paths) {
    if (listed++ == most_listed) break;
    add(text, "      {} x {}\n", count, printable(path, 1000));
  }
  if (paths.size() > most_listed)
    add(text, "      and {} other paths (--json lists them)\n", paths.size() - most_listed);
}

/// The parts of an assembly and where they stand; nothing of a file whose coordinates are the
/// model's.
void add_parts(std::string& text, const FileInfo& info) {
  if (info.instances.empty()) return;
  const FileAssembly& assembly = *info.assembly;
  if (!assembly.reason.empty()) {
    add(text, "  the assembly cannot be followed: {}\n", assembly.reason);
    return;
  }
  std::size_t places = 0;
  for (const FilePart& part : *assembly.parts) places += part.places.size();
  add(text,
      "  assembly, in {}: {} with geometry in {} (--json lists their placements); the file has "
      "each part once,\n"
      "  so that a change shows in all its places\n",
      assembly.unit, counted(assembly.parts->size(), "part", "parts"),
      counted(places, "place", "places"));
  for (const FilePart& part : *assembly.parts) add_part(text, part);
  for (const std::string& warning : *assembly.warnings) add(text, "  warning: {}\n", warning);
}

/// "\"name\", " where there is one.
std::string titled(const std::string& name) {
  return name.empty() ? "" : "\"" + printable(name) + "\", ";
}

std::string in_words(bool rational) { return rational ? "rational" : "polynomial"; }

}  // namespace

std::string info_text(const FileInfo& info) {
  std::string text;
  add(text, "{}: {}{}, units {}, {}\n", info.file, info.format,
      info.schema.empty() ? "" : " " + printable(info.schema), info.units,
      counted(info.surfaces.size(), "B-spline surface", "B-spline surfaces"));
  for (const FileSurface& s : info.surfaces) {
    const auto& [lower, upper] = s.bounding_box;
    add(text, "  {:<8} {}degree {} x {}, net {} x {}, {}{}{}{}\n", s.id, titled(s.name),
        s.degree[0], s.degree[1], s.net[0], s.net[1], in_words(s.rational),
        s.closed[0] ? ", closed in u" : "", s.closed[1] ? ", closed in v" : "",
        s.trimmed ? ", trimmed" : "");
    add(text, "           from ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})\n", lower[0],
        lower[1], lower[2], upper[0], upper[1], upper[2]);
  }
  for (const FileCurve& c : info.curves) {
    add(text, "  {:<8} {}curve of degree {}, {}, {}\n", c.id, titled(c.name), c.degree,
        counted(static_cast<std::size_t>(c.control_points), "control point", "control points"),
        in_words(c.rational));
  }
  for (const FileTessellation& t : info.tessellated_items) {
    add(text, "  {:<8} {}tessellated, {}\n", t.id, titled(t.name),
        counted(static_cast<std::size_t>(t.triangles), "triangle", "triangles"));
  }
  std::map<std::string, int> others;
  for (const FileOtherSurface& s : info.other_surfaces) ++others[s.form];
  if (!others.empty()) {
    std::string counts;
    for (const auto& [form, count] : others)
      counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, form);
    add(text,
        "  other surfaces, to be converted before they are sculpted (--faces lists them): {}\n",
        counts);
  }
  if (!info.left_out.empty()) add(text, "  left out:\n");
  for (const FileLeftOut& left : info.left_out) add(text, "    {}\n", left.sentence);
  add_parts(text, info);
  for (const std::string& remark : info.remarks) add(text, "  {}\n", printable(remark, 2000));
  return text;
}

}  // namespace knead::cli
