#include <algorithm>
#include <cassert>
#include <cmath>

#include "knead/hold/seams.hpp"
#include "seams_space.hpp"

namespace knead {
namespace {

using seams::InnerKnot;

/// The target of one direction of a patch.
struct Target {
  int degree = 0;
  std::vector<InnerKnot> inner;
};

std::vector<InnerKnot> mirrored(std::vector<InnerKnot> inner, bool mirror) {
  if (!mirror) return inner;
  std::ranges::reverse(inner);
  for (InnerKnot& k : inner) k.t = 1 - k.t;
  return inner;
}

/// Extends `target` to contain `other`; true if that changed it.
///
/// A degree raised by one raises every multiplicity by one, or the space would not contain the old
/// one.
bool take_over(Target& target, const Target& other, bool mirror, double agreement) {
  bool changed = false;
  if (other.degree > target.degree) {
    for (InnerKnot& k : target.inner) k.multiplicity += other.degree - target.degree;
    target.degree = other.degree;
    changed = true;
  }
  std::vector<InnerKnot> wanted = mirrored(other.inner, mirror);
  for (InnerKnot& k : wanted) k.multiplicity += target.degree - other.degree;
  const auto pairs = seams::matching_knots(target.inner, wanted, agreement);
  std::size_t pair = 0;
  std::vector<InnerKnot> missing;
  for (std::size_t j = 0; j < wanted.size(); ++j) {
    if (pair < pairs.size() && pairs[pair].second == j) {
      InnerKnot& stored = target.inner[pairs[pair++].first];
      if (stored.multiplicity >= wanted[j].multiplicity) continue;
      stored.multiplicity = wanted[j].multiplicity;
    } else {
      missing.push_back(wanted[j]);
    }
    changed = true;
  }
  target.inner.insert(target.inner.end(), missing.begin(), missing.end());
  std::ranges::stable_sort(target.inner, {}, &InnerKnot::t);
  return changed;
}

}  // namespace

// The least spaces that contain both sides at every whole seam, as a fixed point. Knots that stand
// keep their bits, and new ones are measured from the nearer end, as `normalised_knots` does, so
// that mirrored edges get mirrored knots.
std::vector<SeamRefinement> seam_refinements(std::span<const Surface* const> patches,
                                             std::span<const Seam> seams, double agreement) {
  std::vector<std::array<Target, 2>> targets;
  for (const Surface* patch : patches) {
    std::array<Target, 2> pair;
    for (int d = 0; d < 2; ++d) {
      const KnotVector& knots = patch->knots(d);
      pair[static_cast<std::size_t>(d)] = {
          knots.degree(), seams::inner_knots(seams::normalised_knots(knots, false))};
    }
    targets.push_back(std::move(pair));
  }
  const auto target = [&](const PatchEdge& e) -> Target& {
    assert(e.patch >= 0 && static_cast<std::size_t>(e.patch) < patches.size());
    return targets[static_cast<std::size_t>(e.patch)][static_cast<std::size_t>(edge_along(e.edge))];
  };
  // Each pass carries knots one seam further. The only maps are t and 1 − t, so at most the
  // mirrored union appears.
  for (bool changed = true; changed;) {
    changed = false;
    for (const Seam& seam : seams) {
      if (seam.kind != SeamKind::whole) continue;
      changed = take_over(target(seam.a), target(seam.b), seam.reversed, agreement) || changed;
      changed = take_over(target(seam.b), target(seam.a), seam.reversed, agreement) || changed;
    }
  }

  std::vector<SeamRefinement> refinements;
  for (std::size_t patch = 0; patch < patches.size(); ++patch) {
    for (int d = 0; d < 2; ++d) {
      const KnotVector& knots = patches[patch]->knots(d);
      const Interval domain = knots.domain();
      const Target& wanted = targets[patch][static_cast<std::size_t>(d)];
      SeamRefinement refinement{static_cast<int>(patch), d, wanted.degree - knots.degree(), {}};
      std::vector<double> own_values;  // values of the inner knots, bit for bit
      for (double x : knots.knots()) {
        if (x > domain.lower && x < domain.upper && (own_values.empty() || own_values.back() != x))
          own_values.push_back(x);
      }
      const auto inner = seams::inner_knots(seams::normalised_knots(knots, false));
      for (const InnerKnot& k : wanted.inner) {
        const auto at = std::ranges::find(inner, k.t, &InnerKnot::t);
        const bool stands = at != inner.end();
        const double value = stands ? own_values[static_cast<std::size_t>(at - inner.begin())]
                                    : (k.t < 0.5 ? domain.lower + k.t * domain.length()
                                                 : domain.upper - (1 - k.t) * domain.length());
        const int already = stands ? at->multiplicity + refinement.elevate : 0;
        refinement.insert.insert(refinement.insert.end(),
                                 static_cast<std::size_t>(k.multiplicity - already), value);
      }
      if (refinement.elevate > 0 || !refinement.insert.empty())
        refinements.push_back(std::move(refinement));
    }
  }
  return refinements;
}

}  // namespace knead
