#include <fmt/format.h>

#include <algorithm>

#include "base/decompositions.hpp"
#include "constraint_rows.hpp"

namespace knead {
namespace {

/// V_j = Σ_k a_jk V_{basis_k}: the coefficients of every column of `ring` (3 × n) over `rank`
/// independent columns.
struct RingRelation {
  int rank = 0;
  std::vector<int> basis;
  Eigen::MatrixXd coefficients;  // rank × n
};

// Rank by singular values above `flatness` of the largest: 2 for a ring in a plane with the pole, 3
// for a cone, 1 for a line, 0 if it is collapsed too. Coordinates along the singular vectors kept
// are then combined by QR with pivoting, whose pivots are the columns that span the ring best.
Expected<RingRelation> relation(const Eigen::Matrix3Xd& ring, double flatness) {
  RingRelation result;
  const auto left = detail::left_singular(ring);
  if (!left) return std::unexpected(left.error());
  const auto& [vectors, singular] = *left;
  while (result.rank < std::min<Eigen::Index>(3, ring.cols()) &&
         singular[result.rank] > flatness * singular[0])
    ++result.rank;
  if (result.rank == 0) return result;
  const Eigen::MatrixXd flat = vectors.leftCols(result.rank).transpose() * ring;
  const auto qr = detail::PivotedQr::create(flat);
  if (!qr) return std::unexpected(qr.error());
  for (int k = 0; k < result.rank; ++k) result.basis.push_back(qr->order()[k]);
  result.coefficients = qr->coefficients(result.rank);
  return result;
}

}  // namespace

// At a collapsed side C¹ asks that the next row stays an affine image of its rest shape: Q_j − P =
// Σ_k a_jk (Q_k − P) with the a of the rest shape. So a plane tangent to the surface at the pole
// stays one, and a cone a cone, while the frame of up to three columns moves freely.
Expected<std::vector<Pole>> keep_poles(const Surface& rest, double tolerance, double flatness,
                                       ConstraintList& to) {
  for (const auto& [value, name] :
       {std::pair{tolerance, "pole"}, std::pair{flatness, "flatness"}}) {
    if (auto valid = detail::check_tolerance(value, name); !valid)
      return std::unexpected(valid.error());
  }
  std::vector<Pole> poles;
  for (const SurfaceEdge edge :
       {SurfaceEdge::u0, SurfaceEdge::u1, SurfaceEdge::v0, SurfaceEdge::v1}) {
    const detail::NetAcross net(rest, edge_across(edge));
    const KnotVector& knots = net.knots();
    const int p = knots.degree(), count = knots.count(), columns = net.columns();
    // With p equal knots at the end, its row of control points is the edge.
    if (edge_at_end(edge) ? knots[count] != knots[count + p - 1] : knots[1] != knots[p]) continue;
    const int row = edge_at_end(edge) ? count - 1 : 0, next = edge_at_end(edge) ? count - 2 : 1;
    const Point pole = net.point(row, 0);
    Eigen::Matrix3Xd ring(3, columns);
    bool collapsed = true;
    for (int j = 0; j < columns; ++j) {
      collapsed = collapsed && (net.point(row, j) - pole).norm() <= tolerance;
      ring.col(j) = net.point(next, j) - pole;
    }
    if (!collapsed) continue;
    const std::string name = fmt::format("pole {}", edge_name(edge));
    const auto affine = relation(ring, flatness);
    if (!affine) return std::unexpected(affine.error().within(name));
    for (int j = 0; j < columns; ++j) {
      if (j > 0) detail::append(to, name, {{net.index(row, j), 1.0}, {net.index(row, 0), -1.0}});
      detail::Terms terms = {{net.index(next, j), 1.0}};
      double sum = 0;
      bool chosen = false;
      for (int k = 0; k < affine->rank; ++k) {
        chosen = chosen || affine->basis[static_cast<std::size_t>(k)] == j;
        terms.emplace_back(net.index(next, affine->basis[static_cast<std::size_t>(k)]),
                           -affine->coefficients(k, j));
        sum += affine->coefficients(k, j);
      }
      terms.emplace_back(net.index(row, 0), sum - 1);
      if (!chosen) detail::append(to, name, std::move(terms));
    }
    poles.push_back({edge, affine->rank});
  }
  return poles;
}

}  // namespace knead
