#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/shared_list.hpp"
#include "knead/hold/seams.hpp"
#include "knead/session/session.hpp"
#include "scene/parted_edges.hpp"
#include "scene/scene.hpp"

namespace knead {

/// The record of a session so far.
struct SessionRecord {
  SharedList<StepRecord> steps;  ///< shared by the states of a history
  std::vector<SeamReport>
      seam_reports;         ///< of the model of the last step; patches are indices of surfaces
  std::vector<Note> notes;  ///< side effects of commands: refinements, lines kept smooth
  std::optional<double> energy_before;    ///< energy before the first step
  std::vector<ModeRecord> modes = {};     ///< of the last command `modes`, lowest first
  std::vector<ModeRecord> buckling = {};  ///< of the last command `buckling`, likewise
};

/// The whole state at one moment. A value: undo restores an earlier one, bit for bit.
struct SessionState : Scene, SessionRecord {
  /// With the surfaces converted so far; null: as opened.
  std::shared_ptr<const Document> document = {};
};

/// Number of control points that are not where they were opened, bit for bit.
[[nodiscard]] int moved_control_points(const SceneSurface& surface);
/// `parted_edges` of the faces of a document on surfaces that have moved.
[[nodiscard]] Expected<std::vector<PartedEdge>> parted_edges(const Document& document,
                                                             const SessionState& state);
/// What `Session::save` writes of such a state. Errors: an edge that is parted and was not freed
/// (numerical); those of `Document::save`.
[[nodiscard]] Expected<std::string> saved(const Document& document, const SessionState& state);
/// The same, read again. Errors: those of saving, and of opening that.
[[nodiscard]] Expected<std::shared_ptr<const Source>> saved_source(const Document& document,
                                                                   const SessionState& state);
/// What `Session::save` writes, read again. Errors: those of saving, and of opening that.
[[nodiscard]] Expected<std::shared_ptr<const Source>> saved_source(const Session& session);

}  // namespace knead
