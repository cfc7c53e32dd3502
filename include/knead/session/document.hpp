#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "knead/exchange/step_file.hpp"

namespace knead {

/// A surface of a document as it was opened.
struct DocumentSurface {
  std::string id;    ///< "#123"
  std::string name;  ///< label in the file
  std::string unit;  ///< length unit
  std::shared_ptr<const Surface> surface;
};

/// A CAD file that was opened: its surfaces, and the means to write it back. Immutable; copies share the data.
class Document {
 public:
  [[nodiscard]] static Expected<Document> open(const std::filesystem::path& path);
  [[nodiscard]] static Document from(StepFile file);

  [[nodiscard]] const std::string& name() const { return file_.name(); }
  [[nodiscard]] const std::vector<DocumentSurface>& surfaces() const { return *surfaces_; }
  [[nodiscard]] const StepFile& file() const { return file_; }

  /// Index of the surface with this id; the error says which ids there are.
  [[nodiscard]] Expected<int> find_surface(const std::string& id) const;

  /// The bytes of the file with these control points (one entry per surface) in place of the original ones.
  [[nodiscard]] Expected<std::string> save(std::span<const std::shared_ptr<const Surface>> surfaces) const;

 private:
  Document(StepFile file, std::shared_ptr<const std::vector<DocumentSurface>> surfaces)
      : file_(std::move(file)), surfaces_(std::move(surfaces)) {}

  StepFile file_;
  std::shared_ptr<const std::vector<DocumentSurface>> surfaces_;
};

}  // namespace knead
