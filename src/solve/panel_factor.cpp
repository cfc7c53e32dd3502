#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>

#include "knead/base/interruption.hpp"
#include "panels.hpp"
#include "simd/panel_kernels.hpp"

namespace knead {
namespace {

/// The fastest kernels up to those of an instruction set.
const detail::PanelKernels& panel_kernels_of(InstructionSet set) {
  if (detail::avx512_panel_kernels != nullptr && set >= InstructionSet::avx512) return *detail::avx512_panel_kernels;
  const bool wide = detail::avx2_panel_kernels != nullptr && set >= InstructionSet::avx2;
  return wide ? *detail::avx2_panel_kernels : *detail::vector128_panel_kernels;
}

/// The rows below the diagonal of the columns of L, one column after the other: those of A, and those of all columns of
/// which it is the first row (George, Liu: Computer Solution of Large Sparse Positive Definite Systems, § 5.3). A
/// column's rows are kept until they have been passed on and nobody asks for them any more.
class ColumnRows {
 public:
  explicit ColumnRows(const SparseMatrix& lower)
      : a_(lower), rows_(static_cast<std::size_t>(lower.cols())), children_(rows_.size()) {}

  /// Ascending. Asked for are columns from the one last given to `forget_before` on.
  [[nodiscard]] const std::vector<int>& of(int column) {
    for (; known_ <= column; ++known_) find(known_);
    return rows_[static_cast<std::size_t>(column)];
  }
  void forget_before(int column) {
    for (; asked_ < column; ++asked_) {
      std::vector<int>& rows = rows_[static_cast<std::size_t>(asked_)];
      if (rows.empty() || rows.front() < known_) release(rows);
    }
  }

 private:
  static void release(std::vector<int>& list) { list = std::vector<int>(); }
  void find(int column) {
    std::vector<int>& rows = rows_[static_cast<std::size_t>(column)];
    for (SparseMatrix::InnerIterator it(a_, column); it; ++it) {
      if (it.row() > column) rows.push_back(static_cast<int>(it.row()));
    }
    std::ranges::sort(rows);
    std::vector<int> merged;
    for (const int child : children_[static_cast<std::size_t>(column)]) {
      std::vector<int>& further = rows_[static_cast<std::size_t>(child)];
      merged.clear();
      std::set_union(rows.begin(), rows.end(), further.begin() + 1, further.end(), std::back_inserter(merged));
      rows.swap(merged);
      if (child < asked_) release(further);
    }
    release(children_[static_cast<std::size_t>(column)]);
    if (!rows.empty()) children_[static_cast<std::size_t>(rows.front())].push_back(column);
  }

  const SparseMatrix& a_;
  std::vector<std::vector<int>> rows_, children_;
  int known_ = 0, asked_ = 0;
};

}  // namespace

void Panels::divide(const SparseMatrix& lower) {
  ColumnRows columns(lower);
  const auto size = static_cast<int>(lower.cols());
  std::vector<int> united, wider, merged;
  for (int first = 0; first < size && !Interruption::asked_for();) {
    columns.forget_before(first);
    // As many columns as fill three quarters of their panel.
    united = columns.of(first);
    wider = united;
    int width = 1, entries = static_cast<int>(united.size());
    for (int next = 1; next < widest && first + next < size; ++next) {
      const int column = first + next;
      const std::vector<int>& more = columns.of(column);
      merged.clear();
      std::set_union(wider.begin(), wider.end(), more.begin(), more.end(), std::back_inserter(merged));
      wider.swap(merged);
      entries += static_cast<int>(more.size());
      const auto below = static_cast<int>(wider.end() - std::ranges::upper_bound(wider, column));
      const int stored = (next + 1) * below + next * (next + 1) / 2;
      if (4 * entries < 3 * stored) continue;
      width = next + 1;
      united = wider;
    }
    Panel panel{first, width, static_cast<int>(rows_.size()), 0, nullptr};
    rows_.insert(rows_.end(), std::ranges::upper_bound(united, first + width - 1), united.end());
    panel.rows = static_cast<int>(rows_.size()) - panel.row;
    all_.push_back(static_cast<int>(panels_.size()));
    panel_of_.insert(panel_of_.end(), static_cast<std::size_t>(width), all_.back());
    panels_.push_back(panel);
    first += width;
  }
  rows_.shrink_to_fit();
  allocate();
}

void Panels::allocate() {
  constexpr std::size_t most = std::size_t{1} << 19;  // of a piece of memory, unless one panel needs more
  const auto values = [](const Panel& panel) {
    return static_cast<std::size_t>(panel.width) * static_cast<std::size_t>(panel.rows) +
           static_cast<std::size_t>(panel.width * (panel.width + 1) / 2);
  };
  for (std::size_t begin = 0; begin < panels_.size();) {
    std::size_t end = begin, size = 0;
    do size += values(panels_[end++]);
    while (end < panels_.size() && size + values(panels_[end]) <= most);
    values_.push_back(std::make_unique<double[]>(size));
    double* next = values_.back().get();
    for (; begin < end; ++begin) {
      panels_[begin].value = next;
      next += values(panels_[begin]);
    }
  }
}

/// Panel after panel. Each finished one waits at the panel that holds the first of its rows that has not been served,
/// which takes its product and passes it on.
class Panels::Making {
 public:
  Making(Panels& panels, const SparseMatrix& lower)
      : p_(panels),
        a_(lower),
        waiting_(p_.panels_.size(), -1),
        next_(p_.panels_.size(), -1),
        served_(p_.panels_.size(), 0),
        place_(static_cast<std::size_t>(lower.cols()), -1) {}

  /// False: a pivot is not positive, or no number, or somebody asks to stop. Whatever is not finite in a row reaches
  /// the pivot of that row.
  bool run() {
    for (const int k : p_.all_) {
      if (Interruption::asked_for()) return false;
      const Panel& panel = p_.panels_[static_cast<std::size_t>(k)];
      const std::span<const int> below = p_.below(panel);
      for (std::size_t i = 0; i < below.size(); ++i) place_[static_cast<std::size_t>(below[i])] = static_cast<int>(i);
      put_entries(panel);
      for (int earlier = waiting_[static_cast<std::size_t>(k)]; earlier >= 0;) {
        const int following = next_[static_cast<std::size_t>(earlier)];
        take_product(panel, earlier);
        pass_on(earlier);
        earlier = following;
      }
      if (!factor_triangle(panel)) return false;
      divide_rows(panel);
      for (const int row : below) place_[static_cast<std::size_t>(row)] = -1;
      pass_on(k);
    }
    return true;
  }

 private:
  [[nodiscard]] double* triangle(const Panel& panel) { return panel.value; }
  [[nodiscard]] double* rows(const Panel& panel) { return triangle(panel) + panel.width * (panel.width + 1) / 2; }

  void put_entries(const Panel& panel) {
    for (int j = 0; j < panel.width; ++j) {
      for (SparseMatrix::InnerIterator it(a_, panel.first + j); it; ++it) {
        const auto i = static_cast<int>(it.row()) - panel.first;
        if (i < j) continue;
        double& to =
            i < panel.width
                ? triangle(panel)[i * (i + 1) / 2 + j]
                : rows(
                      panel)[static_cast<std::ptrdiff_t>(panel.width) * place_[static_cast<std::size_t>(it.row())] + j];
        to += it.value();
      }
    }
  }

  /// Takes the product of an earlier panel's rows from the one that holds the first of them.
  void take_product(const Panel& panel, int number) {
    const Panel& earlier = p_.panels_[static_cast<std::size_t>(number)];
    int& served = served_[static_cast<std::size_t>(number)];
    const std::span<const int> left = p_.below(earlier).subspan(static_cast<std::size_t>(served));
    const double* l = rows(earlier) + static_cast<std::ptrdiff_t>(earlier.width) * served;
    double factors[widest * widest] = {};  // the rows that are columns here, by columns there
    int count = 0;
    for (; count < static_cast<int>(left.size()) && left[static_cast<std::size_t>(count)] < panel.first + panel.width;
         ++count, l += earlier.width) {
      const int i = left[static_cast<std::size_t>(count)] - panel.first;
      for (int j = 0; j < earlier.width; ++j) factors[j * panel.width + i] = l[j];
    }
    double* to = triangle(panel);
    for (int i = 0; i < panel.width; ++i) {
      for (int c = 0; c <= i; ++c, ++to) {
        for (int j = 0; j < earlier.width; ++j) *to -= factors[j * panel.width + i] * factors[j * panel.width + c];
      }
    }
    served += count;
    p_.kernels_->update[earlier.width - 1][panel.width - 1](l, left.data() + count, earlier.rows - served,
                                                            place_.data(), factors, rows(panel));
  }

  void pass_on(int number) {
    const Panel& panel = p_.panels_[static_cast<std::size_t>(number)];
    const int served = served_[static_cast<std::size_t>(number)];
    if (served == panel.rows) return;
    const int row = p_.rows_[static_cast<std::size_t>(panel.row + served)];
    int& waiting = waiting_[static_cast<std::size_t>(p_.panel_of_[static_cast<std::size_t>(row)])];
    next_[static_cast<std::size_t>(number)] = waiting;
    waiting = number;
  }

  /// L of the triangle, with 1 / L_jj on its diagonal.
  bool factor_triangle(const Panel& panel) {
    double* const t = triangle(panel);
    for (int i = 0; i < panel.width; ++i) {
      double* const row = t + i * (i + 1) / 2;
      for (int j = 0; j < i; ++j) {
        const double* const other = t + j * (j + 1) / 2;
        for (int k = 0; k < j; ++k) row[j] -= row[k] * other[k];
        row[j] *= other[j];
      }
      for (int k = 0; k < i; ++k) row[i] -= row[k] * row[k];
      if (!(row[i] > 0) || !std::isfinite(row[i])) return false;
      row[i] = 1 / std::sqrt(row[i]);
    }
    return true;
  }

  void divide_rows(const Panel& panel) {
    const double* const t = triangle(panel);
    double* row = rows(panel);
    for (int r = 0; r < panel.rows; ++r, row += panel.width) {
      for (int j = 0; j < panel.width; ++j) {
        const double* const other = t + j * (j + 1) / 2;
        for (int k = 0; k < j; ++k) row[j] -= row[k] * other[k];
        row[j] *= other[j];
      }
    }
  }

  Panels& p_;
  const SparseMatrix& a_;
  std::vector<int> waiting_, next_;  // the first panel that waits at each, and the next one that waits there, too
  std::vector<int> served_;          // how many of its rows have been columns
  std::vector<int> place_;           // of the present panel's rows below it
};

std::optional<Panels> Panels::factor(const SparseMatrix& lower, InstructionSet set) {
  Panels panels;
  panels.kernels_ = &panel_kernels_of(set);
  panels.divide(lower);
  if (Interruption::asked_for()) return std::nullopt;
  if (!Making(panels, lower).run()) return std::nullopt;
  return panels;
}

}  // namespace knead
