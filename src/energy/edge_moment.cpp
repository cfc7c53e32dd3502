#include "knead/energy/loads.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "rational_basis.hpp"

namespace knead {
namespace {

using Tangents = Eigen::Matrix<double, 3, 2>;

/// F_α = −(a^α·c) n of one point: the forces that do work on the tangents a_α, and their
/// derivatives by these.
struct PointMoment {
  Tangents force;  // columns F_1, F_2
  Eigen::Matrix<double, 6, 6>
      derivative{};  // rows of F_1, then of F_2; columns of a_1, then of a_2

  // A moment M per length about the edge works M δω, δω = t·(n × δn), on the turn of the normal;
  // with δn = −a^α (n·δa_α) that is F_α·δa_α. It follows the edge, so that forces depend on the
  // shape; their derivative is found column by column, by the product rule along each of the six
  // components of the tangents.
  PointMoment(const Tangents& a, int along) {
    const Eigen::Vector3d cross = a.col(0).cross(a.col(1));
    const double area = cross.norm(), speed = a.col(along).norm();
    const Eigen::Vector3d n = cross / area, t = a.col(along) / speed, c = t.cross(n);
    const Tangents dual =
        (Tangents() << a.col(1).cross(n) / area, n.cross(a.col(0)) / area).finished();
    const Eigen::Vector2d part = dual.transpose() * c;
    force = -n * part.transpose();
    for (int k = 0; k < 6; ++k) {
      Tangents d = Tangents::Zero();
      d.col(k / 3)[k % 3] = 1;
      const Eigen::Vector3d turned = d.col(0).cross(a.col(1)) + a.col(0).cross(d.col(1));
      const double grown = n.dot(turned);
      const Eigen::Vector3d dn = (turned - grown * n) / area;
      const Eigen::Vector3d dt = (d.col(along) - t.dot(d.col(along)) * t) / speed;
      const Eigen::Vector3d dc = dt.cross(n) + t.cross(dn);
      Tangents dd;
      dd << d.col(1).cross(n) + a.col(1).cross(dn), dn.cross(a.col(0)) + n.cross(d.col(0));
      dd = (dd - grown * dual) / area;
      const Eigen::Vector2d dpart = dd.transpose() * c + dual.transpose() * dc;
      const Tangents df = -dn * part.transpose() - n * dpart.transpose();
      derivative.col(k) << df.col(0), df.col(1);
    }
  }
};

}  // namespace

struct EdgeMoment::Data {
  struct Gauss {
    double weight;              // of the quadrature, times the moment and the speed at rest
    std::vector<int> nodes;     // local function -> control point
    Eigen::MatrixX2d gradient;  // R_,1, R_,2

    [[nodiscard]] Tangents tangents(const Points& x) const {
      Tangents a = Tangents::Zero();
      for (std::size_t r = 0; r < nodes.size(); ++r) {
        a += x.row(nodes[r]).transpose() * gradient.row(static_cast<Eigen::Index>(r));
      }
      return a;
    }
  };
  int along = 0, size = 0;
  std::vector<Gauss> points;
};

Expected<EdgeMoment> EdgeMoment::create(const Surface& rest, int across, bool at_end,
                                        double per_length, int first_row, int size) {
  if (!std::isfinite(per_length))
    return input_error("a moment is not finite", "moment", "use a finite number");
  auto data = std::make_shared<Data>();
  const int along = 1 - across;
  data->along = along;
  data->size = size > 0 ? size : rest.size();
  const auto weighted =
      rest.rational()
          ? Expected<Surface>(rest)
          : Surface::create(rest.knots(), rest.control_points(),
                            std::vector<double>(static_cast<std::size_t>(rest.size()), 1.0));
  if (!weighted) return std::unexpected(weighted.error());
  const RationalBasis<2> functions(*weighted, 1);
  const BasisQuadrature quadrature =
      gauss_basis(rest.knots(along), rest.knots(along).degree() + 4, 1);
  const Interval domain = rest.knots(across).domain();
  const double end[] = {at_end ? domain.upper : domain.lower};
  const auto table = tabulate_basis(rest.knots(across), end, 1);
  if (!table) return std::unexpected(table.error());
  const int local = (rest.knots(0).degree() + 1) * (rest.knots(1).degree() + 1);
  std::vector<Eigen::MatrixXd> values(3, Eigen::MatrixXd(local, 1));
  for (int k = 0; k < quadrature.basis.size(); ++k) {
    std::array<int, 2> first;
    std::array<const double*, 2> rows;
    first[static_cast<std::size_t>(along)] = quadrature.basis.first[static_cast<std::size_t>(k)];
    rows[static_cast<std::size_t>(along)] = quadrature.basis.row(k, 0);
    first[static_cast<std::size_t>(across)] = table->first[0];
    rows[static_cast<std::size_t>(across)] = table->row(0, 0);
    if (auto ok = functions.evaluate(first, rows, 0, values); !ok)
      return std::unexpected(ok.error());
    Data::Gauss point;
    for (int r = 0; r < local; ++r) {
      const auto i = functions.global(first, r);
      point.nodes.push_back(first_row + i[0] * rest.net()[1] + i[1]);
    }
    point.gradient.resize(local, 2);
    point.gradient << values[static_cast<std::size_t>(multi_index_position<2>({1, 0}))],
        values[static_cast<std::size_t>(multi_index_position<2>({0, 1}))];
    Tangents at_rest = Tangents::Zero();
    for (std::size_t r = 0; r < point.nodes.size(); ++r) {
      at_rest += rest.control_points().row(point.nodes[r] - first_row).transpose() *
                 point.gradient.row(static_cast<Eigen::Index>(r));
    }
    point.weight =
        per_length * quadrature.weights[static_cast<std::size_t>(k)] * at_rest.col(along).norm();
    data->points.push_back(std::move(point));
  }
  return EdgeMoment(std::move(data));
}

Points EdgeMoment::forces(const Points& x) const {
  Points result = Points::Zero(x.rows(), 3);
  for (const Data::Gauss& point : data_->points) {
    const PointMoment moment(point.tangents(x), data_->along);
    for (std::size_t r = 0; r < point.nodes.size(); ++r) {
      result.row(point.nodes[r]) +=
          point.weight *
          (moment.force * point.gradient.row(static_cast<Eigen::Index>(r)).transpose()).transpose();
    }
  }
  return result;
}

// The symmetric part: a moment that turns with its edge has no potential in general, and Newton's
// method for a symmetric system uses what there is of one.
SparseMatrix EdgeMoment::stiffness(const Points& x) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Data::Gauss& point : data_->points) {
    const PointMoment moment(point.tangents(x), data_->along);
    const Eigen::Matrix<double, 6, 6> d =
        point.weight / 2 * (moment.derivative + moment.derivative.transpose());
    const auto local = static_cast<Eigen::Index>(point.nodes.size());
    for (Eigen::Index r = 0; r < local; ++r) {
      for (Eigen::Index s = 0; s < local; ++s) {
        Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
        for (int a = 0; a < 2; ++a) {
          for (int b = 0; b < 2; ++b) {
            block += point.gradient(r, a) * point.gradient(s, b) * d.block<3, 3>(3 * a, 3 * b);
          }
        }
        for (int c = 0; c < 3; ++c) {
          for (int e = 0; e < 3; ++e) {
            entries.emplace_back(3 * point.nodes[static_cast<std::size_t>(r)] + c,
                                 3 * point.nodes[static_cast<std::size_t>(s)] + e, block(c, e));
          }
        }
      }
    }
  }
  SparseMatrix result(3 * data_->size, 3 * data_->size);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace knead
