#include "knead/session/document.hpp"

#include <fmt/format.h>

namespace knead {

Document Document::from(StepFile file) {
  auto surfaces = std::make_shared<std::vector<DocumentSurface>>();
  for (const StepSurface& s : file.surfaces()) {
    surfaces->push_back({s.id, s.name, s.unit, std::make_shared<const Surface>(s.surface)});
  }
  return Document(std::move(file), std::move(surfaces));
}

Expected<Document> Document::open(const std::filesystem::path& path) {
  auto file = StepFile::read(path);
  if (!file) return std::unexpected(file.error());
  return from(std::move(*file));
}

Expected<int> Document::find_surface(const std::string& id) const {
  constexpr std::size_t listed = 12;
  std::string known;
  for (std::size_t k = 0; k < surfaces_->size(); ++k) {
    if ((*surfaces_)[k].id == id) return static_cast<int>(k);
    if (k < listed) known += (k == 0 ? "" : ", ") + (*surfaces_)[k].id;
  }
  for (const StepUnreadableSurface& s : file_.unreadable_surfaces()) {
    if (s.id == id) return std::unexpected(s.reason);
  }
  if (surfaces_->size() > listed) known += ", …";
  return input_error(
      fmt::format("{} has no surface {}", name(), id), "surface",
      known.empty() ? "the file has no B-spline surface that could be sculpted" : "its surfaces are: " + known);
}

Expected<std::string> Document::save(std::span<const std::shared_ptr<const Surface>> surfaces) const {
  std::vector<StepEdit> edits;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    const DocumentSurface& original = (*surfaces_)[k];
    if (surfaces[k] != original.surface) edits.push_back({original.id, surfaces[k]->control_points()});
  }
  return file_.with_control_points(edits);
}

}  // namespace knead
