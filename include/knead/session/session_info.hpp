#pragma once

#include <string>

#include "knead/session/session.hpp"

namespace knead {

class TypeScript;

// What a page shows of a session, as JSON. The page's TypeScript types are generated from the same
// descriptions.

/// Surfaces, tools, settings, notes, the last step; no control points (docs/studio.md).
[[nodiscard]] std::string session_json(const Session& session);

/// The steps from index `first` on, [{energy, stretch, …}, …].
[[nodiscard]] std::string steps_json(const Session& session, std::size_t first);

/// How large a tool the visible part of a surface has room for: the distance of its visible middle
/// from the nearest edge of a face, file units. "null" if no edges of faces are known. Cost: that
/// of `visible_middle`.
[[nodiscard]] std::string edge_distance_json(const Session& session, std::size_t surface);

/// What is measured at a point of a surface, in fractions of its domain: {name, surface, at, point,
/// displacement, normal, curvature}, as by `read_probe`. Errors: a point outside the domain
/// (input).
[[nodiscard]] Expected<std::string> reading_json(const Session& session, int surface,
                                                 const std::array<double, 2>& at);

/// The same of a face that lies on no surface of the session, at the point of it that is nearest
/// (`point_on_face`): `surface` is -1. Errors: those of `point_on_face`; a document without a file
/// of faces (input).
[[nodiscard]] Expected<std::string> face_reading_json(const Session& session,
                                                      const std::string& face, const Point& near);

/// {"error": {kind, what, where, remedy, message, code, values, fixes}}: docs/errors.md.
[[nodiscard]] std::string error_json(const Error& error);

/// {text, code, values, fixes}.
[[nodiscard]] std::string note_json(const Note& note);

/// A TypeScript module with the types of all these and of all commands (`AnyCommand`), and with
/// what `more` declares.
[[nodiscard]] std::string session_typescript(void (*more)(TypeScript&) = nullptr);

}  // namespace knead
