#include "separable_patch.hpp"

#include <cmath>

namespace knead::detail {
namespace {

constexpr int halves = 256;

/// s^k for small whole k >= 0.
double power(double s, int k) {
  double r = 1;
  for (; k > 0; --k) r *= s;
  return r;
}

}  // namespace

/// The monotone factors of all derivatives; a power with exponent 0 is 1, also at σ = 0.
/// Every derivative is a sum of products of such factors, each monotone in σ: their values at the
/// ends of an interval bound them on it exactly, and products of intervals bound the derivative
/// tightly, where interval arithmetic on powers would overestimate.
struct MonotoneCurve::Factors {
  double x, y;    ///< X, Y
  double w1, w2;  ///< w^(−1/p−1), w^(−1/p−2), w = 1 + s^p; they fall
  double z1, z2;  ///< σ^(mp−1), σ^(mp−2); they rise
  double zz2;     ///< σ^(2mp−2)
  double m1, m2;  ///< σ^(m−1), σ^(m−2)
  double zm2;     ///< σ^(mp+m−2)
  double r1 = 0, r2 = 0;  ///< for bounds: σ^(mp−1−k), σ^(m−1−k), k the smaller of mp − 1 and m − 1,
                          ///< where that is > 0
};

MonotoneCurve MonotoneCurve::segment(const Vector2& from, const Vector2& to) {
  MonotoneCurve c;
  c.origin_ = from;
  c.size_ = to - from;
  return c;
}

MonotoneCurve MonotoneCurve::arc(const Vector2& centre, const Vector2& size, double exponent,
                                 bool exchanged) {
  MonotoneCurve c;
  c.straight_ = false;
  c.exchanged_ = exchanged;
  c.origin_ = centre;
  c.size_ = size;
  c.p_ = 2 / exponent;
  c.m_ = c.p_ >= 2 || c.p_ == 1 ? 1 : static_cast<int>(std::ceil(exponent));
  std::vector<Factors> table;
  for (int k = 0; k <= halves; ++k)
    table.push_back(c.computed(static_cast<double>(k) / halves, true));
  c.table_ = std::make_shared<const std::vector<Factors>>(std::move(table));
  return c;
}

/// A search halves [0, 1] again and again: what it asks for was computed when the curve was made,
/// but for descents.
MonotoneCurve::Factors MonotoneCurve::factors(double sigma, bool bounds) const {
  const double place = sigma * halves;
  const int k = static_cast<int>(place);
  return k == place ? (*table_)[static_cast<std::size_t>(k)] : computed(sigma, bounds);
}

MonotoneCurve::Factors MonotoneCurve::computed(double sigma, bool bounds) const {
  Factors f;
  const double mp = m_ * p_, s = power(sigma, m_);
  if (const double k = std::min<double>(mp, m_) - 1; k > 0 && bounds) {
    f.r1 = std::pow(sigma, mp - 1 - k);
    f.r2 = std::pow(sigma, m_ - 1 - k);
  }
  f.m1 = power(sigma, m_ - 1);
  f.m2 = m_ >= 2 ? power(sigma, m_ - 2) : 0;
  if (sigma < 1e-100) {
    f.x = f.w1 = f.w2 = 1;
    f.y = s;
    f.z1 = mp == 1 ? 1 : 0;
    f.z2 = mp == 2 ? 1 : 0;
    f.zz2 = f.zm2 = mp == 1 ? 1 : 0;
    return f;
  }
  const bool round = p_ == 2;
  const double z = round ? sigma * sigma : std::pow(sigma, mp), w = 1 + z;
  f.x = round ? 1 / std::sqrt(w) : std::pow(w, -1 / p_);
  f.y = s * f.x;
  f.w1 = f.x / w;
  f.w2 = f.w1 / w;
  f.z1 = z / sigma;
  f.z2 = f.z1 / sigma;
  f.zz2 = f.z1 * f.z1;
  f.zm2 = f.z1 * f.m1;
  return f;
}

std::array<MonotoneCurve::Vector2, 3> MonotoneCurve::at(double sigma) const {
  if (straight_) return {origin_ + sigma * size_, size_, Vector2::Zero()};
  const Factors f = factors(sigma, false);
  const double m = m_, mp = m * p_;
  std::array<Vector2, 3> c = {Vector2(f.x, f.y), m * f.w1 * Vector2(-f.z1, f.m1),
                              Vector2(-m * (mp - 1) * f.z2 * f.w1 + m * m * (p_ + 1) * f.zz2 * f.w2,
                                      m * (m - 1) * f.m2 * f.w1 - m * m * (p_ + 1) * f.zm2 * f.w2)};
  for (Vector2& d : c) {
    if (exchanged_) std::swap(d[0], d[1]);
    d = d.cwiseProduct(size_).eval();
  }
  c[0] += origin_;
  return c;
}

std::array<std::array<Range, 2>, 4> MonotoneCurve::over(const Range& sigma) const {
  std::array<std::array<Range, 2>, 4> r;
  if (straight_) {
    for (int k = 0; k < 2; ++k) {
      const auto c = static_cast<std::size_t>(k);
      r[0][c] = size_[k] * sigma + origin_[k];
      r[1][c] = r[3][c] = {size_[k], size_[k]};
    }
    return r;
  }
  const Factors a = factors(sigma.lower, true), b = factors(sigma.upper, true);
  const double m = m_, mp = m * p_;
  const Range w1 = {b.w1, a.w1}, w2 = {b.w2, a.w2};
  r[0] = {Range{b.x, a.x}, Range{a.y, b.y}};
  r[1] = {-m * (Range{a.z1, b.z1} * w1), m * (Range{a.m1, b.m1} * w1)};
  r[2] = {m * m * (p_ + 1) * (Range{a.zz2, b.zz2} * w2),
          -m * m * (p_ + 1) * (Range{a.zm2, b.zm2} * w2)};
  if (mp != 1) r[2][0] = r[2][0] + -m * (mp - 1) * (Range{a.z2, b.z2} * w1);
  if (m_ > 1) r[2][1] = r[2][1] + m * (m - 1) * (Range{a.m2, b.m2} * w1);
  r[3] = r[1];
  if (std::min(mp, m) > 1) r[3] = {-m * (Range{a.r1, b.r1} * w1), m * (Range{a.r2, b.r2} * w1)};
  for (std::size_t d = 0; d < 4; ++d) {
    if (exchanged_) std::swap(r[d][0], r[d][1]);
    for (int k = 0; k < 2; ++k) {
      Range& c = r[d][static_cast<std::size_t>(k)];
      c = size_[k] * c;
      if (d == 0) c = c + origin_[k];
    }
  }
  return r;
}

PatchBounds SeparablePatch::bounds(const ParameterRectangle& at) const {
  const auto f = meridian_.over(at.side[0]), g = parallel_.over(at.side[1]);
  constexpr std::array<std::array<std::size_t, 2>, 6> order = {
      {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};
  PatchBounds b;
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [du, dv] = order[k];
    const std::array<Range, 3> c = {f[du][0] * g[dv][0], f[du][0] * g[dv][1],
                                    dv == 0 ? f[du][1] : Range{0, 0}};
    for (std::size_t a = 0; a < 3; ++a) {
      const auto i = static_cast<Eigen::Index>(a);
      b[k].axis[static_cast<std::size_t>(axes_[a])] =
          scale_[i] * c[a] + (k == 0 ? offset_[i] : 0.0);
    }
  }
  // f >= 0 is a common factor of S_v.
  const std::array<Range, 3> along = {f[3][0] * g[0][0], f[3][0] * g[0][1], f[3][1]};
  const std::array<Range, 3> round = {g[3][0], g[3][1], Range{0, 0}};
  for (std::size_t a = 0; a < 3; ++a) {
    const double s = scale_[static_cast<Eigen::Index>(a)];
    b[6].axis[static_cast<std::size_t>(axes_[a])] = s * along[a];
    b[7].axis[static_cast<std::size_t>(axes_[a])] = s * round[a];
  }
  return b;
}

PatchJet SeparablePatch::jet(double u, double v) const {
  const auto f = meridian_.at(u), g = parallel_.at(v);
  constexpr std::array<std::array<std::size_t, 2>, 6> order = {
      {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};
  PatchJet j;
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [du, dv] = order[k];
    const Point c(f[du][0] * g[dv][0], f[du][0] * g[dv][1], dv == 0 ? f[du][1] : 0.0);
    for (int a = 0; a < 3; ++a) {
      j[k][axes_[static_cast<std::size_t>(a)]] = scale_[a] * c[a] + (k == 0 ? offset_[a] : 0.0);
    }
  }
  return j;
}

}  // namespace knead::detail
