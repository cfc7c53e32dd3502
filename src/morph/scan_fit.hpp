#pragma once

#include <functional>

#include "correspondence.hpp"
#include "scan.hpp"

namespace knead::morph {

struct ScanPartners;

struct ScanSettings {
  double reach = 0;  ///< farthest that a point may be from a face at first, file units, > 0
  /// Of each coordinate, file units; none: `estimated_noise`, lowered between turns to what
  /// neighbours differ by in their distances from the moved model, at least a millionth of the
  /// size.
  std::optional<double> noise = {};
  /// Largest residual wanted: then the scan is taken as exact, and has no noise.
  std::optional<double> tolerance = {};
  double refinement = 8;  ///< as of `FitSettings`
  double scale = 1;       ///< of the displacements, once they are known
  bool along_normal = false;
  /// Asked of the partners on the model as given, before anything is fitted.
  std::function<Expected<void>(const ScanPartners&)> check = {};
  /// Told before each turn how many have been made, of how many at most. An error ends the fit.
  std::function<Expected<void>(int, int)> told = {};
};

/// What has become of a point of a scan.
enum class PointState : unsigned char { used, far, beyond_border, turned_away };

/// Which points of a scan have partners on a model, and why others have none.
struct ScanPartners {
  /// The data as they were fitted at last, unscaled; `left_out` are those beyond the reach.
  Correspondences found = {};
  std::size_t beyond_border = 0;        ///< of the model, beside it
  std::size_t turned_away = 0;          ///< normals of scan and model differ by more than 45°
  std::size_t outliers = 0;             ///< more than six deviations from the moved model
  double rms = 0;                       ///< distance of the partners from the model
  std::vector<PointState> states = {};  ///< of each point; outliers are used
};

struct ScanFit {
  FitResult fit = {};
  ScanPartners first = {}, last = {};  ///< on the model as it was, and after it has followed
  double noise = 0;                    ///< that was given or estimated; 0: taken as exact
  int turns = 0;                       ///< times that partners were sought and followed
};

/// The partners of a scan on a model that has not moved. Errors: those of evaluation.
[[nodiscard]] Expected<ScanPartners> scan_partners(const Scan& scan, const VisibleSearch& search,
                                                   std::span<const FitSurface> surfaces,
                                                   const ScanSettings& settings);

/// Moves surfaces so that what is visible of them lies in a scan. By turns: each point p of the
/// scan looks for its foot q on the moved model, the nearest visible point; the datum there is
/// what puts the foot's material point q₀ level with p,
///
///   d = q + (n · (p − q)) n − q₀,   n the normal at q,
///
/// and `fit_surfaces` fits all of them on the surfaces as given, so that no error adds up. Without
/// affine part: nothing goes on beyond the scan but what is nearest. Turns end when the distances
/// grow no smaller by 2 %, or are those of the noise, and after eight.
///
/// Scan points seek the model, not the reverse: each counts once, holes and borders of the scan
/// pull at nothing, and the border beyond which there is nothing to seek is that of the model,
/// which is known exactly. Without partner are points beyond the reach; beside a border (the way to
/// the foot leans by more than 30° from the normal); of which a known normal differs by more than
/// 45° from that of the model, senses apart. From the second turn on data have Tukey's weights,
/// 0 from six deviations on. More than 2e5 partners are fitted as every second, third, …
///
/// Results do not depend on the number of threads. Errors (input): no point has a partner on a
/// surface that is free; those of `fit_surfaces`. Cost: that of a search per point and of a fit,
/// for each turn.
[[nodiscard]] Expected<ScanFit> fit_scan(const Scan& scan, std::span<const FitSurface> surfaces,
                                         std::span<const FitEdge> edges,
                                         const std::vector<bool>& shown,
                                         const ScanSettings& settings);

}  // namespace knead::morph
