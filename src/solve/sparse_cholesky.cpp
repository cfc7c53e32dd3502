#include "knead/solve/sparse_cholesky.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "dissection.hpp"
#include "panels.hpp"

namespace knead {

struct SparseCholesky::Factor {
  Panels panels;          // L
  Eigen::VectorXi order;  // order[i] = position of unknown i in the reordered system
};

namespace {

/// In the order that `order` finds for the whole matrix, which is emptied. A and its permuted copy
/// are never held together with L: memory peaks at one of the two and L.
template <class Order>
Expected<SparseCholesky> factor_by(SparseMatrix&& a, const Order& order) {
  Dissection dissection;
  {
    const SparseMatrix whole = a.selfadjointView<Eigen::Lower>();
    dissection = order(whole);
  }
  SparseMatrix lower(a.rows(), a.cols());
  lower.selfadjointView<Eigen::Lower>() = a.selfadjointView<Eigen::Lower>().twistedBy(
      Eigen::PermutationMatrix<Eigen::Dynamic>(dissection.order));
  SparseMatrix().swap(a);
  return SparseCholesky::factor_in_order(lower, std::move(dissection));
}

}  // namespace

Expected<SparseCholesky> SparseCholesky::factor(SparseMatrix&& a) {
  return factor_by(std::move(a), [](const SparseMatrix& whole) { return minimum_degree(whole); });
}

Expected<SparseCholesky> SparseCholesky::factor(SparseMatrix&& a, const GridPlaces& places) {
  const auto wanted =
      static_cast<std::size_t>(a.cols()) * static_cast<std::size_t>(std::max(places.directions, 0));
  if (places.directions < 1 || places.indices.size() != wanted) {
    return usage_error(
        fmt::format("there are {} indices of places in {} directions for {} unknowns",
                    places.indices.size(), places.directions, a.cols()),
        "Cholesky factorisation", "give as many for each unknown as there are directions");
  }
  return factor_by(std::move(a), [&](const SparseMatrix& whole) { return dissect(whole, places); });
}

Expected<SparseCholesky> SparseCholesky::factor_in_order(const SparseMatrix& lower,
                                                         Dissection dissection) {
  auto panels = Panels::factor(lower, best_instruction_set(), &dissection);
  if (!panels) {
    return numerical_error(
        "the system matrix is not positive definite", "Cholesky factorisation",
        "hold more control points, or use a larger lambda or positive material coefficients");
  }
  return SparseCholesky(
      std::make_shared<const Factor>(std::move(*panels), std::move(dissection.order)),
      static_cast<int>(lower.rows()));
}

Expected<SparseCholesky> SparseCholesky::factor(const SparseMatrix& a) {
  return factor(SparseMatrix(a));
}

namespace {

/// Columns side by side as `Panels` needs them: three and one more.
template <class Values>
inline constexpr int columns = Values::ColsAtCompileTime == 1 ? 1 : 4;
/// Rows of that many values, each within one line of the cache.
///
/// Rows of 4 doubles on 32-byte boundaries: none crosses a line of the cache, and AVX2 loads each
/// at once.
template <class Values>
class Work {
 public:
  explicit Work(Eigen::Index rows) : values_(columns<Values> * rows + spare) {
    const auto off = reinterpret_cast<std::uintptr_t>(values_.data()) / sizeof(double) % spare;
    first_ = values_.data() + (spare - off) % spare;
  }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  [[nodiscard]] double* data() { return first_; }
  [[nodiscard]] const double* data() const { return first_; }
  void clear() { values_.setZero(); }

 private:
  static constexpr int spare = 4;
  Eigen::VectorXd values_;
  double* first_;
};

template <class Values>
void put(Work<Values>& y, int row, const Values& b, Eigen::Index from) {
  double* to = y.data() + columns<Values> * static_cast<std::ptrdiff_t>(row);
  for (int c = 0; c < columns<Values>; ++c) to[c] = c < b.cols() ? b(from, c) : 0;
}

template <class Values>
void take(const Work<Values>& y, int row, Values& x, Eigen::Index to) {
  const double* from = y.data() + columns<Values> * static_cast<std::ptrdiff_t>(row);
  for (int c = 0; c < x.cols(); ++c) x(to, c) = from[c];
}

template <class Values>
Values whole(const Panels& panels, const Eigen::VectorXi& order, const Values& b) {
  Work<Values> y(panels.work_rows());
  for (Eigen::Index i = 0; i < b.rows(); ++i) put<Values>(y, order[i], b, i);
  panels.forward<columns<Values>>(y.data(), panels.all());
  panels.backward<columns<Values>>(y.data(), panels.all());
  Values x(b.rows(), b.cols());
  for (Eigen::Index i = 0; i < b.rows(); ++i) take<Values>(y, order[i], x, i);
  return x;
}

// Only rows of the subset's panels are cleared and used; the rest of `y` stays as it was allocated.
template <class Values>
Values within(const Panels& panels, const SparseCholesky::Subset& subset, const Values& b) {
  Work<Values> y(panels.work_rows());
  panels.clear<columns<Values>>(y.data(), subset.panels);
  for (std::size_t k = 0; k < subset.rows.size(); ++k)
    put<Values>(y, subset.rows[k], b, static_cast<Eigen::Index>(k));
  panels.forward<columns<Values>>(y.data(), subset.panels);
  panels.backward<columns<Values>>(y.data(), subset.panels);
  Values x(b.rows(), b.cols());
  for (std::size_t k = 0; k < subset.rows.size(); ++k)
    take<Values>(y, subset.rows[k], x, static_cast<Eigen::Index>(k));
  return x;
}

// z = L⁻¹ b, whose squared norm is bᵀ A⁻¹ b: a decrement for half the price of a solve.
template <class Values>
SparseCholesky::Half first_half(const Panels& panels, const Eigen::VectorXi& order,
                                const Values& b) {
  Work<Values> y(panels.work_rows());
  for (Eigen::Index i = 0; i < b.rows(); ++i) put<Values>(y, order[i], b, i);
  panels.forward<columns<Values>>(y.data(), panels.all());
  SparseCholesky::Half half;
  half.values = Eigen::Map<const Eigen::VectorXd>(y.data(), columns<Values> * b.rows());
  half.squared_norm = half.values.squaredNorm();
  return half;
}

template <class Values>
void second_half_within(const Panels& panels, const SparseCholesky::Subset& subset,
                        const SparseCholesky::Half& z, Values& x) {
  Work<Values> y(panels.work_rows());
  panels.copy<columns<Values>>(z.values.data(), y.data(), subset.panels);
  panels.backward<columns<Values>>(y.data(), subset.panels);
  x.resize(static_cast<Eigen::Index>(subset.rows.size()), x.cols());
  for (std::size_t k = 0; k < subset.rows.size(); ++k)
    take<Values>(y, subset.rows[k], x, static_cast<Eigen::Index>(k));
}

// x = A⁻¹ (share · B + E b) = L⁻ᵀ (share · z + L⁻¹ E b): the forward sweep of E b runs in its reach
// alone, and one backward sweep serves both.
template <class Values>
void second_half(const Panels& panels, const Eigen::VectorXi& order, const SparseCholesky::Half& z,
                 double share, const SparseCholesky::Subset& subset, const Values& b, Values& x) {
  Work<Values> y(panels.work_rows());
  y.clear();
  for (std::size_t k = 0; k < subset.rows.size(); ++k)
    put<Values>(y, subset.rows[k], b, static_cast<Eigen::Index>(k));
  panels.forward<columns<Values>>(y.data(), subset.panels);
  Eigen::Map<Eigen::VectorXd>(y.data(), columns<Values> * order.size()) += share * z.values;
  panels.backward<columns<Values>>(y.data(), panels.all());
  x.resize(order.size(), x.cols());
  for (Eigen::Index i = 0; i < order.size(); ++i) take<Values>(y, order[i], x, i);
}

}  // namespace

Points SparseCholesky::solve(const Points& b) const {
  return whole(factor_->panels, factor_->order, b);
}
Eigen::VectorXd SparseCholesky::solve(const Eigen::VectorXd& b) const {
  return whole(factor_->panels, factor_->order, b);
}

SparseCholesky::Subset SparseCholesky::subset(std::span<const int> unknowns) const {
  Subset subset;
  for (const int i : unknowns) subset.rows.push_back(factor_->order[i]);
  subset.panels = factor_->panels.reach(subset.rows);
  return subset;
}

Points SparseCholesky::solve_within(const Subset& subset, const Points& b) const {
  return within(factor_->panels, subset, b);
}
Eigen::VectorXd SparseCholesky::solve_within(const Subset& subset, const Eigen::VectorXd& b) const {
  return within(factor_->panels, subset, b);
}

SparseCholesky::Half SparseCholesky::forward(const Points& b) const {
  return first_half(factor_->panels, factor_->order, b);
}
SparseCholesky::Half SparseCholesky::forward(const Eigen::VectorXd& b) const {
  return first_half(factor_->panels, factor_->order, b);
}

void SparseCholesky::backward_within(const Subset& subset, const Half& z, Points& x) const {
  second_half_within(factor_->panels, subset, z, x);
}
void SparseCholesky::backward_within(const Subset& subset, const Half& z,
                                     Eigen::VectorXd& x) const {
  second_half_within(factor_->panels, subset, z, x);
}

void SparseCholesky::backward(const Half& z, double share, const Subset& subset, const Points& b,
                              Points& x) const {
  second_half(factor_->panels, factor_->order, z, share, subset, b, x);
}
void SparseCholesky::backward(const Half& z, double share, const Subset& subset,
                              const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  second_half(factor_->panels, factor_->order, z, share, subset, b, x);
}

}  // namespace knead
