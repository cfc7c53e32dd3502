#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/display.hpp"
#include "scene/span_grid.hpp"

namespace knead {

/// A surface of a model as it moves, or stays.
struct WallMotion {
  std::string id;
  Motion motion;                          ///< on one basis; both null: it is unknown, and left out
  std::shared_ptr<const Surface> opened;  ///< only what moves away from it comes to another face
  std::shared_ptr<const VisibleRegion> visible;  ///< of it; null: all
  std::size_t part = 0;                          ///< of an assembly, with coordinates of its own
};

/// Where a surface that moves comes to another face of its model.
struct FaceContact {
  std::size_t surface = 0;  ///< that moves, of the motions given
  std::optional<std::size_t>
      met;           ///< the surface of the face, likewise; none: it is on no surface of the scene
  std::string face;  ///< then its id
  std::array<double, 2> at = {};  ///< parameters of the surface
  Point place = Point::Zero();    ///< where the motion is as far as `share`
  double share = 1;               ///< of the motion, at which they are within the tolerance
  double room = 1;                ///< of the motion, at which they are still twice as far apart
};

/// The faces of a model as walls that its surfaces may come through: those around, of which the
/// model has triangles, and the surfaces, whose spans lie in boxes. What does not move is prepared
/// once.
class ModelWalls {
 public:
  /// \param around null: the surfaces are all there is
  explicit ModelWalls(std::shared_ptr<const Surroundings> around);
  ~ModelWalls();

  /// The first place where a visible point of a surface that moves comes within `tolerance` of a
  /// face of the same part of an assembly, or of a part of its own face that was not beside it,
  /// none if there is no such place.
  ///
  /// With S(u, t) for the surface and W(u', t) for the face, both moving evenly, it is the least t
  /// in [0, 1] over all u and u' with S = W, less the time that the last `tolerance` along the
  /// normal takes. Faces that meet at an edge touch from the start: a point counts only where it
  /// was farther than the tolerance from the face, and than the triangles of a face around may be,
  /// and goes farther from the surface as opened.
  ///
  /// Pairs of spans whose boxes meet are compared by triangles, 4 × 4 squares for a span, the
  /// corners of each with the triangles of the other; what may meet is refined by Newton's method
  /// for (u', t) on the surfaces themselves, and by a compass search for u, to 1e-4 of a cell. A
  /// dent between the corners is found where triangles may miss it by no more than second
  /// differences say. Faces around count as their triangles. Cost: O(p + q) per control point that
  /// moves, and where boxes meet 1 µs to 10 µs for each pair of spans.
  [[nodiscard]] std::optional<FaceContact> first_contact(std::span<const WallMotion> motions,
                                                         double tolerance);

  /// The size that a relative tolerance is of: the diagonal of the box round all faces and nets.
  [[nodiscard]] double diagonal(std::span<const WallMotion> motions);
  [[nodiscard]] const Surroundings* around() const { return around_.get(); }

 private:
  friend class ContactSearch;
  /// The triangles of the faces around in one part.
  struct Around {
    Patch patch;
    std::vector<double> sags;          ///< by triangle
    std::vector<std::uint32_t> faces;  ///< likewise: of `around_`
    BoxTree tree;
  };
  /// Which spans of a surface show something, made once.
  struct ShownSpans {
    std::shared_ptr<const VisibleRegion> region;
    std::shared_ptr<const Surface> like;  ///< on the same basis
    std::vector<char> shown;              ///< by span, as in `SpanGrid`; empty: all of them
  };
  [[nodiscard]] SpanGrid* grid_of(const WallMotion& wall);
  [[nodiscard]] const std::vector<char>& shown_spans(const WallMotion& wall);

  std::shared_ptr<const Surroundings> around_;
  std::map<std::size_t, Around> parts_;
  std::map<std::string, std::optional<SpanGrid>> still_;   ///< of surfaces that do not move, by id
  std::map<std::string, std::optional<SpanGrid>> moving_;  ///< for one search
  std::map<std::string, ShownSpans> shown_;                ///< by id
};

}  // namespace knead
