#pragma once

#include "kernels.hpp"
#include "lanes.hpp"

namespace knead::detail::KNEAD_ISA {

/// The positive recurrence for any degree up to 15: the same as `FixedRecurrence`, but on blocks of
/// rows in memory, one (k, l, s) at a time. Row `block` of every array is row 0 of the previous
/// block, which lies above: the carry.
class BlockedRecurrence {
  static constexpr int block = 32, padded = block + 8, max_K = max_kernel_degree + 1,
                       arrays = max_K * (max_K + 1) / 2;
  using Rows = double[padded];

 public:
  BlockedRecurrence(const KernelKnots& knots, int degree, const KernelOutput& out)
      : knots_(knots), out_(out), p_(degree), K_(degree + 1) {}

  void run() {
    const int rows = knots_.size - K_;
    for (int first = (rows + p_) / block * block; first >= 0; first -= block) {
      prepare(first);
      for (int m = 2; m <= 2 * K_; ++m) level(m);
      finish();
      if (first < rows) write(first, rows - first < block ? rows - first : block);
    }
  }

 private:
  template <class F>
  KNEAD_INLINE static void for_rows(F&& f) {
    for (int r = 0; r < block; r += lanes) f(r);
  }
  static int index(int k, int s) { return k * (k - 1) / 2 + s; }

  /// d(i + a, k) at the rows r, r + 1, …
  KNEAD_INLINE Lanes d(int r, int a, int k) const {
    return load(x_ + r + a + k) - load(x_ + r + a) + splat(k * splitting);
  }
  KNEAD_INLINE Lanes raw(int r, int a, int k) const {
    return load(x_ + r + a + k) - load(x_ + r + a);
  }

  void prepare(int first) {
    x_ = knots_.from(first);
    for (int k = 1; k < K_; ++k) {
      for_rows([&](int r) { store(reciprocal_[k] + r, 1.0 / d(r, 0, k)); });
    }
  }

  /// All S[k][l] with k + l = m; order K carries its support, as in FixedRecurrence.
  void level(int m) {
    Rows* now = level_[m % 2];
    const Rows* before = level_[(m + 1) % 2];
    for (int k = K_; k >= 1; --k) {
      const int l = m - k;
      if (l < 0 || l > K_ || (k == 1 && l < 2)) continue;
      for (int s = l == 0 ? 1 : 0; s < k; ++s) {
        if (k == K_ && l < K_ && s == 0) continue;  // never needed
        double* at = now[index(k, s)];
        at[block] = carry_[k][l][s];
        if (k == 2 && l == 0) {
          for_rows([&](int r) { store(at + r, load(reciprocal_[2] + r)); });
        } else if (k == 2 && l == 1 && s == 1) {
          for_rows([&](int r) { store(at + r, load(reciprocal_[2] + r)); });
        } else if (s == 0) {
          diagonal(k, l, before, at);
        } else {
          step(k, l, s, before, at);
        }
        carry_[k][l][s] = at[0];
      }
      keep(k, l, now);
    }
  }

  /// s = 0: S[k][l][0] = S[l][k-1][1] + S[k][l-1][1]; terms with s = 1 need an order of at least
  /// two.
  void diagonal(int k, int l, const Rows* before, double* at) const {
    const bool one = l >= 2, other = k >= 2;
    const double* a = before[index(l < 2 ? 2 : l, 1)];
    const double* b = before[index(k < 2 ? 2 : k, 1)];
    for_rows([&](int r) {
      Lanes v = splat(0);
      if (k == K_ && l == K_) {
        v = d(r, 0, K_) * (load(b + r) + load(b + r));
      } else {
        if (one) v = load(a + r);
        if (other) v = v + (l == K_ ? d(r, 0, K_) * load(b + r) : load(b + r));
      }
      store(at + r, v);
    });
  }

  void step(int k, int l, int s, const Rows* before, double* at) const {
    const bool inner = s <= k - 2, third = inner && l >= 1, outer = !(l == 0 && s == 1);
    const double* a = before[index(k, inner ? s + 1 : s)];
    const double* b = before[index(k - 1, inner ? s : 0)];
    const double* c = before[index(k - 1, s - 1)] + 1;
    for_rows([&](int r) {
      Lanes v = splat(0);
      if (third) v = l == K_ ? load(a + r) * d(r, s, K_) : load(a + r);
      const Lanes scale = k < K_ ? load(reciprocal_[k] + r) : splat(1);
      if (inner) v = v + d(r, 0, s) * scale * load(b + r);
      if (outer) v = v + d(r, s, k - s) * scale * load(c + r);
      store(at + r, v);
    });
  }

  /// The levels that make the output, with the masks of functions of lower order without support.
  void keep(int k, int l, const Rows* now) {
    if (k == p_ - 1 && l == p_ - 1) {
      for (int s = 0; s < k; ++s) {
        keep(now[index(k, s)], t2_[s], [&](int r, Lanes v) {
          return where_positive(where_positive(v, raw(r, 0, p_ - 1)), raw(r, s, p_ - 1));
        });
      }
    } else if (k == p_ && l == p_) {
      for (int s = 0; s < k; ++s) {
        keep(now[index(k, s)], t1_[s], [&](int r, Lanes v) {
          return where_positive(where_positive(v, raw(r, 0, p_)), raw(r, s, p_));
        });
      }
    } else if (k == p_ && l == K_) {
      for (int s = 0; s < k; ++s) {
        keep(now[index(k, s)], cross_[s],
             [&](int r, Lanes v) { return where_positive(v, raw(r, 0, p_)); });
      }
    } else if (k == K_ && l == K_) {
      for (int s = 0; s < k; ++s) keep(now[index(k, s)], full_[s], [](int, Lanes v) { return v; });
    }
  }
  template <class Mask>
  KNEAD_INLINE static void keep(const double* from, double* to, Mask&& masked) {
    to[block] = to[0];
    for_rows([&](int r) { store(to + r, masked(r, load(from + r))); });
  }

  /// D(t)_s(i) = t_s(i) − t_{s+1}(i) − t_{s−1}(i+1) + t_s(i+1), t_{−1}(i+1) read as t_1(i); t_s is
  /// zero from `count` on.
  KNEAD_INLINE static Lanes difference(const Rows* t, int s, int count, int r) {
    const auto here = [&](int q) { return q < count ? load(t[q] + r) : splat(0); };
    const auto next = [&](int q) { return q < count ? load(t[q] + r + 1) : splat(0); };
    if (s == 0) return here(0) + next(0) - (here(1) + here(1));
    return (here(s) - here(s + 1)) + (next(s) - next(s - 1));
  }

  void finish() {
    const double factor = factors(p_).g22;
    for (int s = 0; s < p_; ++s) {
      q_[s][block] = q_[s][0];
      for_rows([&](int r) {
        const Lanes here = where_positive(1.0 / d(r, 0, p_), raw(r, 0, p_));
        const Lanes there = where_positive(1.0 / d(r, s, p_), raw(r, s, p_));
        store(q_[s] + r, factor * here * there * difference(t2_, s, p_ - 1, r));
      });
    }
  }

  void write(int first, int rows) const {
    const Factors factor = factors(p_);
    for (int s = 0; s <= p_; ++s) {
      const auto at = [&](int term) {
        return out_.g[term] + static_cast<std::size_t>(s) * out_.stride[term] + first;
      };
      for (int r = 0; r < rows; r += lanes) {
        // Exactly zero where supports do not overlap, whatever the splitting gave.
        const Lanes overlap = load(x_ + r + K_) - load(x_ + r + s);
        const auto put = [&](double* to, Lanes v) { store(to, where_positive(v, overlap)); };
        put(at(0) + r, load(full_[s] + r) * factor.g00);
        put(at(1) + r, difference(t1_, s, p_, r) * factor.g11);
        put(at(2) + r, difference(q_, s, p_, r));
        if (s == 0) {
          store(at(3) + r, 0.5 * (where_positive(splat(1), raw(r, 0, p_)) -
                                  where_positive(splat(1), raw(r, 1, p_))));
        } else {
          const Lanes here = s < p_ ? load(cross_[s] + r) : splat(0);
          const Lanes value = (here - load(cross_[s - 1] + r + 1)) * factor.g10;
          put(at(3) + r, value);
          put(out_.lower10[s - 1] + first + r, -value);
        }
      }
    }
  }

  const KernelKnots& knots_;
  const KernelOutput& out_;
  const int p_, K_;
  const double* x_ = nullptr;
  Rows level_[2][arrays] = {};
  Rows reciprocal_[max_K] = {};
  Rows t1_[max_K] = {}, t2_[max_K] = {}, cross_[max_K] = {}, full_[max_K] = {}, q_[max_K] = {};
  double carry_[max_K + 1][max_K + 1][max_K] = {};
};

}  // namespace knead::detail::KNEAD_ISA
