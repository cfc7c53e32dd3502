#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>

#include "knead/session/session.hpp"

namespace knead {

struct Act;
class ModelWalls;

/// What happens where a surface comes to another face of its model: it is noted, allowed, or as far as it goes.
enum class Through { note, allow, stop };

/// What is known of faces beyond the states: undone, rehearsed or not.
struct KnownFaces {
  std::shared_ptr<const Document> document = {};                             ///< as in `SessionState`
  std::map<std::string, std::shared_ptr<const VisibleRegion>> visible = {};  ///< by surface
  std::shared_ptr<ModelWalls> walls = {};                                    ///< null until a surface has moved
};

/// Compares what moved from the surfaces of `before`, of an open stroke or brush from those before it, with the other
/// faces of the model (`ModelWalls::first_contact`). What comes within the larger of the uncertainty of the file and
/// 1e-6 of the size of the model is noted, with the place and how far it had come there, or made smaller alike, so that
/// twice that distance is left.
[[nodiscard]] Expected<void> meet_faces(Act& act, const Scene& before);
[[nodiscard]] Expected<void> meet_faces(Act& act, std::span<const std::shared_ptr<const Surface>> before);

}  // namespace knead
