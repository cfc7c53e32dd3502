#include "studio_trims.hpp"

#include <algorithm>

#include "studio_context.hpp"

namespace knead::studio {

const std::vector<SurfaceTrim>& ShownParts::trims(const Document& document) {
  if (converted_ != document.converted()) forget();
  if (trims_) return trims_->surfaces;
  auto found = trim_loops(*document.model(), drawn_chord);
  trims_ = found ? *std::move(found) : TrimLoops();
  visible_ = shown_regions(trims_->surfaces);
  converted_ = document.converted();
  return trims_->surfaces;
}

std::shared_ptr<const VisibleRegion> ShownParts::visible(const Document& document,
                                                         std::size_t surface) const {
  if (converted_ != document.converted()) return nullptr;
  return surface < visible_.size() ? visible_[surface] : nullptr;
}

const std::shared_ptr<const Surroundings>& ShownParts::around(const Document& document) {
  if (document.model() == nullptr) {
    around_.reset();
    return around_;
  }
  trims(document);
  if (!around_) around_ = surroundings(*document.model(), visible_);
  return around_;
}

std::size_t place_in_file(const Session& session, int surface) {
  const auto& surfaces = session.state().surfaces;
  const auto& in_file = session.document().surfaces();
  if (surface < 0 || surface >= static_cast<int>(surfaces.size())) return in_file.size();
  const auto found = std::ranges::find(in_file, surfaces[static_cast<std::size_t>(surface)].id,
                                       &DocumentSurface::id);
  return static_cast<std::size_t>(found - in_file.begin());
}

}  // namespace knead::studio
