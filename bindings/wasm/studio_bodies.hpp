#pragma once

#include <array>
#include <string>
#include <vector>

#include "knead/scene/scene.hpp"
#include "knead/scene/shape.hpp"

namespace knead::studio {

/// A curve or a volume to draw; places relative to the requested origin, 3 numbers each.
struct BodyPicture {
  std::vector<float> lines;   ///< ends of chords: of a curve, or of the knot lines on the sides of a volume
  std::vector<float> at;      ///< where these ends are, three fractions of the domain each; of a curve the first counts
  std::vector<float> net;     ///< ends of the legs of the control polygon; of a volume those on its sides
  std::vector<float> points;  ///< the control points, in their order
  bool pulled = false;        ///< of a lattice: it has been pulled, and another pull goes on there
};

/// 24 chords per span of a curve, 6 of a volume's knot lines, of which at most 12 per direction are drawn. Errors: a
/// denominator that is not positive (numerical).
[[nodiscard]] Expected<BodyPicture> body_picture(const SceneBody& body, const Point& origin);

/// The same of the block that the next cubic lattice of this kind by hand moves: as it was pulled, if that goes on, or
/// with `anew`, or else, round the selected surfaces. Errors: those of `lattice_around_selection`.
[[nodiscard]] Expected<BodyPicture> lattice_picture(const Scene& scene, double margin, const std::array<int, 3>& net,
                                                    bool anew, const Point& origin);

/// {"buffers": …, "pulled": …}
[[nodiscard]] std::string body_json(const BodyPicture& picture);

}  // namespace knead::studio
