#pragma once

#include <optional>
#include <span>
#include <vector>

#include "model_walls.hpp"

namespace knead {

/// One search of `ModelWalls::first_contact`.
///
/// In three stages, each of which discards most of what is left:
/// 1. Boxes: spans that move against triangles around and spans of other surfaces (`look`), by
/// trees of boxes that contain the whole way of a span.
/// 2. Triangles: vertices of either side against triangles of the other, both moving in a straight
/// line (`compare`). Meetings of edges with edges are not sought: the third stage searches the
/// neighbourhood of what vertices find.
/// 3. Newton's method on the surfaces themselves (`passage`), and a search among neighbouring
/// points for the one that arrives first (`refined`). Stage 2 can be wrong by the sag of both
/// triangulations; that margin widens its tests, so that what it discards does not meet. Limits on
/// numbers bound the cost of one step: what exceeds them is a wall that is run into at hundreds of
/// places, of which the earliest few suffice.
class ContactSearch {
 public:
  ContactSearch(ModelWalls& walls, std::span<const WallMotion> motions, double tolerance)
      : walls_(walls), motions_(motions), tolerance_(tolerance) {}

  [[nodiscard]] std::optional<FaceContact> first();

 private:
  /// What triangles say of a point that may come to a face.
  struct Candidate {
    double time = 0;  ///< at which it would
    std::size_t surface = 0;
    std::array<double, 2> at = {};     ///< on it
    std::optional<std::size_t> met;    ///< none: a face around
    std::array<double, 2> there = {};  ///< on the surface that is met
    double margin = 0;                 ///< by which triangles may be wrong
    bool sure = false;                 ///< it begins farther away than that
    double sooner = 0;                 ///< by which the time may be wrong
  };
  /// A point of a surface that comes to a face on its way, however far.
  struct Passage {
    double time = 0,
           closing = 0;  ///< when they meet; how far they come nearer along the normal, in all
    std::array<double, 2> there = {};  ///< on the surface that is met
    std::uint32_t face = 0;            ///< else of the faces around

    [[nodiscard]] double share(double apart) const { return time - apart / closing; }
  };

  [[nodiscard]] std::vector<Candidate> solved() const;
  [[nodiscard]] std::optional<FaceContact> earliest(std::span<const Candidate> solved) const;
  [[nodiscard]] static bool before(const Candidate& a, const Candidate& b);
  void look(std::size_t surface);
  void look_around(std::size_t surface, SpanGrid& grid, std::size_t span,
                   const Eigen::AlignedBox3d& box);
  void look_at(std::size_t surface, SpanGrid& grid, std::size_t span,
               const Eigen::AlignedBox3d& box, std::size_t wall, SpanGrid& met);
  void compare(const Patch& patch, const Patch& wall, std::span<const std::uint32_t> triangles,
               Candidate like);
  [[nodiscard]] bool separated(const SpanGrid& grid, std::size_t span, const Patch& wall,
                               std::uint32_t triangle) const;
  [[nodiscard]] bool counts(const Candidate& c, const std::array<double, 2>& at) const;
  [[nodiscard]] std::optional<Passage> passage(const Candidate& c, const std::array<double, 2>& at,
                                               const std::array<double, 2>& there) const;
  [[nodiscard]] std::optional<Passage> passage_around(const Candidate& c,
                                                      const std::array<Point, 2>& way) const;
  [[nodiscard]] std::optional<Passage> passage_of(const Candidate& c,
                                                  const std::array<double, 2>& at,
                                                  const std::array<Point, 2>& way,
                                                  std::array<double, 2> there) const;
  [[nodiscard]] std::optional<FaceContact> refined(const Candidate& c) const;

  ModelWalls& walls_;
  std::span<const WallMotion> motions_;
  double tolerance_;
  std::vector<Candidate> candidates_;
};

}  // namespace knead
