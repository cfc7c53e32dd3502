#include "document_regions.hpp"

#include <algorithm>

namespace knead {

Expected<VisibleRegion> DocumentRegions::of(const std::string& surface) {
  const auto model = document_->source() == nullptr ? nullptr : document_->source()->model();
  if (model != nullptr && model->find_surface(surface) != nullptr) {
    if (!faces_) faces_ = std::make_unique<const VisibleRegions>(model);
    return faces_->of(surface);
  }
  const auto& surfaces = document_->surfaces();
  const auto found = std::ranges::find(surfaces, surface, &DocumentSurface::id);
  return found == surfaces.end() ? VisibleRegion{} : region_of_sides(*found->surface);
}

}  // namespace knead
