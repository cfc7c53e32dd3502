#include "panels.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>

#include "simd/panel_kernels.hpp"

namespace knead {
namespace {

/// The fastest kernels up to those of an instruction set.
const detail::PanelKernels& kernels_of(InstructionSet set) {
  const bool wide = detail::avx2_panel_kernels != nullptr && set >= InstructionSet::avx2;
  return wide ? *detail::avx2_panel_kernels : *detail::vector128_panel_kernels;
}

}  // namespace

Panels::Panels(const SparseMatrix& lower, InstructionSet set) : kernels_(&kernels_of(set)) {
  const auto* start = lower.outerIndexPtr();
  const auto* row = lower.innerIndexPtr();
  const auto size = static_cast<int>(lower.cols());
  std::vector<int> united, wider;
  int values = 0;
  for (int first = 0; first < size;) {
    // As many columns as fill three quarters of their panel.
    int width = 1, entries = start[first + 1] - start[first] - 1;
    united.assign(row + start[first] + 1, row + start[first + 1]);
    wider = united;
    for (int next = 1; next < widest && first + next < size; ++next) {
      const int column = first + next;
      std::vector<int> merged;
      std::set_union(wider.begin(), wider.end(), row + start[column] + 1, row + start[column + 1],
                     std::back_inserter(merged));
      wider = std::move(merged);
      entries += start[column + 1] - start[column] - 1;
      const auto below = static_cast<int>(wider.end() - std::ranges::upper_bound(wider, column));
      const int stored = (next + 1) * below + next * (next + 1) / 2;
      if (4 * entries < 3 * stored) continue;
      width = next + 1;
      united = wider;
    }
    const int last = first + width - 1;
    Panel panel{first, width, static_cast<int>(rows_.size()), 0, values};
    rows_.insert(rows_.end(), std::ranges::upper_bound(united, last), united.end());
    panel.rows = static_cast<int>(rows_.size()) - panel.row;
    values += width * (width + 1) / 2 + width * panel.rows;
    all_.push_back(static_cast<int>(panels_.size()));
    panel_of_.insert(panel_of_.end(), static_cast<std::size_t>(width), all_.back());
    panels_.push_back(panel);
    first += width;
  }
  values_.assign(static_cast<std::size_t>(values), 0.0);
  for (const Panel& panel : panels_) fill(panel, lower);
}

void Panels::fill(const Panel& panel, const SparseMatrix& lower) {
  const auto* start = lower.outerIndexPtr();
  const auto* row = lower.innerIndexPtr();
  const int triangle = panel.width * (panel.width + 1) / 2;
  double* to = values_.data() + panel.value;
  const std::span<const int> below(rows_.data() + panel.row, static_cast<std::size_t>(panel.rows));
  for (int j = 0; j < panel.width; ++j) {
    for (auto k = start[panel.first + j]; k < start[panel.first + j + 1]; ++k) {
      const double value = lower.valuePtr()[k];
      if (const int i = row[k] - panel.first; i < panel.width) {
        to[i * (i + 1) / 2 + j] = i == j ? 1 / value : value;
      } else {
        const auto place = std::ranges::lower_bound(below, row[k]) - below.begin();
        to[triangle + panel.width * place + j] = value;
      }
    }
  }
}

std::vector<int> Panels::reach(std::span<const int> rows) const {
  std::vector<char> marked(panels_.size(), 0);
  const auto mark = [&](int row) { marked[static_cast<std::size_t>(panel_of_[static_cast<std::size_t>(row)])] = 1; };
  for (const int row : rows) mark(row);
  std::vector<int> result;
  for (std::size_t k = 0; k < panels_.size(); ++k) {
    if (!marked[k]) continue;
    result.push_back(static_cast<int>(k));
    for (int i = 0; i < panels_[k].rows; ++i) mark(rows_[static_cast<std::size_t>(panels_[k].row + i)]);
  }
  return result;
}

template <int columns>
void Panels::forward(double* x, std::span<const int> panels) const {
  const auto& kernels = columns == 1 ? kernels_->down_one : kernels_->down_four;
  for (const int k : panels) {
    const Panel& p = panels_[static_cast<std::size_t>(k)];
    kernels[p.width - 1](values_.data() + p.value, rows_.data() + p.row, p.rows, x,
                         x + columns * static_cast<std::ptrdiff_t>(p.first));
  }
}

template <int columns>
void Panels::backward(double* x, std::span<const int> panels) const {
  const auto& kernels = columns == 1 ? kernels_->up_one : kernels_->up_four;
  for (std::size_t k = panels.size(); k-- > 0;) {
    const Panel& p = panels_[static_cast<std::size_t>(panels[k])];
    kernels[p.width - 1](values_.data() + p.value, rows_.data() + p.row, p.rows, x,
                         x + columns * static_cast<std::ptrdiff_t>(p.first));
  }
}

template <int columns>
void Panels::clear(double* x, std::span<const int> panels) const {
  for (const int k : panels) {
    const Panel& p = panels_[static_cast<std::size_t>(k)];
    std::fill_n(x + columns * static_cast<std::ptrdiff_t>(p.first), columns * p.width, 0.0);
  }
}

template <int columns>
void Panels::copy(const double* from, double* to, std::span<const int> panels) const {
  for (const int k : panels) {
    const Panel& p = panels_[static_cast<std::size_t>(k)];
    const std::ptrdiff_t at = columns * static_cast<std::ptrdiff_t>(p.first);
    std::copy_n(from + at, columns * p.width, to + at);
  }
}

template void Panels::forward<1>(double*, std::span<const int>) const;
template void Panels::forward<4>(double*, std::span<const int>) const;
template void Panels::backward<1>(double*, std::span<const int>) const;
template void Panels::backward<4>(double*, std::span<const int>) const;
template void Panels::clear<1>(double*, std::span<const int>) const;
template void Panels::clear<4>(double*, std::span<const int>) const;
template void Panels::copy<1>(const double*, double*, std::span<const int>) const;
template void Panels::copy<4>(const double*, double*, std::span<const int>) const;

}  // namespace knead
