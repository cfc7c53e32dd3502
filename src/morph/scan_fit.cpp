#include "scan_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/parallel_for.hpp"
#include "knead/spline/closest_point.hpp"
#include "knead/spline/evaluate.hpp"
#include "robust_weights.hpp"

namespace knead::morph {
namespace {

constexpr int most_turns = 8;
constexpr double settled = 0.98;       // distances of a turn, of those before
constexpr double overestimated = 0.9;  // less noise than that has been assumed
constexpr double near_noise = 1.02;    // distances that are those of the noise, of it
constexpr double least_noise = 1e-5;   // of the size: less is not followed unless it is asked for
constexpr double approach = 0.1;       // a turn follows data to that part of their distances
constexpr std::size_t most_data = 200'000;  // of one fit
constexpr double facing = std::numbers::sqrt2 / 2;
constexpr double search_work = 1e4;  // multiplications, of one point

struct Partner {
  PointState state = PointState::far;
  VisibleFoot foot = {};
  Point normal = Point::Zero();
  double above = 0;  ///< along it
};

/// The model as it is now, and what is nearest of it.
struct MovedModel {
  std::vector<FitSurface> surfaces;
  VisibleSearch search;
};

Expected<MovedModel> moved_model(std::span<const FitSurface> given,
                                 const std::vector<Surface>& moved,
                                 const std::vector<bool>& shown) {
  std::vector<FitSurface> surfaces(given.begin(), given.end());
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    surfaces[s].surface = std::make_shared<const Surface>(moved[s]);
    // A region's parameters stay, and its places go along.
    for (TrimEdge& edge : surfaces[s].region.edges) {
      for (std::size_t k = 0; k < edge.course.size(); ++k) {
        const auto place = evaluate_point<2>(
            *surfaces[s].surface, parameters_at_foot(*surfaces[s].surface, edge.course[k]));
        if (!place) return std::unexpected(place.error());
        edge.points[k] = *place;
      }
    }
  }
  auto search = VisibleSearch::create(surfaces, shown);
  if (!search) return std::unexpected(search.error());
  return MovedModel{std::move(surfaces), *std::move(search)};
}

/// The foot downhill from the last one, if that is visible: between turns feet move little.
std::optional<VisibleFoot> foot_beside(const Point& x, const VisibleFoot& before,
                                       const FitSurface& on) {
  const auto found = closest_point_from<2>(*on.surface, x, before.parameters, on.region.closed);
  Eigen::Vector2d fractions;
  for (int d = 0; d < 2; ++d) {
    const Interval domain = on.surface->knots(d).domain();
    fractions[d] = (found.parameters[static_cast<std::size_t>(d)] - domain.lower) / domain.length();
  }
  if (!on.region.contains(fractions)) return std::nullopt;
  return VisibleFoot{before.surface, found.parameters, found.point, found.distance};
}

/// Seeks the partner of one point. \param last that of the turn before
Expected<Partner> partner_of(const Point& x, const Point& scan_normal, const Partner* last,
                             const VisibleSearch& search, std::span<const FitSurface> surfaces,
                             double reach, double size) {
  Partner result;
  std::optional<VisibleFoot> foot;
  if (last != nullptr && last->state == PointState::used)
    foot = foot_beside(x, last->foot, surfaces[static_cast<std::size_t>(last->foot.surface)]);
  result.foot = foot && foot->distance < reach ? *foot : search.nearest(x, reach);
  if (result.foot.surface < 0) return result;
  const auto normal = normal_at(*surfaces[static_cast<std::size_t>(result.foot.surface)].surface,
                                result.foot.parameters);
  if (!normal) return std::unexpected(normal.error());
  result.normal = *normal;
  const Point way = x - result.foot.point;
  result.above = way.dot(*normal);
  const bool known = !scan_normal.isZero(0);
  result.state = beside(way, *normal, search_accuracy * size)           ? PointState::beyond_border
                 : known && std::abs(scan_normal.dot(*normal)) < facing ? PointState::turned_away
                                                                        : PointState::used;
  return result;
}

Expected<std::vector<Partner>> partners_of(const Scan& scan, const std::vector<Partner>& last,
                                           const VisibleSearch& search,
                                           std::span<const FitSurface> surfaces, double reach) {
  const auto count = static_cast<std::ptrdiff_t>(scan.points.size());
  const double size = search.box().diagonal().norm();
  std::vector<Partner> result(scan.points.size());
  const std::ptrdiff_t block = detail::block_size(count, search_work);
  std::vector<std::optional<Error>> errors(static_cast<std::size_t>((count + block - 1) / block));
  detail::parallel_for(count, block, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      auto found = partner_of(scan.points[k], scan.normals[k], last.empty() ? nullptr : &last[k],
                              search, surfaces, reach, size);
      auto& error = errors[k / static_cast<std::size_t>(block)];
      if (!found && !error) error = found.error();
      if (found) result[k] = *found;
    }
  });
  for (const auto& error : errors) {
    if (error) return std::unexpected(*error);
  }
  return result;
}

/// The displacement that puts the material point of a foot level with its partner.
Expected<Point> displacement_of(const Partner& partner, const Surface& given, bool along_normal) {
  const auto before = evaluate_point<2>(given, partner.foot.parameters);
  if (!before) return std::unexpected(before.error());
  const Point d = partner.foot.point + partner.above * partner.normal - *before;
  return along_normal ? part_along_normal(d, given, partner.foot.parameters) : d;
}

/// Partners as data. \param weighted by how far they are from the model, else all alike
Expected<ScanPartners> as_data(const Scan& scan, const std::vector<Partner>& partners,
                               const VisibleSearch& search, std::span<const FitSurface> given,
                               const ScanSettings& settings, bool weighted, double noise) {
  ScanPartners result;
  Correspondences& found = result.found;
  std::vector<double> distances;
  for (const Partner& partner : partners) {
    result.states.push_back(partner.state);
    if (partner.state == PointState::used) distances.push_back(std::abs(partner.above));
  }
  const double deviation = weighted ? std::max(noise, robust_deviation(distances)) : 0;
  double squares = 0;
  for (std::size_t k = 0; k < partners.size(); ++k) {
    const Partner& partner = partners[k];
    if (partner.state == PointState::far && found.left_out++ < Correspondences::most_listed) {
      constexpr double farther = 100;  // times the reach, to say how far it is
      found.listed.push_back(
          {k, scan.points[k], search.nearest(scan.points[k], farther * settings.reach).distance});
    }
    result.beyond_border += partner.state == PointState::beyond_border ? 1 : 0;
    result.turned_away += partner.state == PointState::turned_away ? 1 : 0;
    if (partner.state != PointState::used) continue;
    const double weight = tukey_weight(partner.above, deviation);
    if (weight == 0) {
      ++result.outliers;
      continue;
    }
    const Surface& surface = *given[static_cast<std::size_t>(partner.foot.surface)].surface;
    const auto d = displacement_of(partner, surface, settings.along_normal);
    if (!d) return std::unexpected(d.error());
    found.data.push_back({partner.foot.surface, partner.foot.parameters, *d, weight});
    found.data.back().along = partner.normal;
    found.numbers.push_back(k);
    found.largest_distance = std::max(found.largest_distance, std::abs(partner.above));
    squares += partner.above * partner.above;
  }
  if (!found.data.empty())
    result.rms = found.rms_distance = std::sqrt(squares / static_cast<double>(found.data.size()));
  return result;
}

/// What is fitted: the data on surfaces that are free, every second, third, … of many.
std::vector<Datum> fitted(const std::vector<Datum>& data, std::span<const FitSurface> surfaces,
                          double scale) {
  std::vector<Datum> result;
  const std::size_t step = (data.size() + most_data - 1) / most_data;
  for (std::size_t k = 0; k < data.size(); k += step) {
    if (surfaces[static_cast<std::size_t>(data[k].surface)].fixed) continue;
    result.push_back(data[k]);
    result.back().displacement *= scale;
  }
  return result;
}

/// The noise as neighbours differ in their distances from the moved model: √2 σ if these are
/// independent, and less by what shape they have in common, which has not been followed yet.
double noise_between(std::span<const std::array<std::uint32_t, 2>> pairs,
                     const std::vector<Partner>& partners) {
  std::vector<double> differences;
  for (const auto& [a, b] : pairs) {
    if (partners[a].state == PointState::used && partners[b].state == PointState::used)
      differences.push_back(std::abs(partners[a].above - partners[b].above));
  }
  return median_deviation(std::move(differences)) / std::numbers::sqrt2;
}

// Only the noise along the normal is left in the data, whose deviation is that of one coordinate;
// `FitSettings` has that of three.
/// \param before a fit of nearly the same data, from which this one goes on
/// \param coarseness times as far from the data as wanted in the end, edges too
FitSettings fit_settings(const ScanSettings& settings, double noise, double scale,
                         const FitResult& before, double coarseness = 1) {
  FitSettings result{
      .tolerance = settings.tolerance, .affine = false, .refinement = settings.refinement};
  if (noise > 0) result.noise = coarseness * std::abs(scale) * noise / std::numbers::sqrt3;
  if (coarseness > 1) {
    result.parting = approach * coarseness * noise;
    result.angle *= coarseness;
  }
  result.begin_with = before.surfaces;
  if (before.lambda > 0) result.begin_with_energy = before.lambda;
  return result;
}

}  // namespace

Expected<ScanPartners> scan_partners(const Scan& scan, const VisibleSearch& search,
                                     std::span<const FitSurface> surfaces,
                                     const ScanSettings& settings) {
  const auto partners = partners_of(scan, {}, search, surfaces, settings.reach);
  if (!partners) return std::unexpected(partners.error());
  return as_data(scan, *partners, search, surfaces, settings, false, 0);
}

Expected<ScanFit> fit_scan(const Scan& scan, std::span<const FitSurface> surfaces,
                           std::span<const FitEdge> edges, const std::vector<bool>& shown,
                           const ScanSettings& settings) {
  ScanFit result;
  auto search = VisibleSearch::create(surfaces, shown);
  if (!search) return std::unexpected(search.error());
  const double size = search->box().diagonal().norm();
  if (!settings.tolerance || settings.noise)
    result.noise = settings.noise ? *settings.noise
                                  : std::max(least_noise * size, estimated_noise(scan.points));
  auto partners = partners_of(scan, {}, *search, surfaces, settings.reach);
  if (!partners) return std::unexpected(partners.error());
  auto data = as_data(scan, *partners, *search, surfaces, settings, false, 0);
  if (!data) return std::unexpected(data.error());
  result.first = *data;
  const bool estimates = result.noise > 0 && !settings.noise;
  const auto pairs =
      estimates ? neighbour_pairs(scan.points) : std::vector<std::array<std::uint32_t, 2>>();
  if (auto right = settings.check ? settings.check(*data) : Expected<void>(); !right)
    return std::unexpected(right.error());
  for (;;) {
    if (auto on = settings.told ? settings.told(result.turns, most_turns) : Expected<void>(); !on)
      return std::unexpected(on.error());
    // Feet are as wrong as the model is off: what is followed more closely at first is not there.
    const double coarseness =
        result.noise > 0 ? std::max(1.0, approach * data->rms / result.noise) : 1;
    auto fit = fit_surfaces(surfaces, edges, fitted(data->found.data, surfaces, 1),
                            fit_settings(settings, result.noise, 1, result.fit, coarseness));
    if (!fit) return std::unexpected(fit.error());
    auto model = moved_model(surfaces, fit->surfaces, shown);
    if (!model) return std::unexpected(model.error());
    auto next = partners_of(scan, *partners, model->search, model->surfaces, settings.reach);
    if (!next) return std::unexpected(next.error());
    auto sought = as_data(scan, *next, model->search, surfaces, settings, true, result.noise);
    if (!sought) return std::unexpected(sought.error());
    result.fit = *std::move(fit);
    result.last = *sought;
    ++result.turns;
    // What the points alone say of the noise is too much where they are too sparse for their shape.
    const double less = estimates ? std::max(least_noise * size, noise_between(pairs, *next)) : 0;
    const bool lower = estimates && less < overestimated * result.noise;
    if (lower) result.noise = less;
    const bool little = result.turns > 1 && !lower && sought->rms > settled * data->rms;
    const bool noise_left = sought->rms <= near_noise * result.noise;
    if ((coarseness == 1 && (little || noise_left)) || result.turns == most_turns) break;
    partners = std::move(next);
    data = std::move(sought);
  }
  if (settings.scale == 1) return result;
  auto scaled =
      fit_surfaces(surfaces, edges, fitted(result.last.found.data, surfaces, settings.scale),
                   fit_settings(settings, result.noise, settings.scale, result.fit));
  if (!scaled) return std::unexpected(scaled.error());
  result.fit = *std::move(scaled);
  return result;
}

}  // namespace knead::morph
