#pragma once

#include <vector>

#include "charted_surface.hpp"
#include "spline/grid_lines.hpp"
#include "surface_foot.hpp"

namespace knead::brep {

/// A B-spline surface that faces lie on. Parameters are fractions of its domain.
///
/// Its chart follows the spans: one of them is as many steps wide as chords need to be within half
/// the limit in either direction, and to turn no more than those of a circle within the limit's
/// share, unless that moves less than a fiftieth of the limit; the other half is for the twist
/// between both directions. Flat spans share a step.
class SplineFace final : public ChartedSurface {
 public:
  /// `surface` must outlive it. Errors: as for `ClosestPointSearch`; a denominator that is not
  /// positive.
  [[nodiscard]] static Expected<SplineFace> create(const Surface& surface);

  [[nodiscard]] Point at(const Eigen::Vector2d& uv) const override;
  [[nodiscard]] Point normal(const Eigen::Vector2d& uv) const override;
  [[nodiscard]] Foot foot(const Point& p,
                          const std::optional<Eigen::Vector2d>& near) const override;
  [[nodiscard]] ParameterSpace space() const override { return feet_.space(); }
  /// The limit's share is that of half the diagonal of the net.
  void set_steps(ChordLimit chord) override;
  [[nodiscard]] Eigen::Vector2d chart(const Eigen::Vector2d& uv) const override;
  [[nodiscard]] Eigen::Vector2d from_chart(const Eigen::Vector2d& steps) const override;
  [[nodiscard]] std::array<bool, 2> straight() const override { return {false, false}; }

 private:
  SplineFace(const Surface& surface, SurfaceFoot feet);
  [[nodiscard]] std::array<double, 2> parameters(const Eigen::Vector2d& fractions) const;
  [[nodiscard]] double twist() const;

  const Surface* surface_;
  SurfaceFoot feet_;
  double size_ = 0;
  std::array<std::vector<SpanChord>, 2> chords_;
  std::array<std::vector<double>, 2> ends_,
      steps_;  // of spans: their fractions, and the steps up to there
};

}  // namespace knead::brep
