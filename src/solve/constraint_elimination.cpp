#include "constraint_elimination.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "knead/base/error_code.hpp"

namespace knead::detail {
namespace {

// Rounding of an elimination is some 1e-16 times the growth of the coefficients, at most by 1/0.3
// for each definition that a row meets: 1e-11 leaves room for five digits of it. Right sides carry
// the rounding of the positions that they were made from besides, hence the larger bound for
// contradictions.
constexpr double dependent_below = 1e-11;
constexpr double contradictory_above = 1e-9;
// Of the largest coefficient: room to choose an unknown that few others use.
//
// Markowitz's choice of pivots (1957) with a threshold: the largest coefficient would be the most
// stable pivot, but one that many definitions contain is substituted in all of them.
constexpr double pivot_threshold = 0.3;

std::vector<int> united(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> result;
  std::ranges::set_union(a, b, std::back_inserter(result));
  return result;
}

void insert(std::vector<int>& ascending, int value) {
  const auto place = std::ranges::lower_bound(ascending, value);
  if (place == ascending.end() || *place != value) ascending.insert(place, value);
}

}  // namespace

ConstraintElimination::ConstraintElimination(int size, const std::vector<bool>& held, bool coupled,
                                             bool sources)
    : coupled_(coupled),
      keep_sources_(sources),
      width_(coupled ? 1 : 3),
      definitions_(at(coupled ? 3 * size : size)),
      users_(definitions_.size()),
      sums_(definitions_.size(), 0.0),
      touched_(definitions_.size(), false) {
  const std::size_t copies = coupled ? 3 : 1;
  for (std::size_t i = 0; i < held.size(); ++i) {
    for (std::size_t k = 0; k < copies; ++k) definitions_[copies * i + k].held = held[i];
  }
}

// Without a normal a constraint on points is one equation with three right sides; over coordinates
// it is three equations with one. One along a normal is a single equation between coordinates.
Expected<void> ConstraintElimination::add(const LinearConstraint& c) {
  const auto [it, added] = numbers_.try_emplace(c.name, static_cast<int>(numbers_.size()));
  if (added) names_.push_back(c.name);
  if (!coupled_) return eliminate(c.terms, c.value.data(), it->second);
  Terms terms;
  if (c.normal) {
    const Point n = c.normal->normalized();
    for (const auto& [unknown, a] : c.terms) {
      for (int k = 0; k < 3; ++k) {
        if (n[k] != 0) terms.emplace_back(3 * unknown + k, a * n[k]);
      }
    }
    const double value = n.dot(c.value);
    return eliminate(terms, &value, it->second);
  }
  for (int k = 0; k < 3; ++k) {
    terms.clear();
    for (const auto& [unknown, a] : c.terms) terms.emplace_back(3 * unknown + k, a);
    if (auto status = eliminate(terms, &c.value[k], it->second); !status) return status;
  }
  return {};
}

void ConstraintElimination::accumulate(int unknown, double c) {
  if (!touched_[at(unknown)]) {
    touched_[at(unknown)] = true;
    unknowns_.push_back(unknown);
  }
  sums_[at(unknown)] += c;
}

// `row.size` follows the largest number that goes into the right side: a contradiction is judged in
// units of it, or cancellation of large positions would count as one.
void ConstraintElimination::add_term(Row& row, int unknown, double c) {
  const Definition& d = definitions_[at(unknown)];
  if (!d.dependent) return accumulate(unknown, c);
  for (const auto& [j, a] : d.terms) accumulate(j, c * a);
  for (int k = 0; k < width_; ++k) {
    row.value[k] -= c * d.value[k];
    row.size = std::max(row.size, std::abs(c * d.value[k]) / row.scale);
  }
  if (keep_sources_) row.sources = united(row.sources, d.sources);
}

/// The constraint in terms of independent and held unknowns.
ConstraintElimination::Row ConstraintElimination::row_of(const Terms& terms, const double* value,
                                                         int name) {
  Row row;
  for (const auto& [unknown, c] : terms) row.scale = std::max(row.scale, std::abs(c));
  row.sources = {name};
  for (int k = 0; k < width_; ++k) {
    row.value[k] = value[k];
    row.size =
        std::max(row.size, row.scale > 0 ? std::abs(value[k]) / row.scale : std::abs(value[k]));
  }
  for (const auto& [unknown, c] : terms) add_term(row, unknown, c);
  std::ranges::sort(unknowns_);
  for (const int j : unknowns_) {
    row.terms.emplace_back(j, sums_[at(j)]);
    sums_[at(j)] = 0;
    touched_[at(j)] = false;
  }
  unknowns_.clear();
  return row;
}

std::string ConstraintElimination::names_of(const std::vector<int>& sources, int without) const {
  std::string text;
  for (int s : sources) {
    if (s != without) text += (text.empty() ? "" : ", ") + names_[at(s)];
  }
  return text.empty() ? "itself" : text;
}

// A row that leaves less than `dependent_below` of its largest coefficient follows from those
// before, or contradicts them. One in held unknowns alone is neither: whether it is met depends on
// where they are, which is not known here (`constraint_space` looks).
Expected<void> ConstraintElimination::eliminate(const Terms& terms, const double* value, int name) {
  const Row row = row_of(terms, value, name);
  double largest = 0, largest_held = 0;
  for (const auto& [j, c] : row.terms) {
    double& of = definitions_[at(j)].held ? largest_held : largest;
    of = std::max(of, std::abs(c));
  }
  if (largest <= dependent_below * row.scale) {
    if (largest_held > dependent_below * row.scale)
      return {};  // a condition on held unknowns: it stays, true or not
    for (int k = 0; k < width_; ++k) {
      if (std::abs(row.value[k]) > contradictory_above * row.size * std::max(row.scale, 1e-300)) {
        return input_error(
            fmt::format("the constraint contradicts {}", names_of(row.sources, name)),
            names_[at(name)], "release one of them", {ErrorCode::constraint_contradicts});
      }
    }
    return {};
  }
  int pivot = -1;
  for (const auto& [j, c] : row.terms) {
    if (definitions_[at(j)].held || std::abs(c) < pivot_threshold * largest) continue;
    if (pivot < 0 || users_[at(j)].size() < users_[at(pivot)].size()) pivot = j;
  }
  define(pivot, row);
  return {};
}

// Gauss–Jordan: the new definition replaces the pivot in all that contain it, so that every
// definition is in independent and held unknowns at any time and no substitution is left for the
// end. `users_` finds those that contain it, which makes a constraint cost what it touches.
void ConstraintElimination::define(int pivot, const Row& row) {
  Definition& d = definitions_[at(pivot)];
  const double c =
      std::ranges::lower_bound(row.terms, pivot, {}, &std::pair<int, double>::first)->second;
  d.dependent = true;
  if (keep_sources_) d.sources = row.sources;
  for (int k = 0; k < width_; ++k) d.value[k] = row.value[k] / c;
  for (const auto& [j, a] : row.terms) {
    if (j == pivot || std::abs(a) <= 1e-15 * row.scale) continue;
    d.terms.emplace_back(j, -a / c);
    insert(users_[at(j)], pivot);
  }
  d.terms.shrink_to_fit();
  for (const int i : users_[at(pivot)]) substitute(i, pivot);
  std::vector<int>().swap(users_[at(pivot)]);
}

/// Replaces the pivot in the definition of a user by its own definition.
void ConstraintElimination::substitute(int index, int pivot) {
  Definition& user = definitions_[at(index)];
  const Definition& d = definitions_[at(pivot)];
  const double c =
      std::ranges::lower_bound(user.terms, pivot, {}, &std::pair<int, double>::first)->second;
  merged_.clear();
  auto old = user.terms.begin();
  const auto keep_old = [&] {
    if (old->first != pivot) merged_.push_back(*old);
    ++old;
  };
  for (const auto& [j, a] : d.terms) {
    while (old != user.terms.end() && old->first < j) keep_old();
    if (old != user.terms.end() && old->first == j) {
      merged_.emplace_back(j, old++->second + c * a);
    } else {
      merged_.emplace_back(j, c * a);
    }
    insert(users_[at(j)], index);
  }
  while (old != user.terms.end()) keep_old();
  for (int k = 0; k < width_; ++k) user.value[k] += c * d.value[k];
  user.terms.assign(merged_.begin(), merged_.end());
  if (keep_sources_) user.sources = united(user.sources, d.sources);
}

}  // namespace knead::detail
