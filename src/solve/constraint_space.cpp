#include "constraint_space.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace knead {
namespace {

/// Whether the numbers of constraints can be used, and whether any couples coordinates.
Expected<bool> check(int size, std::span<const LinearConstraint> constraints) {
  bool coupled = false;
  for (const LinearConstraint& c : constraints) {
    coupled = coupled || c.normal.has_value();
    if (!c.value.allFinite()) return input_error("a right side is not a finite number", c.name);
    if (c.normal && !(c.normal->allFinite() && c.normal->norm() > 0)) {
      return input_error("the normal has no direction", c.name);
    }
    for (const auto& [unknown, coefficient] : c.terms) {
      if (unknown < 0 || unknown >= size) {
        return input_error(fmt::format("there is no control point {}", unknown), c.name,
                           fmt::format("there are {}", size));
      }
      if (!std::isfinite(coefficient))
        return input_error("a coefficient is not a finite number", c.name);
    }
  }
  return coupled;
}

}  // namespace

// Names of sources take memory quadratic in their number, and only an error needs them: the
// elimination runs without, and once more with them where it has failed.
Expected<detail::ConstraintElimination> ConstraintSpace::eliminated(
    int size, std::span<const LinearConstraint> constraints, const std::vector<bool>& held,
    bool coordinates) {
  assert(held.empty() || held.size() == at(size));
  const auto coupled = check(size, constraints);
  if (!coupled) return std::unexpected(coupled.error());
  for (const bool sources :
       {false, true}) {  // who contradicts whom is found out only where somebody does
    detail::ConstraintElimination elimination(size, held, *coupled || coordinates, sources);
    Expected<void> status;
    for (std::size_t k = 0; k < constraints.size() && status; ++k)
      status = elimination.add(constraints[k]);
    if (status) return elimination;
    if (sources) return std::unexpected(status.error());
  }
  return input_error("constraints contradict each other", "constraints",
                     "release one of them");  // not reached
}

Expected<ConstraintSpace> ConstraintSpace::create(int size,
                                                  std::span<const LinearConstraint> constraints,
                                                  const std::vector<bool>& held, bool coordinates) {
  auto elimination = eliminated(size, constraints, held, coordinates);
  if (!elimination) return std::unexpected(elimination.error());
  ConstraintSpace space(0);
  space.size_ = size;
  space.constraints_.assign(constraints.begin(), constraints.end());
  space.number_free(elimination->take(), elimination->coupled());
  return space;
}

// T in three parts: independent unknowns are themselves (`free_`), dependent ones combine them
// (`rows_`), and d, the inhomogeneous part, combines right sides and held unknowns (`values_`,
// `held_rows_`). The identity part is not stored, so that unknowns without a condition cost nothing
// in any product.
void ConstraintSpace::number_free(const std::vector<Definition>& definitions, bool coupled) {
  coupled_ = coupled;
  free_.clear();
  position_.assign(definitions.size(), -1);
  for (std::size_t i = 0; i < definitions.size(); ++i) {
    if (definitions[i].dependent) {
      dependent_.push_back(static_cast<int>(i));
    } else if (!definitions[i].held) {
      position_[i] = static_cast<int>(free_.size());
      free_.push_back(static_cast<int>(i));
    }
  }
  std::vector<Eigen::Triplet<double>> entries, held;
  values_.setZero(static_cast<Eigen::Index>(dependent_.size()), 3);
  for (std::size_t k = 0; k < dependent_.size(); ++k) {
    const Definition& d = definitions[at(dependent_[k])];
    for (int c = 0; c < 3; ++c) values_(static_cast<Eigen::Index>(k), c) = d.value[c];
    for (const auto& [j, a] : d.terms) {
      if (definitions[at(j)].held) {
        held.emplace_back(static_cast<int>(k), j, a);
      } else {
        entries.emplace_back(static_cast<int>(k), position_[at(j)], a);
      }
    }
  }
  rows_.resize(static_cast<Eigen::Index>(dependent_.size()),
               static_cast<Eigen::Index>(free_.size()));
  rows_.setFromTriplets(entries.begin(), entries.end());
  held_rows_.resize(rows_.rows(), static_cast<Eigen::Index>(definitions.size()));
  held_rows_.setFromTriplets(held.begin(), held.end());
}

bool ConstraintSpace::is_determined(int i) const {
  const auto fixed = [this](int unknown) {
    if (position_[at(unknown)] >= 0) return false;
    const auto found = std::ranges::lower_bound(dependent_, unknown);
    if (found == dependent_.end() || *found != unknown) return true;
    const auto k = found - dependent_.begin();
    return rows_.outerIndexPtr()[k] == rows_.outerIndexPtr()[k + 1];
  };
  if (!coupled_) return fixed(i);
  return fixed(3 * i) && fixed(3 * i + 1) && fixed(3 * i + 2);
}

Points ConstraintSpace::reduce_points(const Points& b) const {
  assert(!coupled_ && b.rows() == size_);
  Points y(free_count(), 3);
  for (std::size_t k = 0; k < free_.size(); ++k)
    y.row(static_cast<Eigen::Index>(k)) = b.row(free_[k]);
  for (Eigen::Index k = 0; k < rows_.outerSize(); ++k) {
    for (decltype(rows_)::InnerIterator it(rows_, k); it; ++it) {
      y.row(it.col()) += it.value() * b.row(dependent_[static_cast<std::size_t>(k)]);
    }
  }
  return y;
}

Points ConstraintSpace::expand_points(const Points& y) const {
  assert(!coupled_ && y.rows() == free_count());
  Points x = Points::Zero(size_, 3);
  for (std::size_t k = 0; k < free_.size(); ++k)
    x.row(free_[k]) = y.row(static_cast<Eigen::Index>(k));
  for (Eigen::Index k = 0; k < rows_.outerSize(); ++k) {
    for (decltype(rows_)::InnerIterator it(rows_, k); it; ++it) {
      x.row(dependent_[static_cast<std::size_t>(k)]) += it.value() * y.row(it.col());
    }
  }
  return x;
}

// Cost: O(N) for the table of places, whatever the number of points: ask for many at once.
std::vector<ConstraintSpace::Term> ConstraintSpace::terms(std::span<const int> points) const {
  std::vector<int> place(position_.size(), -1);  // in dependent_
  for (std::size_t k = 0; k < dependent_.size(); ++k)
    place[at(dependent_[k])] = static_cast<int>(k);
  std::vector<Term> result;
  int row = 0;
  for (const int point : points) {
    for (int c = 0; c < (coupled_ ? 3 : 1); ++c, ++row) {
      const std::size_t unknown = at(coupled_ ? 3 * point + c : point);
      if (position_[unknown] >= 0) result.push_back({row, position_[unknown], 1});
      if (place[unknown] < 0) continue;
      for (decltype(rows_)::InnerIterator it(rows_, place[unknown]); it; ++it) {
        result.push_back({row, static_cast<int>(it.col()), it.value()});
      }
    }
  }
  return result;
}

Eigen::MatrixXd ConstraintSpace::reduce(const Points& b) const {
  if (!coupled_) return reduce_points(b);
  const Eigen::Map<const Eigen::VectorXd> flat(b.data(), b.size());
  Eigen::VectorXd y(free_count()), rest(static_cast<Eigen::Index>(dependent_.size()));
  for (std::size_t k = 0; k < free_.size(); ++k) y[static_cast<Eigen::Index>(k)] = flat[free_[k]];
  for (std::size_t k = 0; k < dependent_.size(); ++k)
    rest[static_cast<Eigen::Index>(k)] = flat[dependent_[k]];
  y += rows_.transpose() * rest;
  return y;
}

Points ConstraintSpace::expand(const Eigen::MatrixXd& y) const {
  if (!coupled_) return expand_points(y);
  Points x = Points::Zero(size_, 3);
  const Eigen::VectorXd rest = rows_ * y.col(0);
  for (std::size_t k = 0; k < free_.size(); ++k)
    x.data()[free_[k]] = y(static_cast<Eigen::Index>(k), 0);
  for (std::size_t k = 0; k < dependent_.size(); ++k)
    x.data()[dependent_[k]] = rest[static_cast<Eigen::Index>(k)];
  return x;
}

// yᵀTᵀb is the work on every admissible y, and Tᵀ(lumped b) sees independent rows alone, where T is
// the identity: so both are equal. Two forces that differ in what constraints bear have one lumped
// form, hence one decrement.
Points ConstraintSpace::lumped(const Points& b) const {
  Points result = Points::Zero(size_, 3);
  if (!coupled_) {
    const Points y = reduce_points(b);
    for (std::size_t k = 0; k < free_.size(); ++k)
      result.row(free_[k]) = y.row(static_cast<Eigen::Index>(k));
  } else {
    const Eigen::MatrixXd y = reduce(b);
    for (std::size_t k = 0; k < free_.size(); ++k)
      result.data()[free_[k]] = y(static_cast<Eigen::Index>(k), 0);
  }
  return result;
}

namespace {

/// The rows and columns of some unknowns, ascending.
SparseMatrix selected(const SparseMatrix& a, const std::vector<int>& unknowns) {
  std::vector<int> place(static_cast<std::size_t>(a.rows()), -1);
  for (std::size_t k = 0; k < unknowns.size(); ++k)
    place[static_cast<std::size_t>(unknowns[k])] = static_cast<int>(k);
  const auto size = static_cast<Eigen::Index>(unknowns.size());
  SparseMatrix result(size, size);
  result.reserve(a.nonZeros());
  for (Eigen::Index k = 0; k < size; ++k) {
    result.startVec(k);
    for (SparseMatrix::InnerIterator it(a, unknowns[static_cast<std::size_t>(k)]); it; ++it) {
      const int row = place[static_cast<std::size_t>(it.row())];
      if (row >= 0) result.insertBack(row, k) = it.value();
    }
  }
  result.finalize();
  return result;
}

}  // namespace

// Three ways: A itself where nothing is constrained, rows and columns left out where points are
// only held, and the product otherwise. A ⊗ I is formed only where coordinates are coupled:
// otherwise the three coordinates share one matrix and one factor.
SparseMatrix ConstraintSpace::restrict(const SparseMatrix& a) const {
  assert(a.rows() == size_ && a.cols() == size_);
  const int copies = coupled_ ? 3 : 1;
  if (free_count() == copies * size_ && !coupled_) return a;
  if (!coupled_ && rows_.nonZeros() == 0) return selected(a, free_);
  SparseMatrix full = a;
  if (coupled_) {  // A ⊗ I
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(static_cast<std::size_t>(3 * a.nonZeros()));
    for (Eigen::Index j = 0; j < a.outerSize(); ++j) {
      for (SparseMatrix::InnerIterator it(a, j); it; ++it) {
        for (int c = 0; c < 3; ++c) {
          entries.emplace_back(3 * static_cast<int>(it.row()) + c, 3 * static_cast<int>(j) + c,
                               it.value());
        }
      }
    }
    full.resize(3 * a.rows(), 3 * a.cols());
    full.setFromTriplets(entries.begin(), entries.end());
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t k = 0; k < free_.size(); ++k)
    entries.emplace_back(free_[k], static_cast<int>(k), 1.0);
  for (Eigen::Index k = 0; k < rows_.outerSize(); ++k) {
    for (decltype(rows_)::InnerIterator it(rows_, k); it; ++it) {
      entries.emplace_back(dependent_[static_cast<std::size_t>(k)], static_cast<int>(it.col()),
                           it.value());
    }
  }
  SparseMatrix t(full.rows(), free_count());
  t.setFromTriplets(entries.begin(), entries.end());
  const SparseMatrix right = full * t;
  return SparseMatrix(t.transpose()) * right;
}

// Dependent rows are recomputed from x's independent and held ones. Where a row already agrees to
// rounding it keeps its bits, so that a shape at rest is not moved by the last digit of a sum.
Points ConstraintSpace::feasible(const Points& x) const {
  Points result = x;
  const auto dependents = static_cast<Eigen::Index>(dependent_.size());
  for (Eigen::Index k = 0; k < dependents; ++k) {
    const int unknown = dependent_[static_cast<std::size_t>(k)];
    for (int c = 0; c < (coupled_ ? 1 : 3); ++c) {
      double sum = values_(k, c), size = std::abs(sum);
      const auto add = [&](int other, double coefficient) {
        const double term = coefficient * (coupled_ ? x.data()[other] : x(other, c));
        sum += term;
        size += std::abs(term);
      };
      for (decltype(rows_)::InnerIterator it(rows_, k); it; ++it)
        add(free_[at(static_cast<int>(it.col()))], it.value());
      for (decltype(rows_)::InnerIterator it(held_rows_, k); it; ++it)
        add(static_cast<int>(it.col()), it.value());
      double& entry = coupled_ ? result.data()[unknown] : result(unknown, c);
      if (std::abs(entry - sum) > 1e-15 * size)
        entry = sum;  // a difference of rounding already satisfies it
    }
  }
  return result;
}

// Measured on the constraints as given, not on T: rounding of the elimination shows here.
std::pair<int, double> ConstraintSpace::worst(const Points& x) const {
  std::pair<int, double> result{-1, 0};
  for (std::size_t k = 0; k < constraints_.size(); ++k) {
    const LinearConstraint& c = constraints_[k];
    Point sum = -c.value;
    for (const auto& [unknown, a] : c.terms) sum += a * x.row(unknown).transpose();
    const double off =
        c.normal ? std::abs(c.normal->normalized().dot(sum)) : sum.cwiseAbs().maxCoeff();
    if (off > result.second) result = {static_cast<int>(k), off};
  }
  return result;
}

}  // namespace knead
