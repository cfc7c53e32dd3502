#pragma once

#include <optional>

#include "motion_law.hpp"
#include "scene/model/met_conditions.hpp"
#include "scene/model/model.hpp"
#include "session/document_regions.hpp"
#include "session/gestures/brush_run.hpp"
#include "session/gestures/stroke_model.hpp"
#include "session/session_state.hpp"
#include "through_walls.hpp"

namespace knead {

/// What acts remember for those after them: without it they give the same bits, later.
struct ActCache {
  Models models;                      ///< of steps
  std::optional<StrokeModel> stroke;  ///< that strokes and brushes press
  std::optional<BrushRun> brush;
  MetConditions conditions;  ///< those there are, as of the last check
  KnownFaces faces;          ///< of the document
};

/// One command as it is carried out, on a copy of the state that takes effect only if no error is
/// returned. Each command's file defines `execute` for its fields; what commands share are
/// functions of an act, in headers by subject.
struct Act {
  const Document& document;
  SessionState& state;  ///< with the steps and notes so far
  ActCache& cache;
  const Session::Progress& progress;
  DocumentRegions regions = DocumentRegions(document);
  MotionLaw law = {};                   ///< what the command has asked for so far
  FaceMeeting meeting = FaceMeeting();  ///< with other faces
  /// It has measured itself at which edges faces meet, and as smoothly as before.
  bool edges_measured = false;
  std::optional<int> steps_kept = {};  ///< it was stopped after so many steps, which stay
};

}  // namespace knead
