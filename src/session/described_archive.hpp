#pragma once

#include "archive.hpp"
#include "knead/base/describe.hpp"

namespace knead::archive {

/// Writes a described value: its parts in the order of the description, variants and choices as numbers, lists and
/// optionals preceded by their count. Opaque parts are shared surfaces.
void write(Writer& a, const Type& type, const void* value);

/// Reads what `write` wrote; makes the reader bad on invalid data.
void read(Reader& a, const Type& type, void* value);

}  // namespace knead::archive
