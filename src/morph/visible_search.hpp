#pragma once

#include <memory>
#include <span>
#include <vector>

#include "surface_fit.hpp"

namespace knead::morph {

/// The nearest visible point of a model.
struct VisibleFoot {
  int surface = -1;                       ///< its position; -1: none within reach
  std::array<double, 2> parameters = {};  ///< of it there
  Point point = Point::Zero();
  double distance = std::numeric_limits<double>::infinity();
};

/// Finds the nearest points of what the faces of a model show, through one tree of boxes over all
/// of them. Immutable, const is thread-safe.
///
/// The domain of every surface is divided into cells, at its knots and finer; those that no face
/// shows are dropped. A cell's box is that of 5 × 5 points on it, widened by the largest second
/// difference of these, which exceeds what the surface bulges between them about eight times. A
/// surface is searched where one of its boxes may hold the nearest point: first for its nearest
/// point of all (`ClosestPointSearch`), which settles the matter where it is visible. If not, the
/// nearest visible point is a local minimum of the distance, sought from the middle of each box
/// that may hold it, or lies on an edge of a face, which chords stand for.
///
/// Accuracy: of visible points inside a face that of `ClosestPointSearch`; on edges the deviation
/// of the chords from the edge (`TrimEdge::deviation`), by which the nearest point of a surface may
/// be beyond the edge too. Points at equal distances: the one found first, always the same.
/// The surfaces must outlive it.
class VisibleSearch {
 public:
  /// Surfaces that nothing shows are to be left out by `shown`, one flag for each; empty: none is.
  /// Errors (numerical): a denominator that is not positive. Cost: 25 evaluations per cell, and the
  /// preparation of a search on every surface, shared among threads.
  [[nodiscard]] static Expected<VisibleSearch> create(std::span<const FitSurface> surfaces,
                                                      const std::vector<bool>& shown = {});

  /// The nearest visible point, if it is nearer than `reach`. Cost: some 20 µs near one surface.
  [[nodiscard]] VisibleFoot nearest(const Point& x, double reach) const;
  /// The same of many points, by threads.
  [[nodiscard]] std::vector<VisibleFoot> nearest(std::span<const Point> points, double reach) const;

  /// Round all that is visible.
  [[nodiscard]] Eigen::AlignedBox3d box() const;

 private:
  struct Data;
  explicit VisibleSearch(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

}  // namespace knead::morph
