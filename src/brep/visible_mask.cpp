#include "visible_mask.hpp"

#include <algorithm>
#include <cmath>

namespace knead {
namespace {

using Eigen::Vector2d;
using Loop = std::vector<Vector2d>;

constexpr double negligible = 1e-9;  // of a cell's area

/// What lies above some chords: its area, and its first moments about the lower left corner of a
/// cell.
struct Moments {
  double area = 0, x = 0, y = 0;
};

/// The chords within one cell: what lies above them in it, and their extent and moment along x,
/// which count for the cells above.
struct Crossing {
  int cell;
  Moments above;
  double width = 0, width_x = 0;
};

double signed_area(const Loop& loop) {
  double sum = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vector2d &a = loop[k], &b = loop[(k + 1) % loop.size()];
    sum += (a.x() - loop[0].x()) * (b.y() - loop[0].y()) -
           (b.x() - loop[0].x()) * (a.y() - loop[0].y());
  }
  return sum;
}

/// 1 if the loop, as it runs, has what it adds on its left, else −1.
/// Files do not agree on the directions of loops: nesting and the signed area give the sign with
/// which chords count.
double sense(const std::vector<Loop>& face, std::size_t which) {
  bool within = false;
  for (std::size_t k = 0; k < face.size(); ++k) {
    VisibleRegion alone;
    alone.faces = {{face[k]}};
    if (k != which && alone.contains(face[which].front())) within = !within;
  }
  return (signed_area(face[which]) > 0) != within ? 1 : -1;
}

/// The cell of a line of them, `lines[k]` to `lines[k + 1]`, in which x lies.
int cell_of(const std::vector<double>& lines, double x) {
  const auto after = std::upper_bound(lines.begin(), lines.end(), x) - lines.begin();
  return std::clamp(static_cast<int>(after) - 1, 0, static_cast<int>(lines.size()) - 2);
}

/// Sorts the chords of loops into cells.
class Crossings {
 public:
  Crossings(const std::array<std::vector<double>, 2>& lines) : xs_(lines[0]), ys_(lines[1]) {
    strips.resize(xs_.size() - 1);
  }

  std::vector<std::vector<Crossing>> strips;

  /// Splits a chord at the sides of strips.
  void add(Vector2d a, Vector2d b, double sign) {
    if (std::max(a.x(), b.x()) < xs_.front() || std::min(a.x(), b.x()) >= xs_.back()) return;
    if (a.x() == b.x())
      return in_strip(cell_of(xs_, a.x()), a, b, sign);  // adds no area, but marks what it cuts
    if (a.x() > b.x()) {
      std::swap(a, b);
      sign = -sign;
    }
    const auto at = [&](double x) {
      return Vector2d(x, a.y() + (b.y() - a.y()) * ((x - a.x()) / (b.x() - a.x())));
    };
    Vector2d from = a.x() < xs_.front() ? at(xs_.front()) : a;
    const Vector2d last = b.x() > xs_.back() ? at(xs_.back()) : b;
    for (int i = cell_of(xs_, from.x()); from.x() < last.x(); ++i) {
      const double side = xs_[static_cast<std::size_t>(i) + 1];
      const Vector2d to = last.x() <= side ? last : at(side);
      in_strip(i, from, to, sign);
      from = to;
    }
  }

 private:
  const std::vector<double>&xs_, &ys_;

  /// Splits a chord of a strip at the sides of its cells.
  void in_strip(int i, Vector2d a, Vector2d b, double sign) {
    if (a.y() > b.y()) {
      std::swap(a, b);
      sign = -sign;
    }
    const auto at = [&](double y) {
      return Vector2d(a.x() + (b.x() - a.x()) * ((y - a.y()) / (b.y() - a.y())), y);
    };
    if (a.y() >= ys_.back()) return;
    Vector2d from = a;
    const double bottom = ys_.front();
    if (from.y() < bottom) {  // what runs below the domain counts like its lower side
      const Vector2d to = b.y() <= bottom ? Vector2d(b.x(), bottom) : at(bottom);
      in_cell(i, 0, {from.x(), bottom}, to, sign);
      from = to;
      if (b.y() <= bottom) return;
    }
    for (int j = cell_of(ys_, from.y());; ++j) {
      const double side = ys_[static_cast<std::size_t>(j) + 1];
      if (b.y() <= side) return in_cell(i, j, from, b, sign);
      const Vector2d to = at(side);
      in_cell(i, j, from, to, sign);
      from = to;
      if (static_cast<std::size_t>(j) + 2 == ys_.size()) return;
    }
  }

  // Moments of a trapezoid with heights h_a and h_b at a_x and b_x, h linear between them: ∫ h dx,
  // ∫ x h dx and ∫ (H² − y²)/2 dx, H the height of the cell. Coordinates are those from the cell's
  // own corner, which keeps the digits of small cells far from the origin.
  void in_cell(int i, int j, const Vector2d& a, const Vector2d& b, double sign) {
    const double x0 = xs_[static_cast<std::size_t>(i)], y0 = ys_[static_cast<std::size_t>(j)];
    const double height = ys_[static_cast<std::size_t>(j) + 1] - y0, dx = sign * (b.x() - a.x());
    const double ax = a.x() - x0, bx = b.x() - x0, ay = a.y() - y0, by = b.y() - y0;
    const double ah = height - ay, bh = height - by;
    Crossing crossing{j, {}, dx, dx * (ax + bx) / 2};
    crossing.above.area = dx * (ah + bh) / 2;
    crossing.above.x = dx * (ah * ax / 3 + (ah * bx + bh * ax) / 6 + bh * bx / 3);
    crossing.above.y = dx * (height * height / 2 - (ay * ay + ay * by + by * by) / 6);
    strips[static_cast<std::size_t>(i)].push_back(crossing);
  }
};

}  // namespace

VisibleMask::VisibleMask(const VisibleRegion& region,
                         const std::array<std::vector<double>, 2>& lines) {
  const auto &xs = lines[0], &ys = lines[1];
  const int count = static_cast<int>(ys.size()) - 1;
  if (region.faces.empty()) {
    strips_.assign(xs.size() - 1, {{count, full}});
    return;
  }
  Crossings crossings(lines);
  for (const auto& face : region.faces) {
    for (std::size_t l = 0; l < face.size(); ++l) {
      if (face[l].size() < 3) continue;
      const double sign = sense(face, l);
      for (std::size_t k = 0; k < face[l].size(); ++k) {
        crossings.add(face[l][k], face[l][(k + 1) % face[l].size()], sign);
      }
    }
  }
  strips_.resize(xs.size() - 1);
  for (std::size_t i = 0; i < strips_.size(); ++i) {
    auto& found = crossings.strips[i];
    std::ranges::sort(found, {}, &Crossing::cell);
    const int strip = static_cast<int>(i);
    const double width = xs[i + 1] - xs[i];
    // Cells are passed upwards with the sum of Δx of all chords below: a chord far down counts for
    // the whole column above it by one number, and cells that no chord meets need no work.
    double below = 0, below_x = 0;  // of all chords in cells passed
    int next = 0;
    for (std::size_t k = 0; k < found.size();) {
      const int j = found[k].cell;
      if (j > next) append(strip, j, below > 0.5 * width ? full : hidden);
      const double y = ys[static_cast<std::size_t>(j)],
                   height = ys[static_cast<std::size_t>(j) + 1] - y;
      Moments sum{below * height, below_x * height, below * height * height / 2};
      for (; k < found.size() && found[k].cell == j; ++k) {
        sum.area += found[k].above.area;
        sum.x += found[k].above.x;
        sum.y += found[k].above.y;
        below += found[k].width;
        below_x += found[k].width_x;
      }
      next = j + 1;
      const double share = sum.area / (width * height);
      // Slivers of rounding are no part of their own: their centroid is noise.
      if (share <= negligible || share >= 1 - negligible) {
        append(strip, next, share > 0.5 ? full : hidden);
        continue;
      }
      append(strip, next, static_cast<int>(cut_cells_.size()));
      const double x = xs[i] + std::clamp(sum.x / sum.area, 0., width);
      cut_cells_.push_back({{strip, j}, {x, y + std::clamp(sum.y / sum.area, 0., height)}, share});
    }
    if (next < count) append(strip, count, below > 0.5 * width ? full : hidden);
  }
}

/// Continues a strip up to the cell `end`.
void VisibleMask::append(int strip, int end, int state) {
  auto& runs = strips_[static_cast<std::size_t>(strip)];
  if (!runs.empty() && runs.back().state == state) {
    runs.back().end = end;
  } else {
    runs.push_back({end, state});
  }
}

int VisibleMask::state(int i, int j) const {
  return std::ranges::upper_bound(strips_[static_cast<std::size_t>(i)], j, {}, &Run::end)->state;
}

int VisibleMask::state(const std::array<int, 2>& begin, const std::array<int, 2>& end) const {
  const int first = state(begin[0], begin[1]);
  if (first >= 0) return cut;
  for (int i = begin[0]; i < end[0]; ++i) {
    const auto run =
        std::ranges::upper_bound(strips_[static_cast<std::size_t>(i)], begin[1], {}, &Run::end);
    if (run->state != first || run->end < end[1]) return cut;
  }
  return first;
}

bool VisibleMask::whole() const {
  return std::ranges::all_of(
      strips_, [](const auto& runs) { return runs.size() == 1 && runs[0].state == full; });
}

}  // namespace knead
