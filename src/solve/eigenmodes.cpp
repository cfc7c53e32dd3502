#include "knead/solve/eigenmodes.hpp"

#include <fmt/format.h>

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>

#include "base/decompositions.hpp"
#include "coordinate_map.hpp"
#include "eigen_problem.hpp"

// Not Spectra: its headers throw, and the core is compiled without exceptions; and its Lanczos
// iterations have one starting vector, which may miss copies of multiple eigenvalues, as those of
// square plates and round cans.

namespace knead {
namespace {

constexpr double wanted_residual = 1e-10;
constexpr Eigen::Index block_size = 8, most_vectors = 400;
constexpr double relative_shift = 1e-9;
// What a vector must keep of its length when others are subtracted from it.
constexpr double dependent = 1e-12;

/// Numbers in (−1, 1) of the 64-bit linear congruential sequence of Knuth's MMIX.
class Sequence {
 public:
  double next() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(static_cast<std::int64_t>(state_)) * 0x1p-63;
  }

 private:
  std::uint64_t state_ = 1;
};

/// Which eigenvalues θ of the operator are sought: the largest magnitudes, or the largest above 0.
enum class Wanted { largest, positive };

struct RitzPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Block Lanczos for the operator A⁻¹ C, symmetric in the inner product of P.
///
/// The invariant subspace is grown block by block: V_{k+1} R = A⁻¹C V_k − V (Vᵀ P A⁻¹ C V_k), V
/// P-orthonormal, T = Vᵀ P A⁻¹ C V. With the eigenpair (θ, s) of T, x = V s has the residual |A⁻¹C
/// x − θ x|_P = |R s_last|, s_last the rows of the last block: known without computing x (Grimes,
/// Lewis and Simon, "A shifted block Lanczos algorithm for solving sparse symmetric generalized
/// eigenproblems", 1994).
///
/// A block of 8 starting vectors or more finds eigenvalues of multiplicity up to 8; a single vector
/// finds one copy of each. Every block is orthogonalised against all before, twice: then no copies
/// of converged pairs appear, which a three-term recurrence would produce by rounding. The price is
/// N × 400 numbers and O(N m²) operations for m vectors.
class Lanczos {
 public:
  Lanczos(const detail::SparseLdlt& a, const SparseMatrix& c, const SparseMatrix& p)
      : a_(a),
        c_(c),
        p_(p),
        most_(std::min(most_vectors, p.rows())),
        basis_(p.rows(), most_),
        t_(most_, most_) {
    t_.setZero();
  }

  /// The wanted pairs that converged, best first, `count` at most.
  Expected<RitzPairs> find(Eigen::Index count, Wanted wanted) {
    count = std::min(count, most_);
    Eigen::MatrixXd next(p_.rows(), std::min(std::max(block_size, count / 2), most_));
    for (double& x : next.reshaped()) x = sequence_.next();
    orthonormalise(next);
    if (next.cols() == 0) return RitzPairs{{}, Eigen::MatrixXd(p_.rows(), 0)};
    while (true) {
      const Eigen::Index first = size_, width = append(next);
      next = a_.solve(Eigen::MatrixXd(c_ * basis_.middleCols(first, width)));
      for (int pass = 0; pass < 2; ++pass) {  // twice is enough
        const Eigen::MatrixXd h = basis_.leftCols(size_).transpose() * (p_ * next);
        next.noalias() -= basis_.leftCols(size_) * h;
        t_.block(0, first, size_, width) += h;
      }
      t_.block(first, 0, width, first) = t_.block(0, first, first, width).transpose();
      const Eigen::MatrixXd r = orthonormalise(next);
      auto found = converged(count, wanted, r, first, width);
      const bool exhausted = size_ == most_ || next.cols() == 0;
      if (!found || found->values.size() >= count || exhausted) return found;
    }
  }

 private:
  Eigen::Index append(const Eigen::MatrixXd& block) {
    const Eigen::Index width = std::min(block.cols(), most_ - size_);
    basis_.middleCols(size_, width) = block.leftCols(width);
    size_ += width;
    return width;
  }

  /// Replaces columns by orthonormal ones of the same span and returns R of the product; columns
  /// that depend on others are left out.
  ///
  /// Gram–Schmidt, twice, with P as inner product. A column that loses all but 1e-12 of the
  /// largest length lies in the span of those before; the space is then invariant in its direction.
  Eigen::MatrixXd orthonormalise(Eigen::MatrixXd& block) {
    Eigen::MatrixXd r = Eigen::MatrixXd::Zero(block.cols(), block.cols());
    Eigen::Index kept = 0;
    double largest = 0;
    for (Eigen::Index j = 0; j < block.cols(); ++j) {
      Eigen::VectorXd x = block.col(j);
      const double before = length(x);
      largest = std::max(largest, before);
      for (int pass = 0; pass < 2; ++pass) {
        const Eigen::VectorXd h = block.leftCols(kept).transpose() * (p_ * x);
        x.noalias() -= block.leftCols(kept) * h;
        r.block(0, j, kept, 1) += h;
      }
      // Rounding leaves parts along the vectors before.
      if (size_ > 0)
        x.noalias() -=
            basis_.leftCols(size_) * (basis_.leftCols(size_).transpose() * (p_ * x)).eval();
      const double left = length(x);
      if (!(left > dependent * largest) || left == 0) continue;
      r(kept, j) = left;
      block.col(kept++) = x / left;
    }
    block.conservativeResize(Eigen::NoChange, kept);
    return r.topRows(kept).eval();
  }

  [[nodiscard]] double length(const Eigen::VectorXd& x) const {
    return std::sqrt(std::max(0.0, x.dot(p_ * x)));
  }

  // The Rayleigh–Ritz pairs of T that have converged, in order from the best, up to the first that
  // has not: a pair behind one that is still moving may itself move up.
  [[nodiscard]] Expected<RitzPairs> converged(Eigen::Index count, Wanted wanted,
                                              const Eigen::MatrixXd& r, Eigen::Index first,
                                              Eigen::Index width) const {
    const Eigen::MatrixXd t = t_.topLeftCorner(size_, size_);
    const auto ritz = detail::symmetric_eigen(Eigen::MatrixXd((t + t.transpose()) / 2));
    if (!ritz) return std::unexpected(ritz.error());
    std::vector<Eigen::Index> order(static_cast<std::size_t>(size_));
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    const Eigen::VectorXd& theta = ritz->values;
    std::ranges::stable_sort(order, [&](Eigen::Index i, Eigen::Index j) {
      return wanted == Wanted::positive ? theta[i] > theta[j]
                                        : std::abs(theta[i]) > std::abs(theta[j]);
    });
    const double largest = theta.cwiseAbs().maxCoeff();
    std::vector<Eigen::Index> good;
    for (const Eigen::Index i : order) {
      if (static_cast<Eigen::Index>(good.size()) == count) break;
      if (wanted == Wanted::positive && theta[i] <= dependent * largest) break;
      const double error =
          r.rows() == 0 ? 0 : (r * ritz->vectors.col(i).segment(first, width)).norm();
      if (error > wanted_residual * std::abs(theta[i])) break;  // in order, so that none is skipped
      good.push_back(i);
    }
    RitzPairs result;
    result.values.resize(static_cast<Eigen::Index>(good.size()));
    result.vectors.resize(basis_.rows(), result.values.size());
    for (Eigen::Index k = 0; k < result.values.size(); ++k) {
      const Eigen::Index i = good[static_cast<std::size_t>(k)];
      result.values[k] = theta[i];
      result.vectors.col(k) = basis_.leftCols(size_) * ritz->vectors.col(i);
    }
    return result;
  }

  const detail::SparseLdlt& a_;
  const SparseMatrix &c_, &p_;
  Eigen::Index most_, size_ = 0;
  Eigen::MatrixXd basis_, t_;
  Sequence sequence_;
};

/// The displacement x = T y, its longest row of length 1.
Points shape_of(const SparseMatrix& map, const Eigen::VectorXd& y) {
  const Eigen::VectorXd x = map * y;
  Points shape = Eigen::Map<const Points>(x.data(), x.size() / 3, 3);
  const double largest = shape.rowwise().norm().maxCoeff();
  if (largest > 0) shape /= largest;
  return shape;
}

Expected<void> check(const SparseMatrix& a, const SparseMatrix& b, const SparseMatrix& map,
                     int count) {
  if (count < 1)
    return input_error(fmt::format("{} is not a number of modes", count), "count", "use 1 or more");
  if (a.rows() != b.rows() || a.rows() != map.rows()) {
    return input_error("the matrices are of different sizes", "modes",
                       "give 3 rows per control point");
  }
  if (map.cols() == 0)
    return input_error("everything is held", "modes", "leave something free to move");
  return {};
}

Expected<SparseMatrix> map_of(Eigen::Index coordinates,
                              std::span<const LinearConstraint> constraints) {
  auto space = ConstraintSpace::create(static_cast<int>(coordinates / 3), constraints);
  if (!space) return std::unexpected(space.error());
  return coordinate_map(*space);
}

SparseMatrix restricted(const SparseMatrix& a, const SparseMatrix& map) {
  return map.transpose() * a * map;
}

double trace(const SparseMatrix& a) { return a.diagonal().sum(); }

}  // namespace

// T as a matrix of 3N rows, whether or not constraints couple coordinates.
SparseMatrix coordinate_map(const ConstraintSpace& space) {
  std::vector<int> all(static_cast<std::size_t>(space.size()));
  std::iota(all.begin(), all.end(), 0);
  const int copies = space.coupled() ? 1 : 3;
  std::vector<Eigen::Triplet<double>> entries;
  for (const ConstraintSpace::Term& term : space.terms(all)) {
    for (int c = 0; c < copies; ++c) {
      entries.emplace_back(copies * term.row + c, copies * term.unknown + c, term.coefficient);
    }
  }
  SparseMatrix map(3 * space.size(), copies * space.free_count());
  map.setFromTriplets(entries.begin(), entries.end());
  return map;
}

SparseMatrix on_coordinates(const SparseMatrix& scalar) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(3 * scalar.nonZeros()));
  for (int j = 0; j < scalar.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(scalar, j); it; ++it) {
      for (int c = 0; c < 3; ++c)
        entries.emplace_back(3 * static_cast<int>(it.row()) + c, 3 * j + c, it.value());
    }
  }
  SparseMatrix result(3 * scalar.rows(), 3 * scalar.cols());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

// K φ = ω² M φ. The lowest ω² are the largest θ = 1/(ω² + σ) of (K + σM)⁻¹M, which is symmetric in
// the inner product of M, and which Lanczos finds first (shift and invert: Ericsson and Ruhe, "The
// spectral transformation Lanczos method", 1980). K is singular where rigid motions are left; a σ
// of 1e-9 of the mean ω², tr K / tr M, keeps it regular, and ω² = 0 comes out as a θ like any
// other. Values are Rayleigh quotients of the unshifted matrices, whose error is the square of the
// vector's.
Expected<std::vector<Eigenmode>> mapped_vibration_modes(const SparseMatrix& stiffness,
                                                        const SparseMatrix& mass,
                                                        const SparseMatrix& map, int count) {
  if (auto ok = check(stiffness, mass, map, count); !ok) return std::unexpected(ok.error());
  const SparseMatrix k = restricted(stiffness, map), m = restricted(mass, map);
  if (!(trace(m) > 0))
    return input_error("there is no mass", "density", "give the material a density > 0");
  const double shift = relative_shift * std::max(trace(k), 0.0) / trace(m);
  const SparseMatrix shifted = k + shift * m;
  detail::SparseLdlt solver;
  if (!solver.factor(shifted)) {
    return numerical_error("the stiffness cannot be factored", "modes",
                           "look for folds, and for a load that buckles it");
  }
  const auto wanted = std::min<Eigen::Index>(count, map.cols());
  const auto pairs = Lanczos(solver, m, m).find(wanted, Wanted::largest);
  if (!pairs) return std::unexpected(pairs.error());
  if (pairs->values.size() < wanted) {
    return numerical_error(fmt::format("{} of {} modes converged", pairs->values.size(), wanted),
                           "count", "ask for fewer");
  }
  std::vector<Eigenmode> modes;
  for (Eigen::Index i = 0; i < wanted; ++i) {
    const Eigen::VectorXd y = pairs->vectors.col(i), ky = k * y, my = m * y;
    const double value = y.dot(ky) / y.dot(my);
    modes.push_back({value, (ky - value * my).norm() / (ky + shift * my).norm(), shape_of(map, y)});
  }
  std::ranges::stable_sort(modes, {}, &Eigenmode::value);
  return modes;
}

// (K + λ K_G) φ = 0 with the geometric stiffness K_G of the given load. With G = −K_G, θ = 1/λ are
// the eigenvalues of K⁻¹G, symmetric in the inner product of K, which must be positive definite;
// that of G would be none, as G is indefinite. The smallest λ > 0 are the largest θ > 0; loads in
// the opposite direction have θ < 0.
Expected<std::vector<Eigenmode>> mapped_buckling_modes(const SparseMatrix& stiffness,
                                                       const SparseMatrix& geometric,
                                                       const SparseMatrix& map, int count) {
  if (auto ok = check(stiffness, geometric, map, count); !ok) return std::unexpected(ok.error());
  const SparseMatrix k = restricted(stiffness, map), g = -restricted(geometric, map);
  detail::SparseLdlt solver;
  if (!solver.factor(k) || !solver.positive()) {
    return numerical_error("the structure moves without strain, or is unstable without its load",
                           "buckling", "hold it so that no rigid motion is left");
  }
  const auto pairs =
      Lanczos(solver, g, k).find(std::min<Eigen::Index>(count, map.cols()), Wanted::positive);
  if (!pairs) return std::unexpected(pairs.error());
  std::vector<Eigenmode> modes;
  for (Eigen::Index i = 0; i < pairs->values.size(); ++i) {
    const Eigen::VectorXd y = pairs->vectors.col(i), ky = k * y, gy = g * y;
    const double value = y.dot(ky) / y.dot(gy);
    modes.push_back({value, (ky - value * gy).norm() / ky.norm(), shape_of(map, y)});
  }
  return modes;
}

Expected<std::vector<Eigenmode>> vibration_modes(const SparseMatrix& stiffness,
                                                 const SparseMatrix& mass,
                                                 std::span<const LinearConstraint> constraints,
                                                 int count) {
  const auto map = map_of(stiffness.rows(), constraints);
  if (!map) return std::unexpected(map.error());
  return mapped_vibration_modes(stiffness, mass, *map, count);
}

Expected<std::vector<Eigenmode>> buckling_modes(const SparseMatrix& stiffness,
                                                const SparseMatrix& geometric,
                                                std::span<const LinearConstraint> constraints,
                                                int count) {
  const auto map = map_of(stiffness.rows(), constraints);
  if (!map) return std::unexpected(map.error());
  return mapped_buckling_modes(stiffness, geometric, *map, count);
}

}  // namespace knead
