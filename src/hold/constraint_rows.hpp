#pragma once

#include <string>
#include <utility>
#include <vector>

#include "knead/hold/constraints.hpp"

namespace knead::detail {

// Weights that are proportional up to the rounding of their decimals.
inline constexpr double proportional = 1e-7;

using Terms = std::vector<std::pair<int, double>>;

/// A net seen across lines of one direction: i counts along `direction`, j along the lines.
class NetAcross {
 public:
  NetAcross(const Surface& s, int direction) : surface_(s), direction_(direction) {}

  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] const KnotVector& knots() const { return surface_.knots(direction_); }
  [[nodiscard]] const KnotVector& knots_along() const { return surface_.knots(1 - direction_); }
  [[nodiscard]] int rows() const { return knots().count(); }
  [[nodiscard]] int columns() const { return knots_along().count(); }
  [[nodiscard]] int index(int i, int j) const {
    return direction_ == 0 ? i * columns() + j : j * rows() + i;
  }
  [[nodiscard]] Point point(int i, int j) const {
    return surface_.control_points().row(index(i, j)).transpose();
  }
  [[nodiscard]] double weight(int i, int j) const {
    return surface_.rational() ? surface_.weights()[static_cast<std::size_t>(index(i, j))] : 1;
  }
  [[nodiscard]] MultiIndex<2> derivative(int across, int along) const {
    return direction_ == 0 ? MultiIndex<2>{across, along} : MultiIndex<2>{along, across};
  }

 private:
  const Surface& surface_;
  int direction_;
};

/// Basis functions and their derivatives at one parameter of one span.
struct LocalBasis {
  int first;  ///< index of the first function
  int degree;
  std::vector<double> values;

  LocalBasis(const KnotVector& knots, int span, double u, int order);
  /// N_i^(order), 0 for functions that vanish here.
  [[nodiscard]] double at(int i, int order) const {
    const int r = i - first;
    if (r < 0 || r > degree) return 0;
    return values[static_cast<std::size_t>(order * (degree + 1) + r)];
  }
  [[nodiscard]] int last() const { return first + degree; }
};

/// The spans at c: one, or the ones to its left and right where the derivative of the given order
/// may jump at c.
[[nodiscard]] std::vector<int> spans_at(const KnotVector& knots, double c, int order);

/// R_ij at (u, v) in the given spans, or with `along` 0 or 1 its derivative in that direction.
/// `denominator` (W) may be null. Errors: W is not positive (numerical).
[[nodiscard]] Expected<Terms> rational_row(const Surface& s, double u, double v, int span_u,
                                           int span_v, int along = -1,
                                           double* denominator = nullptr);

/// Appends a condition with zero right side: zero coefficients are omitted, the others divided by
/// the largest; a single control point without a normal becomes held. Appends nothing if all are
/// zero.
void append(ConstraintList& to, const std::string& name, Terms terms,
            const std::optional<Point>& normal = {});

/// Rows of which all others are combinations, ascending, and the largest |r|_1 of the others'
/// remainders.
struct SelectedRows {
  std::vector<int> chosen;
  double remainder = 0;
};
/// None of no rows, nor of rows without unknowns. Errors (numerical): a coefficient is not a finite
/// number.
///
/// Chosen such that every other row r is a combination of them up to a remainder with |r|_1 <=
/// tolerance: |Σ r X| is then at most that times the largest |X|.
[[nodiscard]] Expected<SelectedRows> select_rows(const std::vector<Terms>& rows, double tolerance);

[[nodiscard]] Expected<void> check_parameter(const KnotVector& knots, double u, const char* name);
[[nodiscard]] Expected<void> check_tolerance(double tolerance, const char* name);

}  // namespace knead::detail
