#pragma once

#include <string>

#include "knead/exchange/step_file.hpp"
#include "knead/session/session.hpp"

namespace knead::cli {

/// A line for every surface of which edges of faces are known: how many are held, how far the surface is from them now,
/// and what is left free.
void print_edges(const SessionState& state);

/// The same with every edge, as a JSON list.
[[nodiscard]] std::string edges_json(const SessionState& state);

/// For every surface on which faces lie: what is visible of it, its middle, and the edges with their neighbours.
void print_faces(const step::File& file);

}  // namespace knead::cli
