#pragma once

#include <vector>

#include "contact_anchor.hpp"
#include "contact_limits.hpp"

namespace knead {

/// The directions of Newton's iteration from one anchor, within one neighbourhood: (A + H) d = r by
/// conjugate gradients.
///
/// They are preconditioned with A⁻¹ and with what the directions before have shown: a displacement
/// p that conjugate gradients tried, and the change of forces y = (A + H) p that it caused, are a
/// pair of the BFGS formula, by which A⁻¹ is corrected (Morales and Nocedal, Automatic
/// preconditioning by limited memory quasi-Newton updating, 2000). H changes little from one
/// direction to the next near the minimum, and the stiff parts of it need not be found anew. Pairs
/// are kept with A⁻¹ y, so that a correction costs no substitution, and so that a direction ends
/// where it would without: at a share of its first residual in the norm of A⁻¹.
///
/// Measuring a residual costs a substitution. Where what touches has settled, and steps before have
/// contracted residuals so much that the next one will be small enough by a wide margin, it is not
/// measured: Newton's iteration measures the one that counts.
class ContactDirections {
 public:
  /// \param corrects Whether directions use what those before have shown.
  explicit ContactDirections(bool corrects) : corrects_(corrects) {}

  /// Call when the anchor or the neighbourhood changes: pairs are known there only.
  void forget() {
    pairs_.clear();
    contraction_ = 1;
  }

  struct Wanted {
    double tolerance;  ///< of the first residual
    /// Whether what touches changes little, so that what residuals before have shown can be relied
    /// on.
    bool settled = false;
    int most = max_cg_iterations;  ///< substitutions
  };

  /// To a share of the first residual. If A + H turns out not to be positive, the result is the sum
  /// of the steps so far, or the preconditioned r: a descent direction in any case (Nocedal and
  /// Wright, Numerical Optimization, Alg. 7.1). The slope is left to be found.
  /// \param image A⁻¹ r in the neighbourhood.
  /// \param solves Is raised by the number of substitutions.
  [[nodiscard]] ContactDirection find(const PotentialState& state, const Anchor& anchor,
                                      ContactNeighbourhood& near, Combination r, Points image,
                                      const Wanted& wanted, int& solves);

  /// A pair more: what a step of Newton's iteration along a direction has changed. A direction
  /// whose last step of conjugate gradients was not measured gets its pair from here.
  void take(double step, const ContactDirection& direction, const Anchor& anchor,
            const Residual& before, const Residual& after);

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
  [[nodiscard]] Preconditioned precondition(const Anchor& anchor, const Combination& r,
                                            const Image& image_of) const;
  void keep(Pair pair);

  bool corrects_;
  // Of squared residuals by a step, in the mean over the last direction that measured it.
  double contraction_ = 1;
  std::vector<Pair> pairs_;  // the newest last; none unless `corrects_`
};

}  // namespace knead
