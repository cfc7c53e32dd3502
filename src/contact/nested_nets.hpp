#pragma once

#include <span>
#include <vector>

#include "knead/energy/domain_scaling.hpp"
#include "knead/energy/stiffness.hpp"

namespace knead {

/// Prolongations from nets of ever fewer control points to the one before, the first one to the
/// nets of the patches, patch after patch: knot insertion, so that every space of functions
/// contains the next (of rational patches their control points are related alike, which is the same
/// for constant weights).
///
/// A coarser net leaves out every second knot inside the domain in the directions where spans are
/// short: those whose mean span, in the units of the scaling, is at most 1.5 times the shortest of
/// the patch. Knots of multiplicity p and more stay, since functions may have creases there (not
/// those of degree 1, which are nothing else). It ends where there are at most `enough` control
/// points; empty if that cannot be reached by leaving out a quarter at least each time.
template <int D>
[[nodiscard]] std::vector<SparseMatrix> nested_prolongations(
    std::span<const Spline<D>> patches, std::span<const DomainScaling<D>> scalings, int enough);

}  // namespace knead
