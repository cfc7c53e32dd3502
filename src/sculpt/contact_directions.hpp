#pragma once

#include <vector>

#include "contact_anchor.hpp"

namespace knead {

/// The directions of Newton's iteration from one anchor, within one neighbourhood: (A + H) d = r by conjugate
/// gradients.
///
/// They are preconditioned with A⁻¹ and with what the directions before have shown: a displacement p that conjugate
/// gradients tried, and the change of forces y = (A + H) p that it caused, are a pair of the BFGS formula, by which A⁻¹
/// is corrected (Morales and Nocedal, Automatic preconditioning by limited memory quasi-Newton updating, 2000). H
/// changes little from one direction to the next near the minimum, and the stiff parts of it need not be found anew.
/// Pairs are kept with A⁻¹ y, so that a correction costs no substitution, and so that a direction ends where it would
/// without: at a share of its first residual in the norm of A⁻¹.
class ContactDirections {
 public:
  /// \param corrects Whether directions use what those before have shown.
  explicit ContactDirections(bool corrects) : corrects_(corrects) {}

  /// Call when the anchor or the neighbourhood changes: pairs are known there only.
  void forget() { pairs_.clear(); }

  /// To `tolerance` of the first residual. If A + H turns out not to be positive, the result is the sum of the steps so
  /// far, or the preconditioned r: a descent direction in any case (Nocedal and Wright, Numerical Optimization,
  /// Alg. 7.1). The slope is left to be found.
  /// \param image A⁻¹ r in the neighbourhood. \param solves Is raised by the number of substitutions.
  [[nodiscard]] Direction find(const PotentialState& state, const Anchor& anchor, ContactNeighbourhood& near,
                               Combination r, Points image, double tolerance, int& solves);

 private:
  struct Pair {
    Points p;
    Combination ap;  // A p
    double with_r;   // rᵀp of the anchor's r
    Combination y;
    Points y_image;  // A⁻¹ y
    double scale;    // 1 / pᵀy
  };
  /// A displacement z = M r, and A z.
  struct Preconditioned {
    Points z;
    Combination az;
  };

  template <class Image>
  [[nodiscard]] Preconditioned precondition(const Anchor& anchor, const Combination& r, const Image& image_of) const;
  void keep(Pair pair);

  bool corrects_;
  std::vector<Pair> pairs_;  // the newest last; none unless `corrects_`
};

}  // namespace knead
