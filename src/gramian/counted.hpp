#pragma once

#include <cmath>

#include "operation_count.hpp"

namespace knead {

/// A double that counts the operations done with it, per thread: templates are run on it to measure
/// their cost. Comparisons, copies and sign changes are not counted.
struct Counted {
  double value;

  Counted() = default;
  Counted(double x) : value(x) {}  // NOLINT(google-explicit-constructor): it stands in for a double
  explicit operator double() const { return value; }

  /// The count of this thread; assign {} to reset.
  static OperationCount& count() {
    static thread_local OperationCount operations;
    return operations;
  }

  friend Counted operator+(Counted a, Counted b) {
    return ++count().additions, Counted(a.value + b.value);
  }
  friend Counted operator-(Counted a, Counted b) {
    return ++count().additions, Counted(a.value - b.value);
  }
  friend Counted operator*(Counted a, Counted b) {
    return ++count().multiplications, Counted(a.value * b.value);
  }
  friend Counted operator/(Counted a, Counted b) {
    return ++count().divisions, Counted(a.value / b.value);
  }
  friend Counted operator-(Counted a) { return -a.value; }
  friend Counted root(Counted a) { return ++count().divisions, Counted(std::sqrt(a.value)); }
  Counted& operator+=(Counted b) { return *this = *this + b; }
  Counted& operator-=(Counted b) { return *this = *this - b; }
  Counted& operator*=(Counted b) { return *this = *this * b; }
  friend bool operator>(Counted a, Counted b) { return a.value > b.value; }
};

}  // namespace knead
