#include "multigrid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/interruption.hpp"
#include "base/parallel_for.hpp"

namespace knead {
namespace {

// Over the largest eigenvalue of D⁻¹A: the upper three quarters fall by 0.6 at least.
//
// With λ the largest eigenvalue, an error along an eigenvector of D⁻¹A with eigenvalue μ is
// multiplied by 1 − 1.6 μ/λ, between −0.6 and 0.6 for μ from λ/4 to λ. Functions with μ below λ/4
// are left to the coarser space.
constexpr double damping = 1.6;
constexpr int power_iterations = 12;
// The smoother diverges, and B is no longer positive, where the weight exceeds 2/λ: that is where
// power iteration has found less than 0.73 of λ.
constexpr double power_margin = 1.1;  // power iteration finds less than the largest eigenvalue
// Of a Galerkin product at a time, which bounds what lies beside it.
constexpr int product_columns = 2048;
constexpr double exact_solve = 1e-12, known_solve = 1e-8, known_tolerance = 1e-3;
constexpr int max_iterations = 500, max_known_iterations = 100;

std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }

double dot(const Points& a, const Points& b) { return a.cwiseProduct(b).sum(); }

/// Pᵀ A P. In blocks of columns: A P as a whole would take as much memory again as A.
SparseMatrix galerkin(const SparseMatrix& a, const SparseMatrix& p,
                      const SparseMatrix& transposed) {
  SparseMatrix result(p.cols(), p.cols());
  for (Eigen::Index first = 0; first < p.cols(); first += product_columns) {
    const Eigen::Index count = std::min<Eigen::Index>(product_columns, p.cols() - first);
    const SparseMatrix right = a * p.middleCols(first, count);
    const SparseMatrix block = transposed * right;
    if (first == 0) result.reserve(block.nonZeros() * (p.cols() / count + 1));
    for (Eigen::Index j = 0; j < count; ++j) {
      result.startVec(first + j);
      for (SparseMatrix::InnerIterator it(block, j); it; ++it)
        result.insertBack(it.row(), first + j) = it.value();
    }
  }
  result.finalize();
  return result;
}

/// Rows of p in these places of a matrix with `rows` rows, −1 being left out, and the columns of p
/// that are not zero then, whose places in the result are written to `columns`.
SparseMatrix placed(const SparseMatrix& p, const std::vector<int>& places, Eigen::Index rows,
                    std::vector<int>& columns) {
  std::vector<Eigen::Triplet<double>> entries;
  int used = 0;
  columns.assign(static_cast<std::size_t>(p.cols()), -1);
  for (Eigen::Index j = 0; j < p.outerSize(); ++j) {
    bool any = false;
    for (SparseMatrix::InnerIterator it(p, j); it; ++it) {
      const int row = places[static_cast<std::size_t>(it.row())];
      if (row < 0) continue;
      entries.emplace_back(row, used, it.value());
      any = true;
    }
    if (any) columns[static_cast<std::size_t>(j)] = used++;
  }
  SparseMatrix result(rows, used);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

/// Tᵀ A T in the numbering of points; rows and columns of others than independent points are empty.
SparseMatrix lumped(const ConstraintSpace& space, const SparseMatrix& a) {
  const SparseMatrix reduced = space.restrict(a);
  const std::span<const int> free = space.independent();
  SparseMatrix result(a.rows(), a.cols());
  result.reserve(reduced.nonZeros());
  Eigen::Index column = 0;
  for (std::size_t k = 0; k < free.size(); ++k) {
    while (column <= free[k]) result.startVec(column++);
    for (SparseMatrix::InnerIterator it(reduced, static_cast<Eigen::Index>(k)); it; ++it)
      result.insertBack(free[at(it.row())], free[k]) = it.value();
  }
  while (column < a.cols()) result.startVec(column++);
  result.finalize();
  return result;
}

/// Numbers between −½ and ½ without a pattern.
///
/// The start of power iteration must have a part along the eigenvector sought, whose signs
/// alternate from control point to control point: a smooth start would have next to none. Fixed
/// numbers, so that the same system gives the same bits.
Points scattered(Eigen::Index rows) {
  Points x(rows, 3);
  std::uint32_t state = 1;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    state = state * 1664525u + 1013904223u;  // Knuth's linear congruence
    x.data()[i] = static_cast<double>(state >> 8) / static_cast<double>(1 << 24) - 0.5;
  }
  return x;
}

/// The damped weights of Jacobi's method, 1.6 / (d λ) for the diagonal d and the largest eigenvalue
/// λ of D⁻¹A, found by power iteration.
/// \param d zero where there is no unknown.
template <class Product>
Eigen::VectorXd jacobi_weights(const Eigen::VectorXd& d, const Product& product) {
  const Eigen::VectorXd inverse = (d.array() == 0).select(0.0, d.cwiseInverse());
  double largest = 1;
  Points x = inverse.cwiseSign().asDiagonal() * scattered(d.size());
  for (int i = 0; i < power_iterations; ++i) {
    x /= x.norm();
    x = inverse.asDiagonal() * product(x);
    largest = x.norm();
  }
  return damping / (power_margin * largest) * inverse;
}

/// x = w r.
void weigh(const Eigen::VectorXd& w, const Points& r, Points& x) {
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    for (int c = 0; c < 3; ++c) x(i, c) = w[i] * r(i, c);
  }
}

}  // namespace

ConstrainedMultigrid::Columns::Columns(const SparseMatrix& a) {
  start.assign(a.outerIndexPtr(), a.outerIndexPtr() + a.cols() + 1);
  row.assign(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros());
  value.assign(a.valuePtr(), a.valuePtr() + a.nonZeros());
}

/// y = Aᵀ x. Four sums side by side do not wait for one another.
void ConstrainedMultigrid::Columns::transposed_times(const Fours& x, Fours& y) const {
  y.resize(count());
  const double work = 4.0 * static_cast<double>(value.size()) /
                      static_cast<double>(std::max<std::size_t>(count(), 1));
  const auto columns = static_cast<std::ptrdiff_t>(count());
  detail::parallel_for(columns, detail::block_size(columns, work),
                       [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                         for (; begin < end; ++begin) {
                           const auto j = static_cast<std::size_t>(begin);
                           Four sum[4] = {};
                           int k = start[j];
                           for (; k + 4 <= start[j + 1]; k += 4) {
                             for (int c = 0; c < 4; ++c)
                               sum[c] += value[at(k + c)] * x[at(row[at(k + c)])];
                           }
                           for (; k < start[j + 1]; ++k) sum[0] += value[at(k)] * x[at(row[at(k)])];
                           y[j] = (sum[0] + sum[1]) + (sum[2] + sum[3]);
                         }
                       });
}

Points ConstrainedMultigrid::apply(const Points& x) const {
  if (!space_.tied()) return product_(x);  // what is held is zero, and of the result it is not read
  return space_.lumped(product_(space_.expand_points(space_.reduce_points(x))));
}

// x ≈ A⁻¹ r on space `level` + 2 (the finest is in `precondition`): one smoothing from x = 0, the
// correction from the next space, and one smoothing more. With S = w D⁻¹ (w the damping over λ)
// both ends are the same, so that the map r ↦ x is
//
//   B = S + (I − S A) P B' Pᵀ (I − A S) + (I − S A) S,
//
// symmetric, and positive where B' and 2 D/w − A are: what conjugate gradients need of a
// preconditioner. Several smoothings, or Gauss–Seidel, would smooth more a cycle; the first costs a
// product for each, and the second depends on an order of unknowns, which threads would have to
// respect.
//
// The correction is applied twice from the third space on (a W): a second cycle from the residual
// of the first is again symmetric, and levels with a quarter of the unknowns each keep the cost of
// a cycle at O(N).
void ConstrainedMultigrid::cycle(std::size_t level, const Fours& r, Fours& x) const {
  x.resize(r.size());
  if (level == levels_.size()) {
    Points b(static_cast<Eigen::Index>(r.size()), 3);
    for (std::size_t i = 0; i < r.size(); ++i) {
      for (int c = 0; c < 3; ++c) b(static_cast<Eigen::Index>(i), c) = static_cast<double>(r[i][c]);
    }
    const Points solved = coarsest_->solve(b);
    for (std::size_t i = 0; i < r.size(); ++i) {
      for (int c = 0; c < 3; ++c)
        x[i][c] = static_cast<float>(solved(static_cast<Eigen::Index>(i), c));
    }
    return;
  }
  const Level& here = levels_[level];
  Fours product, left = r, coarse_r, coarse_x, correction;
  for (std::size_t i = 0; i < r.size(); ++i) x[i] = here.weight[i] * r[i];
  here.a.transposed_times(x, product);
  for (std::size_t i = 0; i < r.size(); ++i) left[i] -= product[i];
  here.next.prolongation.transposed_times(left, coarse_r);
  cycle(level + 1, coarse_r, coarse_x);
  if (level + 1 < levels_.size()) {  // a W: the coarser the cheaper
    levels_[level + 1].a.transposed_times(coarse_x, product);
    for (std::size_t i = 0; i < coarse_r.size(); ++i) coarse_r[i] -= product[i];
    cycle(level + 1, coarse_r, correction);
    for (std::size_t i = 0; i < coarse_r.size(); ++i) coarse_x[i] += correction[i];
  }
  here.next.restriction.transposed_times(coarse_x, correction);
  here.a.transposed_times(correction, product);
  for (std::size_t i = 0; i < r.size(); ++i)
    x[i] += correction[i] + here.weight[i] * (left[i] - product[i]);
}

/// The correction from the coarser spaces for a force on the finest one.
///
/// Forces are divided by their largest first: single precision has 7 digits but ends at 1e-38,
/// where residuals of small models and late iterations would vanish.
Points ConstrainedMultigrid::coarse(const Points& r) const {
  const double size = r.cwiseAbs().maxCoeff();
  if (!(size > 0)) return Points::Zero(r.rows(), 3);
  Fours from(static_cast<std::size_t>(r.rows())), restricted, solved, to;
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    for (int c = 0; c < 3; ++c) from[at(i)][c] = static_cast<float>(r(i, c) / size);
  }
  next_.prolongation.transposed_times(from, restricted);
  cycle(0, restricted, solved);
  next_.restriction.transposed_times(solved, to);
  Points correction(r.rows(), 3);
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    for (int c = 0; c < 3; ++c) correction(i, c) = size * static_cast<double>(to[at(i)][c]);
  }
  return correction;
}

// The cycle on the finest space, in double precision and with A applied by the caller's product,
// which need not assemble it: a cubic A on a surface has 49 entries a row. Where nothing depends on
// other unknowns T only leaves rows out, which a weight of 0 does as well.
Points ConstrainedMultigrid::precondition(const Points& r) const {
  Points x(r.rows(), 3);
  weigh(weight_, r, x);
  Points left = r - apply(x);
  for (Eigen::Index i = 0; i < left.rows(); ++i) {
    if (weight_[i] == 0) left.row(i).setZero();
  }
  const Points correction = coarse(left);
  left -= apply(correction);
  for (Eigen::Index i = 0; i < left.rows(); ++i) {
    for (int c = 0; c < 3; ++c) x(i, c) += correction(i, c) + weight_[i] * left(i, c);
  }
  return space_.tied() ? space_.expand_points(space_.reduce_points(x)) : x;
}

// Conjugate gradients preconditioned by B (Hestenes and Stiefel 1952; Saad 2003, Alg. 9.1). The
// square rᵀBr that the recurrence needs anyway is the square of the error in the energy norm, up
// to the difference of B and A⁻¹, and ends it. The curvature is tested, because rounding of an A
// that is nearly singular may make it negative.
ConstrainedMultigrid::Solved ConstrainedMultigrid::iterate(const Points& b, double tolerance,
                                                           int limit) const {
  Points r = space_.lumped(b), z = precondition(r), p = z;
  Solved result{Points::Zero(b.rows(), 3)};
  double rs = dot(r, z);
  const double target = tolerance * tolerance * rs;
  while (rs > target && result.iterations < limit && !Interruption::asked_for()) {
    const Points ap = product_(p);
    const double curvature = dot(p, ap);
    if (!(curvature > 0)) break;
    ++result.iterations;
    result.x += rs / curvature * p;
    r -= rs / curvature * space_.lumped(ap);
    z = precondition(r);
    const double next = dot(r, z);
    p = z + next / rs * p;
    rs = next;
  }
  return result;
}

Points ConstrainedMultigrid::solve(const Points& b) const {
  return iterate(b, exact_solve, max_iterations).x;
}

/// Adds the space of a prolongation, whose matrix takes the place of the one before.
void ConstrainedMultigrid::add_space(SparseMatrix& matrix, const SparseMatrix& prolongation) {
  const SparseMatrix restriction = prolongation.transpose();
  SparseMatrix next = galerkin(matrix, prolongation, restriction);
  Transfer transfer{Columns(prolongation), Columns(restriction)};
  if (weight_.size() == 0) {
    Eigen::VectorXd diagonal = matrix.diagonal();
    if (!space_.tied()) {  // the matrix has rows of held points, too
      Eigen::VectorXd of_free = Eigen::VectorXd::Zero(diagonal.size());
      for (const int i : space_.independent()) of_free[i] = diagonal[i];
      diagonal = of_free;
    }
    weight_ = jacobi_weights(diagonal, [this](const Points& x) { return apply(x); });
    next_ = std::move(transfer);
  } else {
    const Eigen::VectorXd weight = jacobi_weights(
        matrix.diagonal(), [&](const Points& x) { return symmetric_product(matrix, x); });
    levels_.push_back(
        {Columns(matrix), std::vector<float>(weight.begin(), weight.end()), std::move(transfer)});
  }
  matrix = std::move(next);
}

// The known displacement of ones is smooth, the worst case of a method whose coarse spaces do not
// fit; its iteration count also says how good a cycle is (`StepEngine`).
Expected<ConstrainedMultigrid> ConstrainedMultigrid::create(
    SparseMatrix&& a, Product product, ConstraintSpace space,
    const std::vector<SparseMatrix>& prolongations) {
  if (space.coupled() || space.free_count() == 0 || prolongations.empty())
    return usage_error("there are no nested spaces for this system");
  ConstrainedMultigrid result(std::move(space));
  result.product_ = std::move(product);
  SparseMatrix matrix;
  if (result.space_.tied()) {
    matrix = lumped(result.space_, a);
    SparseMatrix().swap(a);
  } else {
    matrix.swap(a);
  }
  std::vector<int> places(static_cast<std::size_t>(matrix.rows()), -1);
  for (const int i : result.space_.independent()) places[at(i)] = i;
  for (const SparseMatrix& given : prolongations) {
    std::vector<int> columns;
    // Constraints are those of the finest space only. A coarse function loses its part on points
    // that are held or dependent, and vanishes where nothing is left: a correction never moves
    // them.
    const SparseMatrix p = placed(given, places, matrix.rows(), columns);
    places = std::move(columns);
    result.add_space(matrix, p);
  }
  auto coarsest = SparseCholesky::factor(std::move(matrix));
  if (!coarsest) return std::unexpected(coarsest.error());
  result.coarsest_ = std::move(*coarsest);

  const Points ones = result.space_.expand_points(Points::Ones(result.space_.free_count(), 3));
  const Solved known = result.iterate(result.product_(ones), known_solve, max_known_iterations);
  if (const double error = (known.x - ones).cwiseAbs().maxCoeff(); !(error <= known_tolerance)) {
    return numerical_error(
        fmt::format("multigrid does not converge (a known solution is missed by {:.1e})", error),
        "iteration", "use the direct solver");
  }
  result.iterations_ = known.iterations;
  return result;
}

}  // namespace knead
