#pragma once

#include <optional>

#include "session/session_state.hpp"
#include "studio_picture.hpp"
#include "studio_trims.hpp"

namespace knead::studio {

/// What the page's queries are about.
struct Studio {
  std::optional<Session> session;
  Point origin = Point::Zero();  ///< of pictures, file units
  PictureMaker pictures;
  ShownParts shown;
  Session::Progress progress;     ///< of the command under way
  Session::GoOn go_on;            ///< asked within its steps
  std::size_t file_surfaces = 0;  ///< of the document as it was opened
};

/// The error (usage) of what needs a session.
[[nodiscard]] inline std::unexpected<Error> nothing_open() {
  return usage_error("nothing is open", {}, "open a file or start a fresh document");
}

[[nodiscard]] inline bool has_surface(const Session& session, int surface) {
  return surface >= 0 && surface < static_cast<int>(session.state().surfaces.size());
}

/// A surface of the session by its number. Errors (usage): there is none.
[[nodiscard]] inline Expected<const SceneSurface*> surface_of(const Session& session, int surface) {
  if (!has_surface(session, surface)) return usage_error("there is no such surface");
  return &session.state().surfaces[static_cast<std::size_t>(surface)];
}

/// What the faces of the open file show of a surface, once its trims have been asked for.
[[nodiscard]] inline std::shared_ptr<const VisibleRegion> visible_part(const Studio& studio,
                                                                       int surface) {
  return studio.shown.visible(studio.session->document(), place_in_file(*studio.session, surface));
}

}  // namespace knead::studio
