#include "display_range.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knead {
namespace {

constexpr std::size_t stride = 3;  // grid lines between samples

/// The lines of a direction at which samples are taken, both ends among them.
std::vector<std::size_t> sampled(std::size_t count) {
  std::vector<std::size_t> lines;
  for (std::size_t k = 0; k < count; k += stride) lines.push_back(k);
  if (lines.back() != count - 1) lines.push_back(count - 1);
  return lines;
}

/// Half the distance between the neighbours of each of these lines.
std::vector<double> widths(const std::vector<double>& u, const std::vector<std::size_t>& lines) {
  std::vector<double> result;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    result.push_back((u[lines[std::min(k + 1, lines.size() - 1)]] - u[lines[k == 0 ? 0 : k - 1]]) /
                     2);
  }
  return result;
}

/// For each pair of sampled lines whether their point is visible; kept, as it takes long and
/// changes with the grid alone.
const std::vector<bool>& visible_samples(const DisplayInput& input,
                                         const std::array<std::vector<std::size_t>, 2>& lines) {
  auto& kept = input.memory.visible;
  const auto& region = input.visible;
  for (const auto& known : kept) {
    if (known.region == region && known.parameters == input.parameters) return known.samples;
  }
  const auto fraction = [&](std::size_t d, std::size_t line) {
    const std::vector<double>& u = input.parameters[d];
    return (u[line] - u.front()) / (u.back() - u.front());
  };
  std::vector<bool> samples;
  for (const std::size_t k : lines[0]) {
    for (const std::size_t l : lines[1]) {
      samples.push_back(!region || region->contains({fraction(0, k), fraction(1, l)}));
    }
  }
  if (std::ranges::find(samples, true) == samples.end()) samples.assign(samples.size(), true);
  constexpr std::size_t most_kept = 1024;
  if (kept.size() == most_kept) kept.erase(kept.begin());
  kept.push_back({region, input.parameters, std::move(samples)});
  return kept.back().samples;
}

}  // namespace

// Quantiles by area: every third grid line in each direction gives a sample with the area |S_u ×
// S_v| Δu Δv around it. Extremes are taken over all points of the grid, and a point is as visible
// as the sample nearest to it, since the test of visibility costs more than everything else here.
void DisplayRangeFinder::add(const DisplayInput& input, std::span<const double> values) {
  const auto& [us, vs] = input.parameters;
  const std::array lines = {sampled(us.size()), sampled(vs.size())};
  const std::array width = {widths(us, lines[0]), widths(vs, lines[1])};
  const std::vector<bool>& visible = visible_samples(input, lines);
  const Points &u = input.evaluation.at({1, 0}), &v = input.evaluation.at({0, 1});
  for (std::size_t k = 0; k < lines[0].size(); ++k) {
    for (std::size_t l = 0; l < lines[1].size(); ++l) {
      const std::size_t at = lines[0][k] * vs.size() + lines[1][l];
      if (!visible[k * lines[1].size() + l] || !std::isfinite(values[at])) continue;
      const auto row = static_cast<Eigen::Index>(at);
      const Point a = u.row(row), b = v.row(row);
      samples_.push_back({values[at], a.cross(b).norm() * width[0][k] * width[1][l]});
    }
  }
  const auto nearest = [](std::size_t line, std::size_t count) {
    return std::min((line + 1) / stride, count - 1);
  };
  for (std::size_t k = 0; k < us.size(); ++k) {
    for (std::size_t l = 0; l < vs.size(); ++l) {
      const double x = values[k * vs.size() + l];
      const std::size_t sample =
          nearest(k, lines[0].size()) * lines[1].size() + nearest(l, lines[1].size());
      if (!visible[sample] || !std::isfinite(x)) continue;
      if (!extremes_) extremes_ = {x, x};
      auto& [least, greatest] = *extremes_;
      least = std::min(least, x);
      greatest = std::max(greatest, x);
    }
  }
}

std::optional<DisplayRange> DisplayRangeFinder::range(const Display& display) const {
  if (!extremes_) return std::nullopt;
  DisplayRange result{.least = (*extremes_)[0], .greatest = (*extremes_)[1]};
  std::array<double, 2> ends = *extremes_;
  if (display.limits) {
    ends = *display.limits;
  } else {
    std::vector<Sample> sorted = samples_;
    std::ranges::sort(sorted, {}, &Sample::value);
    const double whole = std::accumulate(sorted.begin(), sorted.end(), 0.0,
                                         [](double sum, const Sample& s) { return sum + s.area; });
    for (const int end : {0, 1}) {
      const double share = display.percentiles[static_cast<std::size_t>(end)];
      if (share == end || sorted.empty()) continue;  // the extreme itself
      double below = 0;
      const auto found = std::ranges::find_if(
          sorted, [&](const Sample& s) { return (below += s.area) >= share * whole; });
      ends[static_cast<std::size_t>(end)] = (found == sorted.end() ? sorted.back() : *found).value;
    }
    // Symmetric about 0 for signed quantities, so that the neutral colour is 0; from 0 for the
    // others.
    const double upper = display.share * std::max(std::abs(ends[0]), std::abs(ends[1]));
    ends = {display.palette == DisplayPalette::diverging ? -upper : 0, upper};
  }
  result.lower = ends[0];
  result.upper = ends[1];
  return result;
}

}  // namespace knead
