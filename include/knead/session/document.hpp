#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "knead/brep/model.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/source.hpp"

namespace knead {

/// A surface of a document as opened.
using DocumentSurface = SourceSurface;

/// A curve or a volume of a session, which stands for itself.
struct DocumentBody {
  std::string id, name, unit;
  std::variant<std::shared_ptr<const Curve>, std::shared_ptr<const Volume>> shape;
};

/// What a session works on: an opened file, in any format that stores surfaces, or none yet.
/// Immutable; copies share the data.
class Document {
 public:
  /// Errors (input): the file cannot be read, its format is unknown, or it violates its format.
  [[nodiscard]] static Expected<Document> open(const std::filesystem::path& path,
                                               const OpenOptions& options = {});
  [[nodiscard]] static Document from(std::shared_ptr<const Source> source);
  /// Without a file: surfaces are made by commands, and saving writes a new one.
  [[nodiscard]] static Document fresh(std::string name, std::string unit = "mm");

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] bool is_fresh() const { return !source_; }
  /// Length unit of a fresh document, unless the first surface made in it has another.
  [[nodiscard]] const std::string& unit() const { return unit_; }
  [[nodiscard]] const std::vector<DocumentSurface>& surfaces() const;
  /// The curves of the file that stand for themselves.
  [[nodiscard]] const std::vector<SourceCurve>& curves() const;
  /// The opened file; null in a fresh document.
  [[nodiscard]] const Source* source() const { return source_.get(); }
  /// The same as a STEP file, for what only STEP has: faces and their trimming. Null for other
  /// formats.
  [[nodiscard]] const brep::Model* model() const {
    return source_ ? source_->model().get() : nullptr;
  }

  /// The document with surfaces of other forms, given by their ids or those of faces on them, as
  /// B-spline surfaces, as by `Source::with_splines`. Errors: those; there is no file (input).
  [[nodiscard]] Expected<Document> with_splines(std::span<const std::string> surfaces) const;
  /// What has been converted since it was opened, in order.
  [[nodiscard]] const std::vector<std::string>& converted() const { return converted_; }

  /// The bytes of the file with these surfaces in place of the original ones (one each), and with
  /// those of the bodies that are its `curves`; for a fresh document, a STEP file with exactly
  /// these surfaces, in the unit of the first one, and with these curves and volumes. `followed`:
  /// as for `Source::save`.
  [[nodiscard]] Expected<std::string> save(std::span<const DocumentSurface> surfaces,
                                           std::span<const std::string> followed = {},
                                           std::span<const DocumentBody> bodies = {}) const;
  /// The bytes of a new file with these surfaces, whole, the curves, and the six sides of each
  /// volume as surfaces. Errors (input): the format cannot be written, or holds no curves; the
  /// opened file has faces, which a new one would lose; a volume whose ends are not clamped. `how`:
  /// schema and faces; what else it has comes from the document.
  [[nodiscard]] Expected<std::string> save_as(const Format& format,
                                              std::span<const DocumentSurface> surfaces,
                                              std::span<const DocumentBody> bodies = {},
                                              SaveOptions how = {}) const;

 private:
  Document() = default;

  std::string name_, unit_;
  std::shared_ptr<const Source> source_;
  std::vector<std::string> converted_;
};

}  // namespace knead
