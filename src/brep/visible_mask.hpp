#pragma once

#include <array>
#include <vector>

#include "knead/brep/visible_region.hpp"

namespace knead {

/// Which cells of a grid over the domain of a surface are visible, and what of those that an edge
/// cuts.
///
/// A cell's visible area A and first moments follow from Green's theorem, A = −∮ (y − y₁) dx over
/// the chords of the loops within the cell, y₁ its upper side, and the chords below it: exact for
/// the polygons of the region, to about 1e-15 of the cell for each chord. Loops are counted by
/// nesting, outer ones once, those within them negatively. The cells of one strip, which share an
/// interval of the first direction, are kept as runs of equal state. Cost: time linear in chords,
/// in the cells that they cross and in strips; memory in the cells crossed.
class VisibleMask {
 public:
  /// The state of a cell; 0 or more is the number of its `CutCell`.
  static constexpr int full = -1, hidden = -2;
  /// Of a block of cells: they differ, or a part is among them.
  static constexpr int cut = 0;

  /// The visible part of a cell.
  struct CutCell {
    std::array<int, 2> cell;
    std::array<double, 2> middle;  ///< its centroid, in fractions of the domain
    double share;  ///< of the cell's area, 1e-9 to 1 − 1e-9; less is hidden, more is full
  };

  /// \param lines ends of the cells in fractions, ascending, at least two in each direction.
  VisibleMask(const VisibleRegion& region, const std::array<std::vector<double>, 2>& lines);

  [[nodiscard]] int state(int i, int j) const;
  /// Of the cells begin … end − 1: `full` or `hidden` if all are, else `cut`.
  [[nodiscard]] int state(const std::array<int, 2>& begin, const std::array<int, 2>& end) const;
  [[nodiscard]] const std::vector<CutCell>& cut_cells() const { return cut_cells_; }
  /// Every cell is full.
  [[nodiscard]] bool whole() const;

 private:
  struct Run {
    int end, state;  // of the cells up to `end`
  };
  void append(int strip, int end, int state);
  std::vector<std::vector<Run>> strips_;
  std::vector<CutCell> cut_cells_;
};

}  // namespace knead
