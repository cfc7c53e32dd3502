#include "contact_directions.hpp"

#include <cmath>

#include "base/interruption.hpp"

namespace knead {
namespace {

constexpr std::size_t max_pairs = 30;  // twice as many save 3 % more substitutions
// Of squared residuals: less takes more iterations, more saves less.
constexpr double contraction_margin = 6;
constexpr double least_curvature = 1e-3;  // of a pair, as a share of pᵀAp

}  // namespace

void ContactDirections::keep(Pair pair) {
  if (pairs_.size() == max_pairs) pairs_.erase(pairs_.begin());
  pairs_.push_back(std::move(pair));
}

/// The two loops of Nocedal and Wright, Alg. 7.4, around A⁻¹.
/// \param image_of Gives A⁻¹ of what r becomes when `alpha` times the pairs' y are taken from it.
///
/// M = the BFGS inverse from A⁻¹ and the pairs (p, y), symmetric and positive definite where all
/// pᵀy > 0. Everything is needed twice, as z = M r in the neighbourhood and as A z: sums of p and A
/// p keep both without a product with A. Cost: O(pairs × points of the neighbourhood) and what
/// `image_of` takes.
template <class Image>
ContactDirections::Preconditioned ContactDirections::precondition(const Anchor& anchor,
                                                                  const Combination& r,
                                                                  const Image& image_of) const {
  Preconditioned to{{}, r};
  std::vector<double> alpha(pairs_.size());
  for (std::size_t i = pairs_.size(); i-- > 0;) {
    const Pair& pair = pairs_[i];
    alpha[i] = pair.scale * (to.az.beta * pair.with_r + dot(to.az.e, pair.p));
    to.az.add(-alpha[i], pair.y);
  }
  to.z = image_of(to.az, alpha);
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const Pair& pair = pairs_[i];
    const double yz = pair.y.beta * to.az.with_r(anchor) + dot(pair.y.e, to.z);
    const double share = alpha[i] - pair.scale * yz;
    to.z += share * pair.p;
    to.az.add(share, pair.ap);
  }
  return to;
}

// Preconditioned conjugate gradients in combinations: r, A p and A z are β r₀ + E e, and all inner
// products are sums over the neighbourhood and the squares of the anchor. Convergence is measured
// by rᵀA⁻¹r, not by rᵀM r, which `product` gives: the first is the same measure whatever pairs are
// kept. A and M are fixed during the run, as pairs made in it are kept only at its end.
//
// The preconditioned operator is I + A^(−1/2) H A^(−1/2) without pairs: as many eigenvalues differ
// from 1 as H has a rank, and iterations are about as many as there are clusters of them.
ContactDirection ContactDirections::find(const PotentialState& state, const Anchor& anchor,
                                         ContactNeighbourhood& near, Combination r, Points image,
                                         const Wanted& wanted, int& solves) {
  const auto product = [&](const Preconditioned& m) {
    return r.beta * m.az.with_r(anchor) + dot(r.e, m.z);
  };
  ContactDirection to{{0, Points::Zero(near.size(), 3)}, Points::Zero(near.size(), 3)};
  Preconditioned m =
      precondition(anchor, r, [&](const Combination&, const std::vector<double>& alpha) {
        Points z = image;
        for (std::size_t i = 0; i < pairs_.size(); ++i) z -= alpha[i] * pairs_[i].y_image;
        return z;
      });
  Combination ap = m.az;
  Points p = m.z;
  double rs = product(m), squared = r.norm(anchor, image);
  const double first = squared, target = wanted.tolerance * wanted.tolerance * squared;
  std::vector<Pair> made;
  int measured = 0;
  for (int iteration = 0; iteration < wanted.most && squared > target && rs > 0; ++iteration) {
    if (Interruption::asked_for()) break;
    const Points hp = near.hessian(state, p);
    const double pap = ap.norm(anchor, p), curvature = pap + dot(p, hp);
    if (curvature <= 1e-12 * pap) {
      if (iteration == 0) to = {std::move(ap), std::move(p)};
      break;
    }
    const double step = rs / curvature;
    to.ad.add(step, ap);
    to.d += step * p;
    r.add(-step, ap);
    r.e -= step * hp;
    if (corrects_ && wanted.settled && contraction_margin * contraction_ * squared <= target) break;
    Points next_image;
    m = precondition(anchor, r, [&](const Combination& rest, const std::vector<double>& alpha) {
      Points z = rest.image(anchor, near);
      next_image = z;
      for (std::size_t i = 0; i < pairs_.size(); ++i) next_image += alpha[i] * pairs_[i].y_image;
      return z;
    });
    ++solves;
    if (corrects_) {
      made.push_back({p,
                      ap,
                      ap.with_r(anchor),
                      {ap.beta, ap.e + hp},
                      (image - next_image) / step,
                      1 / curvature});
    }
    image = std::move(next_image);
    squared = r.norm(anchor, image);
    ++measured;
    contraction_ = std::pow(squared / first, 1.0 / measured);
    if (!(squared < 1e6 * first)) break;  // nothing but rounding is left
    const double next = product(m), share = next / rs;
    ap.beta = m.az.beta + share * ap.beta;
    ap.e = m.az.e + share * ap.e;
    p = m.z + share * p;
    rs = next;
  }
  for (Pair& pair : made) keep(std::move(pair));
  return to;
}

// The pair of a whole step: p = step · d, y = r before − r after, which is (A + H) p with H
// averaged along the step. A pair with little curvature, or a negative one, would make M indefinite
// or huge, and is left out.
void ContactDirections::take(double step, const ContactDirection& direction, const Anchor& anchor,
                             const Residual& before, const Residual& after) {
  if (!corrects_ || before.image.rows() != after.image.rows()) return;
  Combination ap;
  ap.e = Points::Zero(direction.d.rows(), 3);
  ap.add(step, direction.ad);
  Pair pair{step * direction.d, std::move(ap), 0, before.r, before.image - after.image, 0};
  pair.with_r = pair.ap.with_r(anchor);
  pair.y.add(-1, after.r);
  const double curvature = pair.y.beta * pair.with_r + dot(pair.y.e, pair.p);
  if (!(curvature > least_curvature * pair.ap.norm(anchor, pair.p))) return;
  pair.scale = 1 / curvature;
  keep(std::move(pair));
}

}  // namespace knead
