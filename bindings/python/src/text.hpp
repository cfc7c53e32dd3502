#pragma once

#include <string>

#include "knead/session/session.hpp"

namespace knead::python {

/// What `knead info` says of a file, with the shapes of the session as they are now. \param source
/// null: without a file
[[nodiscard]] std::string text_of(const Session& session, const Source* source);

}  // namespace knead::python
