#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "act.hpp"

namespace knead {

// Edges of faces that follow what moves beside them.

/// Makes an edge of faces one that may follow them. Errors (input): a face at it that cannot
/// follow, or lies on a surface that is not selected, each named with what to do.
[[nodiscard]] Expected<void> follow_edge(Act& act, const std::string& id);
/// Makes the courses of edges known that follow selected surfaces. Errors: those of `follow_edge`.
[[nodiscard]] Expected<void> know_followed(Act& act);
/// Unites the knots of faces at edges that follow, where refining is permitted.
[[nodiscard]] Expected<void> unite_followed(Act& act);
/// Whether all edges that follow are still closed after surfaces changed from `before`. Errors
/// (numerical): one is not, and by how much; a vertex of it moved that another edge holds.
[[nodiscard]] Expected<void> check_followed(const Scene& scene, const Scene& before);

/// One motion, made again and again with edges that follow coupled more tightly, until they are
/// closed.
class Attempts {
 public:
  /// From the shapes as they are; of the selected surfaces from these, where some are given.
  explicit Attempts(const Scene& scene, std::span<const OpenStroke::Before> selected = {});

  /// Whether the surfaces may stay as they are: edges that follow are closed, and as smooth as
  /// asked. If not, couples them more tightly and returns false: what moved the surfaces must be
  /// made again. Where that would keep the edges from moving, the tightest attempt that could be
  /// accepted is taken. What cannot be is left to `check_followed`.
  [[nodiscard]] Expected<bool> together(SessionState& state);
  /// Takes a step unless it must be made again; returns whether it was taken. Errors: those of
  /// `check_followed`.
  [[nodiscard]] Expected<bool> accept(Act& act, const ActiveStep& step);

  /// The shape of each surface of the scene from which the motion is measured.
  [[nodiscard]] std::span<const std::shared_ptr<const Surface>> before() const { return before_; }

 private:
  struct Best {
    SharedItems<SceneSurface> surfaces;
    CouplingTolerance coupling;
    std::vector<Point> motion;  // of points of the edges, in the first one that could be accepted
  };
  std::vector<std::shared_ptr<const Surface>> before_;
  std::optional<Best> best_;  // the tightest that could be accepted
};

}  // namespace knead
