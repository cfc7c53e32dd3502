#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "brep/trim_loops.hpp"
#include "knead/session/document.hpp"
#include "scene/display.hpp"
#include "session/session_state.hpp"

namespace knead::studio {

/// What the faces of an open file show of its surfaces, found when it is first asked for and anew
/// after conversions.
class ShownParts {
 public:
  void forget() { *this = ShownParts(); }
  /// In the order of the file's surfaces; empty where they cannot be followed.
  const std::vector<SurfaceTrim>& trims(const Document& document);
  /// Of a surface of the file; null: all of it, or `trims` has not been called.
  [[nodiscard]] std::shared_ptr<const VisibleRegion> visible(const Document& document,
                                                             std::size_t surface) const;
  /// For displays that see the model; null without a STEP file.
  const std::shared_ptr<const Surroundings>& around(const Document& document);

 private:
  std::optional<TrimLoops> trims_;
  std::vector<std::shared_ptr<const VisibleRegion>> visible_;  // by them
  std::vector<std::string> converted_;  // what of the file was when they were
  std::shared_ptr<const Surroundings> around_;
};

/// The number in the open file of a surface of the session, which has converted ones last; the
/// number of all where it is none of them.
[[nodiscard]] std::size_t place_in_file(const Session& session, int surface);

}  // namespace knead::studio
