#include <algorithm>
#include <cmath>
#include <numbers>

#include "all.hpp"

namespace knead {
namespace {

/// asin(n·d / |d|), degrees: 90° where the surface faces the pull direction d, 0 where it is
/// parallel to it, negative where it is undercut. 0 everywhere for a direction of length 0.
Expected<std::vector<double>> draft_angles(const DisplayInput& input) {
  const std::vector<double>& d = input.settings[0];
  const Point direction = Point(d[0], d[1], d[2]).stableNormalized();
  std::vector<double> result;
  for (Eigen::Index k = 0; k < input.normals.rows(); ++k) {
    const double sine = std::clamp(input.normals.row(k).dot(direction), -1.0, 1.0);
    result.push_back(std::asin(sine) * 180 / std::numbers::pi);
  }
  return result;
}

}  // namespace

Display draft_angle_display() {
  return {.name = "draft",
          .title = "Draft angle",
          .unit = "°",
          .is_signed = true,
          .help =
              "Angle between the surface and the pull direction: red draws off a mould, blue is "
              "undercut, grey is parallel to it.",
          .limits = {{-3, 3}},
          .settings = {{.name = "direction",
                        .title = "Pull",
                        .unit = "",
                        .value = {0, 0, 1},
                        .help = "Direction in which the part leaves the mould; turn it round where "
                                "the normals point inwards"}},
          .values = draft_angles};
}

}  // namespace knead
