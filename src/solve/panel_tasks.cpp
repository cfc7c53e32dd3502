#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <span>

#include "base/parallel_order.hpp"
#include "dissection.hpp"
#include "panels.hpp"
#include "simd/panel_kernels.hpp"

namespace knead {
namespace {

constexpr std::ptrdiff_t least_shared = std::ptrdiff_t{1}
                                        << 21;  // values of L: about a millisecond

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

// Priorities are critical paths: the values of L from a task to the root (T. C. Hu, "Parallel
// sequencing and assembly line problems", 1961). The 1 makes a child's strictly larger than its
// parent's, even for tasks without panels, so that descending order puts children before parents
// and its reverse parents before children, as `parallel_in_order` requires.
void Panels::make_tasks(const Dissection& dissection) {
  int begin = 0;
  for (const Dissection::Node& node : dissection.nodes) {
    int end = begin;
    while (end < static_cast<int>(panels_.size()) && panels_[at(end)].first < node.end) ++end;
    tasks_.push_back({begin, end, node.parent, {}, 0, {}});
    begin = end;
  }
  std::vector<double> work(tasks_.size(), 0.0);  // of a task and those behind it
  for (std::size_t k = tasks_.size(); k-- > 0;) {
    const Task& task = tasks_[k];
    for (int panel = task.begin; panel < task.end; ++panel) {
      work[k] += (panels_[at(panel)].rows + 1) * panels_[at(panel)].width;
    }
    if (task.parent < 0) continue;
    work[k] += work[at(task.parent)] + 1;
    std::vector<int>& siblings = tasks_[at(task.parent)].children;
    siblings.insert(siblings.begin(), static_cast<int>(k));
  }
  // What most has to wait for comes first.
  work_order_.resize(tasks_.size());
  std::iota(work_order_.begin(), work_order_.end(), 0);
  std::ranges::stable_sort(work_order_, [&](int a, int b) { return work[at(a)] > work[at(b)]; });
}

void Panels::separate_tasks() {
  std::vector<int> place(panel_of_.size(),
                         -1);  // of the rows of the matrix, among those that are reached
  for (Task& task : tasks_) separate(task, place);
}

// After this, rows of other tasks in this task's panels point to rows of its own, which begin at
// `first_row`. Two tasks that run at the same time then never write the same row, without locks or
// atomic sums, and a row's sum has one order whatever the number of threads. The rows reached are
// those of the task's panels and of its children, less the task's own: what a child adds to a
// separator further behind passes through here.
void Panels::separate(Task& task, std::vector<int>& place) {
  const auto size = static_cast<int>(panel_of_.size());
  const int end =
      task.end > task.begin ? panels_[at(task.end - 1)].first + panels_[at(task.end - 1)].width : 0;
  // The rows of other tasks, which all come behind it.
  std::vector<int> reached;
  const auto reach = [&](int row) {
    if (row < end || place[at(row)] >= 0) return;
    place[at(row)] = 0;
    reached.push_back(row);
  };
  for (int k = task.begin; k < task.end; ++k) std::ranges::for_each(below(panels_[at(k)]), reach);
  const auto is_own = [&](int row) {
    return task.begin <= panel_of_[at(row)] && panel_of_[at(row)] < task.end;
  };
  for (const int child : task.children) {
    for (const int row : tasks_[at(child)].targets) {
      if (!is_own(row)) reach(row);
    }
  }
  std::ranges::sort(reached);
  task.first_row = size + static_cast<int>(original_.size());
  for (std::size_t k = 0; k < reached.size(); ++k)
    place[at(reached[k])] = task.first_row + static_cast<int>(k);
  original_.insert(original_.end(), reached.begin(), reached.end());
  for (int k = task.begin; k < task.end; ++k) {
    const Panel& panel = panels_[at(k)];
    for (int& row : std::span(rows_).subspan(at(panel.row), at(panel.rows))) {
      if (row >= end) row = place[at(row)];
    }
  }
  for (const int child : task.children) {
    for (int& row : tasks_[at(child)].targets) {
      if (!is_own(row)) row = place[at(row)];
    }
  }
  for (const int row : reached) place[at(row)] = -1;
  task.targets = std::move(reached);  // as rows of the matrix, until its parent is separated
}

/// What each task does of some panels. Tasks take part that have some, and those behind these,
/// which pass sums on.
class Panels::Shares {
 public:
  Shares(const Panels& p, std::span<const int> panels)
      : shares_(p.tasks_.size()), takes_part_(p.tasks_.size(), 0) {
    for (std::size_t k = 0; k < shares_.size(); ++k) {
      const Task& task = p.tasks_[k];
      const auto begin = std::ranges::lower_bound(panels, task.begin);
      shares_[k] = std::span(begin, std::lower_bound(begin, panels.end(), task.end));
      if (!shares_[k].empty()) takes_part_[k] = 1;
      for (const int panel : shares_[k]) {
        const Panel& of = p.panels_[at(panel)];
        values_ += static_cast<std::ptrdiff_t>(of.width) * of.rows;
      }
      if (takes_part_[k] && task.parent >= 0) takes_part_[at(task.parent)] = 1;
    }
    std::ranges::copy_if(p.work_order_, std::back_inserter(order_),
                         [&](int k) { return takes_part(k); });
  }

  [[nodiscard]] std::span<const int> of(int task) const { return shares_[at(task)]; }
  [[nodiscard]] bool takes_part(int task) const { return takes_part_[at(task)] != 0; }
  /// Of the tasks that take part, forwards.
  [[nodiscard]] std::vector<int>& order() { return order_; }
  /// Whether they are enough for several threads.
  [[nodiscard]] bool many() const { return values_ >= least_shared; }

 private:
  std::vector<std::span<const int>> shares_;
  std::vector<char> takes_part_;
  std::vector<int> order_;
  std::ptrdiff_t values_ = 0;  // of L
};

template <int columns>
void Panels::substitute_forward(double* x, std::span<const int> panels) const {
  const auto& kernels = columns == 1 ? kernels_->down_one : kernels_->down_four;
  for (const int k : panels) {
    const Panel& p = panels_[at(k)];
    kernels[p.width - 1](p.value, rows_.data() + p.row, p.rows, x,
                         x + columns * static_cast<std::ptrdiff_t>(p.first));
  }
}

template <int columns>
void Panels::substitute_backward(double* x, std::span<const int> panels) const {
  const auto& kernels = columns == 1 ? kernels_->up_one : kernels_->up_four;
  for (std::size_t k = panels.size(); k-- > 0;) {
    const Panel& p = panels_[at(panels[k])];
    kernels[p.width - 1](p.value, rows_.data() + p.row, p.rows, x,
                         x + columns * static_cast<std::ptrdiff_t>(p.first));
  }
}

// A task begins by adding the sums of its children to its rows, in the order of the children. In a
// confined solve children that take no part have stale sums, and are passed over.
template <int columns>
void Panels::forward(double* x, std::span<const int> panels) const {
  if (tasks_.empty()) return substitute_forward<columns>(x, panels);
  const auto row = [&](int i) { return x + columns * static_cast<std::ptrdiff_t>(i); };
  Shares shares(*this, panels);
  detail::parallel_in_order(
      shares.order(), tasks_.size(), shares.many(),
      [&](int k) { return std::span(tasks_[at(k)].children); },
      [&](int k) {
        const Task& task = tasks_[at(k)];
        std::fill_n(row(task.first_row), columns * task.targets.size(), 0.0);
        for (const int child : task.children) {
          if (!shares.takes_part(child)) continue;
          const double* from = row(tasks_[at(child)].first_row);
          for (const int target : tasks_[at(child)].targets) {
            double* to = row(target);
            for (int c = 0; c < columns; ++c) to[c] += *from++;
          }
        }
        substitute_forward<columns>(x, shares.of(k));
      });
}

// From the root down: a task copies the values of its targets from its parent's rows, which are
// final by then, to rows of its own, so that the kernels find them where L's rows point.
template <int columns>
void Panels::backward(double* x, std::span<const int> panels) const {
  if (tasks_.empty()) return substitute_backward<columns>(x, panels);
  const auto row = [&](int i) { return x + columns * static_cast<std::ptrdiff_t>(i); };
  Shares shares(*this, panels);
  std::ranges::reverse(shares.order());
  detail::parallel_in_order(
      shares.order(), tasks_.size(), shares.many(),
      [&](int k) { return std::span(&tasks_[at(k)].parent, tasks_[at(k)].parent < 0 ? 0 : 1); },
      [&](int k) {
        const Task& task = tasks_[at(k)];
        double* to = row(task.first_row);
        for (const int target : task.targets) to = std::copy_n(row(target), columns, to);
        substitute_backward<columns>(x, shares.of(k));
      });
}

template <class F>
void Panels::for_each_range(std::span<const int> panels, const F& f) const {
  const auto range = [&](int first, int last) {
    f(panels_[at(first)].first, panels_[at(last)].first + panels_[at(last)].width);
  };
  if (tasks_.empty()) {
    for (const int k : panels) range(k, k);
    return;
  }
  // Tasks add to all rows that they know, and not to those of a reach alone.
  Shares shares(*this, panels);
  for (const int k : shares.order()) {
    if (tasks_[at(k)].begin < tasks_[at(k)].end) range(tasks_[at(k)].begin, tasks_[at(k)].end - 1);
  }
}

template <int columns>
void Panels::clear(double* x, std::span<const int> panels) const {
  for_each_range(panels, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    std::fill(x + columns * begin, x + columns * end, 0.0);
  });
}

template <int columns>
void Panels::copy(const double* from, double* to, std::span<const int> panels) const {
  for_each_range(panels, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    std::copy(from + columns * begin, from + columns * end, to + columns * begin);
  });
}

template void Panels::clear<1>(double*, std::span<const int>) const;
template void Panels::clear<4>(double*, std::span<const int>) const;
template void Panels::copy<1>(const double*, double*, std::span<const int>) const;
template void Panels::copy<4>(const double*, double*, std::span<const int>) const;
template void Panels::forward<1>(double*, std::span<const int>) const;
template void Panels::forward<4>(double*, std::span<const int>) const;
template void Panels::backward<1>(double*, std::span<const int>) const;
template void Panels::backward<4>(double*, std::span<const int>) const;

}  // namespace knead
