#pragma once

namespace knead::cli {

/// Whether a command that ran well has found what it was asked to look for, a fault: the program
/// then ends with the exit code 1. False when the program starts.
void set_negative_outcome(bool negative);
[[nodiscard]] bool negative_outcome();

}  // namespace knead::cli
