#pragma once

#include "describe/describe.hpp"
#include "session_state.hpp"

namespace knead {

/// Its document is left out, as are the parts of surfaces that faces show and the courses of edges,
/// which follow from it.
template <>
const Type& type_of<Scene>();
template <>
const Type& type_of<SessionState>();
template <>
const Type& type_of<StepRecord>();

// Parts of it that are reported as well.
void describe(ShellMaterial& m, Fields& fields);
void describe(FundamentalMaterial& m, Fields& fields);
void describe(StepRecord& s, Fields& fields);
/// What reports say of a step: all but the surface and the iterations.
void describe_figures(StepRecord& s, Fields& fields);
std::span<const Choice> choices(SeamContinuity);

}  // namespace knead
