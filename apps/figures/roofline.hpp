#pragma once

#include <functional>
#include <string>
#include <vector>

#include "figures/figures.hpp"

namespace knead::figures {

/// A kernel of the library with what one run of it computes, and what it has to move at least.
struct RooflineKernel {
  std::string name;
  double operations = 0;  ///< additions and multiplications, divisions and roots as one each
  /// Of arguments read once and results written once; tables of one direction are left out.
  double bytes = 0;
  std::function<void()> run;
};

/// Evaluation of a bicubic net of 32 × 32 on a grid of points² points; K of a cubic net of net²
/// with all six terms, assembled, applied and multiplied; substitution with its factor; four
/// Gramians of 10,000 functions.
[[nodiscard]] std::vector<RooflineKernel> roofline_kernels(int points = 500, int net = 128);

/// What one thread of this machine does at most.
struct Machine {
  double memory = 0;  ///< bytes per second, read and written in equal parts, of arrays of 64 MB
  double cache = 0;   ///< the same of 128 kB
  double peak = 0;  ///< additions and multiplications per second in vectors of the best instruction
                    ///< set, not fused
};
[[nodiscard]] Machine measured_machine();

/// The shortest of some runs in this thread, by the processor's clock: what else runs on the
/// machine counts little.
[[nodiscard]] double shortest_seconds(const std::function<void()>& run);

/// A picture and a table of both, measured in this run in one thread.
void add_roofline(Report& report);

}  // namespace knead::figures
