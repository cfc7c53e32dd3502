#pragma once

#include "knead/scene/scene.hpp"

namespace knead {

/// The way of a brush over a surface, straight in the parameters between the points that it is given; on a closed
/// surface the shorter way around.
class BrushPath {
 public:
  /// \param spacing largest distance of places, file units.
  /// \param rope the pointer draws the brush by a rope of this length; 0: they are together.
  BrushPath(const Surface& surface, double spacing, double rope);

  /// The places on the way of the brush from where it is (`at`) while the pointer goes from `from` to `to`. Errors
  /// (input): points outside of the domain, a way of more than 20,000 places.
  [[nodiscard]] Expected<std::vector<Fractions>> places(const Fractions& from, const Fractions& to,
                                                        const Fractions& at) const;
  /// The point of the surface there, with its normal S_u × S_v / |S_u × S_v|, zero where undefined.
  [[nodiscard]] Expected<BrushPlace> place(const Fractions& at) const;

 private:
  [[nodiscard]] Fractions towards(const Fractions& from, const Fractions& to, double share) const;
  [[nodiscard]] Expected<double> length(const Fractions& from, const Fractions& to) const;

  const Surface& surface_;
  double spacing_, rope_;
  std::array<bool, 2> closed_ = {};
};

}  // namespace knead
