#pragma once

namespace knead::detail {

/// A number of about 106 bits: the sum of two doubles, the second at most half an ulp of the first.
/// Made of additions, multiplications and divisions of doubles, none of them fused, so it has the
/// same bits on every machine.
///
/// Sums, products and quotients are right to 2^-100 relative to the result, as long as no
/// intermediate result leaves the range of doubles: factors below 2^996, products above 2^-960
/// (below, they lose digits down to those of a double). Sources: T. J. Dekker (1971) for products;
/// M. Joldes, J.-M. Muller, V. Popescu, Tight and rigorous error bounds for basic building blocks
/// of double-word arithmetic (2017), for the rest.
struct DoubleDouble {
  double high, low;

  DoubleDouble() = default;
  constexpr DoubleDouble(double x)
      : high(x), low(0) {}  // NOLINT(google-explicit-constructor): every double is one
  constexpr DoubleDouble(double first, double second) : high(first), low(second) {}
  explicit constexpr operator double() const { return high; }

  /// a + b without error.
  static constexpr DoubleDouble sum(double a, double b) {
    const double s = a + b, of_b = s - a;
    return {s, (a - (s - of_b)) + (b - of_b)};
  }
  /// a b without error: the factors are split into halves of 26 bits, whose products are exact.
  static constexpr DoubleDouble product(double a, double b) {
    const auto upper = [](double x) {
      const double shifted = 0x1.0000002p27 * x;
      return shifted - (shifted - x);
    };
    const double p = a * b, a1 = upper(a), a2 = a - a1, b1 = upper(b), b2 = b - b1;
    return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
  }

  friend constexpr DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
    const DoubleDouble upper = sum(a.high, b.high), lower = sum(a.low, b.low);
    const DoubleDouble once = ordered(upper.high, upper.low + lower.high);
    return ordered(once.high, once.low + lower.low);
  }
  friend constexpr DoubleDouble operator-(DoubleDouble a) { return {-a.high, -a.low}; }
  friend constexpr DoubleDouble operator-(DoubleDouble a, DoubleDouble b) { return a + -b; }
  friend constexpr DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
    const DoubleDouble p = product(a.high, b.high);
    return ordered(p.high, p.low + (a.high * b.low + a.low * b.high));
  }
  friend constexpr DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
    const double quotient = a.high / b.high;
    const DoubleDouble p = quotient * b;
    return ordered(quotient, ((a.high - p.high) - p.low + a.low) / b.high);
  }
  /// Of small integers and the like: quicker.
  friend constexpr DoubleDouble operator*(double a, DoubleDouble b) {
    const DoubleDouble p = product(a, b.high);
    return ordered(p.high, p.low + a * b.low);
  }
  friend constexpr DoubleDouble operator/(DoubleDouble a, double b) {
    const double quotient = a.high / b;
    const DoubleDouble p = product(quotient, b);
    return ordered(quotient, (((a.high - p.high) - p.low) + a.low) / b);
  }
  DoubleDouble& operator+=(DoubleDouble b) { return *this = *this + b; }

 private:
  /// a + b without error for |a| >= |b|.
  static constexpr DoubleDouble ordered(double a, double b) {
    const double s = a + b;
    return {s, b - (s - a)};
  }
};

}  // namespace knead::detail
