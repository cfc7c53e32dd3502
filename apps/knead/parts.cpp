#include "parts.hpp"

#include <fmt/format.h>

#include <map>
#include <vector>

#include "cli.hpp"
#include "knead/base/printable.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

constexpr std::size_t most_listed = 6;

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

void print_part(const FilePart& part) {
  say("    {}: {}, B-spline surfaces: {}{}\n", title(part),
      counted(part.faces.size(), "face", "faces"), first_of(part.surfaces),
      part.curves.empty() ? "" : ", curves: " + first_of(part.curves));
  std::map<std::string, int> paths;
  for (const FilePlace& place : part.places) ++paths[place.path];
  std::size_t listed = 0;
  for (const auto& [path, count] : paths) {
    if (listed++ == most_listed) break;
    say("      {} x {}\n", count, printable(path, 1000));
  }
  if (paths.size() > most_listed)
    say("      and {} other paths (--json lists them)\n", paths.size() - most_listed);
}

}  // namespace

void print_parts(const FileInfo& info) {
  if (info.instances.empty()) return;
  const FileAssembly& assembly = *info.assembly;
  if (!assembly.reason.empty()) {
    say("  the assembly cannot be followed: {}\n", assembly.reason);
    return;
  }
  std::size_t places = 0;
  for (const FilePart& part : *assembly.parts) places += part.places.size();
  say("  assembly, in {}: {} with geometry in {} (--json lists their placements); the file has "
      "each part once,\n"
      "  so that a change shows in all its places\n",
      assembly.unit, counted(assembly.parts->size(), "part", "parts"),
      counted(places, "place", "places"));
  for (const FilePart& part : *assembly.parts) print_part(part);
  for (const std::string& warning : *assembly.warnings) say("  warning: {}\n", warning);
}

}  // namespace knead::cli
