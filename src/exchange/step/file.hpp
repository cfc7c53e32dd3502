#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "brep/moved_edge.hpp"
#include "knead/base/error.hpp"
#include "knead/brep/model.hpp"
#include "knead/spline/spline.hpp"

namespace knead::step {

/// New control points of one surface, in the order of `Surface::control_points`.
struct Edit {
  std::string id;  ///< "#123"
  Points control_points;
};

/// Another curve in place of a free one.
struct CurveReplacement {
  std::string id;  ///< "#123"
  Curve curve;
};

/// A STEP file (ISO 10303-21 exchange structure) whose records remember their bytes, and the model
/// that it holds.
///
/// Reading keeps all bytes. Writing is surgical: only what must differ does (docs/step.md).
/// Immutable; copies share the data; const access is thread-safe. Cost of reading: linear in the
/// size of the file.
class File {
 public:
  /// Reads and parses a file. Errors (input): it cannot be read; it is not an exchange structure
  /// (with line and entity).
  [[nodiscard]] static Expected<File> read(const std::filesystem::path& path);
  /// Parses bytes; `name` stands for the file in errors.
  [[nodiscard]] static Expected<File> parse(std::string bytes, std::string name);

  [[nodiscard]] const std::string& name() const;
  /// The input, byte for byte.
  [[nodiscard]] const std::string& bytes() const;
  /// The first FILE_SCHEMA name, as in "AUTOMOTIVE_DESIGN"; empty if the header has none.
  [[nodiscard]] const std::string& schema() const;

  /// What it holds.
  [[nodiscard]] const brep::Model& model() const;
  /// The same, which may outlive the file.
  [[nodiscard]] std::shared_ptr<const brep::Model> shared_model() const;
  [[nodiscard]] const std::vector<brep::SplineSurface>& surfaces() const {
    return model().surfaces;
  }
  /// Whether this is a B-spline curve that is not free.
  [[nodiscard]] bool is_bound_curve(const std::string& id) const;
  /// What is wrong with the file outside of its surfaces: references to names that it does not
  /// define, the first ten of them and the number of the others. What such a record describes is
  /// left out, and kept as it is when written.
  [[nodiscard]] std::vector<Error> warnings() const;
  /// The bytes of this file with the control points of some surfaces replaced and every other byte
  /// as it was.
  ///
  /// A coordinate is rewritten, to 17 significant digits, only if its bits change. A point also
  /// referenced outside this surface keeps its record and the surface refers to a new one;
  /// references shared within the surface are split only if their positions come to differ. The
  /// result is parsed again and compared bit for bit before it is returned. No edits, or edits that
  /// change nothing, give the input bytes. Errors: unknown or repeated id, wrong number of control
  /// points, a coordinate that is not finite (input); the self-check fails (numerical).
  [[nodiscard]] Expected<std::string> with_control_points(std::span<const Edit> edits) const;

  /// The bytes of this file with whole surfaces replaced, including nets, degrees, knots and
  /// weights, and every other byte as it was.
  ///
  /// Where only control points differ this is `with_control_points`. Otherwise what differs in the
  /// surface's record is rewritten: degrees, the list of control points, weights, and the knots of
  /// a direction; forms with implied knots become B_SPLINE_SURFACE_WITH_KNOTS unless the new knots
  /// are implied as well; a surface that gains weights becomes a complex instance with
  /// RATIONAL_B_SPLINE_SURFACE. Name, surface form and the flags for closed and self-intersecting
  /// stay. Control points equal to one of the old net keep its record; others take over records
  /// that only this surface used and no longer needs, or get new ones (docs/step.md). The parameter
  /// domain should stay the same, since trimming curves are defined on it; this is not checked.
  /// Errors: unknown or repeated id; no weights where the file has some; a knot inside the domain
  /// repeated more often than the degree (input); the self-check fails (numerical).
  ///
  /// `moved`: the curve of an edge becomes a new B_SPLINE_CURVE_WITH_KNOTS, RATIONAL_B_SPLINE_CURVE
  /// if it has weights. A SURFACE_CURVE (or subtype) stays, with its PCURVEs, and refers to the new
  /// curve: in place if only this edge uses it, else as a copy under a new name. The old curve's
  /// records stay. The point of a vertex is treated as a control point is. Further errors (input):
  /// an edge or vertex that is not in the file.
  ///
  /// `curves`: of a free curve on the same net only moved coordinates differ; with another net its
  /// record is written anew under its name and label. Further errors (input): a curve that is not
  /// free, or torn along a knot.
  [[nodiscard]] Expected<std::string> with_surfaces(
      std::span<const brep::Replacement> replacements, const brep::MovedEdges& moved = {},
      std::span<const CurveReplacement> curves = {}) const;

  struct Data;  ///< private to the exchange room
  [[nodiscard]] const Data& data() const { return *data_; }

 private:
  explicit File(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

}  // namespace knead::step
