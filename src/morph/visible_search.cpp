#include "visible_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parallel_for.hpp"
#include "brep/shared_edge.hpp"
#include "brep/visible_mask.hpp"
#include "knead/spline/closest_point.hpp"
#include "knead/spline/evaluate.hpp"
#include "spline/box_tree.hpp"

namespace knead::morph {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector2d;

constexpr int samples = 5;           // of a cell, per direction
constexpr double search_work = 2e4;  // multiplications, of one point

std::size_t at(int d) { return static_cast<std::size_t>(d); }

/// Ends of the cells of a direction, as fractions of the domain: at knots, and at least about
/// sixteen.
std::vector<double> cell_lines(const KnotVector& knots) {
  const auto spans = knots.spans();
  const int parts = std::clamp(16 / static_cast<int>(spans.size()), 2, 16);
  const Interval domain = knots.domain();
  std::vector<double> lines;
  for (const int span : spans) {
    for (int k = 0; k < parts; ++k) {
      const double knot = knots[span] + (knots[span + 1] - knots[span]) * k / parts;
      lines.push_back((knot - domain.lower) / domain.length());
    }
  }
  lines.push_back(1);
  return lines;
}

struct Chord {
  Vector2d from, to;
  Point start, end;
  double deviation = 0;

  [[nodiscard]] AlignedBox3d box() const {
    AlignedBox3d result(start);
    result.extend(end);
    return result;
  }
};

struct Shown {
  const Surface* surface = nullptr;
  const VisibleRegion* region = nullptr;
  std::optional<ClosestPointSearch<2>> search = {};
  std::optional<VisibleMask> mask = {};
  std::array<std::vector<double>, 2> lines = {};
  std::vector<AlignedBox3d> boxes = {};  // of its visible cells
  std::vector<std::array<int, 2>> cells = {};
  std::vector<Chord> chords = {};
  BoxTree edges = {};  // of them

  Expected<void> prepare();
  [[nodiscard]] bool visible(const Vector2d& fractions) const;
  /// The nearest point on an edge, and whether `foot` is as near to its chord as that is to the
  /// edge.
  [[nodiscard]] std::pair<VisibleFoot, bool> on_edge(const Point& x, const Vector2d& foot,
                                                     double within) const;
  [[nodiscard]] Vector2d fractions(const std::array<double, 2>& parameters) const {
    Vector2d result;
    for (int d = 0; d < 2; ++d) {
      const Interval domain = surface->knots(d).domain();
      result[d] = (parameters[at(d)] - domain.lower) / domain.length();
    }
    return result;
  }

 private:
  Expected<void> add_boxes();
  void add_chords();
};

Expected<void> Shown::add_boxes() {
  const auto knots = [&](int d, int cell) {
    const Interval domain = surface->knots(d).domain();
    std::array<double, samples> result{};
    for (int k = 0; k < samples; ++k) {
      const double a = lines[at(d)][at(cell)], b = lines[at(d)][at(cell + 1)];
      const double x = domain.lower + (a + (b - a) * k / (samples - 1)) * domain.length();
      result[at(k)] = std::clamp(x, domain.lower, domain.upper);
    }
    return result;
  };
  const int rows = static_cast<int>(lines[0].size()) - 1,
            columns = static_cast<int>(lines[1].size()) - 1;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      if (mask->state(i, j) == VisibleMask::hidden) continue;
      const auto u = knots(0, i), v = knots(1, j);
      const auto grid = evaluate_grid<2>(*surface, {std::span(u), std::span(v)});
      if (!grid) return std::unexpected(grid.error());
      const Points& points = grid->points();
      AlignedBox3d box;
      double bulge = 0;
      for (Eigen::Index k = 0; k < points.rows(); ++k) {
        box.extend(Point(points.row(k).transpose()));
        const Eigen::Index row = k / samples, column = k % samples;
        const auto second = [&](Eigen::Index step) {
          return (points.row(k - step) - 2 * points.row(k) + points.row(k + step)).norm();
        };
        if (column > 0 && column < samples - 1) bulge = std::max(bulge, second(1));
        if (row > 0 && row < samples - 1) bulge = std::max(bulge, second(samples));
      }
      const Point wider = Point::Constant(bulge);
      boxes.emplace_back(box.min() - wider, box.max() + wider);
      cells.push_back({i, j});
    }
  }
  return {};
}

void Shown::add_chords() {
  std::vector<AlignedBox3d> around;
  for (const TrimEdge& edge : region->edges) {
    for (std::size_t k = 0; k + 1 < edge.course.size(); ++k) {
      chords.push_back(
          {edge.course[k], edge.course[k + 1], edge.points[k], edge.points[k + 1], edge.deviation});
      around.push_back(chords.back().box());
    }
  }
  edges = BoxTree(around);
}

Expected<void> Shown::prepare() {
  auto made = ClosestPointSearch<2>::create(*surface);
  if (!made) return std::unexpected(std::move(made.error()));
  search.emplace(*std::move(made));
  for (int d = 0; d < 2; ++d) lines[at(d)] = cell_lines(surface->knots(d));
  mask.emplace(*region, lines);
  add_chords();
  return add_boxes();
}

bool Shown::visible(const Vector2d& f) const {
  std::array<int, 2> cell{};
  for (int d = 0; d < 2; ++d) {
    const auto& ends = lines[at(d)];
    const auto upper = std::upper_bound(ends.begin() + 1, ends.end() - 1, f[d]);
    cell[at(d)] = static_cast<int>(upper - ends.begin()) - 1;
  }
  const int state = mask->state(cell[0], cell[1]);
  return state == VisibleMask::full || (state != VisibleMask::hidden && region->contains(f));
}

// The chord gives the place along the edge, the surface the point there.
std::pair<VisibleFoot, bool> Shown::on_edge(const Point& x, const Vector2d& foot,
                                            double within) const {
  VisibleFoot result;
  std::optional<std::uint32_t> best;
  double along = 0;
  edges.near(x, within, [&](std::uint32_t k) {
    const Chord& chord = chords[k];
    const Point way = chord.end - chord.start;
    const double length = way.squaredNorm();
    const double t = length > 0 ? std::clamp((x - chord.start).dot(way) / length, 0.0, 1.0) : 0.0;
    const double distance = (chord.start + t * way - x).norm();
    if (distance >= within) return;
    within = distance;
    best = k;
    along = t;
  });
  if (!best) return {result, false};
  const Chord& chord = chords[*best];
  const Vector2d place = chord.from + along * (chord.to - chord.from);
  result.parameters = parameters_at_foot(*surface, place);
  const auto point = evaluate_point<2>(*surface, result.parameters);
  if (!point) return {VisibleFoot{}, false};
  result.point = *point;
  result.distance = (*point - x).norm();
  Vector2d off = foot - place;
  for (int d = 0; d < 2; ++d) {
    if (region->closed[at(d)]) off[d] -= std::round(off[d]);
  }
  const Vector2d way = chord.to - chord.from;
  if (way.squaredNorm() > 0) off -= off.dot(way) / way.squaredNorm() * way;
  return {result, off.cwiseAbs().maxCoeff() <= chord.deviation};
}

}  // namespace

struct VisibleSearch::Data {
  std::vector<Shown> shown;
  std::vector<int> numbers;  // of the surfaces in the list that was given
  std::vector<std::pair<std::uint32_t, std::uint32_t>> cells;  // surface in `shown`, cell of it
  BoxTree tree;
};

Expected<VisibleSearch> VisibleSearch::create(std::span<const FitSurface> surfaces,
                                              const std::vector<bool>& shown) {
  auto data = std::make_shared<Data>();
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    if (!shown.empty() && !shown[k]) continue;
    data->shown.push_back({.surface = surfaces[k].surface.get(), .region = &surfaces[k].region});
    data->numbers.push_back(static_cast<int>(k));
  }
  std::vector<Expected<void>> prepared(data->shown.size());
  detail::parallel_for(static_cast<std::ptrdiff_t>(data->shown.size()), 1,
                       [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                         for (auto k = static_cast<std::size_t>(begin);
                              k < static_cast<std::size_t>(end); ++k)
                           prepared[k] = data->shown[k].prepare();
                       });
  std::vector<AlignedBox3d> boxes;
  for (std::uint32_t k = 0; k < data->shown.size(); ++k) {
    if (!prepared[k]) return std::unexpected(prepared[k].error());
    for (std::uint32_t cell = 0; cell < data->shown[k].boxes.size(); ++cell) {
      boxes.push_back(data->shown[k].boxes[cell]);
      data->cells.emplace_back(k, cell);
    }
  }
  data->tree = BoxTree(boxes);
  return VisibleSearch(std::move(data));
}

VisibleFoot VisibleSearch::nearest(const Point& x, double reach) const {
  // What is known of a surface that has been searched: its nearest point was visible, or not.
  struct Searched {
    std::uint32_t surface = 0;
    bool settled = false;
  };
  std::vector<Searched> searched;
  VisibleFoot best;
  best.distance = reach;
  const auto take = [&](std::uint32_t k, const VisibleFoot& foot) {
    if (!(foot.distance < best.distance)) return;
    best = foot;
    best.surface = data_->numbers[k];
  };
  const auto as_foot = [](const ClosestPoint<2>& found) {
    return VisibleFoot{-1, found.parameters, found.point, found.distance};
  };
  double within = reach;
  data_->tree.near(x, within, [&](std::uint32_t box) {
    const auto [k, cell] = data_->cells[box];
    const Shown& shown = data_->shown[k];
    if (!(shown.boxes[cell].exteriorDistance(x) < within)) return;
    auto known = std::ranges::find(searched, k, &Searched::surface);
    if (known == searched.end()) {
      searched.push_back({k, true});
      const auto found = shown.search->nearest(x);
      const Vector2d fractions = shown.fractions(found.parameters);
      if (!(found.distance < within)) return;
      if (!shown.visible(fractions)) {
        const auto [edge, beside] = shown.on_edge(x, fractions, std::min(within, best.distance));
        take(k, beside ? as_foot(found) : edge);
        searched.back().settled = beside;
      } else {
        take(k, as_foot(found));
      }
      within = std::min(within, best.distance);
      known = searched.end() - 1;
    }
    if (known->settled) return;
    Vector2d middle;
    for (int d = 0; d < 2; ++d) {
      const auto line = at(shown.cells[cell][at(d)]);
      middle[d] = 0.5 * (shown.lines[at(d)][line] + shown.lines[at(d)][line + 1]);
    }
    const auto found =
        shown.search->nearest_from(x, parameters_of(*shown.surface, middle), shown.region->closed);
    if (found.distance < within && shown.visible(shown.fractions(found.parameters)))
      take(k, as_foot(found));
    within = std::min(within, best.distance);
  });
  if (best.surface < 0) return {};
  return best;
}

std::vector<VisibleFoot> VisibleSearch::nearest(std::span<const Point> points, double reach) const {
  std::vector<VisibleFoot> result(points.size());
  const auto count = static_cast<std::ptrdiff_t>(points.size());
  detail::parallel_for(
      count, detail::block_size(count, search_work), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
          result[k] = nearest(points[k], reach);
      });
  return result;
}

AlignedBox3d VisibleSearch::box() const {
  AlignedBox3d result;
  for (const Shown& shown : data_->shown) {
    for (const Chord& chord : shown.chords) result.extend(chord.box());
    if (shown.chords.empty()) {
      for (const AlignedBox3d& box : shown.boxes) result.extend(box);
    }
  }
  return result;
}

}  // namespace knead::morph
