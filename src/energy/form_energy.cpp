#include "form_energy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/gauss_legendre.hpp"
#include "form_law.hpp"
#include "rational_basis.hpp"

namespace knead {
namespace {

using detail::form_vectors;
using detail::FormDerivatives;
using detail::FormElement;
using detail::FormPoint;
using detail::FormRest;

template <int D>
Expected<void> check_weights(const Spline<D>& rest, const FormWeights& weights) {
  for (const auto& [w, name] : {std::pair(weights.w1, "w1"), std::pair(weights.w2, "w2")}) {
    if (std::isfinite(w) && w >= 0) continue;
    return input_error(fmt::format("{} is not a weight of a fundamental form", w), name,
                       "use finite numbers >= 0");
  }
  if (D == 1 && weights.w2 > 0 && rest.knots()[0].degree() < 2) {
    return input_error("a curve of degree 1 does not bend", "w2",
                       R"(elevate its degree to 2 or more, or give "w2":0)");
  }
  return {};
}

/// The positions of the derivatives that forms depend on among all.
template <int D>
std::array<std::size_t, form_vectors<D>> form_positions() {
  if constexpr (D == 1) {
    return {static_cast<std::size_t>(multi_index_position<1>({1})),
            static_cast<std::size_t>(multi_index_position<1>({2}))};
  } else {
    return {static_cast<std::size_t>(multi_index_position<3>({1, 0, 0})),
            static_cast<std::size_t>(multi_index_position<3>({0, 1, 0})),
            static_cast<std::size_t>(multi_index_position<3>({0, 0, 1}))};
  }
}

Eigen::Matrix3Xd local_points(const FormElement& element, const Points& x) {
  Eigen::Matrix3Xd result(3, static_cast<Eigen::Index>(element.nodes.size()));
  for (std::size_t r = 0; r < element.nodes.size(); ++r) {
    result.col(static_cast<Eigen::Index>(r)) = x.row(element.nodes[r]).transpose();
  }
  return result;
}

/// The elements of a spline in the order of its spans, and the weights of their Gauss points.
template <int D>
class FormElements {
 public:
  FormElements(const Spline<D>& weighted, int gauss_points) : functions_(weighted, D == 1 ? 2 : 1) {
    local_ = 1;
    for (std::size_t d = 0; d < D; ++d) {
      const int p = weighted.knots()[d].degree();
      points_[d] = std::min(gauss_points > 0 ? gauss_points : 2 * p + 1, max_gauss_points);
      quadrature_[d] = gauss_basis(weighted.knots()[d], points_[d], D == 1 ? 2 : 1);
      local_ *= p + 1;
      per_element_ *= points_[d];
      count_ *= quadrature_[d].basis.size() / points_[d];
      net_[d] = weighted.net()[d];
    }
  }

  [[nodiscard]] int count() const { return count_; }

  /// Element k, the last direction fastest, as its points are.
  [[nodiscard]] Expected<FormElement> make(int k, std::vector<double>& weights) const {
    std::array<int, D> begin, first;
    for (std::size_t d = D; d-- > 0;) {
      const int spans = quadrature_[d].basis.size() / points_[d];
      begin[d] = k % spans * points_[d];
      k /= spans;
      first[d] = quadrature_[d].basis.first[static_cast<std::size_t>(begin[d])];
    }
    FormElement element;
    for (int r = 0; r < local_; ++r) {
      int node = 0;
      const auto i = functions_.global(first, r);
      for (std::size_t d = 0; d < D; ++d) node = node * net_[d] + i[d];
      element.nodes.push_back(node);
    }
    constexpr int vectors = form_vectors<D>;
    element.derivative.resize(local_, vectors * per_element_);
    std::vector<Eigen::MatrixXd> tables(multi_indices<D>(D == 1 ? 2 : 1).size(),
                                        Eigen::MatrixXd(local_, 1));
    for (int g = 0; g < per_element_; ++g) {
      std::array<const double*, D> rows;
      double weight = 1;
      for (std::size_t d = D, rest = static_cast<std::size_t>(g); d-- > 0;) {
        const auto at =
            static_cast<std::size_t>(begin[d]) + rest % static_cast<std::size_t>(points_[d]);
        rest /= static_cast<std::size_t>(points_[d]);
        rows[d] = quadrature_[d].basis.row(static_cast<int>(at), 0);
        weight *= quadrature_[d].weights[at];
      }
      if (auto ok = functions_.evaluate(first, rows, 0, tables); !ok)
        return std::unexpected(ok.error());
      const auto positions = form_positions<D>();
      for (int v = 0; v < vectors; ++v) {
        element.derivative.col(vectors * g + v) = tables[positions[static_cast<std::size_t>(v)]];
      }
      weights.push_back(weight);
    }
    return element;
  }

 private:
  RationalBasis<D> functions_;
  std::array<BasisQuadrature, D> quadrature_;
  std::array<int, D> points_{}, net_{};
  int local_ = 1, per_element_ = 1, count_ = 1;
};

}  // namespace

template <int D>
struct FormEnergy<D>::Data {
  static constexpr int vectors = form_vectors<D>;

  FormWeights weights;
  int size = 0;
  std::vector<FormElement> elements;
  std::vector<FormRest<D>> rest;  // element after element

  /// Calls visit(element, point of the element, its rest, derivatives of the shape).
  template <class Visit>
  void each_point(const Points& x, Visit visit) const {
    std::size_t index = 0;
    for (const FormElement& element : elements) {
      const Eigen::Matrix3Xd derivatives = local_points(element, x) * element.derivative;
      for (Eigen::Index k = 0; k < derivatives.cols() / vectors; ++k, ++index) {
        visit(element, k, rest[index],
              FormDerivatives<D>(derivatives.template middleCols<vectors>(vectors * k)));
      }
    }
  }

  [[nodiscard]] Expected<void> add(FormElement element, const std::vector<double>& of_points,
                                   const Points& x) {
    const Eigen::Matrix3Xd derivatives = local_points(element, x) * element.derivative;
    for (Eigen::Index k = 0; k < derivatives.cols() / vectors; ++k) {
      const FormDerivatives<D> d = derivatives.template middleCols<vectors>(vectors * k);
      const auto tangents = d.template leftCols<D>();
      FormRest<D> at{of_points[static_cast<std::size_t>(k)], tangents.transpose() * tangents, 0};
      if constexpr (D == 1) {
        if (weights.w2 > 0) at.curvature = std::sqrt(detail::SquaredCurvature(d).value);
        if (!std::isfinite(at.curvature)) {
          return numerical_error("the rest shape has no tangent at a Gauss point",
                                 fmt::format("point {}", rest.size()),
                                 "remove spans on which control points coincide");
        }
      }
      rest.push_back(at);
    }
    elements.push_back(std::move(element));
    return {};
  }

  /// The sum over all points of what `take` reads of a `FormPoint` as a matrix of its unknowns.
  template <class Take>
  [[nodiscard]] SparseMatrix assemble(const Points& x, Take take) const {
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<Tangent> tangents;
    each_point(x, [&](const FormElement& element, Eigen::Index k, const FormRest<D>& at,
                      const auto& derivatives) {
      tangents.push_back(at.weight * take(FormPoint<D>(derivatives, at, weights)));
      if (k + 1 < element.derivative.cols() / vectors) return;
      append(element, tangents, entries);
      tangents.clear();
    });
    SparseMatrix matrix(3 * size, 3 * size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }

 private:
  using Tangent = Eigen::Matrix<double, 3 * vectors, 3 * vectors>;

  /// Σ_g Bᵀ T B of one element, B its derivatives at Gauss point g: a product of matrices per pair
  /// of coordinates.
  static void append(const FormElement& element, const std::vector<Tangent>& tangents,
                     std::vector<Eigen::Triplet<double>>& to) {
    const auto& b = element.derivative;
    Eigen::MatrixXd weighted(b.cols(), b.rows()), block(b.rows(), b.rows());
    for (int c = 0; c < 3; ++c) {
      for (int e = c; e < 3; ++e) {
        for (std::size_t g = 0; g < tangents.size(); ++g) {
          const auto at = vectors * static_cast<Eigen::Index>(g);
          const Eigen::Matrix<double, vectors, vectors> of_pair =
              tangents[g](Eigen::seqN(c, vectors, 3), Eigen::seqN(e, vectors, 3));
          weighted.template middleRows<vectors>(at) =
              of_pair * b.template middleCols<vectors>(at).transpose();
        }
        block.noalias() = b * weighted;
        for (Eigen::Index i = 0; i < b.rows(); ++i) {
          for (Eigen::Index j = 0; j < b.rows(); ++j) {
            const int row = 3 * element.nodes[static_cast<std::size_t>(i)] + c;
            const int column = 3 * element.nodes[static_cast<std::size_t>(j)] + e;
            const double value = c == e ? (block(i, j) + block(j, i)) / 2 : block(i, j);
            to.emplace_back(row, column, value);
            if (c != e) to.emplace_back(column, row, value);
          }
        }
      }
    }
  }
};

// Polynomial splines get weights of 1, so that one set of functions serves both.
template <int D>
Expected<FormEnergy<D>> FormEnergy<D>::create(const Spline<D>& rest, const FormWeights& weights,
                                              int gauss_points) {
  if (auto ok = check_weights<D>(rest, weights); !ok) return std::unexpected(ok.error());
  const auto weighted =
      rest.rational()
          ? Expected<Spline<D>>(rest)
          : Spline<D>::create(rest.knots(), rest.control_points(),
                              std::vector<double>(static_cast<std::size_t>(rest.size()), 1.0));
  if (!weighted) return std::unexpected(weighted.error());
  auto data = std::make_shared<Data>();
  data->weights = weights;
  data->size = rest.size();
  const FormElements<D> elements(*weighted, gauss_points);
  for (int k = 0; k < elements.count(); ++k) {
    std::vector<double> of_points;
    auto element = elements.make(k, of_points);
    if (!element) return std::unexpected(element.error());
    if (auto ok = data->add(std::move(*element), of_points, rest.control_points()); !ok) {
      return std::unexpected(ok.error());
    }
  }
  return FormEnergy(std::move(data));
}

template <int D>
ShellParts FormEnergy<D>::energy(const Points& x) const {
  ShellParts parts;
  data_->each_point(x,
                    [&](const FormElement&, Eigen::Index, const FormRest<D>& rest, const auto& d) {
                      const FormPoint<D> point(d, rest, data_->weights);
                      parts.membrane += rest.weight * point.metric;
                      parts.bending += rest.weight * point.bend;
                    });
  return parts;
}

template <int D>
Points FormEnergy<D>::gradient(const Points& x) const {
  constexpr int vectors = form_vectors<D>;
  Points result = Points::Zero(x.rows(), 3);
  data_->each_point(
      x, [&](const FormElement& element, Eigen::Index k, const FormRest<D>& rest, const auto& d) {
        const FormPoint<D> point(d, rest, data_->weights);
        const Eigen::Map<const Eigen::Matrix<double, 3, vectors>> by_vector(point.gradient.data());
        for (std::size_t r = 0; r < element.nodes.size(); ++r) {
          const auto row = element.derivative.row(static_cast<Eigen::Index>(r))
                               .template segment<vectors>(vectors * k);
          result.row(element.nodes[r]) += rest.weight * (by_vector * row.transpose()).transpose();
        }
      });
  return result;
}

template <int D>
SparseMatrix FormEnergy<D>::hessian(const Points& x) const {
  return data_->assemble(x, [](const FormPoint<D>& point) { return point.hessian; });
}

template <int D>
SparseMatrix FormEnergy<D>::material_hessian(const Points& x) const {
  return data_->assemble(x, [](const FormPoint<D>& point) { return point.material; });
}

template <int D>
SparseMatrix FormEnergy<D>::tense_hessian(const Points& x) const {
  return data_->assemble(x, [](const FormPoint<D>& point) { return point.tense(); });
}

template <int D>
int FormEnergy<D>::size() const {
  return data_->size;
}

template <int D>
double FormEnergy<D>::stretching_scale() const {
  double sum = 0;
  for (const FormRest<D>& rest : data_->rest)
    sum += rest.weight * data_->weights.w1 * rest.metric.squaredNorm();
  return sum;
}

template class FormEnergy<1>;
template class FormEnergy<3>;

}  // namespace knead
