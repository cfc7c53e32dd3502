#include "morph_deviation.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel_for.hpp"
#include "brep/tessellation/context_faces.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::detail {
namespace {

struct Differences {
  std::vector<Difference> before, after;
  std::vector<Point> places;  ///< before

  explicit Differences(std::size_t count = 0) : before(count), after(count), places(count) {}
};

/// Position of the value that this part of all, in order, does not exceed. Requires: count > 0
std::size_t share_of(std::size_t count, double part) {
  return static_cast<std::size_t>(std::ceil(part * static_cast<double>(count))) - 1;
}

MorphHistogram histogram_of(const std::vector<Difference>& differences) {
  constexpr int bins = 41;  // an odd number: one is about 0
  MorphHistogram result{0, std::vector<int>(bins, 0)};
  if (differences.empty()) return result;
  std::vector<double> sizes;
  for (const Difference& d : differences) sizes.push_back(std::abs(d.outward));
  const auto at = share_of(sizes.size(), 0.99);
  std::ranges::nth_element(sizes, sizes.begin() + static_cast<std::ptrdiff_t>(at));
  result.limit = sizes[at];
  for (const Difference& d : differences) {
    const double share = result.limit > 0 ? (d.outward / result.limit + 1) / 2 : 0.5;
    const int bin = std::clamp(static_cast<int>(share * bins), 0, bins - 1);
    ++result.counts[static_cast<std::size_t>(bin)];
  }
  return result;
}

/// A point of a surface and its unit normal ∂u × ∂v, which is 0 where it has none.
Expected<std::array<Point, 2>> with_normal(const Surface& surface,
                                           const std::array<double, 2>& parameters) {
  Parameters<2> place(1, 2);
  place << parameters[0], parameters[1];
  const auto at = evaluate<2>(surface, place, 1);
  if (!at) return std::unexpected(at.error());
  return std::array<Point, 2>{at->points().row(0).transpose(),
                              unit_normals(*at).row(0).transpose()};
}

Difference difference_of(const morph::Datum& datum, const Point& whole, const Point& outward) {
  // Of a datum that is known along one direction alone the rest is no deviation.
  const bool partly = !datum.along.isZero(0);
  const Point known = partly ? Point(datum.along.dot(whole) * datum.along) : whole;
  return {known.norm(), known.dot(outward)};
}

Expected<Differences> differences_at(const MovingModel& model, std::span<const morph::Datum> data,
                                     const std::vector<Surface>& moved) {
  const std::vector<int> senses = outward_senses(model);
  Differences result(data.size());
  std::vector<std::optional<Error>> errors(data.size() / 1024 + 1);
  const auto measure = [&](std::size_t i) -> Expected<void> {
    const morph::Datum& datum = data[i];
    const auto k = static_cast<std::size_t>(datum.surface);
    const auto from = with_normal(*model.placed[k].surface, datum.parameters);
    if (!from) return std::unexpected(from.error());
    const auto to = with_normal(moved[k], datum.parameters);
    if (!to) return std::unexpected(to.error());
    const auto& [place, normal] = *from;
    const auto& [new_place, new_normal] = *to;
    result.places[i] = place;
    result.before[i] = difference_of(datum, datum.displacement, senses[k] * normal);
    result.after[i] =
        difference_of(datum, datum.displacement - (new_place - place), senses[k] * new_normal);
    return {};
  };
  parallel_for(std::ssize(errors), 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto block = static_cast<std::size_t>(begin); block < static_cast<std::size_t>(end);
         ++block) {
      for (std::size_t i = 1024 * block; i < std::min(data.size(), 1024 * (block + 1)); ++i) {
        if (auto done = measure(i); !done && !errors[block]) errors[block] = done.error();
      }
    }
  });
  for (const auto& error : errors) {
    if (error) return std::unexpected(*error);
  }
  return result;
}

}  // namespace

Deviation deviation_of(const std::vector<Difference>& differences) {
  if (differences.empty()) return {};
  std::vector<double> lengths;
  for (const Difference& d : differences) lengths.push_back(d.length);
  std::ranges::sort(lengths);
  const auto count = static_cast<double>(lengths.size());
  const auto share = [&](double part) { return lengths[share_of(lengths.size(), part)]; };
  const auto [least, most] = std::ranges::minmax(differences, {}, &Difference::outward);
  Deviation result{.of_95 = share(0.95),
                   .of_99 = share(0.99),
                   .largest = lengths.back(),
                   .signed_least = least.outward,
                   .signed_most = most.outward};
  for (const auto& [length, outward] : differences) {
    result.mean += length / count;
    result.rms += length * length / count;
    result.signed_mean += outward / count;
  }
  result.rms = std::sqrt(result.rms);
  return result;
}

std::vector<int> outward_senses(const MovingModel& model) {
  std::vector<int> senses = face_senses(*model.model);
  senses.resize(model.placed.size(), 0);
  for (std::size_t k = 0; k < senses.size(); ++k) {
    const bool mirrored = model.places[k].to_model.linear().determinant() < 0;
    senses[k] = (senses[k] < 0) != mirrored ? -1 : 1;
  }
  return senses;
}

Expected<void> add_deviations(const MovingModel& model, std::span<const morph::Datum> data,
                              std::span<const morph::Datum> between,
                              const std::vector<Surface>& moved, MorphedFile& result) {
  const auto all = differences_at(model, data, moved);
  if (!all) return std::unexpected(all.error());
  MorphReport& report = result.report;
  report.before = deviation_of(all->before);
  report.after = deviation_of(all->after);
  report.histogram_before = histogram_of(all->before);
  report.histogram_after = histogram_of(all->after);
  std::vector<Differences> by_surface(model.surfaces.size());
  for (std::size_t i = 0; i < data.size(); ++i) {
    Differences& own = by_surface[static_cast<std::size_t>(data[i].surface)];
    own.before.push_back(all->before[i]);
    own.after.push_back(all->after[i]);
  }
  std::vector<int> numbers(model.surfaces.size(), -1);
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (!model.shown[k]) continue;
    const int net = model.surfaces[k].surface->size(), new_net = moved[k].size();
    report.control_points_before += net;
    report.control_points_after += new_net;
    const auto& before = by_surface[k].before;
    const auto& after = by_surface[k].after;
    if (before.empty() && model.surfaces[k].fixed) continue;
    numbers[k] = static_cast<int>(report.surfaces.size());
    report.surfaces.push_back({model.source->surfaces()[k].id, model.faces[k],
                               static_cast<int>(before.size()), deviation_of(before),
                               deviation_of(after), net, new_net});
  }
  if (!between.empty()) {
    const auto errors = differences_at(model, between, moved);
    if (!errors) return std::unexpected(errors.error());
    report.points_between = static_cast<int>(between.size());
    report.between = deviation_of(errors->after);
  }
  result.points.reserve(data.size());
  for (std::size_t i = 0; i < data.size(); ++i) {
    const Point& place = all->places[i];
    result.points.push_back({numbers[static_cast<std::size_t>(data[i].surface)],
                             {place.x(), place.y(), place.z()},
                             all->before[i].outward,
                             all->after[i].outward});
  }
  return {};
}

}  // namespace knead::detail
