#include "knead/exchange/format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "compressed_source.hpp"
#include "exchange/meshes/surface_mesh.hpp"
#include "foreign_format.hpp"
#include "format_list.hpp"
#include "knead/exchange/file_io.hpp"

namespace knead {
namespace {

bool has_ending(const Format& format, std::string_view file_name) {
  const auto dot = file_name.rfind('.');
  std::string ending(dot == std::string_view::npos ? "" : file_name.substr(dot));
  for (char& c : ending) c = 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return std::ranges::find(format.endings, ending) != format.endings.end();
}

/// "a, b or c".
std::string alternatives(const std::vector<std::string>& items) {
  std::string text;
  for (std::size_t k = 0; k < items.size(); ++k) {
    text += (k == 0 ? "" : k + 1 == items.size() ? " or " : ", ") + items[k];
  }
  return text;
}

/// "STEP (.step, .stp, .p21)".
std::string with_endings(const Format& format) {
  std::string text = std::string(format.name) + " (";
  for (std::size_t k = 0; k < format.endings.size(); ++k) {
    text += (k == 0 ? "" : ", ") + std::string(format.endings[k]);
  }
  return text + ")";
}

}  // namespace

std::span<const Format> formats() {
  static const std::vector<Format> all = [] {
    std::vector<Format> made;
    for (const auto make : detail::format_list) made.push_back(make());
    return made;
  }();
  return all;
}

const Format* find_format(std::string_view id) {
  const auto found = std::ranges::find(formats(), id, &Format::id);
  return found == formats().end() ? nullptr : &*found;
}

std::string list_of_endings(FormatContent content, bool opened) {
  std::vector<std::string> endings;
  for (const Format& format : formats()) {
    if (format.content != content || (opened && format.open == nullptr)) continue;
    endings.insert(endings.end(), format.endings.begin(), format.endings.end());
  }
  return alternatives(endings);
}

Expected<const Format*> format_of_name(std::string_view file_name, FormatContent content) {
  const std::string plain =
      content == FormatContent::surfaces ? uncompressed_name(file_name) : std::string(file_name);
  for (const Format& format : formats()) {
    if (format.content == content && has_ending(format, plain)) return &format;
  }
  return input_error(fmt::format("\"{}\" is not a {} file", file_name,
                                 content == FormatContent::triangles ? "mesh" : "CAD"),
                     {}, "use a name that ends in " + list_of_endings(content));
}

std::unexpected<Error> detail::nothing_to_write() {
  return input_error(
      "there is no surface to write", {},
      "make one with the command `new`, or begin with a file that has B-spline surfaces");
}

const std::vector<SourceCurve>& Source::curves() const {
  static const std::vector<SourceCurve> none;
  return none;
}

Expected<void> Source::can_move_edge(const std::string& id) const {
  return input_error("only edges of faces can follow", id);
}

Expected<std::shared_ptr<const Source>> Source::with_splines(
    std::span<const std::string> /*surfaces*/) const {
  return input_error("only faces of STEP and IGES files can be converted", name());
}

Expected<std::shared_ptr<const Source>> open_source(std::string bytes, std::string name,
                                                    const OpenOptions& options) {
  if (compression_of(bytes) != Compression::none) {
    return detail::open_compressed(std::move(bytes), std::move(name), options);
  }
  const Format* chosen = nullptr;
  std::vector<std::string> known;
  for (const Format& format : formats()) {
    if (format.open == nullptr) continue;
    known.push_back(with_endings(format));
    if (chosen == nullptr && format.recognises(bytes)) chosen = &format;
  }
  for (const Format& format : formats()) {
    if (chosen == nullptr && format.open != nullptr && has_ending(format, uncompressed_name(name)))
      chosen = &format;
  }
  if (chosen != nullptr) return chosen->open(std::move(bytes), std::move(name));
  Error error = detail::foreign_format(bytes).value_or(Error{
      ErrorKind::input, "the format of this file is not known", {}, "open " + alternatives(known)});
  error.file = std::move(name);
  return std::unexpected(std::move(error));
}

std::string format_table() {
  std::string text =
      "| format | endings | opened | written | a file holds |\n|---|---|---|---|---|\n";
  for (const Format& format : formats()) {
    std::string endings;
    for (const std::string_view ending : format.endings)
      endings += (endings.empty() ? "`" : ", `") + std::string(ending) + "`";
    text += fmt::format(
        "| {} | {} | {} | {} | {} |\n", format.name, endings, format.open != nullptr ? "yes" : "no",
        format.save != nullptr || format.save_meshes != nullptr ? "yes" : "no", format.holds);
  }
  return text;
}

std::string format_json() {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Format& format : formats()) {
    list.push_back(
        {{"id", format.id},
         {"name", format.name},
         {"endings", std::vector<std::string>(format.endings.begin(), format.endings.end())},
         {"media_type", format.media_type},
         {"content", format.content == FormatContent::surfaces ? "surfaces" : "triangles"},
         {"holds", format.holds},
         {"opens", format.open != nullptr}});
  }
  return list.dump();
}

Expected<std::string> save_surfaces(std::span<const NamedSurface> surfaces, const Format& format,
                                    const SaveOptions& options) {
  if (!options.curves.empty() && !format.writes_curves) {
    return input_error(fmt::format("curves are not written to {}", format.name), {}, "write STEP");
  }
  if (format.save != nullptr) return format.save(surfaces, options);
  const auto meshes = detail::meshes_of(surfaces, options);
  if (!meshes) return std::unexpected(meshes.error());
  return save_meshes(*meshes, format, options);
}

Expected<std::string> save_meshes(std::span<const NamedMesh> meshes, const Format& format,
                                  const SaveOptions& options) {
  if (format.save_meshes == nullptr) {
    return input_error(fmt::format("{} does not hold triangles", format.name), {},
                       "use " + list_of_endings(FormatContent::triangles));
  }
  std::size_t count = 0;
  for (const NamedMesh& mesh : meshes) {
    count += std::max(mesh.triangles.size(), static_cast<std::size_t>(mesh.points.rows()));
  }
  if (count > std::numeric_limits<std::int32_t>::max()) {
    return input_error("the mesh has more than 2^31 triangles", "detail", "use a smaller one");
  }
  return format.save_meshes(meshes, options);
}

}  // namespace knead
