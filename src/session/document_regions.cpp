#include "knead/session/document_regions.hpp"

#include <algorithm>

namespace knead {

Expected<VisibleRegion> DocumentRegions::of(const std::string& surface) {
  const step::File* const file = document_->step_file();
  if (file != nullptr && file->find_surface(surface) != nullptr) {
    if (!faces_) faces_ = std::make_unique<const VisibleRegions>(*file);
    return faces_->of(surface);
  }
  const auto& surfaces = document_->surfaces();
  const auto found = std::ranges::find(surfaces, surface, &DocumentSurface::id);
  return found == surfaces.end() ? VisibleRegion{} : region_of_sides(*found->surface);
}

}  // namespace knead
