#pragma once

#include <functional>

#include "knead/base/error.hpp"

namespace knead {

/// Lets whoever starts a long computation end it early. While one exists, computations of the same
/// thread ask it now and then whether to go on: within iterations, factorisations and the
/// integration of forces. After the first no they return as soon as they can, with an error or with
/// values that mean nothing: whoever made it then throws away what they made. Only the innermost
/// one is asked.
class Interruption {
 public:
  /// \param go_on is asked often and should take no longer than reading a flag; empty: computations
  /// go on.
  explicit Interruption(std::function<bool()> go_on);
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;
  ~Interruption();

  /// Whether the answer has been no.
  [[nodiscard]] bool happened() const { return happened_; }
  /// Whether the innermost one of this thread says no, now or before; false without one.
  [[nodiscard]] static bool asked_for();
  /// What follows is to be computed even so: asks no more.
  static void settle();

 private:
  std::function<bool()> go_on_;
  bool happened_ = false;
  Interruption* outer_;
};

/// The error of what was interrupted.
[[nodiscard]] std::unexpected<Error> interrupted_error();

}  // namespace knead
