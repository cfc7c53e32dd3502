#pragma once

#include <filesystem>
#include <memory>
#include <optional>
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
  [[nodiscard]] static Document from(step::File file);
  /// Without a file: surfaces are made by commands, and saving writes a new one.
  [[nodiscard]] static Document fresh(std::string name, std::string unit = "mm");

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] bool is_fresh() const { return !file_; }
  /// Length unit of a fresh document, unless the first surface made in it says another one.
  [[nodiscard]] const std::string& unit() const { return unit_; }
  [[nodiscard]] const std::vector<DocumentSurface>& surfaces() const { return *surfaces_; }
  /// Only where there is a file.
  [[nodiscard]] const step::File& file() const { return *file_; }

  /// The bytes of the file with these surfaces in place of the original ones (one each); of a fresh document, a file
  /// with exactly these, in the unit of the first one.
  [[nodiscard]] Expected<std::string> save(std::span<const DocumentSurface> surfaces) const;

 private:
  Document() = default;

  std::string name_, unit_;
  std::optional<step::File> file_;
  std::shared_ptr<const std::vector<DocumentSurface>> surfaces_;
};

}  // namespace knead
