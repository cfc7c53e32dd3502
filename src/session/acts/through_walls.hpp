#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>

#include "session/session_state.hpp"

namespace knead {

struct Act;
class ModelWalls;

/// What happens where a surface comes to another face of its model: it is noted, allowed, or as far
/// as it goes.
enum class Through { note, allow, stop };

/// What is known of faces beyond the states: undone, rehearsed or not.
struct KnownFaces {
  std::shared_ptr<const Document> document = {};  ///< as in `SessionState`
  std::map<std::string, std::shared_ptr<const VisibleRegion>> visible = {};  ///< by surface
  std::shared_ptr<ModelWalls> walls = {};  ///< null until a surface has moved
};

/// How a command meets the other faces of its model: what moved is compared with them at its end,
/// or, where it may stop there, after each of its steps, so that equal steps that are one command
/// end as as many commands would.
///
/// What comes within the larger of the uncertainty of the file and 1e-6 of the size of the model
/// (`ModelWalls::first_contact`) is noted, with the place and how far it had come there, or made
/// smaller alike, so that twice that distance is left.
class FaceMeeting {
 public:
  explicit FaceMeeting(Through through = Through::note) : through_(through) {}

  /// After a step from these shapes of the surfaces of the scene.
  [[nodiscard]] Expected<void> after_step(Act& act,
                                          std::span<const std::shared_ptr<const Surface>> before);
  /// At the end of a command that began with the surfaces of `before`; what an open gesture has
  /// moved counts whole.
  [[nodiscard]] Expected<void> at_end(Act& act, const Scene& before);
  /// Whether something was made smaller.
  [[nodiscard]] bool stopped() const { return stopped_; }

 private:
  Expected<void> meet(Act& act, std::span<const std::shared_ptr<const Surface>> before);

  Through through_;
  bool stopped_ = false;
  bool each_step_ = false;  // nothing is left to be compared at the end
};

}  // namespace knead
