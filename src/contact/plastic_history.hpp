#pragma once

#include "knead/spline/spline.hpp"

namespace knead {

/// How much of a displacement stays.
struct Plasticity {
  double share = 1;  ///< p, 0 to 1
  double yield = 0;  ///< y, a length >= 0: up to it nothing stays

  friend bool operator==(const Plasticity&, const Plasticity&) = default;
};

/// m ← u wherever |u| > |m|: the history of a stroke, row by row the largest displacement u that
/// any place of the tool has asked of that point. Being a maximum over the places it depends on
/// which places there were, not on how often or in which order, and a place that was passed before
/// adds nothing.
void remember(Points& history, const Points& displacement);

/// p max(0, 1 − y/|m|) m, row by row: what stays of a history m when the tool is taken away.
[[nodiscard]] Points staying(const Points& history, const Plasticity& plasticity);

/// What one point at rest is pressed with, and how far that is felt: the operator λ(1 − ℓ²Δ)² of a
/// material on a bed.
struct Locality {
  double lambda = 0;   ///< λ = β/ℓ⁴
  double tension = 0;  ///< 2β/ℓ², which is 2√(βλ)
};

/// The bed that lets a plate of bending stiffness β feel no further than ℓ (both normalised, > 0).
/// The operator βΔ² − αΔ + λ is then β(Δ − 1/ℓ²)², whose Green's function (r/ℓ) K₁(r/ℓ) / (4πβ/ℓ²)
/// is positive and falls everywhere: a dent has no rim. With less tension its values alternate, and
/// the rim of a dent rises by up to e^−π = 4 %.
[[nodiscard]] Locality locality_of(double beta, double length);

}  // namespace knead
