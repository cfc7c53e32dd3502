#pragma once

#include <memory>
#include <string>

#include "knead/base/error.hpp"

namespace knead {

/// What a command did besides what it was asked for: a text for people, and what a program reads of it, null if nothing
/// but the text is known. Notes with the same text are the same; snapshots keep both.
struct Note : std::string {
  std::shared_ptr<const Diagnostic> diagnostic;

  Note() = default;
  Note(std::string text) : std::string(std::move(text)) {}  // NOLINT: a text is a note
  Note(std::string text, Diagnostic read) : std::string(std::move(text)) {
    if (read.code != ErrorCode{}) diagnostic = std::make_shared<const Diagnostic>(std::move(read));
  }
};

}  // namespace knead
