#include "knead/energy/shell_energy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "rational_basis.hpp"
#include "shell_blocks.hpp"
#include "shell_law.hpp"
#include "shell_quadrature.hpp"
#include "tensor_pattern.hpp"

namespace knead {
namespace {

using detail::ShellElement;
using detail::ShellPoint;
using detail::ShellRest;
using detail::Vector6;

using Basis = Eigen::Block<const Eigen::MatrixXd, Eigen::Dynamic, 5, true>;

Basis basis_at(const ShellElement& element, Eigen::Index point) {
  return element.derivative.middleCols<5>(5 * point);
}

Eigen::Matrix3Xd coordinates(const ShellElement& element, const Points& x) {
  Eigen::Matrix3Xd result(3, static_cast<Eigen::Index>(element.nodes.size()));
  for (std::size_t r = 0; r < element.nodes.size(); ++r) {
    result.col(static_cast<Eigen::Index>(r)) = x.row(element.nodes[r]).transpose();
  }
  return result;
}

/// The basis on the element whose Gauss points are [begin_d, begin_d + points_d) of the two tables.
Expected<ShellElement> make_element(const Surface& rational, const RationalBasis<2>& functions,
                                    const std::array<BasisQuadrature, 2>& quadrature,
                                    const std::array<int, 2>& begin,
                                    const std::array<int, 2>& points) {
  const std::array<int, 2> first{quadrature[0].basis.first[static_cast<std::size_t>(begin[0])],
                                 quadrature[1].basis.first[static_cast<std::size_t>(begin[1])]};
  const int p = rational.knots(0).degree(), q = rational.knots(1).degree(),
            local = (p + 1) * (q + 1);
  ShellElement element;
  for (int r = 0; r < local; ++r) {
    const auto i = functions.global(first, r);
    element.nodes.push_back(i[0] * rational.net()[1] + i[1]);
  }
  const Eigen::Index total = points[0] * points[1];
  std::vector<Eigen::MatrixXd> tables(6, Eigen::MatrixXd(local, total));
  for (int k = 0; k < total; ++k) {
    const std::array<const double*, 2> rows{quadrature[0].basis.row(begin[0] + k / points[1], 0),
                                            quadrature[1].basis.row(begin[1] + k % points[1], 0)};
    if (auto ok = functions.evaluate(first, rows, k, tables); !ok)
      return std::unexpected(ok.error());
  }
  const auto table = [&](int a, int b) -> const Eigen::MatrixXd& {
    return tables[static_cast<std::size_t>(multi_index_position<2>({a, b}))];
  };
  element.value = table(0, 0);
  element.derivative.resize(local, 5 * total);
  for (Eigen::Index k = 0; k < total; ++k) {
    element.derivative.middleCols<5>(5 * k) << table(1, 0).col(k), table(0, 1).col(k),
        table(2, 0).col(k), table(0, 2).col(k), table(1, 1).col(k);
  }
  return element;
}

/// The 3N × 3N pattern of zeros: every entry of the scalar one as a 3 × 3 block.
/// Coordinates of a control point are adjacent unknowns, 3 i + c, and each row of the matrix lists
/// its blocks one after the other: entry (3 a + c, 3 b + e) is found from that of (a, b) without a
/// search.
SparseMatrix three_fold(const SparseMatrix& scalar) {
  SparseMatrix result(3 * scalar.rows(), 3 * scalar.cols());
  result.resizeNonZeros(9 * scalar.nonZeros());
  int* start = result.outerIndexPtr();
  int* index = result.innerIndexPtr();
  start[0] = 0;
  for (Eigen::Index row = 0; row < scalar.outerSize(); ++row) {
    const int begin = scalar.outerIndexPtr()[row], end = scalar.outerIndexPtr()[row + 1];
    for (int c = 0; c < 3; ++c, ++start) {
      for (int k = begin; k < end; ++k) {
        for (int e = 0; e < 3; ++e) *index++ = 3 * scalar.innerIndexPtr()[k] + e;
      }
      start[1] = start[0] + 3 * (end - begin);
    }
  }
  std::fill(result.valuePtr(), result.valuePtr() + result.nonZeros(), 0.0);
  return result;
}

}  // namespace

struct ShellEnergy::Data {
  detail::ShellLaw law;
  int size = 0;
  TensorPattern<2> pattern;
  std::vector<ShellElement> elements;
  std::vector<ShellRest> rest;  // element after element
  std::vector<double> measure;  // of the parameters, of the same points
  SparseMatrix scalar, zero;
  detail::ShellBlocks blocks;

  /// Calls visit(element, point of the element, its rest, local geometry, index over all points).
  template <class Visit>
  void each_point(const Points& x, Visit visit) const {
    Eigen::Index index = 0;
    for (const ShellElement& element : elements) {
      const Eigen::Matrix3Xd derivatives = coordinates(element, x) * element.derivative;
      for (Eigen::Index k = 0; k < element.value.cols(); ++k, ++index) {
        visit(element, k, rest[static_cast<std::size_t>(index)],
              ShellPoint(derivatives.middleCols<5>(5 * k)), index);
      }
    }
  }

  /// \param points Gauss points of each direction with their number on an element, and the first
  /// ones of this element.
  [[nodiscard]] Expected<void> add_rest(const ShellElement& element, const Points& x,
                                        const detail::ShellQuadrature& points,
                                        const std::array<int, 2>& begin) {
    const Eigen::Matrix3Xd derivatives = coordinates(element, x) * element.derivative;
    for (Eigen::Index k = 0; k < element.value.cols(); ++k) {
      const ShellPoint at(derivatives.middleCols<5>(5 * k));
      if (!(at.area > 0) || !at.inverse.allFinite()) {
        return numerical_error("the rest shape has no normal at a Gauss point",
                               fmt::format("point {}", rest.size()),
                               "remove folds and spans on which control points coincide");
      }
      const auto [weight, u] = points.at(begin, static_cast<int>(k));
      const auto here = detail::coefficients_at(law, u);
      if (!here) return std::unexpected(here.error());
      const auto [membrane, bending] = law.stiffness(at, *here);
      measure.push_back(weight);
      rest.push_back({weight * law.measure(at), weight * at.area,
                      weight * at.area * law.mass(here->thickness), at.metric, at.curvature,
                      membrane, bending});
    }
    return {};
  }

  /// Σ over all points of R_i times their share of a vector.
  [[nodiscard]] Points spread(double ShellRest::*share, const Point& vector) const {
    Points result = Points::Zero(size, 3);
    if (vector == Point::Zero()) return result;
    std::size_t index = 0;
    for (const ShellElement& element : elements) {
      for (Eigen::Index k = 0; k < element.value.cols(); ++k, ++index) {
        for (std::size_t r = 0; r < element.nodes.size(); ++r) {
          const double part = rest[index].*share * element.value(static_cast<Eigen::Index>(r), k);
          result.row(element.nodes[r]) += part * vector.transpose();
        }
      }
    }
    return result;
  }
};

Expected<ShellEnergy> ShellEnergy::create(const Surface& rest, const ShellMaterial& material,
                                          int gauss_points) {
  if (auto ok = validated(material); !ok) return std::unexpected(ok.error());
  auto data = std::make_shared<Data>();
  data->law.material = material;
  return with_law(rest, std::move(data), gauss_points);
}

Expected<ShellEnergy> ShellEnergy::of_forms(const Surface& rest,
                                            const FundamentalMaterial& material, int gauss_points) {
  if (auto ok = validated_weights(material); !ok) return std::unexpected(ok.error());
  auto data = std::make_shared<Data>();
  data->law.material = material;
  return with_law(rest, std::move(data), gauss_points);
}

// The energy of Kirchhoff and Love, W = ½ ∫ n·ε + m·κ dA over the rest shape, with the membrane
// strain ε = (a − A)/2, the change of curvature κ = B − b (A and B the forms of the rest shape), n
// = C_n ε and m = C_m κ; degree 2 at least, as b has second derivatives. Everything that depends on
// the rest shape alone is found here, once: the basis at the Gauss points, the forms, and both 3 ×
// 3 matrices of the law.
Expected<ShellEnergy> ShellEnergy::with_law(const Surface& surface, std::shared_ptr<Data> data,
                                            int gauss_points) {
  for (std::size_t d = 0; d < 2; ++d) {
    const KnotVector& knots = surface.knots()[d];
    if (knots.degree() < 2) {
      return input_error("a surface of degree 1 does not bend",
                         fmt::format("direction {}", d == 0 ? "u" : "v"),
                         "elevate its degree to 2 or more");
    }
    data->pattern.degree[d] = knots.degree();
  }
  const auto gauss = detail::shell_quadrature(surface.knots(), data->law, gauss_points);
  if (!gauss) return std::unexpected(gauss.error());
  const auto& [quadrature, points] = *gauss;
  data->size = surface.size();
  data->pattern.net = surface.net();
  const Points& x = surface.control_points();
  const auto weighted =
      surface.rational()
          ? Expected<Surface>(surface)
          : Surface::create(surface.knots(), x,
                            std::vector<double>(static_cast<std::size_t>(surface.size()), 1.0));
  if (!weighted) return std::unexpected(weighted.error());
  const RationalBasis<2> functions(*weighted, 2);
  for (int u = 0; u < quadrature[0].basis.size(); u += points[0]) {
    for (int v = 0; v < quadrature[1].basis.size(); v += points[1]) {
      auto element = make_element(*weighted, functions, quadrature, {u, v}, points);
      if (!element) return std::unexpected(element.error());
      if (auto ok = data->add_rest(*element, x, *gauss, {u, v}); !ok)
        return std::unexpected(ok.error());
      data->elements.push_back(std::move(*element));
    }
  }
  data->scalar = data->pattern.allocate();
  data->zero = three_fold(data->scalar);
  data->blocks = detail::ShellBlocks(surface, quadrature, points, data->elements, data->rest);
  return ShellEnergy(std::move(data));
}

ShellParts ShellEnergy::energy(const Points& x) const {
  return data_->blocks.forces(x, nullptr, nullptr);
}

ShellParts ShellEnergy::energy(const Points& x, Eigen::Ref<Points> gradient) const {
  return data_->blocks.forces(x, &gradient, nullptr);
}

Points ShellEnergy::gradient(const Points& x) const {
  Points result = Points::Zero(x.rows(), 3);
  static_cast<void>(energy(x, result));
  return result;
}

ShellStress ShellEnergy::stress(const Points& x) const {
  ShellStress result(6, static_cast<Eigen::Index>(data_->rest.size()));
  static_cast<void>(data_->blocks.forces(x, nullptr, &result));
  return result;
}

ShellStress ShellEnergy::stress(const Points& x, const Points& d) const {
  ShellStress result(6, static_cast<Eigen::Index>(data_->rest.size()));
  data_->each_point(x, [&](const ShellElement& element, Eigen::Index k, const ShellRest& rest,
                           const ShellPoint& at, Eigen::Index index) {
    Vector6 strain = detail::shell_strain(at, rest.metric, rest.curvature);
    const Eigen::Matrix3Xd local = coordinates(element, d);
    Eigen::Matrix<double, 6, Eigen::Dynamic> rows(6, 3 * local.cols());
    const Basis basis = basis_at(element, k);
    detail::strain_rows(at, basis, detail::covariant_second(at, basis), rows);
    for (Eigen::Index c = 0; c < 3; ++c) {
      strain += rows.middleCols(c * local.cols(), local.cols()) * local.row(c).transpose();
    }
    result.col(index) = rest.stress(strain);
  });
  return result;
}

ShellStress ShellEnergy::tension(const ShellStress& stress) const {
  ShellStress result = ShellStress::Zero(6, stress.cols());
  for (Eigen::Index k = 0; k < stress.cols(); ++k) {
    result.col(k).head<3>() =
        detail::tension(stress.col(k).head<3>(), data_->rest[static_cast<std::size_t>(k)].metric);
  }
  return result;
}

SparseMatrix ShellEnergy::hessian(const Points& x, const ShellStress& stress) const {
  SparseMatrix matrix = data_->zero;
  data_->blocks.add_hessian(x, stress, data_->pattern, data_->scalar, matrix);
  return matrix;
}

Points ShellEnergy::area_load(const Point& per_area) const {
  return data_->spread(&ShellRest::area, per_area);
}

Points ShellEnergy::weight(const Point& acceleration) const {
  return data_->spread(&ShellRest::mass, acceleration);
}

// On the deformed surface: its area element |a_1 × a_2| and its normal. The drag of wind is that of
// its normal component, relative to the surface's own velocity.
Points ShellEnergy::normal_load(const Points& x, const Points& velocity, double pressure,
                                const Point& wind) const {
  Points result = Points::Zero(data_->size, 3);
  data_->each_point(x, [&](const ShellElement& element, Eigen::Index k, const ShellRest&,
                           const ShellPoint& at, Eigen::Index index) {
    const auto basis = element.value.col(k);
    const Point moving = coordinates(element, velocity) * basis;
    const double measure = data_->measure[static_cast<std::size_t>(index)];
    const Point force = measure * at.area * (pressure + at.normal.dot(wind - moving)) * at.normal;
    for (std::size_t r = 0; r < element.nodes.size(); ++r) {
      result.row(element.nodes[r]) += basis[static_cast<Eigen::Index>(r)] * force.transpose();
    }
  });
  return result;
}

double ShellEnergy::area() const {
  double sum = 0;
  for (const ShellRest& rest : data_->rest) sum += rest.area;
  return sum;
}

SparseMatrix ShellEnergy::mass() const {
  SparseMatrix matrix = data_->scalar;
  std::fill(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros(), 0.0);
  std::size_t index = 0;
  for (const ShellElement& element : data_->elements) {
    const Eigen::Index points = element.value.cols();
    Eigen::VectorXd weights(points);
    for (Eigen::Index k = 0; k < points; ++k, ++index) weights[k] = data_->rest[index].mass;
    const Eigen::MatrixXd block = element.value * weights.asDiagonal() * element.value.transpose();
    for (std::size_t r = 0; r < element.nodes.size(); ++r) {
      for (std::size_t s = 0; s < element.nodes.size(); ++s) {
        matrix.coeffRef(element.nodes[r], element.nodes[s]) +=
            (block(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(s)) +
             block(static_cast<Eigen::Index>(s), static_cast<Eigen::Index>(r))) /
            2;
      }
    }
  }
  return matrix;
}

double ShellEnergy::stretching_scale() const {
  if (const auto* m = std::get_if<ShellMaterial>(&data_->law.material)) {
    return 0.5 * m->young * m->thickness / (1 - m->poisson * m->poisson) * area();
  }
  double sum = 0;
  for (const ShellRest& rest : data_->rest) {
    sum += rest.weight / 8 *
           rest.metric.dot(Eigen::Vector3d(1, 1, 4).asDiagonal() * rest.membrane * rest.metric);
  }
  return sum;
}

// A shell has E h³ / 12 (1 − ν²). A surface that keeps its fundamental forms has no thickness: the
// mean over the surface of what its law does to a curvature equal to the metric stands for it, and
// the thickness is that of the homogeneous shell with the same ratio of bending to stretching, h² =
// 12 D/B.
double ShellEnergy::bending_stiffness() const {
  if (const auto* m = std::get_if<ShellMaterial>(&data_->law.material)) {
    return m->young * m->thickness * m->thickness * m->thickness /
           (12 * (1 - m->poisson * m->poisson));
  }
  double sum = 0;
  for (const ShellRest& rest : data_->rest) {
    sum += rest.weight *
           rest.metric.dot(Eigen::Vector3d(1, 1, 4).asDiagonal() * rest.bending * rest.metric);
  }
  return sum / area();
}

double ShellEnergy::effective_thickness() const {
  if (const auto* m = std::get_if<ShellMaterial>(&data_->law.material)) return m->thickness;
  return std::sqrt(12 * bending_stiffness() * area() / (2 * stretching_scale()));
}

double ShellEnergy::mass_per_area() const { return data_->law.mass(); }

int ShellEnergy::size() const { return data_->size; }

}  // namespace knead
