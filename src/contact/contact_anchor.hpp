#pragma once

#include <algorithm>
#include <cmath>

#include "contact_neighbourhood.hpp"

namespace knead {

/// Contacts affect few control points, and the minimum is sought within their neighbourhood. Let r
/// be the imbalance of forces b − AY + F at some Y₀, the anchor, and z = L⁻¹r with A = LLᵀ:
/// computed once on the whole net. From then on all directions, and so all residuals, are
/// combinations β r + E e, with forces e in the neighbourhood (E embeds them) whose images A⁻¹E e
/// are needed only there, as is s = A⁻¹r. The new Y = Y₀ + A⁻¹(β r + E e) is needed everywhere
/// once, at the end.
struct Anchor {
  Points y;
  ConstrainedCholesky::Half z;
  double rs;                          // rᵀ A⁻¹ r
  double quadratic;                   // ½ YᵀAY − Yᵀb
  double squared;                     // YᵀAY
  Points x_here, s_here, force_here;  // x_here: start + Y₀
};

/// β r + E e.
///
/// For two of them (β₁ r + E e₁)ᵀA⁻¹(β₂ r + E e₂) = β₁β₂ rᵀs + β₁ sᵀe₂ + β₂ sᵀe₁ + e₁ᵀ(EᵀA⁻¹E) e₂:
/// the square rᵀs is known, s = A⁻¹r is needed in the neighbourhood alone, and the last term is a
/// solve within it. Nothing outside takes part.
struct Combination {
  double beta = 0;
  Points e;

  /// (β r + E e)ᵀ A⁻¹ (β r + E e), given its image under A⁻¹ in the neighbourhood.
  [[nodiscard]] double norm(const Anchor& anchor, const Points& image) const {
    return beta * with_r(anchor) + dot(e, image);
  }
  /// rᵀ A⁻¹ (β r + E e).
  [[nodiscard]] double with_r(const Anchor& anchor) const {
    return beta * anchor.rs + dot(anchor.s_here, e);
  }
  [[nodiscard]] Points image(const Anchor& anchor, const ContactNeighbourhood& near) const {
    if ((e.array() == 0).all()) return beta * anchor.s_here;
    return beta * anchor.s_here + near.inverse(e);
  }
  void add(double t, const Combination& other) {
    beta += t * other.beta;
    e += t * other.e;
  }
};

/// A residual r, A⁻¹ r in the neighbourhood, and rᵀA⁻¹r.
struct Residual {
  Combination r;
  Points image;
  double squared = 0;

  /// Finds both of r.
  void measure(const Anchor& anchor, const ContactNeighbourhood& near) {
    image = r.image(anchor, near);
    squared = r.norm(anchor, image);
  }
  [[nodiscard]] double decrement() const { return std::sqrt(std::max(0.0, squared)); }
};

/// A displacement d in the neighbourhood, A d, and the slope of Φ along d.
struct ContactDirection {
  Combination ad;
  Points d;
  double slope = 0;
};

}  // namespace knead
