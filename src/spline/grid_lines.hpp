#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "knead/spline/knot_vector.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// Every span of positive length in so many equal pieces: where these begin, and the end of the
/// domain.
[[nodiscard]] std::vector<double> even_parameters(const KnotVector& knots, int pieces);

/// Parameters of one direction of a display grid of a surface: every span of positive length in
/// equal pieces, so that every knot line is a grid line.
struct GridLines {
  std::vector<double> parameters;         ///< ascending, ends of the domain included
  std::vector<std::uint32_t> knot_lines;  ///< which of them are knots, ends included
  std::vector<std::uint32_t> coarse;      ///< which of them are there without a window; empty: all
};

/// `detail` pieces over the domain, rounded up to the same number in each span; at least two where
/// the degree is above 1 and one where it is 1, but no more than `most` in all where there are
/// fewer spans than that. Requires: detail >= 1 (asserted).
[[nodiscard]] GridLines grid_lines(const KnotVector& knots, int detail, int most = 400);

/// The chord over the whole of a span, in one direction of a surface.
struct SpanChord {
  double distance = 0;  ///< from the surface: h²/8 · max |S_uu − (S_uu · t) t|
  /// Between points of chord and surface of the same parameter: h²/8 · max |S_uu|.
  double drift = 0;
  double turn = 0;  ///< of the tangent, radians: h · max |S_uu − (S_uu · t) t| / |S_u|
};

/// Of every span of a direction, about the largest: maxima are estimated at max(3, p) points inside
/// each span, along lines at and between the knots of the other direction (at most 64 of them).
/// Cost: one evaluation of order 2 there. Errors: a rational denominator that is not positive
/// (numerical).
[[nodiscard]] Expected<std::vector<SpanChord>> span_chords(const Surface& surface, int direction);

/// A part of the domain that is looked at from nearby.
struct GridWindow {
  std::array<double, 2> lower = {0, 0}, upper = {0, 0};  ///< parameters
  double tolerance = 0;                                  ///< there, as `ChordOptions::tolerance`
  bool operator==(const GridWindow&) const = default;
};

/// How closely the lines of a grid follow a surface.
struct ChordOptions {
  int detail = 96;            ///< as for `grid_lines` of the knots: the coarsest grid
  double tolerance = 0;       ///< distance of chords from the surface, a length > 0
  int most = 1500;            ///< lines per direction
  int most_points = 100'000;  ///< of the grid; both limits yield to `detail`
  std::optional<GridWindow> window = {};
};

/// The grid lines of both directions, with more pieces in every span whose chords would be farther
/// from the surface than the tolerance: a chord over h is off by h²/8 · max |S_uu − (S_uu · t) t|
/// with the unit tangent t, that is by κ L²/8 for the length L of the piece. The maximum is
/// estimated as for `span_chords`, so that chords are within about the tolerance. Where that would
/// take more points than the options allow, the tolerance is doubled until it does not. Of these
/// pieces, the ones that lie in the window, in part or whole, are divided evenly until their points
/// are within its tolerance of those of the surface with the same parameters, so that what is drawn
/// by parameters, such as trims, is where it belongs; it is doubled likewise. The other lines stay
/// as they are, so that a picture outside of the window does not change. Cost: one evaluation of
/// order 2 at these points. Errors: a rational denominator that is not positive (numerical).
[[nodiscard]] Expected<std::array<GridLines, 2>> grid_lines(const Surface& surface,
                                                            const ChordOptions& options);

}  // namespace knead
