#include "contact_factor.hpp"

#include <utility>

#include "base/interruption.hpp"

namespace knead {
namespace {

// Of A + H: a cubic net of 100 × 100 has 4.3 million. There a factor takes 300 MB, and as long as
// hundreds of conjugate gradients; on larger nets it takes longer.
constexpr std::ptrdiff_t most_factor_entries = 5'000'000;
// A row of A with so many entries, twice those of degree 5, is dense: no order saves anything of
// the 9 n³ operations of a factor over all coordinates, and a substitution on the whole net takes 6
// n². Below these it is worth hundreds of them.
constexpr std::ptrdiff_t dense_row = 200, most_dense_entries = 1'500'000;
constexpr int most_factor_rounds = 6;
// Of conjugate gradients: more of them, and a new factor is cheaper.
constexpr int most_factor_iterations = 8;
constexpr double least_gain = 0.5;  // of the residual: a round that leaves more has met rounding
// Of the first residual: a factor that leaves more has no digits.
constexpr double poor_direction = 0.1;

}  // namespace

// A + H over coordinates has 9 times the entries of A on one, since H couples x, y and z of points;
// where constraints couple coordinates, A ⊗ I is what was factored, with 3 times as many as A.
bool ContactFactor::is_possible(const StepProblem& problem) {
  const ConstrainedCholesky* inverse = problem.inverse.factor();
  if (problem.source == nullptr || inverse == nullptr) return false;
  const bool dense = inverse->entries() > dense_row * inverse->space().free_count();
  const std::ptrdiff_t entries = (inverse->space().coupled() ? 3 : 9) * inverse->entries();
  return entries <= (dense ? most_dense_entries : most_factor_entries);
}

ContactFactor::ContactFactor(const StepProblem& problem, const Potential& potential)
    : potential_(potential),
      space_(problem.inverse.space().on_coordinates()),
      places_(problem.source->places()),
      system_(with_coordinate_blocks(problem.source->a())) {}

// Order and restriction serve from one factor to the next. They are made anew only where a block of
// H needs entries that the pattern does not have.
bool ContactFactor::factor(const PotentialState& state) {
  system_.clear();
  potential_.each_hessian_block(state,
                                [this](std::span<const int> points, const Eigen::MatrixXd& block) {
                                  system_.add(points, block);
                                });
  if (system_.renewed()) restriction_.emplace(space_, system_.sum(), &places_);
  inverse_.reset();
  auto factored = ConstrainedCholesky::factor(system_.sum(), space_, *restriction_);
  if (!factored) return false;
  inverse_.emplace(std::move(*factored));
  factored_ = state;
  subset_ = {};
  return true;
}

/// z = M ρ, and A z.
///
/// With ρ = β r + E e and s = A⁻¹ρ known in the neighbourhood, (A + H₀) z = ρ is z = s − M (H₀ s),
/// as (A + H₀) s = ρ + H₀ s. The right side H₀ s is zero outside: one solve within the part. A z =
/// ρ − H₀ z needs no product with A.
ContactDirection ContactFactor::precondition(const Residual& rest,
                                             ContactNeighbourhood& near) const {
  ContactDirection to{rest.r, {}, 0};
  if (rest.r.beta != 0) {
    to.d = rest.image - inverse_->solve_within(subset_, near.hessian(factored_, rest.image));
  } else {
    to.d = inverse_->solve_within(subset_, rest.r.e);
  }
  to.ad.e -= near.hessian(factored_, to.d);
  return to;
}

/// A d for what lowers the residual to `target` of its square.
/// \param enough Whether it does.
///
/// M is the inverse of A + H₀, so that iterations count what has come into contact or left it since
/// H₀; eight of them cost about what a new factor does.
Combination ContactFactor::conjugate_gradients(const PotentialState& state, const Anchor& anchor,
                                               ContactNeighbourhood& near, Residual rest,
                                               double target, bool& enough, int& solves) const {
  Combination sum{0, Points::Zero(near.size(), 3)};
  ContactDirection p;
  double before = 0;
  enough = false;
  for (int iteration = 0; iteration < most_factor_iterations; ++iteration) {
    const ContactDirection m = precondition(rest, near);
    const double product = rest.r.beta * m.ad.with_r(anchor) + dot(rest.r.e, m.d);
    if (iteration == 0) {
      p = m;
    } else {
      const double share = product / before;
      p.d = m.d + share * p.d;
      p.ad.beta = m.ad.beta + share * p.ad.beta;
      p.ad.e = m.ad.e + share * p.ad.e;
    }
    before = product;
    const Points hp = near.hessian(state, p.d);
    const double pap = p.ad.norm(anchor, p.d), curvature = pap + dot(p.d, hp);
    if (!(curvature > 1e-12 * pap) || !(product > 0)) return sum;
    const double step = product / curvature;
    sum.add(step, p.ad);
    rest.r.add(-step, p.ad);
    rest.r.e -= step * hp;
    rest.measure(anchor, near);
    solves += 2;
    enough = rest.squared <= target;
    if (enough) break;
  }
  return sum;
}

// Iterative refinement (Wilkinson 1963; Higham 2002, ch. 12): each round solves for the residual
// that the rounds before left, computed from d itself. A round that does not halve it with a fresh
// factor has met rounding; with an old one, the factor is to blame and is made anew. A digit is
// asked for at least; where it is not reached, conjugate gradients continue alone.
bool ContactFactor::find(const PotentialState& state, const Anchor& anchor,
                         ContactNeighbourhood& near, Residual rest, double tolerance,
                         ContactDirection& to, int& solves) {
  to.ad = {0, Points::Zero(near.size(), 3)};
  to.d = to.ad.e;
  const double first = rest.squared, target = tolerance * tolerance * first;
  bool fresh = false;
  if (inverse_ && !near.contains(factored_)) inverse_.reset();
  for (int round = 0; round < most_factor_rounds && !(rest.squared <= target); ++round) {
    if (Interruption::asked_for()) return false;
    if (!inverse_) {
      if (!factor(state)) return false;
      fresh = true;
      ++solves;
    }
    if (subset_.points != near.subset().points) subset_ = inverse_->subset(near.subset().points);
    bool enough = false;
    const Combination ad = conjugate_gradients(state, anchor, near, rest, target, enough, solves);
    const Points d = ad.image(anchor, near);
    Residual next{rest.r, {}, 0};
    next.r.add(-1, ad);
    next.r.e -= near.hessian(state, d);
    next.measure(anchor, near);
    solves += 2;
    const bool gains = next.squared < least_gain * least_gain * rest.squared;
    if (gains) {
      to.ad.add(1, ad);
      to.d += d;
      rest = std::move(next);
    }
    if (fresh && !gains) break;
    if (!fresh && (!gains || !enough)) inverse_.reset();
  }
  return rest.squared <= poor_direction * poor_direction * first;
}

}  // namespace knead
