#pragma once

#include "knead/exchange/save_faces.hpp"
#include "knead/session/session.hpp"

namespace knead {

/// The faces of a session's document as they are now, as a new file of another format: what `Session::save` writes,
/// with the edges that follow where they have moved, read again. Lengths of a file without a unit are those of
/// `options`. Errors: those of `Session::save` and of `save_faces` of that file.
[[nodiscard]] Expected<FacesFile> save_faces(const Session& session, const Format& format,
                                             const SaveOptions& options = {}, bool convert = false);

}  // namespace knead
