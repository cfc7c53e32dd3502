#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "knead/scene/energy_density.hpp"
#include "knead/scene/held_points.hpp"
#include "knead/session/session.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::studio {

/// What colours the surface.
/// Energy: the integrand of the energy per area of the parameter domain, in normalised units (`energy_density`).
enum class PictureField { none, deviation, mean_curvature, gaussian_curvature, gap, energy };

/// A surface as a grid of points to draw: `pieces` per span, so that every knot line is a line of the grid. Grid point
/// (k, l) is row k · counts[1] + l. Positions are relative to the origin asked for, so that single precision suffices.
struct Picture {
  std::array<std::uint32_t, 2> counts = {0, 0};
  std::vector<float> positions, normals;        ///< 3 per grid point; normals of length 1
  std::vector<float> values;                    ///< of the field, one per grid point; empty without one
  std::vector<float> fractions_s, fractions_t;  ///< of the domain, per grid line
  std::vector<std::uint32_t> lines_u, lines_v;  ///< grid lines that are knot lines, ends of the domain included
  std::vector<float> net;                       ///< control points, 3 each
  std::vector<std::uint8_t> held;  ///< per control point, by whatever holds it: 0, 1 or 2 as of `held_points`
};

/// Draws one surface again and again; tables and memory are kept while the knots stay the same.
class Painter {
 public:
  /// Errors (numerical): a rational denominator that is not positive.
  /// With `opened`, the shape as it came is drawn instead.
  Expected<void> paint(const SessionState& state, int index, const Point& origin, int detail, PictureField field,
                       bool opened = false);
  [[nodiscard]] const Picture& picture() const { return picture_; }

 private:
  Expected<void> tabulate(const Surface& surface, int detail);
  void paint_normals();
  /// The opened shape at the parameters of the picture.
  Expected<void> evaluate_opened(const Surface& opened);
  Expected<void> paint_held(const SceneSurface& surface);
  Expected<void> paint_energy(const SessionState& state, int index);
  Expected<void> paint_values(const SessionState& state, int index, PictureField field, bool opened);

  std::optional<std::array<KnotVector, 2>> knots_;
  int detail_ = 0;
  std::array<std::vector<double>, 2> parameters_;
  std::array<BasisTable, 2> tables_;
  Evaluation<2> evaluation_, opened_;
  Picture picture_;
  std::vector<std::pair<HeldInput, std::vector<std::uint8_t>>> held_;
  std::vector<std::pair<EnergyScalingInput, DomainScaling<2>>> scalings_;
};

}  // namespace knead::studio
