#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/solve/linear_constraint.hpp"

namespace knead::detail {

/// Gaussian elimination of linear constraints, which come one after another: every unknown is held,
/// independent, or defined by independent and held ones.
///
/// A constraint defines the unknown that the fewest definitions contain so far, among those not
/// held whose coefficients reach 0.3 of the largest. It is then substituted in the definitions that
/// contain it. Cost of a constraint: linear in the terms of the definitions that it meets, whatever
/// came before elsewhere. Memory: linear in the terms of all definitions.
class ConstraintElimination {
 public:
  struct Definition {
    bool dependent = false, held = false;
    /// Over independent and held unknowns, ascending.
    std::vector<std::pair<int, double>> terms = {};
    double value[3] = {0, 0, 0};
    /// Names of the constraints it follows from, ascending, where they are kept.
    std::vector<int> sources = {};
  };

  /// \param size number of points; with `coupled`, their 3 coordinates are the unknowns: 3 i + k.
  /// \param held one flag per point; empty: none.
  /// \param sources whether definitions know the constraints they follow from, which takes memory
  /// quadratic in the number of names: only an error about a contradiction needs them.
  ConstraintElimination(int size, const std::vector<bool>& held, bool coupled, bool sources);

  /// Errors (input): the constraint contradicts those before it, which are named where `sources`
  /// are kept.
  [[nodiscard]] Expected<void> add(const LinearConstraint& constraint);

  [[nodiscard]] bool coupled() const { return coupled_; }
  [[nodiscard]] const Definition& definition(int unknown) const {
    return definitions_[at(unknown)];
  }
  /// The definitions, which are taken away.
  [[nodiscard]] std::vector<Definition> take() { return std::move(definitions_); }

 private:
  using Terms = std::vector<std::pair<int, double>>;

  struct Row {
    Terms terms;  // ascending
    double value[3] = {0, 0, 0};
    std::vector<int> sources;
    double scale = 0;  // largest coefficient before elimination
    double size = 1;   // of the numbers that the right side was computed from
  };

  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] Row row_of(const Terms& terms, const double* value, int name);
  void add_term(Row& row, int unknown, double c);
  void accumulate(int unknown, double c);
  [[nodiscard]] std::string names_of(const std::vector<int>& sources, int without) const;
  [[nodiscard]] Expected<void> eliminate(const Terms& terms, const double* value, int name);
  void define(int pivot, const Row& row);
  void substitute(int user, int pivot);

  bool coupled_, keep_sources_;
  int width_;  // right sides
  std::vector<Definition> definitions_;
  std::vector<std::vector<int>>
      users_;  // users_[j]: dependent unknowns whose definition contains j, ascending
  std::map<std::string, int> numbers_;  // of names
  std::vector<std::string> names_;
  std::vector<double> sums_;   // scratch: coefficients of one row by unknown
  std::vector<bool> touched_;  // scratch: which of them count
  std::vector<int> unknowns_;  // scratch: a list of these
  Terms merged_;               // scratch
};

}  // namespace knead::detail
