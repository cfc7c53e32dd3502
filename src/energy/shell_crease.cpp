#include "shell_crease.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/gauss_legendre.hpp"
#include "rational_basis.hpp"

namespace knead {
namespace {

/// The tangents a_1, a_2 of one side, then those of the other.
using SideTangents = Eigen::Matrix<double, 3, 4>;
using Gradient = Eigen::Matrix<double, 12, 1>;

/// c and s of one point, and their derivatives by the four tangents.
struct PointAngle {
  double c, s;
  Gradient dc, ds;

  // δn = (δ(a_1 × a_2) − n n·δ(a_1 × a_2)) / |a_1 × a_2|: for a vector y, y·δn = ŷ·(δa_1 × a_2 +
  // a_1 × δa_2) with ŷ = (y − n n·y) / |a_1 × a_2|, whose derivatives are a_2 × ŷ by a_1 and ŷ ×
  // a_1 by a_2.
  PointAngle(const SideTangents& a, int along) {
    const Eigen::Vector3d cross[2] = {a.col(0).cross(a.col(1)), a.col(2).cross(a.col(3))};
    const double area[2] = {cross[0].norm(), cross[1].norm()}, speed = a.col(along).norm();
    const Eigen::Vector3d n[2] = {cross[0] / area[0], cross[1] / area[1]}, t = a.col(along) / speed;
    c = n[0].dot(n[1]);
    s = n[0].cross(n[1]).dot(t);
    // δc = n_b·δn_a + n_a·δn_b, δs = (n_b × t)·δn_a + (t × n_a)·δn_b + (n_a × n_b)·δt.
    const Eigen::Vector3d by_c[2] = {n[1], n[0]}, by_s[2] = {n[1].cross(t), t.cross(n[0])};
    for (int side = 0; side < 2; ++side) {
      const auto tangents = a.middleCols<2>(2 * side);
      const auto through_normal = [&](const Eigen::Vector3d& by, Gradient& out) {
        const Eigen::Vector3d flat = (by - n[side].dot(by) * n[side]) / area[side];
        out.segment<3>(6 * side) = tangents.col(1).cross(flat);
        out.segment<3>(6 * side + 3) = flat.cross(tangents.col(0));
      };
      through_normal(by_c[side], dc);
      through_normal(by_s[side], ds);
    }
    const Eigen::Vector3d by_t = n[0].cross(n[1]);
    ds.segment<3>(3 * along) += (by_t - t.dot(by_t) * t) / speed;
  }
};

/// The first derivatives of the basis of one side at one point of the seam: those of functions that
/// are not zero.
struct SidePoint {
  std::vector<int> nodes;
  Eigen::MatrixX2d gradient;
};

class SideBasis {
 public:
  static Expected<SideBasis> create(const CreaseSide& side) {
    const Surface& rest = *side.rest;
    auto weighted =
        rest.rational()
            ? Expected<Surface>(rest)
            : Surface::create(rest.knots(), rest.control_points(),
                              std::vector<double>(static_cast<std::size_t>(rest.size()), 1.0));
    if (!weighted) return std::unexpected(weighted.error());
    return SideBasis(side, std::move(*weighted));
  }

  /// At a parameter along the edge.
  [[nodiscard]] Expected<SidePoint> at(double parameter) const {
    const KnotVector &along = weighted_.knots(1 - side_.across),
                     &across = weighted_.knots(side_.across);
    const double place[] = {parameter};
    const double end[] = {side_.at_end ? across.domain().upper : across.domain().lower};
    const auto table = tabulate_basis(along, place, 1), edge = tabulate_basis(across, end, 1);
    if (!table) return std::unexpected(table.error());
    if (!edge) return std::unexpected(edge.error());
    std::array<int, 2> first;
    std::array<const double*, 2> rows;
    const auto l = static_cast<std::size_t>(1 - side_.across),
               c = static_cast<std::size_t>(side_.across);
    first[l] = table->first[0];
    rows[l] = table->row(0, 0);
    first[c] = edge->first[0];
    rows[c] = edge->row(0, 0);
    const RationalBasis<2> functions(weighted_, 1);
    const int local = (along.degree() + 1) * (across.degree() + 1);
    std::vector<Eigen::MatrixXd> values(3, Eigen::MatrixXd(local, 1));
    if (auto ok = functions.evaluate(first, rows, 0, values); !ok)
      return std::unexpected(ok.error());
    const Eigen::MatrixXd &u = values[static_cast<std::size_t>(multi_index_position<2>({1, 0}))],
                          &v = values[static_cast<std::size_t>(multi_index_position<2>({0, 1}))];
    SidePoint point;
    std::vector<int> kept;
    for (int r = 0; r < local; ++r) {
      if (u(r, 0) == 0 && v(r, 0) == 0) continue;
      const auto i = functions.global(first, r);
      point.nodes.push_back(side_.first + i[0] * weighted_.net()[1] + i[1]);
      kept.push_back(r);
    }
    point.gradient.resize(static_cast<Eigen::Index>(kept.size()), 2);
    for (std::size_t k = 0; k < kept.size(); ++k) {
      point.gradient.row(static_cast<Eigen::Index>(k)) << u(kept[k], 0), v(kept[k], 0);
    }
    return point;
  }

 private:
  SideBasis(const CreaseSide& side, Surface weighted)
      : side_(side), weighted_(std::move(weighted)) {}
  CreaseSide side_;
  Surface weighted_;
};

/// Shares of the domain at which spans of either side end, ascending.
/// Gauss rules must not cross a knot of either side: derivatives across may jump there.
std::vector<double> breaks_of(const KnotVector& a, const KnotVector& b, bool reversed) {
  std::vector<double> breaks;
  const auto append = [&](const KnotVector& knots, bool turned) {
    const Interval domain = knots.domain();
    for (const int span : knots.spans()) {
      for (const int k : {span, span + 1}) {
        const double share = (knots[k] - domain.lower) / domain.length();
        breaks.push_back(turned ? 1 - share : share);
      }
    }
  };
  append(a, false);
  append(b, reversed);
  std::ranges::sort(breaks);
  constexpr double same = 1e-9;  // shares this close are one
  const auto end =
      std::ranges::unique(breaks, [](double x, double y) { return y - x <= same; }).begin();
  breaks.erase(end, breaks.end());
  return breaks;
}

}  // namespace

struct ShellCrease::Data {
  struct Gauss {
    double weight;           // of the quadrature, times k and the speed at rest
    std::vector<int> nodes;  // of both sides
    Eigen::MatrixX4d
        gradient;  // derivatives of their functions by u and v of side a, then of side b
    double c, s;   // at rest

    [[nodiscard]] SideTangents tangents(const Points& x) const {
      SideTangents a = SideTangents::Zero();
      for (std::size_t r = 0; r < nodes.size(); ++r) {
        a += x.row(nodes[r]).transpose() * gradient.row(static_cast<Eigen::Index>(r));
      }
      return a;
    }
  };
  int along = 0;
  std::vector<Gauss> points;

  [[nodiscard]] Expected<void> add(const SidePoint& a, const SidePoint& b, double weight,
                                   const Points& rest_a, const Points& rest_b, int first_a,
                                   int first_b);
};

/// `weight` does not count the speed yet.
Expected<void> ShellCrease::Data::add(const SidePoint& a, const SidePoint& b, double weight,
                                      const Points& rest_a, const Points& rest_b, int first_a,
                                      int first_b) {
  Gauss point{weight, a.nodes, {}, 0, 0};
  point.nodes.insert(point.nodes.end(), b.nodes.begin(), b.nodes.end());
  point.gradient = Eigen::MatrixX4d::Zero(static_cast<Eigen::Index>(point.nodes.size()), 4);
  point.gradient.topLeftCorner(a.gradient.rows(), 2) = a.gradient;
  point.gradient.bottomRightCorner(b.gradient.rows(), 2) = b.gradient;
  SideTangents at_rest = SideTangents::Zero();
  for (std::size_t r = 0; r < point.nodes.size(); ++r) {
    const bool of_a = r < a.nodes.size();
    const Eigen::RowVector3d place =
        of_a ? rest_a.row(point.nodes[r] - first_a) : rest_b.row(point.nodes[r] - first_b);
    at_rest += place.transpose() * point.gradient.row(static_cast<Eigen::Index>(r));
  }
  const PointAngle angle(at_rest, along);
  if (!std::isfinite(angle.c) || !std::isfinite(angle.s)) {
    return numerical_error("a side of a crease has no normal at rest", "seam",
                           "remove collapsed edges beside it");
  }
  point.c = angle.c;
  point.s = angle.s;
  point.weight *= at_rest.col(along).norm();
  points.push_back(std::move(point));
  return {};
}

Expected<ShellCrease> ShellCrease::create(const CreaseSide& a, const CreaseSide& b, bool reversed,
                                          double stiffness) {
  if (!(std::isfinite(stiffness) && stiffness > 0)) {
    return input_error(fmt::format("{} is not a stiffness of a crease", stiffness), "stiffness",
                       "use a finite number > 0");
  }
  const auto basis_a = SideBasis::create(a), basis_b = SideBasis::create(b);
  if (!basis_a) return std::unexpected(basis_a.error());
  if (!basis_b) return std::unexpected(basis_b.error());
  const KnotVector &knots_a = a.rest->knots(1 - a.across), &knots_b = b.rest->knots(1 - b.across);
  const Interval domain_a = knots_a.domain(), domain_b = knots_b.domain();
  const std::vector<double> breaks = breaks_of(knots_a, knots_b, reversed);
  const int count = std::max(knots_a.degree(), knots_b.degree()) + 1;
  const auto rule = gauss_legendre(count);
  auto data = std::make_shared<Data>();
  data->along = 1 - a.across;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    const double half = 0.5 * (breaks[k + 1] - breaks[k]),
                 middle = 0.5 * (breaks[k + 1] + breaks[k]);
    for (int g = 0; g < count; ++g) {
      const double share = middle + half * rule.abscissae[static_cast<std::size_t>(g)];
      const double share_b = reversed ? 1 - share : share;
      const auto at_a = basis_a->at(domain_a.lower + share * domain_a.length());
      const auto at_b = basis_b->at(domain_b.lower + share_b * domain_b.length());
      if (!at_a) return std::unexpected(at_a.error());
      if (!at_b) return std::unexpected(at_b.error());
      const double weight =
          stiffness * half * domain_a.length() * rule.weights[static_cast<std::size_t>(g)];
      if (auto ok = data->add(*at_a, *at_b, weight, a.rest->control_points(),
                              b.rest->control_points(), a.first, b.first);
          !ok) {
        return std::unexpected(ok.error());
      }
    }
  }
  return ShellCrease(std::move(data));
}

double ShellCrease::energy(const Points& x) const {
  double sum = 0;
  for (const Data::Gauss& point : data_->points) {
    const PointAngle now(point.tangents(x), data_->along);
    sum += 0.5 * point.weight *
           ((now.c - point.c) * (now.c - point.c) + (now.s - point.s) * (now.s - point.s));
  }
  return sum;
}

void ShellCrease::add_gradient(const Points& x, Points& gradient) const {
  for (const Data::Gauss& point : data_->points) {
    const PointAngle now(point.tangents(x), data_->along);
    const Gradient by_tangents =
        point.weight * ((now.c - point.c) * now.dc + (now.s - point.s) * now.ds);
    const Eigen::Map<const SideTangents> f(by_tangents.data());
    for (std::size_t r = 0; r < point.nodes.size(); ++r) {
      gradient.row(point.nodes[r]) +=
          (f * point.gradient.row(static_cast<Eigen::Index>(r)).transpose()).transpose();
    }
  }
}

// Gauss and Newton's part is positive semidefinite, which the minimisation needs; the rest is
// proportional to c − c_0 and s − s_0, small wherever the spring does its work.
void ShellCrease::append_hessian(const Points& x,
                                 std::vector<Eigen::Triplet<double>>& entries) const {
  for (const Data::Gauss& point : data_->points) {
    const PointAngle now(point.tangents(x), data_->along);
    const auto n = static_cast<Eigen::Index>(point.nodes.size());
    Eigen::MatrixX2d rows(3 * n, 2);
    for (int k = 0; k < 2; ++k) {
      const Gradient& by = k == 0 ? now.dc : now.ds;
      const Eigen::Map<const SideTangents> f(by.data());
      for (Eigen::Index r = 0; r < n; ++r)
        rows.col(k).segment<3>(3 * r) = f * point.gradient.row(r).transpose();
    }
    const Eigen::MatrixXd block = point.weight * rows * rows.transpose();
    for (Eigen::Index i = 0; i < 3 * n; ++i) {
      for (Eigen::Index j = 0; j < 3 * n; ++j) {
        entries.emplace_back(
            3 * point.nodes[static_cast<std::size_t>(i / 3)] + static_cast<int>(i % 3),
            3 * point.nodes[static_cast<std::size_t>(j / 3)] + static_cast<int>(j % 3),
            block(i, j));
      }
    }
  }
}

double ShellCrease::opening(const Points& x) const {
  double largest = 0;
  for (const Data::Gauss& point : data_->points) {
    const PointAngle now(point.tangents(x), data_->along);
    const double c = now.c * point.c + now.s * point.s, s = now.s * point.c - now.c * point.s;
    largest = std::max(largest, std::abs(std::atan2(s, c)));
  }
  return largest;
}

}  // namespace knead
