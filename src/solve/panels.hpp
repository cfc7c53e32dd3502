#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dissection.hpp"
#include "knead/base/instruction_set.hpp"
#include "knead/energy/stiffness.hpp"

namespace knead {
namespace detail {
struct PanelKernels;
}
struct Dissection;

/// A lower triangular matrix L divided into panels of up to four adjacent columns that mostly have
/// the same rows: a panel stores a dense block over the union of their rows. Substitution then
/// reads each row of the unknowns once per panel instead of once per column, and fills vector
/// registers. A few zeros are stored to make panels wider, never more than a quarter of a panel.
///
/// The panels of a dissected matrix form tasks, one per node, which threads share. What a task adds
/// to unknowns of others it sums up in rows of its own, beyond those of the matrix, which the node
/// behind it adds to the unknowns: sums do not depend on the number of threads. Without a
/// dissection there is one task.
///
/// Substitution is bound by the memory that L is read from: 8 bytes an entry, twice a solve,
/// whatever is done with them. Hence three columns at once, and a width of four, for which the
/// unknowns of a panel and the sums of a row stay in registers.
class Panels {
 public:
  static constexpr int widest = 4;

  Panels() = default;
  /// The L of A = L Lᵀ, made in place: each panel takes from A's entries the products of those
  /// before it that reach it, so that L is stored once and A beside it.
  /// \param lower the lower triangle of A, in the order in which it is to be factored, columns in
  /// any order of rows
  /// \param set the fastest instruction set to use; all give the same bits
  /// \param dissection that gave the order; null: another order did.
  /// None: A is not positive definite or not finite, or an `Interruption` is asked for.
  [[nodiscard]] static std::optional<Panels> factor(const SparseMatrix& lower,
                                                    InstructionSet set = best_instruction_set(),
                                                    const Dissection* dissection = nullptr);

  /// The panels involved if the right side is zero except in these rows and the solution is needed
  /// only there, ascending.
  [[nodiscard]] std::vector<int> reach(std::span<const int> rows) const;
  [[nodiscard]] const std::vector<int>& all() const { return all_; }

  /// Rows that substitution works with: those of the matrix, and behind them some whose values mean
  /// nothing.
  [[nodiscard]] Eigen::Index work_rows() const {
    return static_cast<Eigen::Index>(panel_of_.size() + original_.size());
  }

  /// Numbers, those zeros among them.
  [[nodiscard]] std::size_t stored() const;

  /// L y = b and Lᵀ x = y, in place, `columns` values per row of `work_rows`, by these panels: all
  /// of them, or a reach. Every row of the forward sweep sums in the order of the columns of L
  /// within a task, and what other tasks add before; rows of the backward sweep first sum the
  /// entries below their panel. `columns`: 1, or 4 for three (the last is carried along; x aligned
  /// to 16 bytes, better to 32).
  template <int columns>
  void forward(double* x, std::span<const int> panels) const;
  template <int columns>
  void backward(double* x, std::span<const int> panels) const;
  /// Sets the rows of these panels to zero, and those that their substitution adds to without need.
  template <int columns>
  void clear(double* x, std::span<const int> panels) const;
  /// Copies the same rows.
  template <int columns>
  void copy(const double* from, double* to, std::span<const int> panels) const;

 private:
  struct Panel {
    int first, width;  // columns
    int row, rows;     // of those below, in rows_
    double* value;     // the triangle row by row with 1 / L_jj on its diagonal, then the rows below
  };

  /// The panels begin … end − 1.
  struct Task {
    int begin, end;
    int parent;                 // −1: none
    std::vector<int> children;  // ascending
    // Of the rows of its own: one for each row of other tasks that it or its children reach.
    int first_row = 0;
    std::vector<int>
        targets;  // what each of them is added to: a row of the parent, or one of those of its own
  };
  class Making;
  class Shares;
  /// Divides L into panels, which have no values yet; none goes on from one of these columns to the
  /// one before.
  void divide(const SparseMatrix& lower, std::span<const int> breaks);
  /// Memory for them, zero.
  void allocate();
  /// Makes the tasks of the nodes, without rows of their own.
  void make_tasks(const Dissection& dissection);
  /// Gives each task its rows, to which its panels then add.
  void separate_tasks();
  void separate(Task& task, std::vector<int>& place);
  /// f(begin, end) for ranges of rows in which all rows are that substitution by some panels
  /// touches.
  template <class F>
  void for_each_range(std::span<const int> panels, const F& f) const;
  template <int columns>
  void substitute_forward(double* x, std::span<const int> panels) const;
  template <int columns>
  void substitute_backward(double* x, std::span<const int> panels) const;
  [[nodiscard]] std::span<const int> below(const Panel& panel) const {
    return std::span(rows_).subspan(static_cast<std::size_t>(panel.row),
                                    static_cast<std::size_t>(panel.rows));
  }

  const detail::PanelKernels* kernels_ = nullptr;
  std::vector<Panel> panels_;
  std::vector<int> all_, panel_of_;  // 0, 1, … and the panel of every column
  std::vector<int> rows_;
  std::vector<Task> tasks_;      // children before parents; none: one
  std::vector<int> work_order_;  // of the tasks, forwards
  std::vector<int> original_;    // of the tasks' own rows: the row of the matrix
  std::vector<std::unique_ptr<double[]>>
      values_;  // in pieces, which fit where what they are made of has been
};

}  // namespace knead
