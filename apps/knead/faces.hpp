#pragma once

#include "knead/exchange/file_info.hpp"
#include "knead/session/session.hpp"

namespace knead::cli {

/// A line for every surface with known edges of faces: how many are held, the present distance of
/// the surface from them, and what is free.
void print_edges(const Session& session);

/// For every surface on which faces lie: its visible part, its middle, and the edges with their
/// neighbours; then the surfaces of other forms, their faces, and whether they can be converted.
void print_faces(const FileInfo& info);

}  // namespace knead::cli
