#include "lab_curves.hpp"

#include <algorithm>
#include <cmath>

#include "knead/spline/basis.hpp"

namespace knead::lab {
namespace {

/// The same functions, plus `before` in front, on knots whose domain is their whole range: every
/// piece of every function can be evaluated from either side of its ends.
struct WholeLine {
  KnotVector knots;
  int before;

  static WholeLine of(const KnotVector& knots) {
    const int p = knots.degree();
    const auto x = knots.knots();
    const int before = p + 1 - knots.multiplicity(x.front()),
              after = p + 1 - knots.multiplicity(x.back());
    auto made = KnotVector::create(p, extended_knots(knots, before, after));
    return made ? WholeLine{std::move(*made), before}
                : WholeLine{knots, 0};  // it is valid: nothing else can fail
  }
};

class Sampler {
 public:
  Sampler(const KnotVector& knots, int order, int pixels)
      : whole_(WholeLine::of(knots)), knots_(knots), order_(order), pixels_(pixels) {}

  Curves run() {
    const int n = knots_.count();
    out_.offsets.push_back(0);
    for (int i = 0; i < n; ++i) {
      sample(i);
      out_.offsets.push_back(static_cast<std::int32_t>(out_.points.size() / 2));
      if (order_ > 0) add_impulses(i);
    }
    if (order_ == 0) measure_unity();
    return std::move(out_);
  }

 private:
  void add(double u, double value) {
    out_.points.push_back(u);
    out_.points.push_back(value);
    if (!std::isfinite(value)) return;
    out_.lowest = std::min(out_.lowest, value);
    out_.highest = std::max(out_.highest, value);
  }

  void sample(int i) {
    const int p = knots_.degree();
    for (int s = i; s <= i + p; ++s) {
      const double a = knots_[s], b = knots_[s + 1];
      if (a < b) sample_piece(i, a, b, p - order_);
    }
    const double end = knots_.knots().back(), support_end = knots_[i + p + 1];
    // Right of its support a repeated integral is a polynomial of degree times − 1.
    if (order_ < 0 && support_end < end) sample_piece(i, support_end, end, -order_ - 1);
  }

  /// A piece of this degree: a line needs two points.
  void sample_piece(int i, double a, double b, int degree) {
    const double length = whole_.knots.domain().length();
    constexpr int most = 120;
    const double wanted = std::ceil((b - a) / length * pixels_ / 5);
    const int segments = degree <= 1 ? 1 : static_cast<int>(std::clamp(wanted, 4.0, double(most)));
    for (int k = 0; k <= segments; ++k) {
      const double u = k == segments ? b : a + (b - a) * k / segments;
      add(u, value(i, u, k == segments ? Side::left : Side::right));
    }
  }

  [[nodiscard]] double value(int i, double u, Side side) const {
    if (order_ < 0) return basis_integral(knots_, i, -order_, u);
    return basis_function(whole_.knots, whole_.before + i, order_, u, side);
  }

  void add_impulses(int i) {
    const int p = knots_.degree();
    for (const KnotJumps& at : derivative_jumps(knots_, i)) {
      for (int k = std::max(0, order_ - 1 - p); k < order_; ++k) {
        const double weight = at.of_order(order_ - 1 - k, p);
        if (weight == 0) continue;
        out_.impulses.insert(out_.impulses.end(), {double(i), at.knot, double(k), weight});
        if (k == 0 && std::isfinite(weight))
          out_.largest_weight = std::max(out_.largest_weight, std::abs(weight));
      }
    }
  }

  void measure_unity() {
    std::vector<double> values(static_cast<std::size_t>(knots_.degree()) + 1);
    constexpr int parts = 8;
    for (const int s : knots_.spans()) {
      for (int k = 0; k <= parts; ++k) {
        const double a = knots_[s], b = knots_[s + 1];
        basis_values(knots_, s, k == parts ? b : a + (b - a) * k / parts, values.data());
        double sum = 0;
        for (const double v : values) sum += v;
        out_.unity = std::max(out_.unity, std::abs(sum - 1));
      }
    }
  }

  WholeLine whole_;
  const KnotVector& knots_;
  int order_, pixels_;
  Curves out_;
};

}  // namespace

Curves sample_curves(const KnotVector& knots, int order, int pixels) {
  return Sampler(knots, order, pixels).run();
}

std::vector<double> values_at(const KnotVector& knots, int order, double u) {
  std::vector<double> values(static_cast<std::size_t>(knots.count()));
  const WholeLine whole = WholeLine::of(knots);
  for (int i = 0; i < knots.count(); ++i) {
    values[static_cast<std::size_t>(i)] =
        order < 0 ? basis_integral(knots, i, -order, u)
                  : basis_function(whole.knots, whole.before + i, order, u);
  }
  return values;
}

}  // namespace knead::lab
