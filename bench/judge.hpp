#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

namespace knead::bench {

/// Numbers by what was measured: instructions by kernel, times by benchmark.
using Measured = std::map<std::string, double>;

/// One sentence for every kernel whose count differs from the expected one by more than a share of
/// it, in either direction, and for every one that is in only one of the two. Empty: all as
/// expected.
[[nodiscard]] std::vector<std::string> unexpected_counts(const Measured& expected,
                                                         const Measured& counted, double share);

/// The benchmarks whose time in `head` exceeds that in `base` by more than a share of it, in every
/// round that both lists have. A benchmark that a round lacks in base or head is not judged:
/// nothing shows that it became slower.
[[nodiscard]] std::vector<std::string> slower_in_every_round(std::span<const Measured> base,
                                                             std::span<const Measured> head,
                                                             double share);

}  // namespace knead::bench
