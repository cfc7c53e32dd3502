#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "act.hpp"

namespace knead {

// Edges of faces that follow what moves beside them.

/// Makes an edge of faces one that may follow them. Errors (input): a face at it that cannot follow, or lies on a
/// surface that is not selected, each named with what to do.
[[nodiscard]] Expected<void> follow_edge(Act& act, const std::string& id);
/// Makes the courses of edges known that follow selected surfaces. Errors: those of `follow_edge`.
[[nodiscard]] Expected<void> know_followed(Act& act);
/// Unites the knots of faces at edges that follow, where refining is permitted.
[[nodiscard]] Expected<void> unite_followed(Act& act);
/// Whether all edges that follow are still closed after surfaces changed from `before`. Errors (numerical): one is not,
/// and by how much; a vertex of it moved that another edge holds.
[[nodiscard]] Expected<void> check_followed(Act& act, const Scene& before);

/// The same motion, made again and again with edges coupled more tightly.
struct Attempts {
  struct Best {
    SharedItems<SceneSurface> surfaces;
    CouplingTolerance coupling;
    std::vector<Point> motion;  ///< of points of the edges, in the first one that could be accepted
  };
  std::vector<std::shared_ptr<const Surface>> before;  ///< of each surface of the scene
  std::optional<Best> best = {};                       ///< the tightest that could be accepted
};

[[nodiscard]] Attempts attempts(const Act& act);
/// Whether the surfaces may stay as they are: edges that follow are closed, and as smooth as asked. If not, couples
/// them more tightly and returns false: what moved the surfaces must be made again. Where that would keep the edges
/// from moving, the tightest attempt that could be accepted is taken. What cannot be is left to `check_followed`.
[[nodiscard]] Expected<bool> together(Act& act, Attempts& attempts);
/// Takes a step unless `together` says that it must be made again; returns whether it was taken. Errors: those of
/// `check_followed`.
[[nodiscard]] Expected<bool> take_together(Act& act, const ActiveStep& step, Attempts& attempts);

}  // namespace knead
