#include "analytic.hpp"

#include "methods.hpp"

namespace knead::detail {

BandMatrix analytic_gramian(const KnotVector& knots, int a, int b) {
  const int p = knots.degree();
  BandMatrix result(knots.count(), p, symmetry_of(a, b));
  if (a > p || b > p) return result;
  Analytic<> analytic(knots);
  analytic.accumulate(a, b, [&](int i, int j, double value) { result.at(i, j) += value; });
  // Integrals of j extend only from the left, so the formula covers i <= j; the lower half is the
  // upper one of G^ba.
  if (a != b) {
    analytic.accumulate(b, a, [&](int i, int j, double value) {
      if (i != j) result.at(j, i) += value;
    });
  }
  return result;
}

}  // namespace knead::detail
