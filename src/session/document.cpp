#include "knead/session/document.hpp"

#include "knead/exchange/step_text.hpp"

namespace knead {

Document Document::from(step::File file) {
  auto surfaces = std::make_shared<std::vector<DocumentSurface>>();
  for (const step::SurfaceEntity& s : file.surfaces()) {
    surfaces->push_back({s.id, s.name, s.unit, std::make_shared<const Surface>(s.surface)});
  }
  Document document;
  document.name_ = file.name();
  document.file_ = std::move(file);
  document.surfaces_ = std::move(surfaces);
  return document;
}

Document Document::fresh(std::string name, std::string unit) {
  Document document;
  document.name_ = std::move(name);
  document.unit_ = std::move(unit);
  document.surfaces_ = std::make_shared<const std::vector<DocumentSurface>>();
  return document;
}

Expected<Document> Document::open(const std::filesystem::path& path) {
  auto file = step::File::read(path);
  if (!file) return std::unexpected(file.error());
  return from(std::move(*file));
}

Expected<std::string> Document::save(std::span<const DocumentSurface> surfaces) const {
  if (!file_) {
    std::vector<step::NewSurface> made;
    for (const DocumentSurface& s : surfaces) made.push_back({s.name, *s.surface});
    step::TextOptions options;
    options.unit = surfaces.empty() ? unit_ : surfaces.front().unit;
    options.product = name_;
    return step::text_of(made, options);
  }
  std::vector<step::Replacement> replacements;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    const DocumentSurface& original = (*surfaces_)[k];
    if (surfaces[k].surface != original.surface) replacements.push_back({original.id, *surfaces[k].surface});
  }
  return file_->with_surfaces(replacements);
}

}  // namespace knead
