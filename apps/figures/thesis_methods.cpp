#include "figures/thesis_methods.hpp"

#include <algorithm>
#include <cassert>

#include "base/gauss_legendre.hpp"
#include "gramian/counted.hpp"

namespace knead::figures {
namespace {

constexpr int orders = max_degree + 1, highest = 2 * max_degree + 1;
using Row = std::array<Counted, orders>;

/// Values of B-splines at one point: function span − p + c, c = 0 … p, of degrees 0 … 2p + 1
/// (Figs. 5.8, 5.26).
class Triangle {
 public:
  explicit Triangle(const KnotVector& knots)
      : p_(knots.degree()), x_(knots.knots().begin(), knots.knots().end()) {
    x_.insert(x_.end(), static_cast<std::size_t>(p_ + 1),
              x_.back());  // "compute extended knot vector"
  }

  void fill(int span, double u, int degree) {
    const int first = span - p_;
    for (int c = 0; c <= p_; ++c) left_[at(c)] = Counted(u) - x(first + c);
    for (int k = 1; k <= degree; ++k) right_[at(k)] = Counted(x(span + k)) - u;
    for (auto& row : values_) row.fill(0);
    values_[0][at(p_)] = 1;
    for (int q = 1; q <= degree; ++q) {
      const int lowest = std::max(0, p_ - q + 1);  // of the functions of degree q − 1
      Counted after = 0;                           // what function c + 1 hands down
      for (int c = p_; c >= lowest; --c) {
        const Counted length = left_[at(c)] + right_[at(c + q - p_)],
                      quotient = values_[at(q - 1)][at(c)] / length;
        length_[at(q)][at(c)] = length;
        values_[at(q)][at(c)] = c == p_ ? left_[at(c)] * quotient : left_[at(c)] * quotient + after;
        if (c > 0) after = right_[at(c + q - p_)] * quotient;
      }
      if (lowest > 0) values_[at(q)][at(lowest - 1)] = after;
    }
  }

  /// values(q)[c] = N_{span-p+c} of degree q.
  [[nodiscard]] const Row& values(int q) const { return values_[at(q)]; }

  /// The derivatives of order d of the functions of degree p: the triangle backwards.
  [[nodiscard]] Row derivatives(int d) const {
    Row row = values_[at(p_ - d)];
    for (int q = p_ - d + 1; q <= p_; ++q) {
      const int lowest = p_ - q + 1;
      Counted after = 0;
      for (int c = p_; c >= lowest; --c) {
        const Counted quotient = Counted(q) * row[at(c)] / length_[at(q)][at(c)];
        row[at(c)] = c == p_ ? quotient : quotient - after;
        after = quotient;
      }
      row[at(lowest - 1)] = -after;
    }
    return row;
  }

  [[nodiscard]] double x(int i) const { return x_[at(i)]; }

 private:
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }

  int p_;
  std::vector<double> x_;
  Row left_{};
  std::array<Counted, highest + 1> right_{};
  std::array<Row, highest + 1> values_{}, length_{};
};

class Run {
 public:
  Run(const KnotVector& knots, Reuse reuse)
      : knots_(knots), p_(knots.degree()), reuse_(reuse), triangle_(knots) {
    for (auto& term : upper_) term.assign(at(knots.count() * (p_ + 1)), Counted(0));
    Counted::count() = {};
  }

  ThesisGramians gaussian() {
    const GaussRule rule = gauss_legendre(p_ + 1);
    for (const int span : knots_.spans()) {
      const Counted a = knots_[span], b = knots_[span + 1], half = (b - a) * 0.5,
                    middle = (a + b) * 0.5;
      for (std::size_t g = 0; g < rule.abscissae.size(); ++g) {
        const Counted u = middle + half * rule.abscissae[g], weight = half * rule.weights[g];
        ++work_.samples;
        Row n[3];
        recursion([&] { triangle_.fill(span, u.value, p_); });
        n[0] = triangle_.values(p_);
        evaluated();
        for (int d = 1; d <= std::min(p_, 2); ++d) {
          recursion([&] {
            if (reuse_ == Reuse::none) triangle_.fill(span, u.value, p_);
            n[d] = triangle_.derivatives(d);
          });
          if (reuse_ == Reuse::none) evaluated();
        }
        if (p_ < 2) n[2].fill(0);
        for (int i = 0; i <= p_; ++i) {
          Counted weighted[3];
          for (int d = 0; d <= std::min(p_, 2); ++d) weighted[d] = weight * n[d][at(i)];
          for (int j = i; j <= p_; ++j) {
            entry(0, span, i, j) += weighted[0] * n[0][at(j)];
            entry(1, span, i, j) += weighted[1] * n[1][at(j)];
            if (p_ >= 2) entry(2, span, i, j) += weighted[2] * n[2][at(j)];
            entry(3, span, i, j) += weighted[1] * n[0][at(j)];
          }
        }
      }
    }
    return finished();
  }

  ThesisGramians analytic() {
    weigh();
    const std::vector<int> spans = knots_.spans();
    end_terms(spans.front(), knots_.domain().lower, -1);
    Row before{}, integrals[4];
    for (std::size_t k = 0; k < spans.size(); ++k) {
      const int span = spans[k];
      const double u = knots_[span + 1];
      Row steps;
      ++work_.samples;
      recursion([&] {
        triangle_.fill(span, u, 2 * p_ + 1);
        steps = triangle_.derivatives(p_);
      });
      evaluated();
      // The jump of the last derivative at the knot between this span and the one before is known
      // only now.
      if (k > 0) assemble(spans[k - 1], before, steps, integrals);
      for (int t = 0; t < 4; ++t) {
        if (reuse_ == Reuse::none) {
          recursion([&] { triangle_.fill(span, u, 2 * p_ + 1); });
          evaluated();
        }
        integrals[t] = chain(t, p_, span);
      }
      before = steps;
    }
    end_terms(spans.back(), knots_.domain().upper, 1);
    return finished();
  }

 private:
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }

  template <class F>
  void recursion(F work) {
    const OperationCount start = Counted::count();
    work();
    const OperationCount spent = Counted::count() - start;
    work_.recursions.additions += spent.additions;
    work_.recursions.multiplications += spent.multiplications;
    work_.recursions.divisions += spent.divisions;
  }
  void evaluated() { work_.evaluations += p_ + 1; }

  Counted& entry(int term, int span, int i, int j) {
    return upper_[at(term)][at((span - p_ + i) * (p_ + 1) + j - i)];
  }

  /// weight_[q − p][k] = (x_{k+q+1} − x_k)/(q + 1) (Thm 5.2) for q = p … 2p.
  void weigh() {
    weight_.resize(at(p_ + 1));
    for (int m = 0; m <= p_; ++m) {
      for (int k = 0; k < knots_.count(); ++k) {
        weight_[at(m)].push_back((Counted(triangle_.x(k + p_ + m + 1)) - triangle_.x(k)) /
                                 Counted(p_ + m + 1));
      }
    }
  }

  /// The m-fold integrals of the functions of a span at the point of the triangle (Alg. 5.4), all
  /// at once; derivatives where m < 0.
  Row integral(int m, int span) {
    if (m < 0) return triangle_.derivatives(-m);
    Row row = triangle_.values(p_ + m);
    for (int level = m - 1; level >= 0; --level) {
      const std::vector<Counted>& weight = weight_[at(level)];
      for (int c = p_ - 1; c >= 0; --c) row[at(c)] += row[at(c + 1)];
      for (int c = 0; c <= p_; ++c) row[at(c)] *= weight[at(span - p_ + c)];
    }
    return row;
  }

  /// The factor of the jump of order r in ∫ N_i^(a) N_j^(b), t = 0 … 3 for G00, G11, G22, G10:
  /// N_j^(b) integrated r − a + 1 times.
  Row chain(int t, int r, int span) {
    constexpr int order[] = {0, 1, 2, 1}, both[] = {0, 2, 4, 1};
    if (r < order[t]) return {};
    return integral(r + 1 - both[t], span);
  }

  void assemble(int span, const Row& before, const Row& after, const Row* integrals) {
    const Counted sign = p_ % 2 == 0 ? -1.0 : 1.0;
    for (int i = 0; i <= p_; ++i) {
      const Counted weight = i == 0 ? -before[0] : after[at(i - 1)] - before[at(i)];
      const Counted even = sign.value > 0 ? weight : -weight,
                    odd = -even;  // (−1)^(p+1−a) for a = 0, 2 and for a = 1
      for (int j = i; j <= p_; ++j) {
        entry(0, span, i, j) += even * integrals[0][at(j)];
        entry(1, span, i, j) += odd * integrals[1][at(j)];
        if (p_ >= 2) entry(2, span, i, j) += even * integrals[2][at(j)];
        entry(3, span, i, j) += odd * integrals[3][at(j)];
      }
    }
  }

  /// "Initialise Gramian matrices with constant terms": the ends, where all derivatives jump.
  void end_terms(int span, double u, int side) {
    if (side < 0) {
      ++work_.samples;
      recursion([&] { triangle_.fill(span, u, 2 * p_ + 1); });
      evaluated();
    }
    constexpr int order[] = {0, 1, 2, 1};
    for (int r = 0; r <= p_; ++r) {
      Row jumps;
      recursion([&] { jumps = triangle_.derivatives(r); });
      for (int t = 0; t < 4; ++t) {
        if (r < order[t]) continue;
        const Row beside = chain(t, r, span);
        const bool negative = ((r - order[t]) % 2 == 0) !=
                              (side > 0);  // (−1)^(r−a+1), and at the end the jump is −N^(r)
        for (int i = 0; i <= p_; ++i) {
          for (int j = i; j <= p_; ++j) {
            const Counted term = jumps[at(i)] * beside[at(j)];
            entry(t, span, i, j) += negative ? -term : term;
          }
        }
      }
    }
  }

  ThesisGramians finished() {
    ThesisGramians result;
    work_.spans = static_cast<long>(knots_.spans().size());
    work_.operations = Counted::count();
    result.work = work_;
    for (std::size_t t = 0; t < 4; ++t) {
      for (const Counted& value : upper_[t]) result.upper[t].push_back(value.value);
    }
    return result;
  }

  const KnotVector& knots_;
  const int p_;
  const Reuse reuse_;
  Triangle triangle_;
  Work work_;
  std::array<std::vector<Counted>, 4> upper_;
  std::vector<std::vector<Counted>> weight_;
};

}  // namespace

ThesisGramians thesis_gramians(const KnotVector& knots, ThesisMethod method, Reuse reuse) {
  assert(knots.count() - knots.degree() ==
         static_cast<int>(knots.spans().size()));  // clamped, simple inside
  Run run(knots, reuse);
  return method == ThesisMethod::gaussian ? run.gaussian() : run.analytic();
}

namespace expected {

double samples_per_span(int degree, ThesisMethod method) {
  return method == ThesisMethod::gaussian ? degree + 1 : 1;
}

double evaluations(int degree, int n, ThesisMethod method, Reuse reuse) {
  const int functions = reuse == Reuse::all_in_one ? 1 : method == ThesisMethod::gaussian ? 3 : 5;
  return samples_per_span(degree, method) * functions * (n + 1) * (degree + 1);
}

double recursions(int p, int n, ThesisMethod method) {
  const bool gaussian = method == ThesisMethod::gaussian;
  const double forward = gaussian ? (p + 1) * (p + 1) / 2.0 : (2 * p + 2) * (2 * p + 3) / 2.0;
  const double backward = gaussian ? 3 * 3 / 2.0 : p * (p + 1) / 2.0;
  return samples_per_span(p, method) * (n + 1) * (5 * forward + 3 * backward);
}

double operations(int p, int n, ThesisMethod method) {
  const double values = 4 * (p * (p + 1) / 2.0 + p + 1);
  // Of the integrals of order p + 1, p, p − 1 and p − 3.
  const int levels = 3 * p + std::max(p - 3, 0);
  const double rest =
      method == ThesisMethod::gaussian ? 3 + 3 * values : levels * (2 * p + 1) + p + 2 * values;
  return recursions(p, n, method) + samples_per_span(p, method) * (n + 1) * rest;
}

}  // namespace expected
}  // namespace knead::figures
