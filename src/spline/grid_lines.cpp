#include "grid_lines.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "knead/spline/basis.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

// Of the largest: less is a pole, where directions are not determined.
constexpr double least_speed = 1e-6;

/// Every span in so many pieces.
GridLines divided(const KnotVector& knots, const std::vector<int>& pieces) {
  GridLines lines;
  std::size_t at = 0;
  for (int s : knots.spans()) {
    const int count = pieces[at++];
    lines.knot_lines.push_back(static_cast<std::uint32_t>(lines.parameters.size()));
    for (int k = 0; k < count; ++k)
      lines.parameters.push_back(knots[s] + (knots[s + 1] - knots[s]) * k / count);
  }
  lines.knot_lines.push_back(static_cast<std::uint32_t>(lines.parameters.size()));
  lines.parameters.push_back(knots.domain().upper);
  return lines;
}

/// How closely the lines of one direction follow a surface: the largest chord over a whole span, of
/// each, and in how many pieces it is cut.
struct Direction {
  std::vector<SpanChord> chords;
  std::vector<int> pieces;
};

/// Into how many parts the tolerance of a window cuts each piece between lines; 1 where it is
/// outside.
std::vector<int> parts_in_window(const GridLines& coarse, const Direction& of, double lower,
                                 double upper, double tolerance) {
  std::vector<int> parts;
  std::size_t span = 0;
  for (std::uint32_t k = 0; k + 1 < coarse.parameters.size(); ++k) {
    if (span + 1 < coarse.knot_lines.size() && coarse.knot_lines[span + 1] == k) ++span;
    const bool outside = coarse.parameters[k + 1] < lower || coarse.parameters[k] > upper;
    const double in_span = of.pieces[span], chord = of.chords[span].drift / (in_span * in_span);
    parts.push_back(
        outside ? 1
                : static_cast<int>(std::clamp(std::ceil(std::sqrt(chord / tolerance)), 1.0, 1e6)));
  }
  return parts;
}

GridLines divided(const GridLines& coarse, const std::vector<int>& parts) {
  GridLines lines;
  std::size_t next = 0;  // knot line
  for (std::uint32_t k = 0; k < coarse.parameters.size(); ++k) {
    const auto here = static_cast<std::uint32_t>(lines.parameters.size());
    if (next < coarse.knot_lines.size() && coarse.knot_lines[next] == k) {
      lines.knot_lines.push_back(here);
      ++next;
    }
    lines.coarse.push_back(here);
    lines.parameters.push_back(coarse.parameters[k]);
    if (k == parts.size()) break;
    const double from = coarse.parameters[k], to = coarse.parameters[k + 1];
    for (int j = 1; j < parts[k]; ++j)
      lines.parameters.push_back(from + (to - from) * j / parts[k]);
  }
  return lines;
}

/// The same number in every span.
int pieces_per_span(const KnotVector& knots, int detail, int most) {
  const int count = static_cast<int>(knots.spans().size()), least = knots.degree() == 1 ? 1 : 2;
  const int wanted = knots.degree() == 1 ? 1 : (detail - 1) / count + 1;
  return std::clamp(wanted, least, std::max(least, most / count));
}

/// Parameters at the ends and in the middle of spans, thinned out evenly.
std::vector<double> lines_across(const KnotVector& knots) {
  constexpr std::size_t most = 64;
  std::vector<double> all;
  for (int s : knots.spans()) {
    all.push_back(knots[s]);
    all.push_back((knots[s] + knots[s + 1]) / 2);
  }
  all.push_back(knots.domain().upper);
  if (all.size() <= most) return all;
  std::vector<double> result;
  for (std::size_t k = 0; k < most; ++k) result.push_back(all[k * (all.size() - 1) / (most - 1)]);
  return result;
}

}  // namespace

Expected<std::vector<SpanChord>> span_chords(const Surface& surface, int d) {
  const KnotVector& knots = surface.knots(d);
  const std::vector<int> spans = knots.spans();
  const int samples = std::max(3, knots.degree());
  std::array<std::vector<double>, 2> places;
  for (int s : spans) {
    for (int k = 0; k < samples; ++k) {
      places[static_cast<std::size_t>(d)].push_back(knots[s] + (knots[s + 1] - knots[s]) *
                                                                   (k + 0.5) / samples);
    }
  }
  places[static_cast<std::size_t>(1 - d)] = lines_across(surface.knots(1 - d));
  const auto u = tabulate_basis(surface.knots(0), places[0], 2),
             v = tabulate_basis(surface.knots(1), places[1], 2);
  if (!u) return std::unexpected(u.error());
  if (!v) return std::unexpected(v.error());
  Evaluation<2> values;
  if (auto status = evaluate_grid<2>(surface, {&*u, &*v}, 2, values); !status)
    return std::unexpected(status.error());
  const Points& first = d == 0 ? values.at({1, 0}) : values.at({0, 1});
  const Points& second = d == 0 ? values.at({2, 0}) : values.at({0, 2});
  const double slow = least_speed * first.rowwise().norm().maxCoeff();
  std::vector<SpanChord> chords(spans.size());
  const auto columns = static_cast<Eigen::Index>(places[1].size());
  for (Eigen::Index row = 0; row < first.rows(); ++row) {
    SpanChord& chord =
        chords[static_cast<std::size_t>((d == 0 ? row / columns : row % columns) / samples)];
    const Point t = first.row(row).transpose(), along = second.row(row).transpose();
    const double square = t.squaredNorm(), speed = std::sqrt(square);
    const double across = (square > 0 ? Point(along - along.dot(t) / square * t) : along).norm();
    chord.distance = std::max(chord.distance, across);
    chord.drift = std::max(chord.drift, along.norm());
    if (speed > slow) chord.turn = std::max(chord.turn, across / speed);
  }
  for (std::size_t k = 0; k < spans.size(); ++k) {
    const double length = knots[spans[k] + 1] - knots[spans[k]];
    chords[k].distance *= length * length / 8;
    chords[k].drift *= length * length / 8;
    chords[k].turn *= length;
  }
  return chords;
}

std::vector<double> even_parameters(const KnotVector& knots, int pieces) {
  std::vector<double> result;
  for (const int s : knots.spans()) {
    for (int k = 0; k < pieces; ++k)
      result.push_back(knots[s] + (knots[s + 1] - knots[s]) * k / pieces);
  }
  result.push_back(knots.domain().upper);
  return result;
}

GridLines grid_lines(const KnotVector& knots, int detail, int most) {
  assert(detail >= 1);
  return divided(knots,
                 std::vector<int>(knots.spans().size(), pieces_per_span(knots, detail, most)));
}

namespace {

bool allowed(const ChordOptions& options, double rows, double columns) {
  return rows <= options.most && columns <= options.most && rows * columns <= options.most_points;
}

std::array<GridLines, 2> with_window(const Surface& surface, const std::array<Direction, 2>& of,
                                     const ChordOptions& options) {
  const GridWindow& window = *options.window;
  const std::array coarse = {divided(surface.knots(0), of[0].pieces),
                             divided(surface.knots(1), of[1].pieces)};
  for (double tolerance = window.tolerance;; tolerance *= 2) {
    std::array<std::vector<int>, 2> parts;
    std::array<double, 2> counts = {1, 1};
    for (std::size_t d = 0; d < 2; ++d) {
      parts[d] = parts_in_window(coarse[d], of[d], window.lower[d], window.upper[d], tolerance);
      for (const int n : parts[d]) counts[d] += n;
    }
    const bool finer = counts[0] > static_cast<double>(coarse[0].parameters.size()) ||
                       counts[1] > static_cast<double>(coarse[1].parameters.size());
    if (allowed(options, counts[0], counts[1]) || !finer)
      return {divided(coarse[0], parts[0]), divided(coarse[1], parts[1])};
  }
}

}  // namespace

Expected<std::array<GridLines, 2>> grid_lines(const Surface& surface, const ChordOptions& options) {
  assert(options.detail >= 1 && options.tolerance > 0);
  assert(!options.window || options.window->tolerance > 0);
  std::array<Direction, 2> of;
  std::array<int, 2> base;
  for (int d = 0; d < 2; ++d) {
    auto found = span_chords(surface, d);
    if (!found) return std::unexpected(found.error());
    of[static_cast<std::size_t>(d)].chords = *std::move(found);
    base[static_cast<std::size_t>(d)] = pieces_per_span(surface.knots(d), options.detail, 400);
  }
  for (double tolerance = options.tolerance;; tolerance *= 2) {
    std::array<double, 2> counts = {1, 1};
    bool finer = false;
    for (std::size_t d = 0; d < 2; ++d) {
      auto& [chords, pieces] = of[d];
      pieces.clear();
      for (const SpanChord& chord : chords) {
        const double wanted = std::min(std::ceil(std::sqrt(chord.distance / tolerance)), 1e6);
        pieces.push_back(std::max(base[d], static_cast<int>(wanted)));
        counts[d] += pieces.back();
        finer = finer || pieces.back() > base[d];
      }
    }
    if (!allowed(options, counts[0], counts[1]) && finer) continue;
    if (options.window) return with_window(surface, of, options);
    return std::array{divided(surface.knots(0), of[0].pieces),
                      divided(surface.knots(1), of[1].pieces)};
  }
}

}  // namespace knead
