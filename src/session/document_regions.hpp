#pragma once

#include <memory>
#include <string>

#include "knead/brep/face_edges.hpp"
#include "knead/session/document.hpp"

namespace knead {

/// What is visible of the surfaces of a document: what faces show of them, of surfaces without
/// faces all within their sides (`region_of_sides`). Surfaces that are not of the document, such as
/// those that commands have made, are visible everywhere and have no edges. `document` must outlive
/// it.
class DocumentRegions {
 public:
  explicit DocumentRegions(const Document& document) : document_(&document) {}

  /// Errors and cost: those of `VisibleRegions`, which are made once.
  [[nodiscard]] Expected<VisibleRegion> of(const std::string& surface);

 private:
  const Document* document_;
  std::unique_ptr<const VisibleRegions> faces_ = {};
};

}  // namespace knead
