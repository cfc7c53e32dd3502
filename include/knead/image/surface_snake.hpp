#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "knead/image/snake.hpp"
#include "knead/image/volume.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// What an active surface is closed as.
enum class SurfaceForm {
  sphere,  ///< around in u, from pole to pole in v
  torus,   ///< around in both
};

/// A closed surface that an active one starts from.
struct SurfaceStart {
  SurfaceForm form = SurfaceForm::sphere;
  Point centre = Point::Zero();
  /// Of a sphere those along x, y and z before it is turned: an ellipsoid; of a torus the ring's
  /// and the tube's.
  std::array<double, 3> radii = {1, 1, 1};
  Point axis = Point::UnitZ();  ///< through the poles, or through the hole; any length above 0
};

using SurfaceSpring = SnakeSpringOf<2>;
using SurfaceVolcano = SnakeVolcanoOf<2>;
using SurfaceSnakeSettings = SnakeSettingsOf<2>;

/// A closed surface and what its parameters are of.
///
/// In u the knots are periodic, unclamped and uniform, and the first p rows of control points are
/// repeated at the end. In v those of a torus are so, too; those of a sphere are clamped and
/// uniform, from the pole v = 0 to the other. Its first and last columns are one point each; the
/// next ones are an affine image of a regular polygon around it, so that the surface has a tangent
/// plane there. The normal S_u × S_v of a start points outwards.
struct ClosedSurface {
  Surface surface;
  SurfaceForm form = SurfaceForm::sphere;
};

/// The surface of a start, by least squares on Ω. Errors (input): settings outside their ranges,
/// radii that are not positive, a tube that closes the hole, an axis without direction.
[[nodiscard]] Expected<ClosedSurface> closed_surface(const SurfaceStart& start,
                                                     const SurfaceSnakeSettings& settings);

struct SurfaceSnakeResult {
  ClosedSurface snake;
  int iterations = 0;
  bool converged = false;  ///< whether it came to rest before the iterations ended
  double last_motion = 0;
};

/// Active surfaces in a volume, several at once (several see each other by the region term's
/// outside alone): implicit steps (γ M + K) c⁺ = γ M c + F(c) until they rest, F by p + 1 Gauss
/// points per span and direction.
///
/// On a torus M and K = α (G11 ⊗ G00 + G00 ⊗ G11) + β (G22 ⊗ G00 + 2 G11 ⊗ G11 + G00 ⊗ G22) are the
/// exact Gramians of the periodic knots. On a sphere those along v carry the weights of its metric,
/// sin for M and for the derivative along v, 1/sin for that along u, integrated to rounding, and
/// the bend is K₁ M⁻¹ K₁ with the stretch K₁ (mixed form: the discrete Laplacian squared), which is
/// finite at the poles. Around u all matrices are circulant: a discrete Fourier transform leaves a
/// dense system in v per mode, factored once, and the conditions at the poles become modes that are
/// left out. Viscosity adapts as in `run_snakes`. A surface does not change its topology, and may
/// cross itself. Cost of an iteration: the volume's spline at each Gauss point, and O(m n (m + n))
/// for an m × n net. Errors: those of `closed_surface` (input); a start that is none of its
/// surfaces; a matrix that is not positive definite (numerical).
[[nodiscard]] Expected<std::vector<SurfaceSnakeResult>> run_surface_snakes(
    const VolumePotential& potential, std::vector<ClosedSurface> starts,
    const std::vector<SurfaceSnakeSettings>& settings);

/// Area and enclosed volume, by the divergence theorem; p + 3 Gauss points per span and direction.
/// The volume is positive where S_u × S_v points outwards.
struct SurfaceMeasure {
  double area = 0, volume = 0;
};
[[nodiscard]] SurfaceMeasure measure(const ClosedSurface& snake);

/// Triangles with their corners on the surface, `per_span` steps for each span and direction:
/// closed, with every corner once, running counterclockwise around S_u × S_v.
struct ClosedMesh {
  Points points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};
[[nodiscard]] ClosedMesh closed_mesh(const ClosedSurface& snake, int per_span = 4);

/// How many pairs of triangles that share no corner cross. Cost: O(triangles · those that overlap
/// them along x).
[[nodiscard]] int crossings(const ClosedMesh& mesh);

/// 1 at voxels whose centres are inside the mesh (even-odd rule along the first direction), else 0.
[[nodiscard]] VolumeImage mask_of(const ClosedMesh& mesh, const std::array<int, 3>& size,
                                  const VolumeFrame& frame);

}  // namespace knead
