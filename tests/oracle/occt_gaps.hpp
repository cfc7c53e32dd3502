#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead::oracle {

/// One edge of a face: how far its curve in space is from a surface, lengths in mm.
struct OcctEdge {
  double tolerance = 0;  ///< that Open CASCADE gives the edge
  double gap = 0;        ///< largest distance from the surface, at 41 points
  /// Largest angle between the normals of two surfaces along the edge, degrees; 0 with one.
  double turn = 0;
  bool smooth = false;  ///< another face meets there with the same tangent planes, to 0.1 degrees
  double ends = 0;      ///< largest distance of the ends of its curve from its vertices
};

/// An edge at which the faces on two surfaces meet.
struct OcctCrease {
  std::vector<Point> points;  ///< 201 of them along it, mm
  /// The largest between the tangent planes of both at the feet of these, degrees.
  double angle = 0;
};

struct OcctMeeting;

/// The faces of a file by the surfaces on which they lie, ready for measuring.
class OcctFaces {
 public:
  /// Of a STEP or IGES file; lengths in mm. None where it cannot be read.
  [[nodiscard]] static std::optional<OcctFaces> read(const std::filesystem::path& path);

  [[nodiscard]] int faces() const;
  [[nodiscard]] int bad_faces() const;  ///< that BRepCheck finds fault with
  [[nodiscard]] int bad_edges() const;
  [[nodiscard]] std::map<std::string, int> topology() const;

  /// The edges of all faces on a surface of this file, in order, against that surface as it is in
  /// `after`: their distance from it, and the angle by which its normals turned. Empty: there is no
  /// such face in one of the two.
  [[nodiscard]] std::vector<OcctEdge> edges(const std::string& surface,
                                            const OcctFaces& after) const;
  /// The edges that the faces on two surfaces have in common, in order; on one surface, those at
  /// which it meets itself.
  [[nodiscard]] std::vector<OcctCrease> creases(const std::string& surface,
                                                const std::string& other) const;
  /// max |S_after − S| at a grid of 41 × 41 points of the surface that its faces show, and at those
  /// they do not.
  struct Moved {
    double visible = 0, hidden = 0;
    bool folded = false;  ///< the normal of a point turned by more than 90 degrees
  };
  [[nodiscard]] Moved moved(const std::string& surface, const OcctFaces& after) const;

  /// The edges along which a face on a surface meets one on another surface with the same tangent
  /// planes, to 0.1 degrees, whether both share it or each has its own: the angle between them, and
  /// that with the surface as it is in `after`.
  struct Across {
    double before = 0, after = 0;  ///< degrees
  };
  [[nodiscard]] std::vector<Across> across(const std::string& surface,
                                           const OcctFaces& after) const;

  /// How far 21 × 21 points of the box of each face on a surface, those that the face shows, are
  /// from that surface in `after`, mm, and the largest angle between the normals of both faces
  /// there, degrees. No points: the faces on it are not as many there.
  struct Apart {
    int points = 0;
    double distance = 0, turn = 0;
  };
  [[nodiscard]] Apart apart(const std::string& surface, const OcctFaces& after) const;

  /// How far the feet of a point, mm, on two surfaces are from each other; none: one of them has no
  /// face.
  [[nodiscard]] std::optional<double> gap_at(const Point& p, const std::string& surface,
                                             const std::string& other) const;

  /// Of all edges with two faces (occt_meetings.hpp).
  [[nodiscard]] std::vector<OcctMeeting> meetings() const;

  struct Data;

 private:
  explicit OcctFaces(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

}  // namespace knead::oracle
