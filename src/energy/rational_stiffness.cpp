#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/gauss_legendre.hpp"
#include "rational_basis.hpp"
#include "tensor_pattern.hpp"

namespace knead {
namespace {

/// Which element (span in every direction) each Gauss point of a direction belongs to: runs of equal `first`.
std::vector<std::pair<int, int>> element_runs(const BasisTable& table) {
  std::vector<std::pair<int, int>> runs;
  for (int k = 0; k < table.size();) {
    int end = k + 1;
    while (end < table.size() &&
           table.first[static_cast<std::size_t>(end)] == table.first[static_cast<std::size_t>(k)]) {
      ++end;
    }
    runs.emplace_back(k, end);
    k = end;
  }
  return runs;
}

/// Gauss points on the spans of one direction, cut at `breaks` (ascending, may lie anywhere).
Expected<BasisQuadrature> gauss_basis_between(const KnotVector& knots, const std::vector<double>& breaks, int points,
                                              int order) {
  const GaussRule rule = gauss_legendre(points);
  BasisQuadrature result;
  for (const int span : knots.spans()) {
    double lower = knots[span];
    for (auto next = std::ranges::upper_bound(breaks, lower); lower < knots[span + 1]; ++next) {
      const double upper = next == breaks.end() ? knots[span + 1] : std::min(*next, knots[span + 1]);
      const double half = (upper - lower) / 2, middle = lower + half;
      for (std::size_t g = 0; g < rule.abscissae.size(); ++g) {
        // Strictly inside, so that the span to the right is the intended one; a piece of a single ulp has no interior.
        const double u = std::clamp(middle + half * rule.abscissae[g], lower, std::nextafter(upper, lower));
        result.parameters.push_back(u);
        result.weights.push_back(half * rule.weights[g]);
      }
      lower = upper;
      if (next == breaks.end()) break;
    }
  }
  auto table = tabulate_basis(knots, result.parameters, order);
  if (!table) return std::unexpected(table.error());
  result.basis = std::move(*table);
  return result;
}

template <int D, class Term>
int highest_order(const std::vector<Term>& energy) {
  int order = 0;
  for (const Term& term : energy) {
    int a = 0, b = 0;
    for (std::size_t d = 0; d < D; ++d) {
      a += term.a[d];
      b += term.b[d];
    }
    order = std::max({order, a, b});
  }
  return order;
}

/// K by the points of `quadrature`, element by element. varying[t] multiplies the coefficient of term t at every point
/// of the grid, last direction fastest; empty: one.
template <int D>
class ElementAssembly {
 public:
  ElementAssembly(const Spline<D>& spline, const Energy<D>& energy, int order,
                  const std::array<BasisQuadrature, D>& quadrature, const std::vector<std::vector<double>>& varying)
      : energy_(energy),
        quadrature_(quadrature),
        varying_(varying),
        rational_(spline, order),
        basis_(multi_indices<D>(order).size()) {
    pattern_.net = spline.net();
    for (std::size_t d = 0; d < D; ++d) {
      pattern_.degree[d] = spline.knots()[d].degree();
      runs_[d] = element_runs(quadrature[d].basis);
      local_ *= pattern_.degree[d] + 1;
    }
  }

  Expected<SparseMatrix> run() {
    SparseMatrix matrix = pattern_.allocate();
    std::fill(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros(), 0.0);
    std::array<std::size_t, D> element{};
    do {
      if (auto ok = evaluate(element); !ok) return std::unexpected(ok.error());
      add(element_matrix(), matrix);
    } while (advance(element));
    return matrix;
  }

 private:
  using Dense = Eigen::MatrixXd;

  /// The last direction fastest; false after the last element.
  [[nodiscard]] bool advance(std::array<std::size_t, D>& element) const {
    for (std::size_t d = D; d-- > 0;) {
      if (++element[d] < runs_[d].size()) return true;
      element[d] = 0;
    }
    return false;
  }

  /// Basis, weight and position of every point of the element.
  Expected<void> evaluate(const std::array<std::size_t, D>& element) {
    std::array<int, D> points;
    int total = 1;
    for (std::size_t d = 0; d < D; ++d) {
      points[d] = runs_[d][element[d]].second - runs_[d][element[d]].first;
      first_[d] = quadrature_[d].basis.first[static_cast<std::size_t>(runs_[d][element[d]].first)];
      total *= points[d];
    }
    for (Dense& b : basis_) b.resize(local_, total);
    weight_.resize(total);
    place_.assign(static_cast<std::size_t>(total), 0);
    for (int k = 0; k < total; ++k) {
      std::array<const double*, D> rows;
      double w = 1;
      std::size_t stride = 1;
      for (std::size_t d = D, rest = static_cast<std::size_t>(k); d-- > 0;) {
        const int at = runs_[d][element[d]].first + static_cast<int>(rest % static_cast<std::size_t>(points[d]));
        rest /= static_cast<std::size_t>(points[d]);
        rows[d] = quadrature_[d].basis.row(at, 0);
        w *= quadrature_[d].weights[static_cast<std::size_t>(at)];
        place_[static_cast<std::size_t>(k)] += static_cast<std::size_t>(at) * stride;
        stride *= quadrature_[d].weights.size();
      }
      weight_(k) = w;
      if (auto ok = rational_.evaluate(first_, rows, k, basis_); !ok) return std::unexpected(ok.error());
    }
    return {};
  }

  [[nodiscard]] Dense element_matrix() const {
    Dense block = Dense::Zero(local_, local_);
    for (std::size_t t = 0; t < energy_.size(); ++t) {
      const EnergyTerm<D>& term = energy_[t];
      const Dense& a = basis_[static_cast<std::size_t>(multi_index_position<D>(term.a))];
      const Dense& b = basis_[static_cast<std::size_t>(multi_index_position<D>(term.b))];
      Eigen::VectorXd scaled = term.coefficient * weight_;
      for (std::size_t k = 0; k < place_.size() && !varying_[t].empty(); ++k) {
        scaled[static_cast<Eigen::Index>(k)] *= varying_[t][place_[k]];
      }
      block.noalias() += (a * scaled.asDiagonal()) * b.transpose();
    }
    // The two terms of a symmetric pair are rounded separately; the mean of both halves is symmetric to the last bit.
    return 0.5 * (block + block.transpose());
  }

  void add(const Dense& block, SparseMatrix& matrix) const {
    for (int r = 0; r < local_; ++r) {
      const std::array<int, D> i = rational_.global(first_, r);
      int row = 0;
      for (std::size_t d = 0; d < D; ++d) row = row * pattern_.net[d] + i[d];
      double* to = matrix.valuePtr() + matrix.outerIndexPtr()[row];
      for (int c = 0; c < local_; ++c) to[pattern_.offset(i, rational_.global(first_, c))] += block(r, c);
    }
  }

  const Energy<D>& energy_;
  const std::array<BasisQuadrature, D>& quadrature_;
  const std::vector<std::vector<double>>& varying_;
  TensorPattern<D> pattern_;
  std::array<std::vector<std::pair<int, int>>, D> runs_;  // of Gauss points, element after element
  int local_ = 1;                                         // basis functions on an element
  RationalBasis<D> rational_;
  // Of the element:
  std::array<int, D> first_;
  std::vector<Dense> basis_;  // basis[a](local function, point)
  Eigen::VectorXd weight_;
  std::vector<std::size_t> place_;  // in the whole grid
};

}  // namespace

template <int D>
Expected<SparseMatrix> assemble_rational(const Spline<D>& spline, const Energy<D>& energy, int gauss_points) {
  const int order = highest_order<D>(energy);
  std::array<BasisQuadrature, D> quadrature;
  for (std::size_t d = 0; d < D; ++d) {
    const int points = gauss_points > 0 ? gauss_points : spline.knots()[d].degree() + 8;
    quadrature[d] = gauss_basis(spline.knots()[d], points, order);
  }
  return ElementAssembly<D>(spline, energy, order, quadrature, std::vector<std::vector<double>>(energy.size())).run();
}

template <int D>
Expected<SparseMatrix> assemble_rational(const Spline<D>& spline, const FieldEnergy<D>& energy, int gauss_points) {
  std::array<std::vector<double>, D> breaks;
  std::array<int, D> degree{};
  Energy<D> constant;
  bool any = false;
  for (const FieldTerm<D>& term : energy) {
    const double* c = std::get_if<double>(&term.coefficient);
    constant.push_back({c ? term.factor * *c : term.factor, term.a, term.b});
    if (c) continue;
    any = true;
    for (std::size_t d = 0; d < D; ++d) {
      const KnotVector& knots = std::get<SplineField<D>>(term.coefficient).knots()[d];
      const Interval own = spline.knots()[d].domain(), other = knots.domain();
      if (own.lower != other.lower || own.upper != other.upper) {
        return input_error(
            fmt::format("the domains [{}, {}] and [{}, {}] differ", own.lower, own.upper, other.lower, other.upper), {},
            "give a field over the domain of the spline");
      }
      breaks[d].insert(breaks[d].end(), knots.knots().begin(), knots.knots().end());
      degree[d] = std::max(degree[d], knots.degree());
    }
  }
  if (!any) return assemble_rational<D>(spline, constant, gauss_points);
  const int order = highest_order<D>(energy);
  std::array<BasisQuadrature, D> quadrature;
  for (std::size_t d = 0; d < D; ++d) {
    std::ranges::sort(breaks[d]);
    breaks[d].erase(std::unique(breaks[d].begin(), breaks[d].end()), breaks[d].end());
    const int points = gauss_points > 0 ? gauss_points : spline.knots()[d].degree() + 8 + (degree[d] + 1) / 2;
    auto made = gauss_basis_between(spline.knots()[d], breaks[d], points, order);
    if (!made) return std::unexpected(made.error());
    quadrature[d] = std::move(*made);
  }
  std::array<std::span<const double>, D> parameters;
  for (std::size_t d = 0; d < D; ++d) parameters[d] = quadrature[d].parameters;
  std::vector<std::vector<double>> varying(energy.size());
  for (std::size_t t = 0; t < energy.size(); ++t) {
    const auto* field = std::get_if<SplineField<D>>(&energy[t].coefficient);
    if (field == nullptr) continue;
    auto values = field->on_grid(parameters);
    if (!values) return std::unexpected(values.error());
    varying[t] = std::move(*values);
  }
  return ElementAssembly<D>(spline, constant, order, quadrature, varying).run();
}

template Expected<SparseMatrix> assemble_rational<1>(const Spline<1>&, const Energy<1>&, int);
template Expected<SparseMatrix> assemble_rational<2>(const Spline<2>&, const Energy<2>&, int);
template Expected<SparseMatrix> assemble_rational<3>(const Spline<3>&, const Energy<3>&, int);
template Expected<SparseMatrix> assemble_rational<1>(const Spline<1>&, const FieldEnergy<1>&, int);
template Expected<SparseMatrix> assemble_rational<2>(const Spline<2>&, const FieldEnergy<2>&, int);
template Expected<SparseMatrix> assemble_rational<3>(const Spline<3>&, const FieldEnergy<3>&, int);

}  // namespace knead
