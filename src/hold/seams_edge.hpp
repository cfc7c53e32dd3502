#pragma once

#include <vector>

#include "knead/hold/seams.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::seams {

/// The end of the domain at which an edge lies.
[[nodiscard]] double edge_end(const Surface& surface, SurfaceEdge edge);

/// `surface` and its derivatives at t = (x − lower)/length in [0, 1] along an edge.
[[nodiscard]] Expected<Evaluation<2>> evaluate_edge(const Surface& surface, SurfaceEdge edge,
                                                    std::span<const double> t, int order);

/// The derivative into the patch, across the edge, per parameter.
[[nodiscard]] Points inward(const Evaluation<2>& evaluation, SurfaceEdge edge);

/// p + 3 points per span, span ends included, and at least 24 in all: t ascending from 0 to 1.
[[nodiscard]] std::vector<double> edge_samples(const KnotVector& along);

}  // namespace knead::seams
