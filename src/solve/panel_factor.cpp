#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>
#include <utility>

#include "base/interruption.hpp"
#include "base/parallel_order.hpp"
#include "dissection.hpp"
#include "panels.hpp"
#include "simd/panel_kernels.hpp"

namespace knead {
namespace {

/// The fastest kernels up to those of an instruction set.
const detail::PanelKernels& panel_kernels_of(InstructionSet set) {
  if (detail::avx512_panel_kernels != nullptr && set >= InstructionSet::avx512)
    return *detail::avx512_panel_kernels;
  const bool wide = detail::avx2_panel_kernels != nullptr && set >= InstructionSet::avx2;
  return wide ? *detail::avx2_panel_kernels : *detail::vector128_panel_kernels;
}

/// The rows below the diagonal of the columns of L, one column after the other: those of A, and
/// those of all columns of which it is the first row (George, Liu: Computer Solution of Large
/// Sparse Positive Definite Systems, § 5.3). A column's rows are kept until they have been passed
/// on and nobody asks for them any more.
///
/// With parent(k) the first row below the diagonal of column k of L, rows(j) = rows of A's column j
/// united with rows(k) less j of all k whose parent is j. Columns further down the elimination tree
/// add nothing, as their rows are already in those of their parents. Cost: O(entries of L) times
/// the comparisons of a union.
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
      std::set_union(rows.begin(), rows.end(), further.begin() + 1, further.end(),
                     std::back_inserter(merged));
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

// Supernodes with relaxation (Ashcraft and Grimes, "The influence of relaxed supernode partitions
// on the multifrontal method", 1989), but narrow: a panel takes the largest width up to `widest` at
// which entries of L are at least 3/4 of the numbers that it stores off the diagonal. Widths are
// tried to the end even where one fails, since a later column may bring the rows that an earlier
// one lacked.
void Panels::divide(const SparseMatrix& lower, std::span<const int> breaks) {
  ColumnRows columns(lower);
  const auto size = static_cast<int>(lower.cols());
  std::vector<int> united, wider, merged;
  for (int first = 0; first < size && !Interruption::asked_for();) {
    columns.forget_before(first);
    // As many columns as fill three quarters of their panel.
    united = columns.of(first);
    wider = united;
    int width = 1, entries = static_cast<int>(united.size());
    const auto stop = std::ranges::upper_bound(breaks, first);
    const int most = std::min(widest, (stop == breaks.end() ? size : *stop) - first);
    for (int next = 1; next < most; ++next) {
      const int column = first + next;
      const std::vector<int>& more = columns.of(column);
      merged.clear();
      std::set_union(wider.begin(), wider.end(), more.begin(), more.end(),
                     std::back_inserter(merged));
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

// Pieces of 4 MB rather than one array: they fit where A's arrays have been, and no allocation asks
// for all of L at once.
void Panels::allocate() {
  constexpr std::size_t most = std::size_t{1}
                               << 19;  // of a piece of memory, unless one panel needs more
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

/// Panel after panel. Each finished one waits at the panel that holds the first of its rows that
/// has not been served, which takes its product and passes it on; what goes on to another task
/// waits until that is made. Tasks that do not need each other are made by several threads, and the
/// last ones, of large panels, one by one, where threads share the rows of a panel. Who adds what
/// in which order does not depend on that.
///
/// Left-looking: with J a panel, K those before it that have rows in J,
///
///   L_J = (A_J − Σ_K L_K L_JKᵀ) L_JJ⁻ᵀ,  L_JJ L_JJᵀ = the same difference on J's own rows
///
/// (Ng and Peyton, "Block sparse Cholesky algorithms on advanced uniprocessor computers", 1993). A
/// multifrontal method would stack update matrices beside L; here nothing but L is stored. Stable
/// without pivoting, as Cholesky is for every positive definite A (Higham 2002, § 10.1).
class Panels::Making {
 public:
  Making(Panels& panels, const SparseMatrix& lower)
      : p_(panels),
        a_(lower),
        tasks_(p_.tasks_),
        waiting_(p_.panels_.size(), -1),
        next_(p_.panels_.size(), -1),
        served_(p_.panels_.size(), 0) {
    if (tasks_.empty()) tasks_.push_back({0, static_cast<int>(p_.panels_.size()), -1, {}, 0, {}});
    passed_.resize(tasks_.size());
  }

  /// False: a pivot is not positive, or no number, or somebody asks to stop. Whatever is not finite
  /// in a row reaches the pivot of that row.
  bool run() {
    std::vector<int> shared, alone;
    std::vector<int> depth(tasks_.size(), 0);
    for (std::size_t k = tasks_.size(); k-- > 0;) {
      if (tasks_[k].parent >= 0) depth[k] = depth[static_cast<std::size_t>(tasks_[k].parent)] + 1;
    }
    for (std::size_t k = 0; k < tasks_.size(); ++k) {
      if (depth[k] < last_levels) alone.push_back(static_cast<int>(k));
    }
    for (const int k : p_.work_order_) {
      if (depth[static_cast<std::size_t>(k)] >= last_levels) shared.push_back(k);
    }
    const auto children = [&](int k) {
      return std::span(std::as_const(tasks_[static_cast<std::size_t>(k)].children));
    };
    detail::parallel_in_order(shared, tasks_.size(), true, children, [&](int k) { make(k); });
    for (const int k : alone) make(k);
    return !stopped_;
  }

 private:
  static constexpr int last_levels = 2;  // of tasks that are made one by one

  /// A task's panels. What goes wrong ends all tasks.
  void make(int number) {
    const Task& task = tasks_[static_cast<std::size_t>(number)];
    std::vector<int>& passed = passed_[static_cast<std::size_t>(number)];
    for (const int child : task.children) {
      for (const int panel : passed_[static_cast<std::size_t>(child)]) pass_on(panel, task, passed);
    }
    std::vector<int> place(static_cast<std::size_t>(a_.cols()), -1);
    for (int k = task.begin; k < task.end; ++k) {
      if (Interruption::asked_for()) stopped_ = true;
      if (stopped_) return;
      const Panel& panel = p_.panels_[static_cast<std::size_t>(k)];
      const std::span<const int> below = p_.below(panel);
      for (std::size_t i = 0; i < below.size(); ++i)
        place[static_cast<std::size_t>(below[i])] = static_cast<int>(i);
      put_entries(panel, place);
      take_products(panel, k, place, task, passed);
      if (!factor_triangle(panel)) {
        stopped_ = true;
        return;
      }
      divide_rows(panel);
      for (const int row : below) place[static_cast<std::size_t>(row)] = -1;
      pass_on(k, task, passed);
    }
  }

  [[nodiscard]] double* triangle(const Panel& panel) { return panel.value; }
  [[nodiscard]] double* rows(const Panel& panel) {
    return triangle(panel) + panel.width * (panel.width + 1) / 2;
  }

  void put_entries(const Panel& panel, const std::vector<int>& place) {
    for (int j = 0; j < panel.width; ++j) {
      for (SparseMatrix::InnerIterator it(a_, panel.first + j); it; ++it) {
        const auto i = static_cast<int>(it.row()) - panel.first;
        if (i < j) continue;
        double& to = i < panel.width ? triangle(panel)[i * (i + 1) / 2 + j]
                                     : rows(panel)[static_cast<std::ptrdiff_t>(panel.width) *
                                                       place[static_cast<std::size_t>(it.row())] +
                                                   j];
        to += it.value();
      }
    }
  }

  /// The rows of an earlier panel from the first on that is a column of a later one, and those of
  /// them that are, by columns there.
  struct Product {
    const double* l;
    std::span<const int> rows;
    int width;
    double factors[widest * widest];
  };

  /// Takes the products of all panels that wait at this one.
  void take_products(const Panel& panel, int number, const std::vector<int>& place,
                     const Task& task, std::vector<int>& passed) {
    const int first = waiting_[static_cast<std::size_t>(number)];
    double work = 0;
    for (int k = first; k >= 0; k = next_[static_cast<std::size_t>(k)]) {
      const Panel& earlier = p_.panels_[static_cast<std::size_t>(k)];
      work += earlier.width * (earlier.rows - served_[static_cast<std::size_t>(k)]);
    }
    const std::ptrdiff_t size =
        detail::block_size(panel.rows, work * panel.width / (panel.rows + 1), 16);
    const bool at_once = size >= panel.rows;
    std::vector<Product> products;
    for (int k = first; k >= 0;) {
      const int following = next_[static_cast<std::size_t>(k)];
      const Product product = begin_product(panel, k);
      if (at_once) {
        update(panel, product, place);
      } else {
        products.push_back(product);
      }
      pass_on(k, task, passed);
      k = following;
    }
    if (at_once) return;
    const std::span<const int> below = p_.below(panel);
    detail::parallel_for(panel.rows, size, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (const Product& whole : products) {
        const auto from =
            std::ranges::lower_bound(whole.rows, below[static_cast<std::size_t>(begin)]);
        const auto to = end < panel.rows ? std::lower_bound(from, whole.rows.end(),
                                                            below[static_cast<std::size_t>(end)])
                                         : whole.rows.end();
        Product part = whole;
        part.l += part.width * (from - whole.rows.begin());
        part.rows = std::span(from, to);
        update(panel, part, place);
      }
    });
  }

  /// Serves those rows of an earlier panel that are columns of this one, and takes their product
  /// from its triangle.
  Product begin_product(const Panel& panel, int number) {
    const Panel& earlier = p_.panels_[static_cast<std::size_t>(number)];
    int& served = served_[static_cast<std::size_t>(number)];
    const std::span<const int> left = p_.below(earlier).subspan(static_cast<std::size_t>(served));
    Product product{
        rows(earlier) + static_cast<std::ptrdiff_t>(earlier.width) * served, {}, earlier.width, {}};
    double* const factors = product.factors;
    int count = 0;
    for (; count < static_cast<int>(left.size()) &&
           left[static_cast<std::size_t>(count)] < panel.first + panel.width;
         ++count, product.l += earlier.width) {
      const int i = left[static_cast<std::size_t>(count)] - panel.first;
      for (int j = 0; j < earlier.width; ++j) factors[j * panel.width + i] = product.l[j];
    }
    double* to = triangle(panel);
    for (int i = 0; i < panel.width; ++i) {
      for (int c = 0; c <= i; ++c, ++to) {
        for (int j = 0; j < earlier.width; ++j)
          *to -= factors[j * panel.width + i] * factors[j * panel.width + c];
      }
    }
    served += count;
    product.rows = left.subspan(static_cast<std::size_t>(count));
    return product;
  }

  /// Takes a product from the rows below a panel.
  void update(const Panel& panel, const Product& product, const std::vector<int>& place) {
    p_.kernels_->update[product.width - 1][panel.width - 1](
        product.l, product.rows.data(), static_cast<std::ptrdiff_t>(product.rows.size()),
        place.data(), product.factors, rows(panel));
  }

  /// To the panel of the first row that has not been served; `passed`: if that is of another task
  /// than this.
  void pass_on(int number, const Task& task, std::vector<int>& passed) {
    const Panel& panel = p_.panels_[static_cast<std::size_t>(number)];
    const int served = served_[static_cast<std::size_t>(number)];
    if (served == panel.rows) return;
    const int row = p_.rows_[static_cast<std::size_t>(panel.row + served)];
    const int at = p_.panel_of_[static_cast<std::size_t>(row)];
    if (at >= task.end) return passed.push_back(number);
    int& waiting = waiting_[static_cast<std::size_t>(at)];
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
  std::vector<Task> tasks_;
  std::vector<int> waiting_,
      next_;  // the first panel that waits at each, and the next one that waits there, too
  std::vector<int> served_;               // how many of its rows have been columns
  std::vector<std::vector<int>> passed_;  // by each task to those behind it
  std::atomic<bool> stopped_ = false;
};

std::optional<Panels> Panels::factor(const SparseMatrix& lower, InstructionSet set,
                                     const Dissection* dissection) {
  Panels panels;
  panels.kernels_ = &panel_kernels_of(set);
  std::vector<int> breaks;
  if (dissection != nullptr) {
    for (const Dissection::Node& node : dissection->nodes) breaks.push_back(node.begin);
  }
  panels.divide(lower, breaks);
  if (Interruption::asked_for()) return std::nullopt;
  if (dissection != nullptr && dissection->nodes.size() > 1) panels.make_tasks(*dissection);
  if (!Making(panels, lower).run()) return std::nullopt;
  panels.separate_tasks();
  return panels;
}

}  // namespace knead
